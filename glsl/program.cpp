#include "glsl/program.h"

#include <fmt/format.h>

#include <glm/gtc/type_ptr.hpp>
#include <string_view>

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

}  // namespace

Program::Program(const GladGLContext& gl, const ExpandedSource& vertex, const ExpandedSource& fragment)
    : gl_(&gl), program_(gl, gl.CreateProgram(), [](const GladGLContext& table, GLuint name) {
        table.DeleteProgram(name);
      }) {
  const GlObject vertex_shader = Compile(gl, GL_VERTEX_SHADER, vertex);
  const GlObject fragment_shader = Compile(gl, GL_FRAGMENT_SHADER, fragment);
  gl.AttachShader(id(), vertex_shader.id());
  gl.AttachShader(id(), fragment_shader.id());
  gl.LinkProgram(id());
  gl.DetachShader(id(), vertex_shader.id());
  gl.DetachShader(id(), fragment_shader.id());
  GLint linked = GL_FALSE;
  gl.GetProgramiv(id(), GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) return;
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
