// Every metric on images small enough to work out by hand, and HDR-FLIP against a direct, slow writing of its
// formulas.
#include "compare/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "compare/flip.h"

namespace arealab::metrics_test {
namespace {

using Pixels = std::vector<glm::vec3>;

// 2×2 in grey: reference 1, 2, 0, 4; image 1, 1, 0, 6. The third pixel is black in both and does not count.
const Pixels kReference = {glm::vec3(1.0f), glm::vec3(2.0f), glm::vec3(0.0f), glm::vec3(4.0f)};
const Pixels kImage = {glm::vec3(1.0f), glm::vec3(1.0f), glm::vec3(0.0f), glm::vec3(6.0f)};

TEST(Metrics, TwoByTwoByHand) {
  const ErrorMetrics e = CompareImages(kImage, kReference, 2);
  EXPECT_NEAR(e.rel_rmse, std::sqrt((0.0 + 1.0 + 4.0) / (1.0 + 4.0 + 16.0)), 1e-12);
  EXPECT_NEAR(e.bias, (0.0 - 1.0 + 2.0) / 7.0, 1e-12);
  EXPECT_NEAR(e.mae, (0.0 + 1.0 + 2.0) / 3.0, 1e-12);
  const double epsilon = std::pow(0.01 * 7.0 / 3.0, 2.0);  // luminance of grey is its value
  EXPECT_NEAR(e.relmse, (1.0 / (4.0 + epsilon) + 4.0 / (16.0 + epsilon)) / 3.0, 1e-9);
  EXPECT_EQ(e.p99, 2.0);  // ceil(0.99 · 3) = 3rd of 0, 1, 2
  EXPECT_EQ(e.max, 2.0);
  EXPECT_EQ(e.max_x, 1);
  EXPECT_EQ(e.max_y, 1);
  EXPECT_TRUE(std::isnan(e.flip));
}

TEST(Metrics, ChannelsCountOneByOne) {
  const Pixels a = {{1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, {0.0f, 3.0f, 0.0f}};
  const Pixels b = {{0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, {0.0f, 2.0f, 0.0f}};
  const ErrorMetrics e = CompareImages(a, b, 2);
  EXPECT_NEAR(e.rel_rmse, std::sqrt((1.0 + 1.0 + 1.0) / (1.0 + 4.0)), 1e-12);
  EXPECT_NEAR(e.bias, (1.0 - 1.0 + 1.0) / 3.0, 1e-12);
  EXPECT_NEAR(e.mae, 3.0 / 6.0, 1e-12);  // two lit pixels of three channels
  const double mean_luminance = 0.7152 * (1.0 + 2.0) / 2.0, epsilon = std::pow(0.01 * mean_luminance, 2.0);
  EXPECT_NEAR(e.relmse, (1.0 / epsilon + 1.0 / (1.0 + epsilon) + 1.0 / (4.0 + epsilon)) / 6.0,
              1e-6 / epsilon);
  EXPECT_EQ(e.max, 1.0);
  EXPECT_EQ(e.max_x, 0);  // the first of equals
  EXPECT_EQ(e.max_y, 0);
}

TEST(Metrics, SwappedImagesDiffer) {  // the reference is the second: what divides must not be the first
  EXPECT_NE(CompareImages(kImage, kReference, 2).rel_rmse, CompareImages(kReference, kImage, 2).rel_rmse);
  EXPECT_GT(CompareImages(kImage, kReference, 2).bias, 0.0);
  EXPECT_LT(CompareImages(kReference, kImage, 2).bias, 0.0);
}

TEST(Metrics, EqualImagesAreZero) {
  const ErrorMetrics e = CompareImages(kReference, kReference, 2);
  for (double v : {e.rel_rmse, e.bias, e.relmse, e.mae, e.p99, e.max}) EXPECT_EQ(v, 0.0);
  const Pixels black(4, glm::vec3(0.0f));
  EXPECT_EQ(CompareImages(black, black, 2).rel_rmse, 0.0);
}

TEST(Metrics, LightWhereTruthIsBlackHasNoRelativeError) {
  const Pixels black(4, glm::vec3(0.0f));
  const ErrorMetrics e = CompareImages(kImage, black, 2);
  EXPECT_TRUE(std::isnan(e.rel_rmse));
  EXPECT_TRUE(std::isnan(e.bias));
  EXPECT_TRUE(std::isnan(e.relmse));
  EXPECT_NEAR(e.mae, 8.0 / 3.0, 1e-12);
  EXPECT_EQ(e.max, 6.0);
}

TEST(Metrics, PercentileLeavesOneInAHundred) {
  Pixels a(200, glm::vec3(1.0f));
  const Pixels b(200, glm::vec3(1.0f));
  for (int i = 0; i < 200; ++i) a[static_cast<std::size_t>(i)].y += static_cast<float>(i);
  const ErrorMetrics e = CompareImages(a, b, 20);
  EXPECT_EQ(e.p99, 197.0);  // the 198th of 0 … 199
  EXPECT_EQ(e.max, 199.0);
  EXPECT_EQ(e.max_x, 19);
  EXPECT_EQ(e.max_y, 9);
}

TEST(Metrics, PlantedNanIsCountedAndSpoilsTheMetrics) {
  RadianceImage truth{2, 2, kReference, kReference};
  auto image = std::make_shared<RadianceImage>(truth);
  image->specular[2].y = std::numeric_limits<float>::quiet_NaN();
  image->specular[3].z = std::numeric_limits<float>::infinity();
  VariantResult variant;
  variant.image = image;
  const std::vector<glm::vec3> total = TotalRadiance(truth);
  const FlipReference flip(total, 2);
  Measure(truth, &flip, &variant);
  EXPECT_EQ(variant.nonfinite_pixels, 2);
  for (const ErrorMetrics* e : {&variant.total, &variant.specular}) {
    for (double v : {e->rel_rmse, e->bias, e->relmse, e->mae, e->p99, e->max, e->flip})
      EXPECT_TRUE(std::isnan(v));
    EXPECT_EQ(e->max_x, -1);
  }
  EXPECT_EQ(variant.diffuse.rel_rmse, 0.0);
}

TEST(Metrics, RelativeRmseAloneIsTheSame) {
  EXPECT_NEAR(RelativeRmse(kImage, kReference), CompareImages(kImage, kReference, 2).rel_rmse, 1e-14);
  EXPECT_EQ(RelativeRmse(kImage, kImage), 0.0);
  EXPECT_TRUE(std::isnan(RelativeRmse(kImage, Pixels(4, glm::vec3(0.0f)))));
  Pixels broken = kImage;
  broken[2].z = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(std::isnan(RelativeRmse(broken, kReference)));
  EXPECT_TRUE(std::isnan(RelativeRmse(kImage, broken)));
  EXPECT_THROW(RelativeRmse(kImage, Pixels(6)), std::invalid_argument);
}

TEST(Metrics, SizeMismatchThrows) {
  const Pixels six(6, glm::vec3(1.0f));
  EXPECT_THROW(CompareImages(six, kReference, 2), std::invalid_argument);
  EXPECT_THROW(CompareImages(kReference, kReference, 3), std::invalid_argument);
  EXPECT_THROW(CompareImages(kReference, kReference, 0), std::invalid_argument);
  EXPECT_THROW(HdrFlip(six, kReference, 2), std::invalid_argument);
  const FlipReference flip(kReference, 2);
  EXPECT_THROW(flip.MapOf(six), std::invalid_argument);
}

// ---- HDR-FLIP, written down directly: two-dimensional kernels, double precision, the library's
// transcendentals.

struct Lab {
  double l, a, b;
};

struct Direct {
  int width, height;
  double ppd = 0.7 * 3840.0 / 0.7 * 3.14159265358979323846 / 180.0;

  static glm::dmat3 ToXyz() {  // sRGB's primaries, D65
    return glm::transpose(glm::dmat3(0.41238656, 0.35759149, 0.18045049, 0.21263682, 0.71518298, 0.07218020,
                                     0.01933062, 0.11919716, 0.95037259));
  }
  static glm::dvec3 White() { return ToXyz() * glm::dvec3(1.0); }
  static double Aces(double v) {
    const double x = 0.6 * v;
    return std::clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
  }
  std::size_t At(int x, int y) const {
    return static_cast<std::size_t>(std::clamp(y, 0, height - 1) * width + std::clamp(x, 0, width - 1));
  }
  template <typename Kernel>
  std::vector<double> Filter(const std::vector<double>& in, int radius, const Kernel& kernel) const {
    std::vector<double> out(in.size());
    double positive = 0.0, negative = 0.0;
    for (int v = -radius; v <= radius; ++v) {
      for (int u = -radius; u <= radius; ++u)
        (kernel(u, v) > 0.0 ? positive : negative) += std::abs(kernel(u, v));
    }
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        double sum = 0.0;
        for (int v = -radius; v <= radius; ++v) {
          for (int u = -radius; u <= radius; ++u) {
            const double k = kernel(u, v);
            sum += k / (k > 0.0 ? positive : negative) * in[At(x + u, y + v)];
          }
        }
        out[At(x, y)] = sum;
      }
    }
    return out;
  }
  double Spatial(double a1, double b1, double a2, double b2, int u, int v) const {
    const double pi = 3.14159265358979323846, z = (u * u + v * v) / (ppd * ppd);
    return a1 * std::sqrt(pi / b1) * std::exp(-pi * pi * z / b1) +
           a2 * std::sqrt(pi / b2) * std::exp(-pi * pi * z / b2);
  }
  static Lab HuntLab(const glm::dvec3& rgb) {
    const glm::dvec3 xyz = (ToXyz() * rgb) / White();
    const auto f = [](double t) {
      const double d = 6.0 / 29.0;
      return t > d * d * d ? std::cbrt(t) : t / (3.0 * d * d) + 4.0 / 29.0;
    };
    const double l = 116.0 * f(xyz.y) - 16.0;
    return {l, 0.01 * l * 500.0 * (f(xyz.x) - f(xyz.y)), 0.01 * l * 200.0 * (f(xyz.y) - f(xyz.z))};
  }
  static double HyAb(const Lab& p, const Lab& q) {
    return std::abs(p.l - q.l) + std::hypot(p.a - q.a, p.b - q.b);
  }

  struct Seen {
    std::vector<Lab> lab;
    std::vector<double> edge, point;
  };
  Seen See(const Pixels& image, double exposure) const {
    std::vector<double> ys, cxs, czs, normal;
    for (const glm::vec3& pixel : image) {
      glm::dvec3 mapped;
      for (int c = 0; c < 3; ++c)
        mapped[c] = Aces(std::max(static_cast<double>(pixel[c]), 0.0) * std::exp2(exposure));
      const glm::dvec3 xyz = (ToXyz() * mapped) / White();
      ys.push_back(116.0 * xyz.y - 16.0);
      cxs.push_back(500.0 * (xyz.x - xyz.y));
      czs.push_back(200.0 * (xyz.y - xyz.z));
      normal.push_back(xyz.y);
    }
    const int r = static_cast<int>(std::ceil(3.0 * std::sqrt(0.04 / (2.0 * 9.8696044011)) * ppd));
    ys = Filter(ys, r, [&](int u, int v) { return Spatial(1, 0.0047, 0, 1e-5, u, v); });
    cxs = Filter(cxs, r, [&](int u, int v) { return Spatial(1, 0.0053, 0, 1e-5, u, v); });
    czs = Filter(czs, r, [&](int u, int v) { return Spatial(34.1, 0.04, 13.5, 0.025, u, v); });
    Seen seen;
    for (std::size_t i = 0; i < ys.size(); ++i) {
      const double y = (ys[i] + 16.0) / 116.0;
      glm::dvec3 rgb =
          glm::inverse(ToXyz()) * (glm::dvec3(y + cxs[i] / 500.0, y, y - czs[i] / 200.0) * White());
      seen.lab.push_back(HuntLab(glm::clamp(rgb, 0.0, 1.0)));
    }
    const double sd = 0.5 * 0.082 * ppd;
    const int fr = static_cast<int>(std::ceil(3.0 * sd));
    const auto g = [&](int u, int v) { return std::exp(-(u * u + v * v) / (2.0 * sd * sd)); };
    const auto ex = Filter(normal, fr, [&](int u, int v) { return -u * g(u, v); });
    const auto ey = Filter(normal, fr, [&](int u, int v) { return -v * g(u, v); });
    const auto px = Filter(normal, fr, [&](int u, int v) { return (u * u / (sd * sd) - 1.0) * g(u, v); });
    const auto py = Filter(normal, fr, [&](int u, int v) { return (v * v / (sd * sd) - 1.0) * g(u, v); });
    for (std::size_t i = 0; i < normal.size(); ++i) {
      seen.edge.push_back(std::hypot(ex[i], ey[i]));
      seen.point.push_back(std::hypot(px[i], py[i]));
    }
    return seen;
  }
  std::vector<double> Map(const Pixels& reference, const Pixels& test,
                          const std::vector<float>& exposures) const {
    std::vector<double> map(reference.size(), 0.0);
    const double largest = std::pow(HyAb(HuntLab({0, 1, 0}), HuntLab({0, 0, 1})), 0.7);
    for (float exposure : exposures) {
      const Seen r = See(reference, static_cast<double>(exposure)),
                 t = See(test, static_cast<double>(exposure));
      for (std::size_t i = 0; i < map.size(); ++i) {
        const double c = std::pow(HyAb(r.lab[i], t.lab[i]), 0.7), knee = 0.4 * largest;
        const double color = c < knee ? 0.95 / knee * c : 0.95 + (c - knee) / (largest - knee) * 0.05;
        const double feature = std::max(std::abs(r.edge[i] - t.edge[i]), std::abs(r.point[i] - t.point[i]));
        map[i] = std::max(map[i], std::pow(color, 1.0 - std::sqrt(feature / std::sqrt(2.0))));
      }
    }
    return map;
  }
};

Pixels Pattern(int width, int height, unsigned seed, float noise) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> jitter(-noise, noise);
  Pixels pixels;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float fx = static_cast<float>(x), fy = static_cast<float>(y);
      const float light =
          0.05f + 6.0f * std::exp(-(std::pow(fx - 14.0f, 2.0f) + std::pow(fy - 9.0f, 2.0f)) / 20.0f);
      const float checker = (x / 6 + y / 6) % 2 == 0 ? 1.0f : 0.4f;
      pixels.push_back(glm::max(
          glm::vec3(light, 0.8f * light, 0.5f * light + 0.02f * fx) * checker * (1.0f + jitter(random)),
          0.0f));
    }
  }
  return pixels;
}

