#include "compare/timing.h"

#include <gtest/gtest.h>

#include "compare/harness.h"
#include "scenes/error.h"

namespace arealab::timing_test {
namespace {

TEST(Timing, BootstrapIntervalHoldsTheMedianAndShrinksWithSpread) {
  const Estimate constant = BootstrapMedian({2.0, 2.0, 2.0, 2.0});
  EXPECT_EQ(constant.value, 2.0);
  EXPECT_EQ(constant.low, 2.0);
  EXPECT_EQ(constant.high, 2.0);

  std::vector<double> narrow, wide;
  for (int i = -10; i <= 10; ++i) {
    narrow.push_back(3.0 + 0.01 * i);
    wide.push_back(3.0 + 0.1 * i);
  }
  const Estimate a = BootstrapMedian(narrow), b = BootstrapMedian(wide);
  EXPECT_DOUBLE_EQ(a.value, 3.0);
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
    EXPECT_GT(timing.ns_per_pixel.value, 0.0);
    EXPECT_LE(timing.ratio_to_point.low, timing.ratio_to_point.value);
    EXPECT_GE(timing.ratio_to_point.high, timing.ratio_to_point.value);
  }
  EXPECT_LE(timings[0].ratio_to_point.low, 1.5);   // only that it is the same draw: noise is the machine's, not asserted
  EXPECT_GE(timings[0].ratio_to_point.high, 0.67);
}

// Seconds of the pass-through, of point, and of a variant.
TEST(Timing, NetRatioTakesThePassThroughOff) {
  std::vector<std::vector<double>> rounds;
  for (int i = 0; i < 20; ++i) {
    const double drift = 1.0 + 0.01 * (i % 5);
    rounds.push_back({1e-3 * drift, 3e-3 * drift, 7e-3 * drift});
  }
  const Timing timing = TimingsOfRounds(rounds, 1000).at(0);
  EXPECT_NEAR(timing.ratio_to_point.value, 7.0 / 3.0, 1e-12);
  EXPECT_NEAR(timing.net_ratio_to_point.value, 3.0, 1e-12);
  EXPECT_NEAR(timing.ns_per_pixel.value, 7000.0 * 1.02, 1e-9);
  EXPECT_NEAR(timing.net_ns_per_pixel.value, 6000.0 * 1.02, 1e-9);
  EXPECT_LT(timing.ns_per_pixel.low, timing.ns_per_pixel.high);
  EXPECT_EQ(timing.refusal, "");
  EXPECT_EQ(timing.rounds, 20);
}

TEST(Timing, NetRatioIsRefusedWherePointIsLostInItsSpread) {
  std::vector<std::vector<double>> rounds;
  for (int i = 0; i < 20; ++i) rounds.push_back({1.0, 1.1 + 0.1 * (i % 2 == 0 ? 1 : -1), 3.0});
  const Timing timing = TimingsOfRounds(rounds, 1).at(0);
  EXPECT_FALSE(std::isfinite(timing.net_ratio_to_point.value));
  EXPECT_NE(timing.refusal.find("within 3 times its spread"), std::string::npos) << timing.refusal;
  EXPECT_TRUE(std::isfinite(timing.ratio_to_point.value));  // the plain ratio needs no such care
}

}  // namespace
}  // namespace arealab::timing_test
