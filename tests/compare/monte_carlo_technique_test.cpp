// The monte_carlo technique: unbiased over pixels and over seeds, its noise falls with the samples, limits
// without noise.
#include <gtest/gtest.h>

#include <array>

#include "tests/compare/technique_laws.h"

namespace arealab::monte_carlo_technique_test {
namespace {

class MonteCarloTechnique : public testing::Test {
 protected:
  static void SetUpTestSuite() { points_ = std::make_unique<TechniquePoints>(); }
  static void TearDownTestSuite() { points_.reset(); }
  static std::unique_ptr<TechniquePoints> points_;
};
std::unique_ptr<TechniquePoints> MonteCarloTechnique::points_;

constexpr std::array<LightShape, 3> kShapes{LightShape::kRectangle, LightShape::kDisk, LightShape::kSphere};

struct Moments {
  double mean = 0.0, deviation = 0.0;
};

Moments MomentsOf(const std::vector<Shaded>& shaded, double Shaded::*lobe, std::size_t first,
                  std::size_t count) {
  Moments moments;
  for (std::size_t i = first; i < first + count; ++i)
    moments.mean += shaded[i].*lobe / static_cast<double>(count);
  for (std::size_t i = first; i < first + count; ++i) {
    moments.deviation += std::pow(shaded[i].*lobe - moments.mean, 2.0) / static_cast<double>(count - 1);
  }
  moments.deviation = std::sqrt(moments.deviation);
  return moments;
}

// One configuration in many pixels, several of them: the mean lies at the truth within the pixels' own
// scatter, and the scatter falls faster than by 1/√n, since the points are stratified.
TEST_F(MonteCarloTechnique, IsUnbiasedAndItsNoiseFalls) {
  constexpr std::size_t kPixels = 2048, kConfigurations = 8;
  constexpr std::array<const char*, 4> kForms{"monte_carlo+samples=1", "monte_carlo+samples=4", "monte_carlo",
                                              "monte_carlo+samples=64"};
  for (const LightShape shape : kShapes) {
    std::vector<PointCase> configurations, pixels;
    for (const PointCase& c : RandomPoints(21, shape, 60)) {
      if (configurations.size() < kConfigurations && c.Truth().form_factor > 1e-3)
        configurations.push_back(c);
    }
    ASSERT_EQ(configurations.size(), kConfigurations);
    const std::vector<Shaded> truth = TruthOf(configurations, 1e-5);
    for (const PointCase& c : configurations) pixels.insert(pixels.end(), kPixels, c);
    std::array<std::array<double, kForms.size()>, 2> noise{};
    for (std::size_t form = 0; form < kForms.size(); ++form) {
      const std::vector<Shaded> shaded = points_->Shade(kForms[form], pixels);
      for (std::size_t k = 0; k < kConfigurations; ++k) {
        int lobe_index = 0;
        for (double Shaded::*lobe : {&Shaded::diffuse, &Shaded::specular}) {
          const Moments moments = MomentsOf(shaded, lobe, k * kPixels, kPixels);
          const double standard_error = moments.deviation / std::sqrt(static_cast<double>(kPixels));
          EXPECT_NEAR(moments.mean, truth[k].*lobe, 4.5 * standard_error + 2e-4 * truth[k].*lobe)
              << kForms[form] << " " << Name(shape) << " " << k << " " << lobe_index;
          noise[static_cast<std::size_t>(lobe_index++)][form] +=
              std::pow(moments.deviation / (truth[k].*lobe), 2.0);
        }
      }
    }
    for (const auto& lobe : noise) {  // squared: 1/16 of the variance is what n alone would give
      EXPECT_LT(lobe[1], 0.25 * lobe[0]) << Name(shape);
      EXPECT_LT(lobe[3], 0.05 * lobe[1]) << Name(shape);
    }
  }
}

TEST_F(MonteCarloTechnique, IsDeterministicAndTheSeedChangesIt) {
  const std::vector<PointCase> cases = RandomPoints(22, LightShape::kRectangle, 500);
  const std::vector<Shaded> once = points_->Shade("monte_carlo", cases),
                            again = points_->Shade("monte_carlo", cases);
  const std::vector<Shaded> other = points_->Shade("monte_carlo", cases, Precision::kFloat, {{"seed", 1.0}});
  std::size_t same = 0, changed = 0, lit = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    same += once[i].diffuse == again[i].diffuse && once[i].specular == again[i].specular ? 1u : 0u;
    lit += once[i].diffuse > 0.0 ? 1u : 0u;
    changed += once[i].diffuse > 0.0 && once[i].diffuse != other[i].diffuse ? 1u : 0u;
  }
  EXPECT_EQ(same, cases.size());
  EXPECT_GT(changed, lit * 99 / 100);
}

// The mean over seeds in one pixel tends to the truth as well: eight are worth eight times the samples.
TEST_F(MonteCarloTechnique, MeanOverSeedsIsTheTruth) {
  const std::vector<PointCase> cases = RandomPoints(23, LightShape::kRectangle, 1000);
  const std::vector<Shaded> truth = TruthOf(cases);
  std::vector<Shaded> mean(cases.size());
  constexpr int kSeeds = 8;
  Shaded single;  // mean of the squared errors of one seed
  for (int seed = 0; seed < kSeeds; ++seed) {
    const auto shaded =
        points_->Shade("monte_carlo", cases, Precision::kFloat, {{"seed", static_cast<double>(seed)}});
    for (std::size_t i = 0; i < cases.size(); ++i) {
      mean[i].diffuse += shaded[i].diffuse / kSeeds;
      mean[i].specular += shaded[i].specular / kSeeds;
    }
    for (double Shaded::*lobe : {&Shaded::diffuse, &Shaded::specular}) {
      single.*lobe += std::pow(RelativeRmse(shaded, truth, lobe), 2.0) / kSeeds;
    }
  }
  for (double Shaded::*lobe : {&Shaded::diffuse, &Shaded::specular}) {
    const double ratio = RelativeRmse(mean, truth, lobe) / std::sqrt(single.*lobe);
    EXPECT_NEAR(ratio, 1.0 / std::sqrt(static_cast<double>(kSeeds)), 0.1);
  }
}

// Where one of both kinds of sample has all the say there is no noise: a mirror's radiance, a shrinking
// light.
TEST_F(MonteCarloTechnique, LimitsWithoutNoise) {
  for (const LightShape shape : kShapes) {
    std::vector<PointCase> mirrors(200);
    for (PointCase& c : mirrors) {
      c.shape = shape;
      c.roughness = 0.01;
    }
    if (shape == LightShape::kSphere) {
      for (PointCase& c : mirrors) c.center.z = 2.0;
    }
    const std::vector<Shaded> one(mirrors.size(), Shaded{1.0, 1.0});
    EXPECT_LT(RelativeRmse(points_->Shade("monte_carlo", mirrors), one, &Shaded::specular), 0.03)
        << Name(shape);

    std::vector<PointCase> cases = RandomPoints(24, shape, 200);
    for (PointCase& c : cases) c.half_size *= 1e-3;
    const std::vector<Shaded> point = points_->Shade("point", cases, Precision::kDouble);
    const std::vector<Shaded> shaded = points_->Shade("monte_carlo", cases, Precision::kDouble);
    EXPECT_LT(RelativeRmse(shaded, point, &Shaded::diffuse), 2e-3) << Name(shape);
    EXPECT_LT(RelativeRmse(shaded, point, &Shaded::specular), 2e-2) << Name(shape);
  }
}

TEST_F(MonteCarloTechnique, Laws) {
  ExpectFinite(*points_, "monte_carlo");
  for (const LightShape shape : kShapes) {
    const std::vector<PointCase> cases = RandomPoints(25, shape, 500);
    ExpectLinearInRadiance(*points_, "monte_carlo", cases);
    ExpectFreeOfScale(*points_, "monte_carlo", cases);
    // The same points in both: they differ where a sample falls on the other side of an edge.
    const auto in_float = points_->Shade("monte_carlo", cases),
               in_double = points_->Shade("monte_carlo", cases, Precision::kDouble);
    EXPECT_LT(RelativeRmse(in_float, in_double, &Shaded::diffuse), 2e-3) << Name(shape);
    EXPECT_LT(RelativeRmse(in_float, in_double, &Shaded::specular), 2e-3) << Name(shape);
  }
}

}  // namespace
}  // namespace arealab::monte_carlo_technique_test
