// The talk's figures against an intersection that is counted.
#include "compare/oat_claims.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include <cmath>
#include <numbers>

namespace arealab::oat_claims_test {
namespace {

// Mid-points of the smaller cap, even in height and turn, that lie in the other one.
double Counted(double r0, double r1, double d) {
  constexpr int kAcross = 600, kAround = 600;
  const double smaller = std::min(r0, r1), larger = std::max(r0, r1), versine = 1.0 - std::cos(smaller);
  int inside = 0;
  for (int i = 0; i < kAcross; ++i) {
    const double z = 1.0 - versine * (i + 0.5) / kAcross, s = std::sqrt(1.0 - z * z);
    for (int j = 0; j < kAround; ++j) {
      const double x = s * std::cos(2.0 * std::numbers::pi * (j + 0.5) / kAround);
      inside += x * std::sin(d) + z * std::cos(d) > std::cos(larger);
    }
  }
  return 2.0 * std::numbers::pi * versine * inside / (kAcross * kAround);
}

TEST(OatClaims, ExactOverlapIsTheCountedOneAndTheCorrectedForm) {
  for (const auto& [r0, r1, d] : {std::array{0.3, 0.2, 0.25}, std::array{1.2, 0.4, 1.1}, std::array{1.5, 1.5, 1.0}, std::array{0.7, 0.7, 0.1}}) {
    EXPECT_NEAR(CapOverlapExact(r0, r1, d), Counted(r0, r1, d), 2e-3);
    EXPECT_NEAR(CapOverlapCorrected(r0, r1, d), CapOverlapExact(r0, r1, d), 1e-9);
    // As printed no area at all: its third term has the wrong sign.
    EXPECT_LT(CapOverlapPrinted(r0, r1, d), 0.0);
  }
}

// The smoothstep meets the exact form at both ends and in between is off by a few percent of the smaller cap.
TEST(OatClaims, SmoothstepIsWithinItsBand) {
  const CapCurve curve = MakeCapCurve(0.8, 0.3, 33);
  EXPECT_NEAR(curve.exact.front(), curve.smoothstep.front(), 1e-12);
  EXPECT_NEAR(curve.exact.back(), 0.0, 1e-12);
  EXPECT_NEAR(curve.smoothstep.back(), 0.0, 1e-12);
  const CapOverlapError error = MeasureCapOverlap();
  // Measured 0.0475, 0.0194 and 0.1605, the last for equal caps (in the plane: disks).
  EXPECT_NEAR(error.rms, 0.0475, 0.005);
  EXPECT_NEAR(error.bias, 0.0194, 0.002);
  EXPECT_NEAR(error.largest, 0.1605, 0.005);
  EXPECT_EQ(error.radius0, error.radius1);
  EXPECT_NEAR(MeasureCapOverlap(24).rms, error.rms, 0.1 * error.rms);
  const double smaller = 2.0 * std::numbers::pi * (1.0 - std::cos(std::min(error.radius0, error.radius1)));
  EXPECT_NEAR((CapOverlapSmoothstep(error.radius0, error.radius1, error.distance) - CapOverlapExact(error.radius0, error.radius1, error.distance)) / smaller,
              error.largest, 1e-12);
}

TEST(OatClaims, AveragedCentroidIsTooBright) {
  EXPECT_NEAR(AveragedCentroidGain(std::numbers::pi / 3.0), std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(AveragedCentroidGain(80.0 * std::numbers::pi / 180.0), 4.41, 0.01);
}

}  // namespace
}  // namespace arealab::oat_claims_test