TEST(HdrFlip, EqualsTheFormulasWrittenDirectly) {
  constexpr double kMaxError = 1e-4;  // float against double; pow(ΔE, 0.7) is steep near 0: measured 4.7e-6
  constexpr int kWidth = 37, kHeight = 26;  // not a multiple of the eight pixels taken at a time
  const Pixels reference = Pattern(kWidth, kHeight, 1, 0.0f), test = Pattern(kWidth, kHeight, 2, 0.3f);
  const FlipReference flip(reference, kWidth);
  ASSERT_GE(flip.exposures().size(), 3u);
  const std::vector<float> map = flip.MapOf(test);
  const std::vector<double> expected = Direct{kWidth, kHeight}.Map(reference, test, flip.exposures());
  ASSERT_EQ(map.size(), expected.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < map.size(); ++i) {
    ASSERT_NEAR(static_cast<double>(map[i]), expected[i], kMaxError) << i;
    largest = std::max(largest, expected[i]);
  }
  EXPECT_GT(largest, 0.2);  // the comparison is not of zeros
}

// Of a picture that differs in one spot only, what lies out of the filters' reach is left out: what lies in it is as beside
// differences everywhere else, and the rest is 0.
TEST(HdrFlip, ASpotAloneIsAsAmongOthers) {
  constexpr int kWidth = 300, kHeight = 100, kReach = 10, kFar = 24;
  const Pixels reference = Pattern(kWidth, kHeight, 1, 0.0f), other = Pattern(kWidth, kHeight, 2, 0.3f);
  const FlipReference flip(reference, kWidth);
  for (const auto& [column, row] : {std::pair(0, 0), {63, 15}, {64, 16}, {150, 47}, {127, 48}, {299, 99}}) {
    Pixels alone = reference, among = other;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const auto i = static_cast<std::size_t>(y * kWidth + x);
        if (std::max(std::abs(x - column), std::abs(y - row)) <= kFar) among[i] = reference[i];
      }
    }
    const auto spot = static_cast<std::size_t>(row * kWidth + column);
    alone[spot] = among[spot] = 3.0f * reference[spot] + 0.1f;
    const std::vector<float> map = flip.MapOf(alone), beside = flip.MapOf(among);
    int lit = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const auto i = static_cast<std::size_t>(y * kWidth + x);
        const int away = std::max(std::abs(x - column), std::abs(y - row));
        ASSERT_EQ(map[i], away > kReach ? 0.0f : beside[i]) << x << " " << y;
        lit += map[i] > 0.0f;
      }
    }
    EXPECT_GT(lit, 100) << column;
  }
}

