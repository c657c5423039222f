#include "compare/flip.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace arealab {
namespace {

constexpr int kLanes = 8;
typedef float Lanes __attribute__((vector_size(4 * kLanes)));
typedef int IntLanes __attribute__((vector_size(4 * kLanes)));

// Pixels per degree of the published default: 0.7 m × (3840 / 0.7 m) × π / 180.
constexpr double kPixelsPerDegree = 0.7 * 3840.0 / 0.7 * std::numbers::pi / 180.0;

// Contrast sensitivity, a Gaussian b per channel in degrees² and, for blue-yellow, two with their heights a
// [Andersson et al. 2020, table 1].
constexpr double kAchromaticB = 0.0047, kRedGreenB = 0.0053;
constexpr double kBlueYellowA[2] = {34.1, 13.5}, kBlueYellowB[2] = {0.04, 0.025};
constexpr double kFeatureWidth =
    0.082;  // degrees, peak to trough of the eye's edge detector [2020, sec. 4.2.1]
constexpr float kColorExponent = 0.7f;  // q_c; that of features, q_f, is ½, a square root [2020, sec. 4.3]
constexpr float kColorKnee = 0.4f, kKneeValue = 0.95f;  // p_c, p_t [2020, sec. 4.1.3]
constexpr double kToneTarget = 0.85;                    // t of both exposures [2021, sec. 3.2]

// Narkowicz's ACES fit (2.51 x² + 0.03 x) / (2.43 x² + 0.59 x + 0.14), with the pre-exposure 0.6 it was made
// for folded in.
constexpr float kAces[5] = {0.36f * 2.51f, 0.6f * 0.03f, 0.36f * 2.43f, 0.6f * 0.59f, 0.14f};

constexpr int kPad = 16;  // taps to either side at most; kernels below reach 10

// Half of a kernel that is even or odd about its centre.
struct Taps {
  int radius = 0;
  bool odd = false;
  std::array<float, kPad + 1> weight{};
};

struct Filters {
  Taps achromatic, red_green, blue_yellow[2];
  float blue_yellow_share[2];
  Taps feature, edge, point;                        // Gaussian, first and second derivative
  std::array<float, 9> xyz_from_rgb, rgb_from_xyz;  // row by row; XYZ relative to white
};

// An image as three planes, rows padded to a multiple of kLanes.
struct Planar {
  int width = 0, height = 0;
  std::size_t stride = 0;
  std::array<std::vector<float>, 3> channel;
};

using Planes7 = std::array<std::vector<float>, 7>;  // kPad rows more above and below

namespace baseline {
#include "compare/flip_kernels.inc"
}
#if defined(__x86_64__) && !defined(__clang__)
#define AREALAB_FLIP_HASWELL 1
#pragma GCC push_options
#pragma GCC target("avx2,fma")
namespace haswell {
#include "compare/flip_kernels.inc"
}
#pragma GCC pop_options
#endif

struct Kernels {
  decltype(&baseline::FilterRow) filter_row = baseline::FilterRow;
  decltype(&baseline::PerceiveRow) perceive_row = baseline::PerceiveRow;
  decltype(&baseline::CompareRow) compare_row = baseline::CompareRow;
};

Kernels ChooseKernels() {
#ifdef AREALAB_FLIP_HASWELL
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    return {haswell::FilterRow, haswell::PerceiveRow, haswell::CompareRow};
  }
#endif
  return {};
}

// exp(−x²/2σ²), normalised to sum 1, dropped where below 1e-7 of the peak: less than float resolves.
Taps GaussianTaps(double sigma, int radius) {
  Taps taps;
  taps.radius = std::min(radius, static_cast<int>(std::ceil(sigma * std::sqrt(2.0 * std::log(1e7)))));
  double sum = 1.0;
  for (int k = 1; k <= taps.radius; ++k) sum += 2.0 * std::exp(-k * k / (2.0 * sigma * sigma));
  for (int k = 0; k <= taps.radius; ++k) {
    taps.weight[static_cast<std::size_t>(k)] =
        static_cast<float>(std::exp(-k * k / (2.0 * sigma * sigma)) / sum);
  }
  return taps;
}

