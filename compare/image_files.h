// Radiance as files: EXRs of half floats with the lobes as layers, and pictures for a screen.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "compare/half_image.h"

namespace arealab {

enum class ExrLoss { kNone, kForTheEye };

// Channels diffuse.R … specular.B (diffuse.Y alone where the lobe is gray). Half where the exponent is 0, for the eye compressed by
// DWA where all is finite; float with exactly the same values at other exponents. Throws InputError where the file cannot be written.
void WriteExr(const std::filesystem::path& file, const HalfImage& image, ExrLoss loss = ExrLoss::kNone);
// As float, unrounded.
void WriteExr(const std::filesystem::path& file, const RadianceImage& image);
// Reads either form. Throws InputError where it cannot.
RadianceImage ReadExr(const std::filesystem::path& file);

// sRGB, 8 bits: clamp(radiance × 2^exposure). Non-finite values show as magenta.
void WritePng(const std::filesystem::path& file, std::span<const glm::vec3> radiance, int width,
              double exposure);

// The same of codes that are chosen already: R, G, B per pixel, row 0 the top.
void WritePngCodes(const std::filesystem::path& file, std::span<const std::uint8_t> codes, int width);

// What a picture shows: diffuse + specular + the emitters (`emission` may be empty).
std::vector<glm::vec3> Picture(const RadianceImage& image, std::span<const glm::vec3> emission);

}  // namespace arealab
