#include "glsl/fitted_lobe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "glsl/fit_lobe.h"
#include "glsl/technique.h"

namespace arealab::fitted_lobe_test {
namespace {

// Over all directions, by midpoints in z and azimuth.
template <typename Density>
double SphereIntegral(const Density& density) {
  constexpr int kRows = 400, kColumns = 400;
  double sum = 0.0;
  for (int i = 0; i < kRows; ++i) {
    const double z = -1.0 + (2.0 * i + 1.0) / kRows, r = std::sqrt(1.0 - z * z);
    for (int j = 0; j < kColumns; ++j) {
      const double azimuth = 2.0 * glm::pi<double>() * (j + 0.5) / kColumns;
      sum += density({r * std::cos(azimuth), r * std::sin(azimuth), z});
    }
  }
  return sum * 4.0 * glm::pi<double>() / (kRows * kColumns);
}

TEST(FittedLobe, HasTheIntegralOfATransformedCosine) {
  const ShaderLibrary library;
  const std::vector<Technique> techniques = LoadTechniques(library);
  for (const char* name : {"ltc", "ltc@published", "ltc+lobes=cosine", "ltc+lobes=two", "hill"}) {
    const auto lobe = FindFittedLobe(library, ParseVariant(techniques, name), Brdf::kGgx, 0.6, 0.7);
    ASSERT_TRUE(lobe) << name;
    EXPECT_NEAR(SphereIntegral([&](const glm::dvec3& d) { return lobe->Density(d); }), lobe->magnitude * (1.0 + lobe->other), 1e-3) << name;
    EXPECT_EQ(lobe->other != 0.0, std::string(name).find("lobes=") != std::string::npos);
  }
}

TEST(FittedLobe, IsTheBrdfsWithinWhatAFitOfOneLobeLeaves) {
  const ShaderLibrary library;
  const std::vector<Technique> techniques = LoadTechniques(library);
  const double roughness = 0.5, n_dot_v = 0.6;
  const fit::View view = fit::MakeView(Brdf::kGgx, roughness, n_dot_v);
  const auto distance = [&](double fitted_roughness) {
    const auto lobe = FindFittedLobe(library, ParseVariant(techniques, "ltc"), Brdf::kGgx, fitted_roughness, n_dot_v);
    return SphereIntegral([&](const glm::dvec3& d) { return d.z > 0.0 ? std::abs(lobe->Density(d) - fit::LobeDensity(view, d)) : 0.0; }) /
           SphereIntegral([&](const glm::dvec3& d) { return fit::LobeDensity(view, d); });
  };
  EXPECT_LT(distance(roughness), 0.12);
  EXPECT_GT(distance(0.65), 2.0 * distance(roughness));  // the look-up's place matters
}

TEST(FittedLobe, OfATechniqueWithoutTablesIsNone) {
  const ShaderLibrary library;
  const std::vector<Technique> techniques = LoadTechniques(library);
  EXPECT_FALSE(FindFittedLobe(library, ParseVariant(techniques, "drobot"), Brdf::kGgx, 0.5, 0.5));
}

}  // namespace
}  // namespace arealab::fitted_lobe_test