TEST(HdrFlip, EqualImagesAreZeroAndTheWorstIsNearOne) {
  const Pixels reference = Pattern(32, 24, 1, 0.0f);
  EXPECT_EQ(HdrFlip(reference, reference, 32), 0.0);
  const Pixels green(32 * 24, glm::vec3(0.0f, 4.0f, 0.0f)), blue(32 * 24, glm::vec3(0.0f, 0.0f, 4.0f));
  EXPECT_GT(HdrFlip(blue, green, 32), 0.9);
  EXPECT_LE(HdrFlip(blue, green, 32), 1.0);
}

TEST(HdrFlip, GrowsWithTheDifference) {
  const Pixels reference = Pattern(32, 24, 1, 0.0f);
  double last = 0.0;
  for (float noise : {0.01f, 0.05f, 0.2f, 0.8f}) {
    const double flip = HdrFlip(Pattern(32, 24, 3, noise), reference, 32);
    EXPECT_GT(flip, last);
    last = flip;
  }
}

TEST(HdrFlip, ExposuresBringBrightestAndMedianToTheTarget) {
  // 0.85 by the ACES fit is reached at 1.1035…: Aces(x) = 0.85 solved by bisection here.
  double lo = 0.0, hi = 10.0;
  for (int i = 0; i < 100; ++i) (Direct::Aces(0.5 * (lo + hi)) < 0.85 ? lo : hi) = 0.5 * (lo + hi);
  Pixels reference(9, glm::vec3(0.5f));
  reference[4] = glm::vec3(16.0f);
  const FlipReference flip(reference, 3);
  ASSERT_EQ(flip.exposures().size(), 5u);  // log2(16 / 0.5) stops
  EXPECT_NEAR(static_cast<double>(flip.exposures().front()), std::log2(lo / 16.0), 1e-5);
  EXPECT_NEAR(static_cast<double>(flip.exposures().back()), std::log2(lo / 0.5), 1e-5);
}

TEST(HdrFlip, BlackAndNonFinitePictures) {
  const Pixels black(12, glm::vec3(0.0f)), white(12, glm::vec3(1.0f));
  EXPECT_EQ(HdrFlip(black, black, 4), 0.0);
  EXPECT_GT(HdrFlip(white, black, 4), 0.5);
  Pixels mostly_black = black;
  mostly_black[5] = glm::vec3(3.0f);
  EXPECT_EQ(HdrFlip(mostly_black, mostly_black, 4), 0.0);  // the median is 0: no infinite exposure
  EXPECT_GT(HdrFlip(black, mostly_black, 4), 0.0);
  Pixels broken = white;
  broken[3].x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isnan(HdrFlip(broken, white, 4)));
  EXPECT_TRUE(std::isnan(HdrFlip(white, broken, 4)));
}

}  // namespace
}  // namespace arealab::metrics_test