// −x g(x), its positive weights summing to 1.
Taps EdgeTaps(double sigma, int radius) {
  Taps taps;
  taps.radius = radius;
  taps.odd = true;
  double sum = 0.0;
  for (int k = 1; k <= radius; ++k) sum += k * std::exp(-k * k / (2.0 * sigma * sigma));
  for (int k = 1; k <= radius; ++k) {
    taps.weight[static_cast<std::size_t>(k)] =
        static_cast<float>(-k * std::exp(-k * k / (2.0 * sigma * sigma)) / sum);
  }
  return taps;
}

// (x²/σ² − 1) g(x), positive weights summing to 1 and negative ones to −1.
Taps PointTaps(double sigma, int radius) {
  Taps taps;
  taps.radius = radius;
  std::array<double, kPad + 1> weight{};
  double positive = 0.0, negative = 0.0;
  for (int k = 0; k <= radius; ++k) {
    const double w = (k * k / (sigma * sigma) - 1.0) * std::exp(-k * k / (2.0 * sigma * sigma));
    weight[static_cast<std::size_t>(k)] = w;
    (w > 0.0 ? positive : negative) += (k == 0 ? 1.0 : 2.0) * std::abs(w);
  }
  for (int k = 0; k <= radius; ++k) {
    const double w = weight[static_cast<std::size_t>(k)];
    taps.weight[static_cast<std::size_t>(k)] = static_cast<float>(w / (w > 0.0 ? positive : negative));
  }
  return taps;
}

// Linear sRGB to CIE XYZ over D65's, from the primaries' chromaticities; the fractions are exact for white
// (0.3127, 0.3290).
glm::dmat3 XyzFromRgb() {
  const glm::dvec3 rows[3] = {glm::dvec3(10135552.0, 8788810.0, 4435075.0) / 24577794.0,
                              glm::dvec3(2613072.0, 8788810.0, 887015.0) / 12288897.0,
                              glm::dvec3(1425312.0, 8788810.0, 70074185.0) / 73733382.0};
  glm::dmat3 m;  // glm is column-major
  for (int row = 0; row < 3; ++row) {
    const double white = rows[row].x + rows[row].y + rows[row].z;
    for (int column = 0; column < 3; ++column) m[column][row] = rows[row][column] / white;
  }
  return m;
}

Filters MakeFilters() {
  Filters filters;
  // exp(−π² d²/b) over d degrees has a standard deviation of sqrt(b / 2π²) degrees.
  const auto sigma = [](double b) {
    return std::sqrt(b / (2.0 * std::numbers::pi * std::numbers::pi)) * kPixelsPerDegree;
  };
  const int radius = static_cast<int>(std::ceil(3.0 * sigma(kBlueYellowB[0])));  // the widest one's, for all
  filters.achromatic = GaussianTaps(sigma(kAchromaticB), radius);
  filters.red_green = GaussianTaps(sigma(kRedGreenB), radius);
  double share[2];
  for (int i = 0; i < 2; ++i) {
    const double s = sigma(kBlueYellowB[i]);
    filters.blue_yellow[i] = GaussianTaps(s, radius);
    double sum = 1.0;
    for (int k = 1; k <= radius; ++k) sum += 2.0 * std::exp(-k * k / (2.0 * s * s));
    share[i] = kBlueYellowA[i] * std::sqrt(std::numbers::pi / kBlueYellowB[i]) * sum * sum;
  }
  for (int i = 0; i < 2; ++i)
    filters.blue_yellow_share[i] = static_cast<float>(share[i] / (share[0] + share[1]));
  const double feature = 0.5 * kFeatureWidth * kPixelsPerDegree;
  const int feature_radius = static_cast<int>(std::ceil(3.0 * feature));
  filters.feature = GaussianTaps(feature, feature_radius);
  filters.edge = EdgeTaps(feature, feature_radius);
  filters.point = PointTaps(feature, feature_radius);
  const glm::dmat3 xyz = XyzFromRgb(), rgb = glm::inverse(xyz);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      filters.xyz_from_rgb[static_cast<std::size_t>(3 * row + column)] = static_cast<float>(xyz[column][row]);
      filters.rgb_from_xyz[static_cast<std::size_t>(3 * row + column)] = static_cast<float>(rgb[column][row]);
    }
  }
  return filters;
}

