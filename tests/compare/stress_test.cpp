// The hard cases: their generators, and that the checks have teeth. The full runs are `arealab stress` and
// `arealab stress
// --mutants`.
#include "compare/stress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "compare/stress_mutants.h"
#include "scenes/error.h"

namespace arealab::stress_test {
namespace {

const StressFamily& Family(const std::string& name) {
  const auto& families = StressFamilies();
  return *std::ranges::find_if(families, [&](const StressFamily& family) { return family.name == name; });
}

TEST(StressCases, AreALineAndBack) {
  for (const StressFamily& family : StressFamilies()) {
    for (const LightShape shape : family.shapes) {
      for (const PointCase& c : MakeCases(family, shape, 50, 3)) {
        const PointCase back = ParseCase(CaseLine(c));
        EXPECT_EQ(CaseLine(back), CaseLine(c)) << family.name;
        EXPECT_EQ(back.center, c.center);
        EXPECT_EQ(back.roughness, c.roughness);
      }
    }
  }
}

TEST(StressCases, WhatIsNoLineIsOneSentence) {
  for (const auto& [line, what] :
       {std::pair{"shape=cube", "expected rectangle, disk, sphere, ellipse, polygon or tube"},
        std::pair{"center=1,2", "expected 3 finite numbers with commas between"},
        std::pair{"roughness=nan", "expected 1 finite number with commas between"},
        std::pair{"shape=polygon corners=0,0,1,0", "expected 6 to 16 finite numbers with commas between"},
        std::pair{"shape=polygon", "expected both or neither"}, std::pair{"corners=0,0,1,0,0,1", "expected both or neither"},
        std::pair{"shape=polygon corners=0,0,1,0,0,1,2", "expected pairs x,y"},
        std::pair{"colour=1", "unknown colour"}, std::pair{"nothing", "expected NAME=VALUE"}}) {
    try {
      ParseCase(line);
      FAIL() << line;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(what));
    }
  }
}

TEST(StressCases, AreTheSameForASeedAndTheFirstOfMore) {
  const StressFamily& family = Family("contact");
  const auto few = MakeCases(family, LightShape::kDisk, 10, 1),
             many = MakeCases(family, LightShape::kDisk, 5000, 1),
             other = MakeCases(family, LightShape::kDisk, 10, 2);
  for (std::size_t i = 0; i < few.size(); ++i) {
    EXPECT_EQ(CaseLine(few[i]), CaseLine(many[i]));
    EXPECT_NE(CaseLine(few[i]), CaseLine(other[i]));
  }
}

// What the sentences say, on the cases.
TEST(StressCases, AreWhatTheirFamilySays) {
  const auto share = [](const char* name, LightShape shape, auto&& holds) {
    const auto cases = MakeCases(Family(name), shape, 2000, 1);
    return static_cast<double>(std::ranges::count_if(cases, holds)) / static_cast<double>(cases.size());
  };
  const auto height = [](const PointCase& c) { return glm::dot(c.position - c.center, c.light_normal); };
  constexpr LightShape kRectangle = LightShape::kRectangle;
  EXPECT_EQ(share("on_plane", kRectangle, [&](const PointCase& c) { return std::abs(height(c)) < 1e-3; }),
            1.0);
  // Every set of corners above the horizon that a convex quadrilateral has.
  std::array<int, 16> corners{};
  for (const PointCase& c : MakeCases(Family("crossing"), kRectangle, 4000, 1)) {
    unsigned above = 0;
    for (unsigned i = 0; i < 4; ++i) {
      const glm::dvec3 corner = c.center - c.position + c.axis_x * (i % 2 ? c.half_size.x : -c.half_size.x) +
                                c.axis_y * (i / 2 ? c.half_size.y : -c.half_size.y);
      above |= (glm::dot(corner, c.normal) > 0.0 ? 1u : 0u) << i;
    }
    ++corners[above];
  }
  for (unsigned above = 0; above < 16; ++above) {
    const bool opposite = above == 6 || above == 9;
    if (opposite || above == 0 || above == 15) continue;
    EXPECT_GT(corners[above], 50) << above;
  }
  EXPECT_GT(share("inside_sphere", LightShape::kSphere,
                  [](const PointCase& c) { return glm::length(c.center - c.position) < c.half_size.x; }),
            0.5);
  EXPECT_EQ(
      share("view_below", kRectangle, [](const PointCase& c) { return glm::dot(c.normal, c.to_view) < 0.0; }),
      1.0);
  // Polygons are convex, counter-clockwise, about their centroid; thin ones too, and ellipses.
  EXPECT_EQ(share("ordinary", LightShape::kPolygon,
                  [](const PointCase& c) {
                    Light again = c.Light();
                    SetCorners(again, c.corners);
                    return !WhyNoPolygon(c.corners) && glm::length(again.corners[1] - c.corners[1]) < 1e-6 && glm::length(again.center - c.center) < 1e-6;
                  }),
            1.0);
  for (const LightShape shape : {kRectangle, LightShape::kEllipse, LightShape::kPolygon}) {
    EXPECT_EQ(share("thin", shape, [](const PointCase& c) { return std::min(c.half_size.x, c.half_size.y) < 4e-3 * std::max(c.half_size.x, c.half_size.y); }), 1.0);
  }
  EXPECT_GT(share("offset", kRectangle, [](const PointCase& c) { return glm::length(c.position) > 9.9e5; }),
            0.99);
}

class Stressed : public testing::Test {
 protected:
  static void SetUpTestSuite() { context_ = CreateContext(ContextKind::kOsmesa); }
  static void TearDownTestSuite() { context_.reset(); }

