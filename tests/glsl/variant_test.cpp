#include "glsl/variant.h"

#include <gmock/gmock.h>

#include <functional>
#include <set>

#include "scenes/error.h"
#include "scenes/shapes.h"

namespace arealab::variant_test {
namespace {

using testing::ElementsAre;

Option MakeOption(const std::string& name, const std::vector<std::string>& choices) {
  Option option{name, "", {}};
  for (const std::string& choice : choices) option.choices.push_back({choice, ""});
  return option;
}

// "ltc" with two options and a published form of its own, "plain" with none, "same" published as it is.
const std::vector<Technique>& Techniques() {
  static const std::vector<Technique> techniques = [] {
    Technique ltc;
    ltc.name = "ltc";
    ltc.shapes = {LightShape::kRectangle};
    ltc.effects = {"fresnel"};
    ltc.options = {MakeOption("edge", {"half", "acos"}), MakeOption("clip", {"arc", "switch", "none"})};
    ltc.published = {{"edge", "acos"}, {"clip", "switch"}};
    Technique plain;
    plain.name = "plain";
    plain.shapes = {LightShape::kRectangle, LightShape::kDisk, LightShape::kSphere};
    plain.effects = {"two_sided"};
    Technique same;
    same.name = "same";
    same.shapes = {LightShape::kDisk, LightShape::kSphere};
    same.options = {MakeOption("way", {"up", "down"})};
    same.published = {{"way", "up"}};
    for (Technique* technique : {&ltc, &plain, &same}) technique->brdfs = {"ggx"};
    return std::vector<Technique>{ltc, plain, same};
  }();
  return techniques;
}

Variant Parse(const std::string& name) {
  return ParseVariant(Techniques(), name);
}

std::string ErrorOf(const std::string& name) {
  try {
    Parse(name);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

std::vector<std::string> NamesOf(const std::vector<Variant>& variants,
                                 const std::function<std::string(const Variant&)>& name) {
  std::vector<std::string> names;
  for (const Variant& variant : variants) names.push_back(name(variant));
  return names;
}

TEST(Variant, CanonicalNamesLeaveDefaultsOutAndKeepTheHeadersOrder) {
  EXPECT_EQ(Parse("ltc").Name(), "ltc");
  EXPECT_EQ(Parse("ltc+clip=switch").Name(), "ltc+clip=switch");
  EXPECT_EQ(Parse("ltc+clip=switch+edge=acos").Name(), "ltc+edge=acos+clip=switch");
  EXPECT_EQ(Parse("ltc+clip=arc+edge=half").Name(), "ltc");
  EXPECT_EQ(Parse("plain").Name(), "plain");
}

TEST(Variant, PublishedFormIsShortForItsOptions) {
  EXPECT_EQ(Parse("ltc@published").Name(), "ltc+edge=acos+clip=switch");
  EXPECT_EQ(Parse("ltc@published").ShortName(), "ltc@published");
  EXPECT_EQ(Parse("ltc+clip=switch+edge=acos").ShortName(), "ltc@published");
  EXPECT_EQ(Parse("ltc@published+edge=half").Name(), "ltc+clip=switch");
  EXPECT_EQ(Parse("ltc@published+edge=half").ShortName(), "ltc+clip=switch");
  EXPECT_EQ(Parse("ltc").ShortName(), "ltc");
}

TEST(Variant, PublishedFormThatIsTheDefaultHasNoNameOfItsOwn) {
  EXPECT_EQ(Parse("same@published").ShortName(), "same");
  EXPECT_EQ(Parse("plain@published").ShortName(), "plain");
  EXPECT_EQ(Parse("same@published"), DefaultVariant(Techniques()[2]));
}

TEST(Variant, EveryNameIsReadBackAsItself) {
  for (const Variant& variant : AllVariants(Techniques())) {
    EXPECT_EQ(Parse(variant.Name()), variant) << variant.Name();
    EXPECT_EQ(Parse(variant.ShortName()), variant) << variant.ShortName();
  }
}

TEST(Variant, AllVariantsChangeOneOptionOfDefaultOrPublishedForm) {
  EXPECT_THAT(
      NamesOf(AllVariants(Techniques()), &Variant::Name),
      ElementsAre("ltc", "ltc+edge=acos", "ltc+clip=switch", "ltc+clip=none", "ltc+edge=acos+clip=switch",
                  "ltc+edge=acos+clip=none", "plain", "same", "same+way=down"));
}

TEST(Variant, ChoicesThatDoNotGoTogetherAreRefused) {
  std::vector<Technique> techniques = Techniques();
  techniques[0].options[0].choices[1].needs = {{"clip", "switch"}};  // acos
  try {
    ParseVariant(techniques, "ltc+edge=acos");
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "variant \"ltc+edge=acos\": edge=acos does not go with clip=arc; expected +clip=switch");
  }
  EXPECT_EQ(ParseVariant(techniques, "ltc+clip=switch+edge=acos").ShortName(), "ltc@published");
  EXPECT_THAT(NamesOf(AllVariants(techniques), &Variant::Name),
              ElementsAre("ltc", "ltc+clip=switch", "ltc+clip=none", "ltc+edge=acos+clip=switch", "plain",
                          "same", "same+way=down"));
}

TEST(Variant, DefaultVariantsShowAPublishedFormWhereItDiffers) {
  EXPECT_THAT(NamesOf(DefaultVariants(Techniques()), &Variant::ShortName),
              ElementsAre("ltc", "ltc@published", "plain", "same"));
}

TEST(Variant, WrongNamesAreRefusedWithWhatExists) {
  EXPECT_EQ(ErrorOf("ltd"),
            "variant \"ltd\": unknown technique \"ltd\"; expected ltc, plain, same (did you mean \"ltc\"?)");
  EXPECT_EQ(ErrorOf("wholly_other"),
            "variant \"wholly_other\": unknown technique \"wholly_other\"; expected ltc, plain, same");
  EXPECT_EQ(ErrorOf(""), "variant \"\": unknown technique \"\"; expected ltc, plain, same");
  EXPECT_EQ(ErrorOf("ltc@author"), "variant \"ltc@author\": unknown form \"@author\"; expected @published");
  EXPECT_EQ(
      ErrorOf("ltc+clipp=arc"),
      "variant \"ltc+clipp=arc\": unknown option \"clipp\"; expected edge, clip (did you mean \"clip\"?)");
  EXPECT_EQ(ErrorOf("plain+clip=arc"),
            "variant \"plain+clip=arc\": unknown option \"clip\"; expected none, plain has no options");
  EXPECT_EQ(ErrorOf("ltc+clip=swich"),
            "variant \"ltc+clip=swich\": unknown choice \"swich\" of option clip; expected arc, switch, none "
            "(did you mean \"switch\"?)");
  EXPECT_EQ(ErrorOf("ltc+clip"), "variant \"ltc+clip\": \"+clip\" chooses nothing; expected +OPTION=CHOICE");
  EXPECT_EQ(ErrorOf("ltc+"), "variant \"ltc+\": \"+\" chooses nothing; expected +OPTION=CHOICE");
  EXPECT_EQ(ErrorOf("ltc+clip=arc+clip=none"),
            "variant \"ltc+clip=arc+clip=none\": option clip is given twice; expected once");
  EXPECT_EQ(ErrorOf("ltc+clip=arc@published"),
            "variant \"ltc+clip=arc@published\": \"@published\" is out of place; expected "
            "TECHNIQUE[@published][+OPTION=CHOICE]…");
}

TEST(Variant, EffectsAreForcedByName) {
  const Variant variant = Parse("same+effect_horizon=1+effect_disk=0");
  EXPECT_EQ(variant.effects, (std::map<std::string, bool>{{"disk", false}, {"horizon", true}}));
  EXPECT_EQ(variant.Name(), "same+effect_disk=0+effect_horizon=1");
  EXPECT_EQ(Parse(variant.Name()), variant);
  const Variant all = Parse("same+effects=all");
  EXPECT_EQ(all.Name(), "same+effects=all");
  EXPECT_EQ(all.effects.count("rectangle"), 0u);  // it does disks and spheres
  EXPECT_TRUE(all.effects.at("sphere"));
  EXPECT_NE(all, Parse("same"));
  EXPECT_THAT(ErrorOf("same+effect_horizom=1"), testing::HasSubstr("unknown effect \"horizom\""));
  EXPECT_EQ(ErrorOf("same+effect_horizon=2"), "variant \"same+effect_horizon=2\": effect_horizon=2; expected 0 or 1");
  EXPECT_EQ(ErrorOf("same+effects=none"), "variant \"same+effects=none\": effects=none; expected effects=all");
}

// Lights a perfect mirror, which has no Fresnel term and lies behind the lights.
Scene SceneWith(LightShape shape, const std::string& name) {
  Scene scene;
  scene.meshes.push_back(MakePlane({2.0, 2.0}, {{0.0, 0.0, -1.0}}));
  scene.materials.resize(1);
  scene.materials[0].base_color = glm::vec3(1.0f);
  scene.materials[0].metalness = 1.0f;
  scene.lights.resize(2);
  scene.lights[0].shape = LightShape::kRectangle;
  scene.lights[1].shape = shape;
  scene.lights[1].name = name;
  return scene;
}

TEST(Variant, UnsupportedShapesAreNamedInASentence) {
  EXPECT_EQ(WhyUnsupported(Parse("ltc"), SceneWith(LightShape::kRectangle, "lamp")), std::nullopt);
  EXPECT_EQ(WhyUnsupported(Parse("ltc"), SceneWith(LightShape::kSphere, "lamp")),
            "ltc shades rectangles; light \"lamp\" is a sphere");
  EXPECT_EQ(WhyUnsupported(Parse("ltc"), SceneWith(LightShape::kDisk, "")),
            "ltc shades rectangles; light 2 is a disk");
  EXPECT_EQ(WhyUnsupported(Parse("same"), SceneWith(LightShape::kDisk, "")),
            "same shades disks and spheres; light 1 is a rectangle");
  EXPECT_EQ(WhyUnsupported(Parse("plain"), SceneWith(LightShape::kSphere, "lamp")), std::nullopt);
}

TEST(Variant, ChoicesForOneShapeRefuseOthers) {
  std::vector<Technique> techniques = Techniques();
  Technique& plain = *std::ranges::find(techniques, "plain", &Technique::name);
  plain.options = {{"horizon", "which", {{"lobe", "its own"}, {"true", "both", {{"shape", "rectangle"}}}}}};
  const Variant both = ParseVariant(techniques, "plain+horizon=true");
  EXPECT_EQ(WhyInconsistent(both), std::nullopt);
  EXPECT_EQ(WhyUnsupported(both, SceneWith(LightShape::kRectangle, "lamp")), std::nullopt);
  EXPECT_EQ(WhyUnsupported(both, SceneWith(LightShape::kDisk, "lamp")),
            "plain with horizon=true goes with rectangles alone; the scene has a disk");
  EXPECT_EQ(WhyUnsupported(DefaultVariant(plain), SceneWith(LightShape::kDisk, "lamp")), std::nullopt);
}

TEST(Variant, UnsupportedEffectsAreNamedInASentence) {
  Scene scene = SceneWith(LightShape::kRectangle, "lamp");
  scene.lights[0].two_sided = true;
  EXPECT_EQ(WhyUnsupported(Parse("ltc"), scene), "ltc does not take two-sided lights; the scene has one");
  EXPECT_EQ(WhyUnsupported(Parse("plain"), scene), std::nullopt);
  scene.lights.erase(scene.lights.begin());
  scene.materials[0].base_color = glm::vec3(0.5f);
  EXPECT_EQ(WhyUnsupported(Parse("ltc"), scene), std::nullopt);
  EXPECT_EQ(WhyUnsupported(Parse("plain"), scene),
            "plain does not take a Fresnel term; the scene's materials reflect less than all light");
}

TEST(Variant, UnsupportedBrdfsAreNamedInASentence) {
  Scene scene = SceneWith(LightShape::kRectangle, "lamp");
  scene.brdf = Brdf::kWard;
  EXPECT_EQ(WhyUnsupported(Parse("ltc"), scene),
            "ltc does not know the BRDF ward, which is the scene's; it knows ggx");
  std::vector<Technique> techniques = Techniques();
  techniques[0].brdfs = {"ggx", "ward"};
  techniques[0].options[0].choices[1].needs = {{"brdf", "ggx"}};
  Variant variant = DefaultVariant(techniques[0]);
  EXPECT_EQ(WhyUnsupported(variant, scene), std::nullopt);
  const Option& option = techniques[0].options[0];
  variant.options[option.name] = option.choices[1].name;
  EXPECT_EQ(WhyInconsistent(variant), std::nullopt);  // it is the scene's matter
  EXPECT_EQ(WhyUnsupported(variant, scene), "ltc with " + option.name + "=" + option.choices[1].name +
                                                " goes with the BRDF ggx alone; the scene's is ward");
  scene.brdf = Brdf::kGgx;
  EXPECT_EQ(WhyUnsupported(variant, scene), std::nullopt);

  scene.diffuse = Brdf::kDisney;
  EXPECT_EQ(WhyUnsupported(Parse("ltc"), scene), "ltc does not know the diffuse BRDF disney, which is the scene's; it knows lambert");
  techniques[0].diffuse_brdfs = {"lambert", "disney"};
  EXPECT_EQ(WhyUnsupported(variant, scene), std::nullopt);
  techniques[0].options[0].choices[1].needs = {{"diffuse", "lambert"}};
  EXPECT_EQ(WhyUnsupported(variant, scene), "ltc with " + option.name + "=" + option.choices[1].name +
                                                " goes with the diffuse BRDF lambert alone; the scene's is disney");
  variant.options[option.name] = option.choices[0].name;
  EXPECT_EQ(WhyUnsupported(variant, scene), std::nullopt);
  scene.sky = glm::dvec3(1.0);
  EXPECT_EQ(WhyUnsupported(variant, scene), "the diffuse BRDF disney reflects no sky here");
}

// A table of the diffuse BRDF is read where it is not Lambert's alone.
// norm=none is fitted for ggx above lambert alone.
TEST(Variant, IdealsGoWithTheBrdfs) {
  const ShaderLibrary library;
  const std::vector<Technique> techniques = LoadTechniques(library);
  const Variant published = ParseVariant(techniques, "ltc@published");
  EXPECT_EQ(IdealVariant(published).options.at("norm"), "none");
  EXPECT_EQ(IdealVariant(published, {Brdf::kWard}).options.at("norm"), "middle");
  EXPECT_EQ(IdealVariant(published, {Brdf::kGgx, Brdf::kDisney}).options.at("norm"), "middle");
}

TEST(Variant, TablesOfTheDiffuseBrdf) {
  std::vector<Technique> techniques = Techniques();
  techniques[0].tables = {{"lobe", "lobe_{brdf}.exr"}, {"matte", "matte_{diffuse}.exr"}};
  const Variant variant = DefaultVariant(techniques[0]);
  EXPECT_EQ(TablesOf(variant, Brdf::kWard).size(), 1u);
  const Brdfs brdfs(Brdf::kGgx, Brdf::kDisney);
  const std::vector<Table> tables = TablesOf(variant, brdfs);
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(TableFile(variant, tables[1], brdfs), "tables/matte_disney.exr");
}

}  // namespace
}  // namespace arealab::variant_test
