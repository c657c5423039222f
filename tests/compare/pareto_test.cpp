#include "compare/pareto.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/compare/synthetic_results.h"

namespace arealab::pareto_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

SceneResult SceneOf(const std::string& name, const std::vector<std::tuple<std::string, double, int>>& variants) {
  SceneResult scene;
  scene.name = name;
  scene.truth_relative_error = 1e-4;
  for (const auto& [variant, error, cycles] : variants) {
    VariantResult& result = scene.variants.emplace_back();
    result.name = result.short_name = variant;
    result.supported = cycles > 0;
    result.total.rel_rmse = error;
    if (cycles > 0) result.isa["bonaire"].core.cycles = cycles;
  }
  return scene;
}

TEST(Pareto, FrontierIsWhatNothingBeatsInBoth) {
  const std::vector<ParetoMark> marks = {{"dear", 9.0, 0.1, {}}, {"beaten", 5.0, 0.6, {}}, {"cheap", 1.0, 0.9, {}},
                                         {"good", 4.0, 0.2, {}}, {"equal", 4.0, 0.3, {}}};
  EXPECT_THAT(Frontier(marks), ElementsAre(2, 3, 0));
  EXPECT_THAT(Frontier({}), ElementsAre());
}

TEST(Pareto, SeveralScenesAreGeometricMeansOverThoseThatAllShade) {
  const std::vector<SceneResult> scenes = {SceneOf("a", {{"ltc", 0.02, 2000}, {"point", 0.5, 400}, {"karis", 0.0, 0}}),
                                           SceneOf("b", {{"ltc", 0.08, 8000}, {"point", 2.0, 400}, {"karis", 0.1, 300}}),
                                           SceneOf("c", {{"ltc", 0.3, 1}, {"point", 0.0, 0}, {"karis", 0.0, 0}})};
  const ParetoPlot plot = MakeParetoPlot(scenes, true);
  ASSERT_EQ(plot.marks.size(), 2u) << "karis shades fewer than half";
  EXPECT_EQ(plot.marks[0].name, "ltc");
  EXPECT_NEAR(plot.marks[0].error, 0.04, 1e-12);
  EXPECT_NEAR(plot.marks[0].cost, 4000.0, 1e-9);
  EXPECT_NEAR(plot.marks[1].error, 1.0, 1e-12);
  EXPECT_THAT(plot.title, testing::AllOf(HasSubstr("a, b"), Not(HasSubstr("c,"))));
  EXPECT_THAT(plot.cost_title, HasSubstr("estimated"));
  EXPECT_TRUE(MakeParetoPlot(std::vector<SceneResult>{SceneOf("d", {{"ltc", 0.1, 0}})}, true).marks.empty());
}

TEST(Pareto, TheMeasuredTimeIsTheCostWhereThereIsOne) {
  std::vector<SceneResult> scenes = {SceneOf("a", {{"ltc", 0.02, 2000}, {"point", 5e-5, 400}})};
  scenes[0].variants[0].time.ratio_to_point = {3.0, 2.8, 3.3};
  scenes[0].variants[1].time.ratio_to_point = {1.0, 0.9, 1.1};
  scenes[0].variants[1].within_truth_error = true;
  const ParetoPlot plot = MakeParetoPlot(scenes, true);
  EXPECT_NEAR(plot.marks.at(0).cost, 3.0, 1e-12);
  EXPECT_NEAR(plot.marks.at(0).interval.high, 3.3, 1e-12);
  EXPECT_NEAR(plot.marks.at(1).error, 1e-4, 1e-15) << "what is within truth's error stands at it";
  EXPECT_THAT(plot.cost_title, HasSubstr("not a GPU"));
}

TEST(Pareto, ThePictureNamesEveryMarkAndEscapesIt) {
  const auto scene = synthetic::MakeScene("gloss", "?", {}, {32, 24, 4}, false);
  ParetoPlot plot = MakeParetoPlot(std::vector{scene}, true);
  plot.marks[0].name = "a<b>&c";
  const std::string svg = ParetoSvg(plot);
  EXPECT_THAT(svg, HasSubstr("a&lt;b&gt;&amp;c"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  std::size_t circles = 0;
  for (std::size_t at = 0; (at = svg.find("<circle", at)) != std::string::npos; ++at) ++circles;
  EXPECT_EQ(circles, plot.marks.size());
  for (std::size_t i = 1; i < plot.marks.size(); ++i) EXPECT_THAT(svg, HasSubstr(">" + plot.marks[i].name + "</text>"));
}

}  // namespace
}  // namespace arealab::pareto_test
