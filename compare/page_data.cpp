#include "compare/page_data.h"

#include <fmt/format.h>
#include <libdeflate.h>

#include <array>
#include <bit>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <memory>
#include <new>
#include <vector>

namespace arealab {
namespace {

using Plane = std::vector<std::uint16_t>;

std::uint16_t Wrap(int v) {
  return static_cast<std::uint16_t>(v & 0xFFFF);
}

// Small differences of either sign become small numbers: 0, −1, 1, −2 … → 0, 1, 2, 3 …
std::uint16_t Zigzag(std::uint16_t v) {
  return Wrap((v << 1) ^ ((v & 0x8000) != 0 ? 0xFFFF : 0));
}

// What a smooth image leaves over once each pixel is foretold from three neighbours; those outside are 0.
Plane Residual(const Plane& plane, std::size_t width) {
  Plane residual(plane.size());
  const Plane dark(width, 0);
  for (std::size_t begin = 0; begin < plane.size(); begin += width) {
    const std::uint16_t *row = plane.data() + begin, *up = begin == 0 ? dark.data() : row - width;
    residual[begin] = Zigzag(Wrap(row[0] - up[0]));
    for (std::size_t x = 1; x < width; ++x) {
      residual[begin + x] = Zigzag(static_cast<std::uint16_t>(row[x] - row[x - 1] - up[x] + up[x - 1]));
    }
  }
  return residual;
}

// Bits that a number's length costs, summed over every fourth pixel: enough to choose by.
std::uint64_t Cost(const Plane& residual) {
  std::uint64_t cost = 0;
  for (std::size_t i = 0; i < residual.size(); i += 4)
    cost += static_cast<std::uint64_t>(std::bit_width(residual[i]));
  return cost;
}

void Append(const Plane& residual, std::vector<std::uint8_t>* bytes) {
  const std::size_t begin = bytes->size(), size = residual.size();
  bytes->resize(begin + 2 * size);
  std::uint8_t* out = bytes->data() + begin;
  for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::uint8_t>(residual[i] & 0xFF);
  for (std::size_t i = 0; i < size; ++i) out[size + i] = static_cast<std::uint8_t>(residual[i] >> 8);
}

// How many of the lowest bits are 0 in every value.
int CommonZeros(const HalfImage& image) {
  unsigned bits = 0;
  for (const Plane& plane : image.planes) {
    for (std::uint16_t v : plane) bits |= v;
  }
  return bits == 0 ? 0 : std::countr_zero(bits);
}

Plane Shifted(const Plane& plane, int shift) {
  Plane shifted(plane);
  for (std::uint16_t& v : shifted) v = static_cast<std::uint16_t>(v >> shift);
  return shifted;
}

std::vector<std::uint8_t> Deflate(const std::vector<std::uint8_t>& bytes) {
  // Measured over a report's files: 7 is 4.6 % smaller in 2.6 times the time, 1 is 6 % larger in 0.7 times it.
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(4), &libdeflate_free_compressor);
  if (compressor == nullptr) throw std::bad_alloc();
  std::vector<std::uint8_t> packed(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()));
  packed.resize(libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), packed.data(), packed.size()));
  return packed;
}

// A script's string literal: every byte stands for itself but those that would end the literal or its line.
std::string Literal(const std::vector<std::uint8_t>& bytes) {
  std::string text = "\"";
  text.reserve(bytes.size() + bytes.size() / 32);
  for (std::uint8_t byte : bytes) {
    switch (byte) {
      case 0:
        text += "\\x00";
        break;
      case '\n':
        text += "\\n";
        break;
      case '\r':
        text += "\\r";
        break;
      case '"':
        text += "\\\"";
        break;
      case '\\':
        text += "\\\\";
        break;
      default:
        text += static_cast<char>(byte);
    }
  }
  return text + "\"";
}

}  // namespace

std::string ScriptSafe(std::string json) {
  std::string safe;
  safe.reserve(json.size());
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (c == '<' || c == '>' || c == '&') {
      safe += fmt::format("\\u{:04x}", static_cast<int>(c));
    } else if (json.compare(i, 3, "\u2028") == 0 || json.compare(i, 3, "\u2029") == 0) {
      safe += json.compare(i, 3, "\u2028") == 0 ? "\\u2028" : "\\u2029";
      i += 2;
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string EncodePageImage(const std::string& key, const HalfImage& image, const HalfImage* truth) {
  const std::size_t width = static_cast<std::size_t>(image.width);
  if (truth != nullptr &&
      (truth->width != image.width || truth->height != image.height || truth->exponent != image.exponent)) {
    truth = nullptr;
  }
  std::vector<std::uint8_t> bytes;
  const int shift = CommonZeros(image);
  std::array<Plane, 6> planes, truth_planes;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    planes[i] = Shifted(image.planes[i], shift);
    if (truth != nullptr) truth_planes[i] = Shifted(truth->planes[i], shift);
  }
  std::array<std::string, 6> modes;
  for (std::size_t lobe = 0; lobe < 2; ++lobe) {
    const Plane& green = planes[3 * lobe + 1];
    for (std::size_t channel : {1u, 0u, 2u}) {  // green first: the others may lean on it
      const std::size_t index = 3 * lobe + channel;
      const Plane& plane = planes[index];
      std::string& mode = modes[index];
      const Plane* bases[2] = {channel == 1 ? nullptr : &green,
                               truth == nullptr ? nullptr : &truth_planes[index]};
      const char* const names[2] = {"g", "t"};
      for (int b = 0; b < 2; ++b) {
        if (mode.empty() && bases[b] != nullptr && *bases[b] == plane) mode = std::string("=") + names[b];
      }
      if (!mode.empty()) continue;
      mode = "raw";
      Plane best = Residual(plane, width);
      std::uint64_t cost = Cost(best);
      for (int b = 0; b < 2; ++b) {
        if (bases[b] == nullptr) continue;
        Plane difference(plane.size());
        for (std::size_t i = 0; i < plane.size(); ++i) difference[i] = Wrap(plane[i] - (*bases[b])[i]);
        difference = Residual(difference, width);
        if (const std::uint64_t its_cost = Cost(difference); its_cost < cost) {
          cost = its_cost;
          best = std::move(difference);
          mode = std::string("-") + names[b];
        }
      }
      Append(best, &bytes);
    }
  }
  const nlohmann::ordered_json header = {{"width", image.width},
                                         {"height", image.height},
                                         {"exponent", image.exponent},
                                         {"shift", shift},
                                         {"planes", modes}};
  // \u escapes keep the key readable in any encoding.
  return fmt::format(
      "arealabImage({},{},{});\n",
      ScriptSafe(nlohmann::json(key).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace)),
      header.dump(), Literal(Deflate(bytes)));
}

}  // namespace arealab
