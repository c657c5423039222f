// A technique's look-up table: a small float EXR of the shader library.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "glsl/gl_objects.h"

namespace arealab {

struct TableTexels {
  glm::ivec2 size{0};
  std::vector<glm::vec4>
      texels;  // row 0 first: texel (i, j) is at texture coordinates (i + ½, j + ½) / size; absent channels 0
};

// Decodes an EXR's bytes; `name` is for the message. Throws InputError.
TableTexels DecodeTable(std::string_view exr, const std::string& name);

// As a texture, RGBA32F, linear, clamped to the edge, one level.
GlObject UploadTable(const GladGLContext& gl, const TableTexels& table);

}  // namespace arealab
