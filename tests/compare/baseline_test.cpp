#include "compare/baseline.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/error.h"
#include "tests/compare/synthetic_results.h"
#include "tests/glsl/temporary_folder.h"

namespace arealab::baseline_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

Results Sample() {
  return synthetic::MakeResults({synthetic::MakeScene("gloss", "?", {}, {32, 24, 4}, false)});
}

VariantResult& Named(Results& results, const std::string& short_name) {
  for (VariantResult& variant : results.scenes[0].variants) {
    if (variant.short_name == short_name) return variant;
  }
  throw std::logic_error(short_name);
}

class BaselineTest : public testing::Test {
 protected:
  BaselineReport Against(const Results& now) const {
    return CompareWithBaseline(now, Baseline(folder_.Write("results.json", ResultsJson(Sample()))));
  }
  TemporaryFolder folder_;
};

TEST_F(BaselineTest, TheSameResultsAreNoWorse) {
  const BaselineReport report = Against(Sample());
  EXPECT_THAT(report.worse, IsEmpty());
  EXPECT_THAT(report.notes, IsEmpty());
  EXPECT_GT(report.compared, 50);
}

TEST_F(BaselineTest, WhatIsWithinTheNoiseIsNoNews) {
  Results now = Sample();
  Named(now, "ltc").total.rel_rmse += 1.5 * now.scenes[0].truth_relative_error;
  Estimate& ratio = Named(now, "hill").time.ratio_to_point;
  ratio = {1.06 * ratio.value, 1.03 * ratio.value, 1.09 * ratio.value};
  Named(now, "oat").isa.at("bonaire").core.cycles -= 1;
  EXPECT_THAT(Against(now).worse, IsEmpty());
}

TEST_F(BaselineTest, WhatIsWorseIsNamedWithBothFigures) {
  Results now = Sample();
  Named(now, "ltc").specular.rel_rmse *= 1.2;
  Estimate& ratio = Named(now, "hill").time.ratio_to_point;
  ratio = {1.1 * ratio.value, 1.05 * ratio.value, 1.15 * ratio.value};
  Named(now, "oat").isa.at("bonaire").core.cycles += 1;
  Named(now, "drobot").total.rel_rmse = kNotMeasured;  // no longer a number
  EXPECT_THAT(Against(now).worse,
              ElementsAre(HasSubstr("drobot: total error"), HasSubstr("oat: bonaire core 560 → 561 cycles"), HasSubstr("hill: 3.20 × point"),
                          HasSubstr("ltc: specular error")));
}

TEST_F(BaselineTest, OtherCompilersOrScenesAreNotCompared) {
  Results now = Sample();
  now.compilers = "radv Mesa 99";
  Named(now, "oat").isa.at("bonaire").core.cycles += 100;
  now.scenes.push_back(now.scenes[0]);
  now.scenes.back().name = "new";
  const BaselineReport report = Against(now);
  EXPECT_THAT(report.worse, IsEmpty());
  EXPECT_THAT(report.notes, ElementsAre("new: not in the baseline", HasSubstr("cycles are not compared")));
}

TEST_F(BaselineTest, AFileThatIsNoneAndAnotherSizeAreRefused) {
  const auto against = [&](const std::string& text) { CompareWithBaseline(Sample(), Baseline(folder_.Write("a.json", text))); };
  const std::string expected = "expected a results.json", scenes = "{\"schema\": 1, \"scenes\": ";
  for (const std::string& text : {std::string("{}"), std::string("[1]"), std::string("{\n\n,"), scenes + "1}", scenes + "[1]}", scenes + "[1e999]}",
                                  scenes + std::string(100000, '[')}) {
    EXPECT_THAT([&] { against(text); }, ThrowsMessage<InputError>(HasSubstr(expected))) << text.substr(0, 50);
  }
  EXPECT_THAT([&] { against("{\n\n,"); }, ThrowsMessage<InputError>(HasSubstr("a.json:3: not JSON")));
  std::string interval = ResultsJson(Sample());
  const std::size_t at = interval.find("\"ratio_interval\": [") + std::string("\"ratio_interval\": [").size();
  interval.erase(at, interval.find(']', at) - at);
  against(interval);  // an interval of no numbers is none
  Results now = Sample();
  now.scenes[0].width = 64;
  EXPECT_THAT([&] { Against(now); }, ThrowsMessage<InputError>(HasSubstr("expected --size 32x24")));
}

}  // namespace
}  // namespace arealab::baseline_test
