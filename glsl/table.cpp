#include "glsl/table.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "scenes/error.h"

namespace arealab {

TableTexels DecodeTable(std::string_view exr, const std::string& name) {
  const auto fail = [&](const std::string& what) -> InputError {
    return InputError(fmt::format("{}:1: {}; expected a float EXR of one to four channels", name, what));
  };
  // The copy is for OpenImageIO, which wants bytes that it could write to.
  std::vector<unsigned char> bytes(exr.begin(), exr.end());
  OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
  const auto input = OIIO::ImageInput::open("table.exr", nullptr, &memory);
  if (!input) throw fail(fmt::format("not readable ({})", OIIO::geterror()));
  const OIIO::ImageSpec& spec = input->spec();
  const int channels = spec.nchannels;
  if (channels < 1 || channels > 4) throw fail(fmt::format("{} channels", channels));
  const auto width = static_cast<std::size_t>(spec.width);
  const auto height = static_cast<std::size_t>(spec.height);
  std::vector<float> values(width * height * static_cast<std::size_t>(channels));
  if (!input->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, values.data())) {
    throw fail(fmt::format("not readable ({})", input->geterror()));
  }
  TableTexels table{{spec.width, spec.height}, std::vector<glm::vec4>(width * height, glm::vec4(0.0f))};
  for (std::size_t i = 0; i < table.texels.size(); ++i) {
    for (int c = 0; c < channels; ++c) {
      table.texels[i][c] = values[i * static_cast<std::size_t>(channels) + static_cast<std::size_t>(c)];
    }
  }
  return table;
}

GlObject UploadTable(const GladGLContext& gl, const TableTexels& table) {
  GlObject texture = MakeTexture(gl, GL_RGBA32F, 1, table.size);
  gl.TextureSubImage2D(texture.id(), 0, 0, 0, table.size.x, table.size.y, GL_RGBA, GL_FLOAT,
                       table.texels.data());
  gl.TextureParameteri(texture.id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TextureParameteri(texture.id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.TextureParameteri(texture.id(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TextureParameteri(texture.id(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

}  // namespace arealab
