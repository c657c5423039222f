// What every technique's header says of the laws is so: one list over all techniques, forms, shapes, lobes and BRDFs, generated
// from the headers. A new technique, option, shape or claim is in it by being there.
#include <gmock/gmock.h>

#include "tests/compare/law_check.h"

namespace arealab::laws_test {
namespace {

std::vector<Technique> AllTechniques() { return LoadTechniques(ShaderLibrary()); }

class TechniqueLaws : public testing::TestWithParam<Technique> {
 protected:
  static void SetUpTestSuite() { check_ = std::make_unique<LawCheck>(); }
  static void TearDownTestSuite() { check_.reset(); }
  static std::unique_ptr<LawCheck> check_;  // keeps the truths
};
std::unique_ptr<LawCheck> TechniqueLaws::check_;

TEST_P(TechniqueLaws, TheHeaderSaysSo) {
  const std::vector<LawMeasure> measures = check_->Measure(GetParam());
  if (std::getenv("AREALAB_PRINT_LAWS")) {
    for (const LawMeasure& m : measures)
      fmt::print("{:<14} {:.3g}  {}\n", m.law, m.error, LawCheck::Where(m));
  }
  for (const std::string& complaint : LawCheck::Judge(GetParam(), measures)) ADD_FAILURE() << complaint;
}

// The instrument: what a header says falsely, and what it leaves out, is found.
TEST(TechniqueLawsThemselves, AFalseHeaderFails) {
  std::vector<Technique> techniques = AllTechniques();
  const auto find = [&](const std::string& name) { return *std::ranges::find(techniques, name, &Technique::name); };
  const Technique honest = find("karis");
  const std::vector<LawMeasure> measures = LawCheck().Measure(honest);
  const auto complaints = [&](const Technique& technique) { return LawCheck::Judge(technique, measures); };
  EXPECT_THAT(complaints(honest), testing::IsEmpty());

  Technique boasting = honest;
  boasting.exact.emplace_back("specular_sphere");
  EXPECT_THAT(complaints(boasting), testing::Contains(testing::HasSubstr("specular_sphere is off by")));
  boasting.exact = {"point_limit", "lambert_disk"};  // a shape that it does not do
  EXPECT_THAT(complaints(boasting), testing::ElementsAre("karis: nothing measures lambert_disk"));

  Technique silent = honest;
  silent.departures.clear();
  EXPECT_THAT(complaints(silent), testing::Contains(testing::HasSubstr("neither claims mirror_limit nor departs from it")));
  EXPECT_THAT(complaints(silent), testing::Contains(testing::HasSubstr("scale is off by")));

  for (Departure& departure : boasting.departures) departure.error *= 0.5;
  EXPECT_THAT(complaints(boasting), testing::Contains(testing::HasSubstr("the header says")));
  Technique modest = honest;
  modest.departures.push_back({"radiance", "", {}, 0.5, "none"});
  EXPECT_THAT(complaints(modest), testing::ElementsAre("karis: departs from radiance by 0: that is none"));
}

INSTANTIATE_TEST_SUITE_P(Headers, TechniqueLaws, testing::ValuesIn(AllTechniques()), [](const auto& technique) { return technique.param.name; });

}  // namespace
}  // namespace arealab::laws_test
