// How far one radiance image is from another.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "compare/results.h"

namespace arealab {

// Of a against the reference b, per channel over the pixels where either is not black:
//   rel_rmse = sqrt(Σ(a−b)² / Σb²), bias = Σ(a−b) / Σb,
//   relmse = mean((a−b)² / (b² + ε)), ε = (0.01 × b's mean luminance)²,
//   mae = mean|a−b|, p99 and max of the pixel's largest |a−b|, in the images' unit.
// Non-finite pixels of either make every metric not measured. `flip` is left to Flip(). Sizes must match.
ErrorMetrics CompareImages(std::span<const glm::vec3> a, std::span<const glm::vec3> b, int width);

// Mean HDR-FLIP [Andersson et al. 2021] at 67 pixels per degree, over all pixels, linear sRGB in.
double HdrFlip(std::span<const glm::vec3> test, std::span<const glm::vec3> reference, int width);

}  // namespace arealab