const Filters& TheFilters() {
  static const Filters filters = MakeFilters();
  return filters;
}

// The colour distance between Hunt-adjusted green and blue, the largest that counts, to the power q_c.
float LargestColorDistance() {
  const glm::dmat3 xyz = XyzFromRgb();
  double lab[2][3];
  for (int i = 0; i < 2; ++i) {
    double f[3];
    for (int row = 0; row < 3; ++row) {
      const double v = xyz[i + 1][row];
      f[row] = v > 216.0 / 24389.0 ? std::cbrt(v) : v * 841.0 / 108.0 + 4.0 / 29.0;
    }
    lab[i][0] = 116.0 * f[1] - 16.0;
    lab[i][1] = 0.01 * lab[i][0] * 500.0 * (f[0] - f[1]);
    lab[i][2] = 0.01 * lab[i][0] * 200.0 * (f[1] - f[2]);
  }
  const double distance =
      std::abs(lab[0][0] - lab[1][0]) + std::hypot(lab[0][1] - lab[1][1], lab[0][2] - lab[1][2]);
  return static_cast<float>(std::pow(distance, static_cast<double>(kColorExponent)));
}

// Columns that are filtered at a time, so that what twenty rows of seven planes hold there stays in the first cache.
constexpr int kBlock = 64;

// In floats: whole pairs of vectors, and an odd number of cache lines, since rows a power of two apart would share a few sets of
// the cache, and the filters down the columns read twenty rows at once.
std::size_t Stride(int width) {
  constexpr int kLine = 16;  // floats in 64 bytes
  return static_cast<std::size_t>(((width + kLine - 1) / kLine | 1) * kLine);
}

// Nothing in the result's channels where a pixel is not finite.
Planar MakePlanar(std::span<const glm::vec3> image, int width) {
  Planar planar;
  planar.width = width;
  planar.height = static_cast<int>(image.size() / static_cast<std::size_t>(width));
  planar.stride = Stride(width);
  for (const glm::vec3& v : image) {
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) return planar;
  }
  for (int c = 0; c < 3; ++c) {
    std::vector<float>& plane = planar.channel[static_cast<std::size_t>(c)];
    plane.assign(planar.stride * static_cast<std::size_t>(planar.height), 0.0f);
    for (int y = 0; y < planar.height; ++y) {
      for (int x = 0; x < width; ++x) {
        // Beyond 1e15 even the darkest exposure of any reference shows white, and squares stay finite.
        plane[static_cast<std::size_t>(y) * planar.stride + static_cast<std::size_t>(x)] = std::clamp(
            image[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)]
                 [c],
            0.0f, 1e15f);
      }
    }
  }
  return planar;
}

// Blocks of kBand rows by kBlock columns within reach of a filter of any difference: elsewhere the map is 0. Row by row.
constexpr int kBand = 16;
static_assert(kBand >= kPad && kBlock >= kPad);
std::vector<bool> DifferingBlocks(std::span<const glm::vec3> a, std::span<const glm::vec3> b, int width, int height) {
  const int columns = (width + kBlock - 1) / kBlock, rows = (height + kBand - 1) / kBand;
  std::vector<bool> near(static_cast<std::size_t>(columns * rows), false);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const int end_x = std::min((column + 1) * kBlock, width), end_y = std::min((row + 1) * kBand, height);
      bool same = true;
      for (int y = row * kBand; y < end_y && same; ++y) {
        const std::ptrdiff_t begin = static_cast<std::ptrdiff_t>(y) * width;
        same = std::equal(a.begin() + begin + column * kBlock, a.begin() + begin + end_x, b.begin() + begin + column * kBlock);
      }
      if (same) continue;
      for (int y = std::max(row - 1, 0); y <= std::min(row + 1, rows - 1); ++y) {
        for (int x = std::max(column - 1, 0); x <= std::min(column + 1, columns - 1); ++x) {
          near[static_cast<std::size_t>(y * columns + x)] = true;
        }
      }
    }
  }
  return near;
}

