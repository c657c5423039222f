// What holds for every technique, whatever it approximates.
#pragma once

#include <algorithm>

#include "tests/compare/technique_points.h"

namespace arealab {

inline std::vector<PointCase> RandomPoints(unsigned seed, LightShape shape, int count) {
  PointRandom random(seed);
  std::vector<PointCase> cases;
  for (int i = 0; i < count; ++i) cases.push_back(RandomPoint(random, shape));
  return cases;
}

inline std::vector<Shaded> TruthOf(const std::vector<PointCase>& cases, double tolerance = 1e-3, Brdfs brdfs = {}) {
  std::vector<Shaded> truth;
  for (const PointCase& c : cases) {
    const LightIntegrals integrals = c.Truth(tolerance, brdfs);
    truth.push_back({integrals.form_factor,
                     c.f0 * (integrals.specular - integrals.specular_grazing) + integrals.specular_grazing});
  }
  return truth;
}

// Finite and not negative where a careless formula divides 0 by 0, in every variant.
inline void ExpectFinite(TechniquePoints& points, const std::string& technique) {
  for (const Variant& variant : points.Variants(technique)) {
    std::vector<PointCase> cases;
    const std::vector<LightShape>& shapes = variant.technique->shapes;
    for (const PointCase& c : HardPoints()) {
      if (std::count(shapes.begin(), shapes.end(), c.shape) > 0) cases.push_back(c);
    }
    for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
      // Ten times float's time: the default stands for all.
      if (precision == Precision::kDouble && variant.Name() != technique) continue;
      const std::vector<Shaded> shaded = points.Shade(variant.Name(), cases, precision);
      for (std::size_t i = 0; i < cases.size(); ++i) {
        ASSERT_TRUE(shaded[i].diffuse >= 0.0 && std::isfinite(shaded[i].diffuse))
            << variant.Name() << " " << i;
        ASSERT_TRUE(shaded[i].specular >= 0.0 && std::isfinite(shaded[i].specular))
            << variant.Name() << " " << i;
      }
    }
  }
}

// Twice the radiance, twice the picture, to the bit.
inline void ExpectLinearInRadiance(TechniquePoints& points, const std::string& variant,
                                   std::vector<PointCase> cases) {
  const std::vector<Shaded> once = points.Shade(variant, cases);
  for (PointCase& c : cases) c.radiance = 2.0;
  const std::vector<Shaded> twice = points.Shade(variant, cases);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    ASSERT_EQ(twice[i].diffuse, 2.0 * once[i].diffuse) << variant << " " << i;
    ASSERT_EQ(twice[i].specular, 2.0 * once[i].specular) << variant << " " << i;
  }
}

// The same scene a thousand times as large, by as much as float inputs tell.
inline void ExpectFreeOfScale(TechniquePoints& points, const std::string& variant,
                              const std::vector<PointCase>& cases) {
  std::vector<PointCase> large;
  for (PointCase c : cases) {
    c.center *= 1000.0;
    c.half_size *= 1000.0;
    large.push_back(c);
  }
  const std::vector<Shaded> one = points.Shade(variant, cases, Precision::kDouble),
                            thousand = points.Shade(variant, large, Precision::kDouble);
  EXPECT_LT(RelativeRmse(thousand, one, &Shaded::diffuse), 1e-5) << variant;
  EXPECT_LT(RelativeRmse(thousand, one, &Shaded::specular), 1e-4) << variant;
}

// The variant's relative RMSE against truth is what was measured, from both sides.
inline void ExpectInBand(TechniquePoints& points, const std::string& variant, const std::vector<PointCase>& cases,
                         const std::vector<Shaded>& truth, double diffuse, double specular) {
  constexpr double kSlack = 0.05;  // relative: another driver's rounding moves no figure by more
  constexpr double kExact = 1e-4;  // of a lobe that is exact
  const std::vector<Shaded> shaded = points.Shade(variant, cases);
  EXPECT_NEAR(RelativeRmse(shaded, truth, &Shaded::diffuse), diffuse, diffuse > 0.0 ? kSlack * diffuse : kExact)
      << variant;
  EXPECT_NEAR(RelativeRmse(shaded, truth, &Shaded::specular), specular, kSlack * specular) << variant;
}

}  // namespace arealab
