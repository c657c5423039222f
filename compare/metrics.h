// How far one radiance image is from another.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "compare/results.h"

namespace arealab {

// Of linear Rec. 709 (sRGB) primaries, in their unit [IEC 61966-2-1].
inline double Luminance(const glm::vec3& color) {
  return 0.2126 * static_cast<double>(color.x) + 0.7152 * static_cast<double>(color.y) +
         0.0722 * static_cast<double>(color.z);
}

// Of a against the reference b, per channel over the pixels where either is not black:
//   rel_rmse = sqrt(Σ(a−b)² / Σb²), bias = Σ(a−b) / Σb,
//   relmse = mean((a−b)² / (b² + ε)), ε = (0.01 × b's mean luminance over those pixels)²,
//   mae = mean|a−b|, p99 (nearest rank) and max of the pixel's largest |a−b|, in the images' unit.
// Equal images give 0 throughout, black ones too; where b is black and a is not, what divides by b is not
// measured. Non-finite pixels of either make every metric not measured. `flip` is left to HdrFlip(). Throws
// std::invalid_argument where the sizes differ or are no multiple of `width`.
ErrorMetrics CompareImages(std::span<const glm::vec3> a, std::span<const glm::vec3> b, int width);

// rel_rmse alone, the same value within rounding, several times as fast.
double RelativeRmse(std::span<const glm::vec3> a, std::span<const glm::vec3> b);

// Its parts, for the pairs of many images: Σ(a−b)², the same both ways, and Σb².
double SquaredDifference(std::span<const glm::vec3> a, std::span<const glm::vec3> b);
double SquaredNorm(std::span<const glm::vec3> b);
double RelativeRmse(double squared_difference, double squared_norm);

// Pixels with a NaN or an infinity in either lobe.
int CountNonfinitePixels(const RadianceImage& image);

// Diffuse + specular, per pixel.
std::vector<glm::vec3> TotalRadiance(const RadianceImage& image);

// Mean HDR-FLIP [Andersson et al. 2021] at 67 pixels per degree, over all pixels, linear sRGB in; see
// compare/flip.h. Not measured where a pixel of either is not finite. Throws std::invalid_argument as
// CompareImages does.
double HdrFlip(std::span<const glm::vec3> test, std::span<const glm::vec3> reference, int width);

// Fills total, diffuse and specular (FLIP of the total only) and nonfinite_pixels of `result` from
// result.image. `flip` may be null: FLIP is then not measured; else it holds the truth's total.
class FlipReference;
void Measure(const RadianceImage& truth, const FlipReference* flip, VariantResult* result);

}  // namespace arealab