  static VariantStress Run(const std::string& name, std::optional<LightShape> shape, std::int64_t cases, bool fp16 = false, Brdfs brdfs = {}) {
    static const ShaderLibrary library;
    static const std::vector<Technique> techniques = LoadTechniques(library);
    StressOptions options;
    options.variants = {ParseVariant(techniques, name)};
    options.judged = {true};
    options.shape = shape;
    options.cases = cases;
    options.fp16 = fp16;
    options.brdfs = brdfs;
    return Stress(*context_, library, options).variants[0];
  }

  static double Bend(const VariantStress& variant, const std::string& path, const std::string& lobe) {
    const auto found = std::ranges::find_if(
        variant.paths, [&](const PathResult& p) { return p.path->name == path && p.lobe == lobe; });
    return found->bend;
  }

  static const FamilyResult& Of(const VariantStress& variant, const std::string& family) {
    return *std::ranges::find_if(variant.families,
                                 [&](const FamilyResult& f) { return f.family->name == family; });
  }

  inline static std::unique_ptr<Context> context_;
};

// Each where its source says, and the default form beside it passes. (All default forms: `arealab check`.) Measured: see below.
TEST_F(Stressed, BrokenFormsFailWhereTheirSourcesSay) {
  const auto fails = [](const VariantStress& variant, const std::string& path) {
    return std::ranges::any_of(variant.paths, [&](const PathResult& p) { return p.path->name == path && !p.failures.empty(); });
  };
  const VariantStress ltc = Run("ltc", LightShape::kRectangle, 3000);
  for (const FamilyResult& family : ltc.families) EXPECT_THAT(family.failures, testing::IsEmpty()) << family.family->name;
  for (const PathResult& path : ltc.paths) EXPECT_THAT(path.failures, testing::IsEmpty()) << path.path->name;
  // The arc cosine of GPUs rings under a bright light: 2.2e-2 of the value, across a floor; the rational fit 1.6e-4, ltc 9e-5.
  const VariantStress fast = Run("ltc@published+edge=fast_acos", LightShape::kRectangle, 300);
  EXPECT_GT(Bend(fast, "floor", "diffuse"), 0.015);
  EXPECT_TRUE(fails(fast, "floor"));
  // The matrix over its last element bands at grazing angles: 0.045; undivided 0.011, ltc 4e-5.
  const VariantStress last = Run("ltc@published+norm=last", LightShape::kRectangle, 300);
  EXPECT_GT(Bend(last, "grazing", "specular"), 0.03);
  EXPECT_TRUE(fails(last, "grazing"));
  // Without a clip what is below the horizon darkens: by as much as is there.
  const VariantStress none = Run("ltc+clip=none", LightShape::kRectangle, 3000);
  EXPECT_GT(Of(none, "crossing").approximation, 0.1);
  EXPECT_THAT(Of(none, "crossing").failures, testing::Not(testing::IsEmpty()));
  // The published clamp fails near the light's plane, in double as well.
  const VariantStress published = Run("ltc+clip=switch+edge=rational", LightShape::kRectangle, 3000);
  EXPECT_GT(Of(published, "contact").approximation, 1e-3);
  EXPECT_THAT(Of(published, "contact").failures, testing::Not(testing::IsEmpty()));
}

// The published form's ideal is another one there. (240 000 cases of each technique: README.)
TEST_F(Stressed, DisneysLobeIsAsSteady) {
  const Brdfs disney(Brdf::kGgx, Brdf::kDisney);
  const VariantStress ltc = Run("ltc", LightShape::kRectangle, 3000, false, disney);
  for (const FamilyResult& family : ltc.families) EXPECT_THAT(family.failures, testing::IsEmpty()) << family.family->name;
  for (const PathResult& path : ltc.paths) EXPECT_THAT(path.failures, testing::IsEmpty()) << path.path->name;
  EXPECT_GT(Of(ltc, "ordinary").p999, 0.0);
  EXPECT_THAT(Run("ltc@published", LightShape::kRectangle, 300, false, disney).ideal, testing::Not(testing::HasSubstr("norm=none")));
  EXPECT_THAT(Run("oat", LightShape::kRectangle, 300, false, disney).families, testing::IsEmpty());
}

// Told, not judged: which cases half floats hold, and what they make of them.
TEST_F(Stressed, HalfFloatsAreToldByFamily) {
  const VariantStress point = Run("point", LightShape::kRectangle, 2400, true);
  const FamilyResult& ordinary = Of(point, "ordinary");
  EXPECT_EQ(ordinary.fp16_cases, ordinary.cases);
  EXPECT_EQ(ordinary.fp16_nonfinite, 0);
  EXPECT_GT(ordinary.fp16_median, 1e-5);  // half a step is 2.4e-4 of the value, less of what the light gives at most
  EXPECT_LT(ordinary.fp16_p999, 0.05);
  EXPECT_EQ(Of(point, "offset").fp16_cases, 0);  // 1e6 m is infinite
  EXPECT_THAT(Of(point, "offset").failures, testing::IsEmpty());
  EXPECT_EQ(Run("point", LightShape::kRectangle, 300).fp16_cases(), 0);  // where it is not asked for
}

TEST(StressCases, AsHalvesAreTheSameLightOrNone) {
  PointCase c;
  c.center = {0.1, 0.0, 2.0};
  const auto half = c.AsHalves();
  ASSERT_TRUE(half);
  EXPECT_EQ(half->center.x, 0.0999755859375);
  c.radiance = 1e-30;
  EXPECT_FALSE(c.AsHalves());
  c.radiance = 1.0;
  c.half_size = {0.5, 1e-6};
  EXPECT_FALSE(c.AsHalves());
  c.half_size = {0.5, 0.5};
  c.position.x = c.center.x = 70000.0;
  EXPECT_FALSE(c.AsHalves());
}

TEST(StressMutants, AreThereExactlyOnce) {
  EXPECT_GE(Mutants().size(), 20u);
  const ShaderLibrary library;
  for (const Mutant& mutant : Mutants()) {
    const std::optional<std::string> text = library.Find(mutant.file);
    ASSERT_TRUE(text) << mutant.file;
    const auto at = text->find(mutant.text);
    ASSERT_NE(at, std::string::npos) << mutant.file << ": " << mutant.text;
    EXPECT_EQ(text->find(mutant.text, at + 1), std::string::npos) << mutant.text;
  }
}

}  // namespace
}  // namespace arealab::stress_test
