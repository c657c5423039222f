#include "compare/page_parts.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <stdexcept>

namespace arealab {
namespace {

std::string Base64(const std::string& bytes) {
  static const char* const kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(4 * (bytes.size() / 3 + 1));
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t have = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t b = 0; b < 3; ++b) group = group << 8 | (b < have ? static_cast<unsigned char>(bytes[i + b]) : 0u);
    for (std::size_t d = 0; d < 4; ++d) text += d <= have ? kDigits[group >> (18 - 6 * d) & 63u] : '=';
  }
  return text;
}

}  // namespace

std::string PngBytes(const std::vector<Rgb>& pixels, int width) {
  const int height = static_cast<int>(pixels.size() / static_cast<std::size_t>(width));
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  auto output = OIIO::ImageOutput::create("png");
  const OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
  if (!output || !output->set_ioproxy(&memory) || !output->open("memory.png", spec) ||
      !output->write_image(OIIO::TypeDesc::UINT8, pixels.data()) || !output->close()) {
    throw std::runtime_error("OpenImageIO cannot encode a PNG in memory");
  }
  return {bytes.begin(), bytes.end()};
}

std::string FigureHtml(const std::vector<Rgb>& pixels, int width, const std::string& caption) {
  return fmt::format(
      "<figure><img alt=\"{0}\" width=\"{1}\" height=\"{2}\" "
      "src=\"data:image/png;base64,{3}\"><figcaption>{0}</figcaption></figure>\n",
      caption, width, pixels.size() / static_cast<std::size_t>(width), Base64(PngBytes(pixels, width)));
}

std::string Escaped(const std::string& text) {
  std::string escaped;
  for (char c : text) {
    switch (c) {
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '&':
        escaped += "&amp;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

}  // namespace arealab
