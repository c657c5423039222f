#include "glsl/program.h"

#include <fmt/format.h>

#include <cstring>
#include <glm/gtc/type_ptr.hpp>
#include <string_view>

#include "glsl/program_store.h"
#include "scenes/error.h"

namespace arealab {
namespace {

// The first line of a driver's log that speaks of an error, else its first line.
std::string FirstError(std::string_view log) {
  std::string first;
  while (!log.empty()) {
    const auto end = std::min(log.find('\n'), log.size());
    const std::string_view line = log.substr(0, end);
    log.remove_prefix(std::min(end + 1, log.size()));
    if (line.find("error") != std::string_view::npos) return std::string(line);
    if (first.empty()) first = line;
  }
  return first.empty() ? "the driver does not say why" : first;
}

GlObject Compile(const GladGLContext& gl, GLenum stage, const ExpandedSource& source) {
  GlObject shader(gl, gl.CreateShader(stage),
                  [](const GladGLContext& table, GLuint name) { table.DeleteShader(name); });
  const char* text = source.text.data();
  const auto length = static_cast<GLint>(source.text.size());
  gl.ShaderSource(shader.id(), 1, &text, &length);
  gl.CompileShader(shader.id());
  GLint compiled = GL_FALSE;
  gl.GetShaderiv(shader.id(), GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE) return shader;
  GLint log_size = 0;
  gl.GetShaderiv(shader.id(), GL_INFO_LOG_LENGTH, &log_size);
  std::string log(static_cast<std::size_t>(std::max(log_size, 1)), '\0');
  GLsizei written = 0;
  gl.GetShaderInfoLog(shader.id(), log_size, &written, log.data());
  log.resize(static_cast<std::size_t>(written));
  throw InputError(fmt::format("{}; expected GLSL 4.50", FirstError(source.RewriteLog(log))));
}

std::shared_ptr<ProgramStore> program_store;

// The texts and the driver; empty where programs are not kept.
std::string ContentOf(const GladGLContext& gl, const ExpandedSource& vertex, const ExpandedSource& fragment) {
  GLint formats = 0;
  if (program_store) gl.GetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats);
  if (formats == 0) return "";
  const auto named = [&](GLenum name) { return std::string(reinterpret_cast<const char*>(gl.GetString(name))) + "\n"; };
  return named(GL_RENDERER) + named(GL_VERSION) + vertex.text + fragment.text;
}

bool IsLinked(const GladGLContext& gl, GLuint program) {
  GLint linked = GL_FALSE;
  gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
  return linked == GL_TRUE;
}

// The format's number, then the driver's bytes.
bool LoadKept(const GladGLContext& gl, GLuint program, const std::string& content) {
  const std::optional<std::string> bytes = program_store->Find(content);
  GLenum format = 0;
  if (!bytes || bytes->size() <= sizeof(format)) return false;
  std::memcpy(&format, bytes->data(), sizeof(format));
  gl.ProgramBinary(program, format, bytes->data() + sizeof(format), static_cast<GLsizei>(bytes->size() - sizeof(format)));
  gl.GetError();  // a format that the driver does not know is one
  return IsLinked(gl, program);
}

void Keep(const GladGLContext& gl, GLuint program, const std::string& content) {
  GLint size = 0;
  gl.GetProgramiv(program, GL_PROGRAM_BINARY_LENGTH, &size);
  if (size <= 0) return;
  GLenum format = 0;
  std::string bytes(sizeof(format) + static_cast<std::size_t>(size), '\0');
  gl.GetProgramBinary(program, size, &size, &format, bytes.data() + sizeof(format));
  std::memcpy(bytes.data(), &format, sizeof(format));
  bytes.resize(sizeof(format) + static_cast<std::size_t>(size));
  program_store->Keep(content, bytes);
}

}  // namespace

void KeepProgramsIn(std::shared_ptr<ProgramStore> store) { program_store = std::move(store); }

Program::Program(const GladGLContext& gl, const ExpandedSource& vertex, const ExpandedSource& fragment)
    : gl_(&gl), program_(gl, gl.CreateProgram(), [](const GladGLContext& table, GLuint name) {
        table.DeleteProgram(name);
      }) {
  const std::string content = ContentOf(gl, vertex, fragment);
  if (!content.empty() && LoadKept(gl, id(), content)) return;
  const GlObject vertex_shader = Compile(gl, GL_VERTEX_SHADER, vertex);
  const GlObject fragment_shader = Compile(gl, GL_FRAGMENT_SHADER, fragment);
  gl.AttachShader(id(), vertex_shader.id());
  gl.AttachShader(id(), fragment_shader.id());
  if (!content.empty()) gl.ProgramParameteri(id(), GL_PROGRAM_BINARY_RETRIEVABLE_HINT, GL_TRUE);
  gl.LinkProgram(id());
  gl.DetachShader(id(), vertex_shader.id());
  gl.DetachShader(id(), fragment_shader.id());
  if (IsLinked(gl, id())) {
    if (!content.empty()) Keep(gl, id(), content);
    return;
  }
  GLint log_size = 0;
  gl.GetProgramiv(id(), GL_INFO_LOG_LENGTH, &log_size);
  std::string log(static_cast<std::size_t>(std::max(log_size, 1)), '\0');
  GLsizei written = 0;
  gl.GetProgramInfoLog(id(), log_size, &written, log.data());
  log.resize(static_cast<std::size_t>(written));
  // A linker speaks of functions that are missing and seldom gives a line: name the file that was asked for.
  const std::string file = fragment.origins.empty() ? "the program" : fragment.origins.back().file;
  throw InputError(fmt::format("{}: does not link: {}; expected all functions that are called to be there",
                               file, FirstError(log)));
}

GLint Program::Location(const std::string& name) const {
  return gl_->GetUniformLocation(id(), name.c_str());
}

void Program::Set(const std::string& name, int value) const {
  gl_->ProgramUniform1i(id(), Location(name), value);
}

void Program::Set(const std::string& name, float value) const {
  gl_->ProgramUniform1f(id(), Location(name), value);
}

void Program::Set(const std::string& name, const glm::vec2& value) const {
  gl_->ProgramUniform2f(id(), Location(name), value.x, value.y);
}

void Program::Set(const std::string& name, const glm::vec3& value) const {
  gl_->ProgramUniform3f(id(), Location(name), value.x, value.y, value.z);
}

void Program::Set(const std::string& name, const glm::dvec3& value) const {
  gl_->ProgramUniform3d(id(), Location(name), value.x, value.y, value.z);
}

void Program::Set(const std::string& name, const glm::mat3& value) const {
  gl_->ProgramUniformMatrix3fv(id(), Location(name), 1, GL_FALSE, glm::value_ptr(value));
}

}  // namespace arealab
