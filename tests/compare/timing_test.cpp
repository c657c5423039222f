#include "compare/timing.h"

#include <gtest/gtest.h>

#include "compare/harness.h"
#include "scenes/error.h"

namespace arealab {
namespace {

TEST(Timing, BootstrapIntervalHoldsTheMedianAndShrinksWithSpread) {
  const Interval constant = BootstrapMedian({2.0, 2.0, 2.0, 2.0});
  EXPECT_EQ(constant.median, 2.0);
  EXPECT_EQ(constant.low, 2.0);
  EXPECT_EQ(constant.high, 2.0);

  std::vector<double> narrow, wide;
  for (int i = -10; i <= 10; ++i) {
    narrow.push_back(3.0 + 0.01 * i);
    wide.push_back(3.0 + 0.1 * i);
  }
  const Interval a = BootstrapMedian(narrow), b = BootstrapMedian(wide);
  EXPECT_DOUBLE_EQ(a.median, 3.0);
  EXPECT_LT(a.low, 3.0);
  EXPECT_GT(a.high, 3.0);
  EXPECT_NEAR((b.high - b.low) / (a.high - a.low), 10.0, 1e-6);  // the same resamples: ten times the spread
}

TEST(Timing, PointIsOneTimesPointAndEveryRatioHasItsInterval) {
  const auto context = CreateContext(ContextKind::kOsmesa);
  const ShaderLibrary library;
  const std::vector<Technique> techniques = LoadTechniques(library);
  Renderer renderer(context->gl(), library);
  renderer.DrawScene(LoadScene(FindScene("gloss")), {64, 64});
  const Variant point = ParseVariant(techniques, "point");
  const auto timings = MeasureTimes(*context, renderer, {point, ParseVariant(techniques, "ltc")}, point, 64 * 64);
  ASSERT_EQ(timings.size(), 2u);
  for (const Timing& timing : timings) {
    EXPECT_GE(timing.rounds, 7);
    EXPECT_GT(timing.ns_per_pixel, 0.0);
    EXPECT_LE(timing.ratio_low, timing.ratio_to_point);
    EXPECT_GE(timing.ratio_high, timing.ratio_to_point);
  }
  EXPECT_LE(timings[0].ratio_low, 1.5);   // only that it is the same draw: noise is the machine's, not asserted
  EXPECT_GE(timings[0].ratio_high, 0.67);
}

}  // namespace
}  // namespace arealab
