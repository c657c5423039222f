#include "compare/metrics.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "compare/flip.h"

namespace arealab {
namespace {

bool IsFinite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool IsBlack(const glm::vec3& v) {
  return v.x == 0.0f && v.y == 0.0f && v.z == 0.0f;
}

void CheckSizes(std::size_t a, std::size_t b, int width) {
  if (a != b || width <= 0 || a % static_cast<std::size_t>(width) != 0) {
    throw std::invalid_argument(
        "images of different sizes cannot be compared; expected equal width and height");
  }
}

// A ratio of which 0/0 is a perfect 0 and x/0 no figure at all.
double Ratio(double numerator, double denominator) {
  if (numerator == 0.0) return 0.0;
  return denominator == 0.0 ? kNotMeasured : numerator / denominator;
}

}  // namespace

ErrorMetrics CompareImages(std::span<const glm::vec3> a, std::span<const glm::vec3> b, int width) {
  CheckSizes(a.size(), b.size(), width);
  ErrorMetrics metrics;
  double luminance = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!IsFinite(a[i]) || !IsFinite(b[i])) return metrics;
    if (IsBlack(a[i]) && IsBlack(b[i])) continue;
    luminance += Luminance(b[i]);
    ++count;
  }
  metrics.rel_rmse = metrics.bias = metrics.relmse = metrics.mae = metrics.p99 = metrics.max = 0.0;
  if (count == 0) return metrics;

  const double mean_luminance = luminance / static_cast<double>(count);
  const double epsilon = 0.01 * mean_luminance * (0.01 * mean_luminance);
  double squares = 0.0, reference_squares = 0.0, differences = 0.0, references = 0.0, relative = 0.0,
         absolute = 0.0;
  bool relative_defined = true;
  std::vector<float> largest;
  largest.reserve(count);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (IsBlack(a[i]) && IsBlack(b[i])) continue;
    double most = 0.0;
    for (int channel = 0; channel < 3; ++channel) {
      const double reference = static_cast<double>(b[i][channel]);
      const double difference = static_cast<double>(a[i][channel]) - reference;
      squares += difference * difference;
      reference_squares += reference * reference;
      differences += difference;
      references += reference;
      absolute += std::abs(difference);
      if (difference != 0.0) {
        const double denominator = reference * reference + epsilon;
        if (denominator > 0.0) {
          relative += difference * difference / denominator;
        } else {
          relative_defined = false;
        }
      }
      most = std::max(most, std::abs(difference));
    }
    if (metrics.max_x < 0 || most > metrics.max) {
      metrics.max = most;
      metrics.max_x = static_cast<int>(i % static_cast<std::size_t>(width));
      metrics.max_y = static_cast<int>(i / static_cast<std::size_t>(width));
    }
    largest.push_back(static_cast<float>(most));
  }
  const double samples = 3.0 * static_cast<double>(count);
  metrics.rel_rmse = Ratio(std::sqrt(squares), std::sqrt(reference_squares));
  metrics.bias = Ratio(differences, references);
  metrics.relmse = relative_defined ? relative / samples : kNotMeasured;
  metrics.mae = absolute / samples;
  const std::size_t rank = (99 * count + 99) / 100 - 1;  // ceil(0.99 n), counted from 0
  std::nth_element(largest.begin(), largest.begin() + static_cast<std::ptrdiff_t>(rank), largest.end());
  metrics.p99 = static_cast<double>(largest[rank]);
  return metrics;
}

double SquaredDifference(std::span<const glm::vec3> a, std::span<const glm::vec3> b) {
  CheckSizes(a.size(), b.size(), 1);
  glm::dvec3 sum(0.0);  // three sums wait for their additions side by side
  for (std::size_t i = 0; i < a.size(); ++i) {
    const glm::dvec3 difference = glm::dvec3(a[i]) - glm::dvec3(b[i]);
    sum += difference * difference;
  }
  return sum.x + sum.y + sum.z;
}

double SquaredNorm(std::span<const glm::vec3> b) {
  glm::dvec3 sum(0.0);
  for (const glm::vec3& v : b) sum += glm::dvec3(v) * glm::dvec3(v);
  return sum.x + sum.y + sum.z;
}

double RelativeRmse(double squared_difference, double squared_norm) {
  // A NaN or an infinity of either image ends up in a sum.
  if (!std::isfinite(squared_difference) || !std::isfinite(squared_norm)) return kNotMeasured;
  return Ratio(std::sqrt(squared_difference), std::sqrt(squared_norm));
}

double RelativeRmse(std::span<const glm::vec3> a, std::span<const glm::vec3> b) {
  return RelativeRmse(SquaredDifference(a, b), SquaredNorm(b));
}

int CountNonfinitePixels(const RadianceImage& image) {
  int count = 0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    if (!IsFinite(image.diffuse[i]) || !IsFinite(image.specular[i])) ++count;
  }
  return count;
}

std::vector<glm::vec3> TotalRadiance(const RadianceImage& image) {
  std::vector<glm::vec3> total(image.size());
  for (std::size_t i = 0; i < total.size(); ++i) total[i] = image.Total(i);
  return total;
}

double HdrFlip(std::span<const glm::vec3> test, std::span<const glm::vec3> reference, int width) {
  CheckSizes(test.size(), reference.size(), width);
  return FlipReference(reference, width).MeanOf(test);
}

void Measure(const RadianceImage& truth, const FlipReference* flip, VariantResult* result) {
  if (!result->image)
    throw std::invalid_argument("a variant without an image cannot be measured; expected one");
  const RadianceImage& image = *result->image;
  const std::vector<glm::vec3> total = TotalRadiance(image);
  result->nonfinite_pixels = CountNonfinitePixels(image);
  result->diffuse = CompareImages(image.diffuse, truth.diffuse, truth.width);
  result->specular = CompareImages(image.specular, truth.specular, truth.width);
  result->total = flip != nullptr ? CompareImages(total, flip->reference(), truth.width)
                                  : CompareImages(total, TotalRadiance(truth), truth.width);
  if (flip != nullptr) result->total.flip = flip->MeanOf(total);
}

}  // namespace arealab