void Resize(FlipReference::Percept& percept, std::size_t size) {
  for (auto* plane : {&percept.lightness, &percept.a, &percept.b, &percept.edge, &percept.point})
    plane->resize(size);
}

// Fills the rows of the bands of kBand that `needed` says.
void FilterRows(const Planar& image, float exposure, const std::vector<bool>& needed, Planes7& planes) {
  const auto stride = static_cast<std::ptrdiff_t>(image.stride);
  for (auto& plane : planes) plane.resize(image.stride * static_cast<std::size_t>(image.height + 2 * kPad));
  static const Kernels kernels = ChooseKernels();
  tbb::parallel_for(std::size_t{0}, needed.size(), [&](std::size_t band) {
    if (!needed[band]) return;
    std::vector<float> scratch(3 * (image.stride + 2 * kPad));
    const int begin = static_cast<int>(band) * kBand;
    for (int y = begin; y < std::min(begin + kBand, image.height); ++y) {
      kernels.filter_row(image, y, std::exp2(exposure), TheFilters(), scratch.data(), planes);
    }
  });
  for (auto& plane : planes) {  // the border repeats
    const auto first = plane.begin() + kPad * stride, end = plane.end() - kPad * stride, last = end - stride;
    for (std::ptrdiff_t k = 1; k <= kPad; ++k) {
      std::copy(first, first + stride, first - k * stride);
      std::copy(last, end, last + k * stride);
    }
  }
}

// The luminance that the tone mapper shows as kToneTarget: the positive root of its quadratic.
double ToneTargetLuminance() {
  const double a = static_cast<double>(kAces[0]) - kToneTarget * static_cast<double>(kAces[2]);
  const double b = static_cast<double>(kAces[1]) - kToneTarget * static_cast<double>(kAces[3]);
  const double c = -kToneTarget * static_cast<double>(kAces[4]);
  return (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a);
}

std::vector<float> ChooseExposures(const Planar& image) {
  std::vector<float> luminance;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * image.stride + static_cast<std::size_t>(x);
      luminance.push_back(0.2126f * image.channel[0][i] + 0.7152f * image.channel[1][i] +
                          0.0722f * image.channel[2][i]);
    }
  }
  const float brightest = *std::max_element(luminance.begin(), luminance.end());
  if (brightest <= 0.0f) return {0.0f};
  const auto median = [&] {
    const auto middle = luminance.begin() + static_cast<std::ptrdiff_t>(luminance.size() / 2);
    std::nth_element(luminance.begin(), middle, luminance.end());
    const double upper = static_cast<double>(*middle);
    if (luminance.size() % 2 == 1) return upper;
    return 0.5 * (upper + static_cast<double>(*std::max_element(luminance.begin(), middle)));
  };
  double middle = median();
  if (middle <= 0.0) {
    std::erase_if(luminance, [](float v) { return v <= 0.0f; });
    middle = median();
  }
  const double start = std::log2(ToneTargetLuminance() / static_cast<double>(brightest));
  const double stop = std::log2(ToneTargetLuminance() / middle);
  const int count = std::max(2, static_cast<int>(std::ceil(stop - start)));
  std::vector<float> exposures;
  for (int i = 0; i < count; ++i)
    exposures.push_back(static_cast<float>(start + (stop - start) * i / (count - 1)));
  return exposures;
}

}  // namespace

