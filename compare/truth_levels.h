// The fixed levels of the specular rule, from coarse to fine: for the integrator's tests and its calibration.
#pragma once

#include <array>

#include "compare/truth.h"

namespace arealab {

struct TruthLevel {
  double outer,
      outer_per_range;  // nodes on a panel of the outline: outer + outer_per_range · its length in u
  double radial, radial_per_reach;  // nodes on a ray: radial + radial_per_reach · the longest ray's y
  int splits;                       // every panel and every ray is cut into this many equal parts
};

constexpr int kTruthLevelCount = 9;
const std::array<TruthLevel, kTruthLevelCount>& TruthLevels();

// How a level's sum is made: in double as it is kept; in float, for GGX, as the check that the first kept level must agree with; with the
// BRDF's text, where GGX otherwise has a form of its own.
enum class TruthForm { kKept, kCheck, kText };

// IntegrateLight with one level and no check; the error members stay 0.
LightIntegrals IntegrateLightAtLevel(const ShadingPoint& point, const Light& light, int level, TruthForm form = TruthForm::kKept);

}  // namespace arealab
