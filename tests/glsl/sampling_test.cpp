// What the Monte Carlo technique draws from, in double: points, half vectors, directions to a light, against
// the densities that they claim.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <set>
#include <vector>

#include "glsl/dual_begin.h"
#include "glsl/ggx_sampling.glsl"
#include "glsl/light_sampling.glsl"
#include "glsl/low_discrepancy.glsl"
#include "glsl/dual_end.h"

namespace arealab::sampling_test {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double kPi = glm::pi<double>();

// The mean over u, by midpoints of a grid.
double Mean(int n, const std::function<double(const dvec2&)>& value) {
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) sum += value({(i + 0.5) / n, (j + 0.5) / n});
  }
  return sum / (n * n);
}

TEST(Sampling, SobolPointsAreStratified) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    std::set<int> columns, rows, squares;
    for (unsigned i = 0; i < 16; ++i) {
      const dvec2 p = dual::SobolPoint(i, seed);
      ASSERT_TRUE(p.x > 0.0 && p.x < 1.0 && p.y > 0.0 && p.y < 1.0);
      columns.insert(static_cast<int>(p.x * 16.0));
      rows.insert(static_cast<int>(p.y * 16.0));
      squares.insert(static_cast<int>(p.x * 4.0) * 4 + static_cast<int>(p.y * 4.0));
    }
    EXPECT_EQ(columns.size(), 16u);
    EXPECT_EQ(rows.size(), 16u);
    EXPECT_EQ(squares.size(), 16u);
  }
}

// Every point of its own is uniform over the seeds, and no two are tied to each other.
TEST(Sampling, SobolPointsAreUniformOverSeeds) {
  constexpr int kSeeds = 40000;
  for (unsigned i : {0u, 1u, 5u, 31u}) {
    std::array<std::array<int, 8>, 8> cells{};
    for (int seed = 0; seed < kSeeds; ++seed) {
      const dvec2 p = dual::SobolPoint(i, dual::Hash(static_cast<unsigned>(seed)));
      ++cells[static_cast<std::size_t>(p.x * 8.0)][static_cast<std::size_t>(p.y * 8.0)];
    }
    double chi2 = 0.0;
    const double expected = kSeeds / 64.0;
    for (const auto& row : cells) {
      for (const int count : row) chi2 += (count - expected) * (count - expected) / expected;
    }
    EXPECT_LT(chi2, 63.0 + 4.5 * std::sqrt(2.0 * 63.0)) << i;  // 63 degrees of freedom, 4.5 σ
  }
}

// A function's mean over the drawn half vectors is its integral against the claimed density.
TEST(Sampling, VisibleHalfVectorsFollowTheirDensity) {
  for (const double n_dot_v : {1.0, 0.5, 0.1}) {
    for (const double alpha : {0.05, 0.3, 1.0}) {
      const dvec3 view(std::sqrt(1.0 - n_dot_v * n_dot_v), 0.0, n_dot_v);
      for (const auto& value : std::vector<std::function<double(const dvec3&)>>{
               [](const dvec3& h) { return h.z; }, [](const dvec3& h) { return h.x / (h.z + 1.0); },
               [](const dvec3& h) { return h.y * h.y; }}) {
        const double drawn = Mean(
            400, [&](const dvec2& u) { return value(dual::SampleVisibleHalfVector(n_dot_v, alpha, u)); });
        // Over the hemisphere in tan θ = α tan ψ, dω = sinθ dθ dφ.
        double integral = 0.0;
        constexpr int kSteps = 800;
        for (int i = 0; i < kSteps; ++i) {
          const double psi = (i + 0.5) / kSteps * 0.5 * kPi;
          const double tangent = alpha * std::tan(psi), cosine = 1.0 / std::sqrt(1.0 + tangent * tangent);
          const double d_theta =
              alpha / (std::cos(psi) * std::cos(psi)) * cosine * cosine * 0.5 * kPi / kSteps;
          for (int j = 0; j < 200; ++j) {
            const double phi = (j + 0.5) / 200.0 * 2.0 * kPi;
            const dvec3 h(tangent * cosine * std::cos(phi), tangent * cosine * std::sin(phi), cosine);
            const double density = dual::SmithG1(n_dot_v, alpha) * dual::GgxDensity(cosine, alpha) *
                                   std::max(glm::dot(view, h), 0.0) / n_dot_v;
            integral += value(h) * density * tangent * cosine * d_theta * 2.0 * kPi / 200.0;
          }
        }
        EXPECT_NEAR(drawn, integral, 2e-3 * std::max(1.0, alpha)) << n_dot_v << " " << alpha;
      }
    }
  }
}

// The share of directions that fall into a part of the rectangle is the part's share of the density's
// integral.
TEST(Sampling, RectangleFollowsItsDensity) {
  struct Place {
    dvec3 point;
    dvec2 half_size;
  };
  for (const Place& place : {Place{{0.3, -0.2, 0.5}, {1.0, 0.6}}, Place{{3.0, 2.0, 0.4}, {1.0, 0.2}},
                             Place{{-0.5, 0.0, 0.02}, {0.7, 2.0}}, Place{{10.0, -3.0, 8.0}, {0.5, 0.4}}}) {
    const auto r = dual::ViewSphericalRectangle(place.point, place.half_size);
    const dvec2 low(-0.5, -1.0), high(0.8, 0.1);  // of the half size
    const double share = Mean(1000, [&](const dvec2& u) {
      const dvec2 p = (dvec2(dual::SampleSphericalRectangle(r, u)) + dvec2(place.point)) / place.half_size;
      return p.x > low.x && p.x < high.x && p.y > low.y && p.y < high.y ? 1.0 : 0.0;
    });
    // ∫ density dω over the part, by midpoints over its area: dω = h / d³ dA.
    const double expected = Mean(1000, [&](const dvec2& u) {
      const dvec2 p = glm::mix(low, high, u) * place.half_size;
      const dvec3 to_light(p - dvec2(place.point), -place.point.z);
      const double d = glm::length(to_light);
      const dvec2 size = (high - low) * place.half_size;
      return dual::SphericalRectangleDensity(r, to_light) * place.point.z / (d * d * d) * size.x * size.y;
    });
    EXPECT_NEAR(share, expected, 2e-3) << place.point.x;
  }
}

TEST(Sampling, CapAndDiskAreEven) {
  dual::Cap cap;
  cap.axis = glm::normalize(dvec3(0.3, -0.5, 0.7));
  cap.versine = 0.4;
  EXPECT_NEAR(
      Mean(200, [&](const dvec2& u) { return dual::VersineBetween(dual::SampleCap(cap, u), cap.axis); }), 0.2,
      1e-5);
  EXPECT_NEAR(Mean(200, [&](const dvec2& u) { return glm::length(dual::SampleCap(cap, u)); }), 1.0, 1e-12);
  EXPECT_NEAR(Mean(200, [&](const dvec2& u) { return std::pow(glm::length(dual::SampleDisk(2.0, u)), 2.0); }),
              2.0, 1e-4);
}

}  // namespace
}  // namespace arealab::sampling_test