FlipReference::FlipReference(std::span<const glm::vec3> reference, int width) : width_(width), reference_(reference.begin(), reference.end()) {
  if (width <= 0 || reference.empty() || reference.size() % static_cast<std::size_t>(width) != 0) {
    throw std::invalid_argument("an image's size is no multiple of its width; expected whole rows");
  }
  const Planar image = MakePlanar(reference, width);
  height_ = image.height;
  if (image.channel[0].empty()) return;
  exposures_ = ChooseExposures(image);
  static const Kernels kernels = ChooseKernels();
  Planes7 planes;
  for (float exposure : exposures_) {
    FilterRows(image, exposure, std::vector<bool>(static_cast<std::size_t>((height_ + kBand - 1) / kBand), true), planes);
    Percept percept;
    Resize(percept, image.stride * static_cast<std::size_t>(height_));
    tbb::parallel_for(tbb::blocked_range<int>(0, height_, 16), [&](const tbb::blocked_range<int>& rows) {
      for (int begin = 0; begin < width_; begin += kBlock) {
        for (int y = rows.begin(); y < rows.end(); ++y) {
          kernels.perceive_row(planes, begin, std::min(begin + kBlock, width_), image.stride, y, TheFilters(),
                               percept,
                               static_cast<std::size_t>(y) * image.stride + static_cast<std::size_t>(begin));
        }
      }
    });
    percepts_.push_back(std::move(percept));
  }
}

std::vector<float> FlipReference::MapOf(std::span<const glm::vec3> test) const {
  if (test.size() != static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {
    throw std::invalid_argument(
        "images of different sizes cannot be compared; expected equal width and height");
  }
  const Planar image = MakePlanar(test, width_);
  if (exposures_.empty() || image.channel[0].empty()) return {};
  static const Kernels kernels = ChooseKernels();
  static const float largest_color = LargestColorDistance();
  std::vector<float> padded(image.stride * static_cast<std::size_t>(height_), 0.0f);
  const std::vector<bool> differing = DifferingBlocks(test, reference_, width_, height_);
  const int columns = (width_ + kBlock - 1) / kBlock, bands = (height_ + kBand - 1) / kBand;
  std::vector<bool> needed(static_cast<std::size_t>(bands), false);  // a filter reaches the bands above and below
  for (int i = 0; i < columns * bands; ++i) {
    if (!differing[static_cast<std::size_t>(i)]) continue;
    const int band = i / columns;
    for (int b = std::max(band - 1, 0); b <= std::min(band + 1, bands - 1); ++b) needed[static_cast<std::size_t>(b)] = true;
  }
  Planes7 planes;
  for (std::size_t e = 0; e < exposures_.size(); ++e) {
    FilterRows(image, exposures_[e], needed, planes);
    tbb::parallel_for(0, bands, [&](int band) {
      Percept percept;
      Resize(percept, kBlock);
      for (int begin = 0; begin < width_; begin += kBlock) {
        if (!differing[static_cast<std::size_t>(band * columns + begin / kBlock)]) continue;
        const int end = std::min(begin + kBlock, width_);
        for (int y = band * kBand; y < std::min((band + 1) * kBand, height_); ++y) {
          const std::size_t at = static_cast<std::size_t>(y) * image.stride + static_cast<std::size_t>(begin);
          kernels.perceive_row(planes, begin, end, image.stride, y, TheFilters(), percept, 0);
          kernels.compare_row(percepts_[e], at, percept, 0, end - begin, largest_color, padded.data() + at);
        }
      }
    });
  }
  std::vector<float> map;
  map.reserve(test.size());
  for (int y = 0; y < height_; ++y) {
    const auto row = padded.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(y) * image.stride);
    map.insert(map.end(), row, row + width_);
  }
  return map;
}

double FlipReference::MeanOf(std::span<const glm::vec3> test) const {
  const std::vector<float> map = MapOf(test);
  if (map.empty()) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0.0;
  for (float v : map) sum += static_cast<double>(v);
  return sum / static_cast<double>(map.size());
}

}  // namespace arealab
