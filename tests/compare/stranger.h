// A minimal renderer that knows nothing of AreaLab: it has the folder that `arealab export` wrote, OpenGL 3.3, and numbers. Its
// G-buffer and lights are the caller's; programs, tables and uniforms are found by the names that inputs.json gives.
#pragma once

#include <OpenImageIO/imageio.h>
#include <glad/gl.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace stranger {

struct Input {
  int width = 0, height = 0;
  std::map<std::string, std::vector<float>> gbuffer;  // RGBA by sampler
  std::array<float, 3> view_position{};
  std::vector<float> light_rows;  // of one light: 4 floats a row
  std::array<float, 3> sky{};
};

struct Output {
  std::vector<float> diffuse, specular;  // RGBA
};

inline std::string ReadText(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(file + " is not there");
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// The numbers of `static const float NAME[…] = {…}` in a C header.
inline std::vector<float> ReadCArray(const std::string& header, const std::string& name) {
  const std::string start = " " + name + "[";
  const std::size_t at = header.find(start);
  if (at == std::string::npos) throw std::runtime_error("no array " + name);
  std::vector<float> values;
  const char* p = header.c_str() + header.find('{', at) + 1;
  for (char* end = nullptr;; p = end) {
    while (*p == ',' || *p == '\n' || *p == ' ') ++p;
    const float value = std::strtof(p, &end);
    if (end == p) return values;
    values.push_back(value);
  }
}

inline int ReadSize(const std::string& header, const std::string& name) {
  return std::atoi(header.c_str() + header.find(name + " = ") + name.size() + 3);
}

inline GLuint Compile(const GladGLContext& gl, GLenum kind, const std::string& text) {
  const GLuint shader = gl.CreateShader(kind);
  const char* source = text.c_str();
  gl.ShaderSource(shader, 1, &source, nullptr);
  gl.CompileShader(shader);
  GLint done = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &done);
  if (!done) {
    std::array<char, 4096> log{};
    gl.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw std::runtime_error(log.data());
  }
  return shader;
}

inline GLuint FloatTexture(const GladGLContext& gl, int width, int height, const float* texels, GLint filter) {
  GLuint texture = 0;
  gl.GenTextures(1, &texture);
  gl.BindTexture(GL_TEXTURE_2D, texture);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, width, height, 0, GL_RGBA, GL_FLOAT, texels);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
  return texture;
}

// An array texture of the levels that an entry of "light_textures" lists.
inline GLuint ArrayTexture(const GladGLContext& gl, const std::string& folder, const nlohmann::json& levels) {
  GLuint texture = 0;
  gl.GenTextures(1, &texture);
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, texture);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const std::string file = folder + "/" + levels[i]["exr"].get<std::string>();
    const auto input = OIIO::ImageInput::open(file);
    if (!input) throw std::runtime_error(file + " is not there");
    const int width = levels[i]["width"], height = levels[i]["height"], layers = levels[i]["layers"];
    if (input->spec().width != width || input->spec().height != height * layers) throw std::runtime_error(file + " is of another size");
    std::vector<float> texels(static_cast<std::size_t>(width * height * layers * 4));
    if (!input->read_image(0, 0, 0, 4, OIIO::TypeFloat, texels.data())) throw std::runtime_error(input->geterror());
    gl.TexImage3D(GL_TEXTURE_2D_ARRAY, static_cast<GLint>(i), GL_RGBA32F, width, height, layers, 0, GL_RGBA, GL_FLOAT, texels.data());
  }
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, static_cast<GLint>(levels.size()) - 1);
  return texture;
}

// Draws the exported pass of GLSL 3.30 in the current context.
inline Output Draw(const GladGLContext& gl, const std::string& folder, const std::string& stem, const Input& input) {
  const nlohmann::json inputs = nlohmann::json::parse(ReadText(folder + "/inputs.json"));
  const GLuint program = gl.CreateProgram();
  gl.AttachShader(program, Compile(gl, GL_VERTEX_SHADER,
                                   "#version 330 core\nvoid main() {\n  vec2 p = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);\n"
                                   "  gl_Position = vec4(p, 0.0, 1.0);\n}\n"));
  gl.AttachShader(program, Compile(gl, GL_FRAGMENT_SHADER, ReadText(folder + "/" + stem + ".330.frag")));
  gl.LinkProgram(program);
  gl.UseProgram(program);

  GLint unit = 0;
  const auto bind = [&](const std::string& sampler, GLuint texture, GLenum target = GL_TEXTURE_2D) {
    gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    gl.BindTexture(target, texture);
    gl.Uniform1i(gl.GetUniformLocation(program, sampler.c_str()), unit++);
    gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));  // what is made next is bound there
  };
  for (const auto& sampler : inputs["gbuffer"]) {
    const std::string name = sampler["sampler"];
    bind(name, FloatTexture(gl, input.width, input.height, input.gbuffer.at(name).data(), GL_NEAREST));
  }
  for (const auto& table : inputs["tables"]) {
    const std::string name = table["sampler"];
    const std::string header = ReadText(folder + "/" + table["c"].get<std::string>());
    const std::vector<float> texels = ReadCArray(header, name);
    bind(name, FloatTexture(gl, ReadSize(header, name + "_width"), ReadSize(header, name + "_height"), texels.data(), GL_LINEAR));
  }
  for (const auto& form : inputs.value("light_textures", nlohmann::json::array())) {
    bind(form["sampler"], ArrayTexture(gl, folder, form["levels"]), GL_TEXTURE_2D_ARRAY);
  }
  gl.Uniform3f(gl.GetUniformLocation(program, "view_position"), input.view_position[0], input.view_position[1], input.view_position[2]);
  gl.Uniform1i(gl.GetUniformLocation(program, "light_count"), 1);
  gl.Uniform3f(gl.GetUniformLocation(program, "sky_radiance"), input.sky[0], input.sky[1], input.sky[2]);
  GLuint block = 0;
  gl.GenBuffers(1, &block);
  gl.BindBuffer(GL_UNIFORM_BUFFER, block);
  std::vector<float> rows = input.light_rows;
  rows.resize(inputs["light_block"]["lights"].get<std::size_t>() * inputs["light_block"]["rows_per_light"].get<std::size_t>() * 4);
  gl.BufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(rows.size() * sizeof(float)), rows.data(), GL_STATIC_DRAW);
  gl.BindBufferBase(GL_UNIFORM_BUFFER, 0, block);
  gl.UniformBlockBinding(program, gl.GetUniformBlockIndex(program, inputs["light_block"]["name"].get<std::string>().c_str()), 0);

  GLuint framebuffer = 0, vertices = 0;
  gl.GenFramebuffers(1, &framebuffer);
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  for (GLenum i = 0; i < 2; ++i) {
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + i, GL_TEXTURE_2D, FloatTexture(gl, input.width, input.height, nullptr, GL_NEAREST), 0);
  }
  const std::array<GLenum, 2> targets{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  gl.DrawBuffers(2, targets.data());
  gl.GenVertexArrays(1, &vertices);
  gl.BindVertexArray(vertices);
  gl.Viewport(0, 0, input.width, input.height);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  Output output;
  for (auto* lobe : {&output.diffuse, &output.specular}) {
    lobe->resize(static_cast<std::size_t>(4 * input.width * input.height));
    gl.ReadBuffer(lobe == &output.diffuse ? GL_COLOR_ATTACHMENT0 : GL_COLOR_ATTACHMENT1);
    gl.ReadPixels(0, 0, input.width, input.height, GL_RGBA, GL_FLOAT, lobe->data());
  }
  return output;
}

}  // namespace stranger
