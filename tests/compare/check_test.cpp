// The image tests are instruments, so they are tested: each planted defect must fail in its own way.
#include "compare/check.h"

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdlib>
#include <limits>
#include <map>
#include <set>
#include <sstream>

#include "compare/check_page.h"
#include "compare/image_files.h"
#include "scenes/error.h"
#include "scenes/scene.h"
#include "tests/glsl/temporary_folder.h"

namespace arealab::check_test {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

const char* const kScene = "gloss";

std::string ReadText(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::vector<std::string> KindsOf(const CheckResult& result) {
  std::vector<std::string> kinds;
  for (const CheckCase& row : result.cases) {
    for (const CheckFailure& failure : row.failures) kinds.push_back(row.variant + ": " + Name(failure.kind));
  }
  return kinds;
}

std::vector<std::string> ChangesOf(const CheckResult& result) {
  std::vector<std::string> changes;
  for (const CheckCase& row : result.cases)
    changes.insert(changes.end(), row.changes.begin(), row.changes.end());
  return changes;
}

// Goldens of ltc and drobot in one scene, in a folder of the test's own.
class ImageCheck : public testing::Test {
 protected:
  ImageCheck() { Run(true); }

  CheckResult Run(bool update, const ShaderLibrary& library = ShaderLibrary(), bool all_variants = true) {
    CheckOptions options;
    options.scenes = {FindScene(kScene)};
    const std::vector<Technique> techniques = LoadTechniques(library);
    for (const char* name : {"drobot", "ltc"}) options.variants.push_back(ParseVariant(techniques, name));
    options.golden = folder_.path() / "goldens";
    options.all_variants = all_variants;
    options.update = update;
    return Check(*context_, library, options);
  }

  fs::path Golden(const std::string& variant) const {
    return folder_.path() / "goldens" / kScene / (variant + ".exr");
  }

  // The shaders with `statement` run last in the lighting pass.
  ShaderLibrary Mutated(const std::string& statement) const {
    std::string text = *ShaderLibrary().Find("lighting.frag");
    const std::string last = "WriteRadiance(diffuse, specular);";
    const std::size_t at = text.rfind(last);
    EXPECT_NE(at, std::string::npos);
    text.insert(at, statement + "\n  ");
    folder_.Write("glsl/lighting.frag", text);
    return ShaderLibrary(folder_.path() / "glsl");
  }

  TemporaryFolder folder_;
  std::unique_ptr<Context> context_ = CreateContext(ContextKind::kOsmesa);
};

TEST_F(ImageCheck, UnchangedImagesPass) {
  const CheckResult result = Run(false);
  EXPECT_THAT(KindsOf(result), IsEmpty());
  EXPECT_EQ(result.checked, 2);
  for (const CheckCase& row : result.cases) EXPECT_EQ(row.image->width, kCheckSize.x);
}

TEST_F(ImageCheck, AnUpdateOfTheUnchangedWritesNothing) {
  const std::string golden = ReadText(Golden("ltc")), bands = ReadText(folder_.path() / "goldens/bands.json");
  EXPECT_THAT(ChangesOf(Run(true)), IsEmpty());
  EXPECT_EQ(ReadText(Golden("ltc")), golden);
  EXPECT_EQ(ReadText(folder_.path() / "goldens/bands.json"), bands);
}

TEST_F(ImageCheck, SwappedTechniquesFail) {
  fs::rename(Golden("ltc"), Golden("aside"));
  fs::rename(Golden("drobot"), Golden("ltc"));
  fs::rename(Golden("aside"), Golden("drobot"));
  EXPECT_THAT(KindsOf(Run(false)), ElementsAre("drobot: golden", "ltc: golden"));
}

TEST_F(ImageCheck, AMissingGoldenIsItsOwnFailure) {
  fs::remove(Golden("ltc"));
  EXPECT_THAT(KindsOf(Run(false)), ElementsAre("ltc: missing golden"));
}

TEST_F(ImageCheck, AGoldenOfAnotherSizeFails) {
  RadianceImage image = ReadExr(Golden("ltc"));
  image.width /= 2;
  image.height *= 2;
  WriteExr(Golden("ltc"), image);
  EXPECT_THAT(KindsOf(Run(false)), ElementsAre("ltc: size"));
}

TEST_F(ImageCheck, ADamagedGoldenFails) {
  fs::resize_file(Golden("ltc"), fs::file_size(Golden("ltc")) / 2);
  EXPECT_THAT(KindsOf(Run(false)), ElementsAre("ltc: unreadable golden"));
}

TEST_F(ImageCheck, AGoldenWithoutVariantFailsAndIsRemovedByUpdate) {
  fs::copy_file(Golden("ltc"), Golden("ltc+clip=gone"));
  EXPECT_THAT(KindsOf(Run(false)), ElementsAre("ltc+clip=gone: stale golden"));
  EXPECT_THAT(KindsOf(Run(false, {}, false)), IsEmpty());  // not where only some variants are tested
  EXPECT_THAT(ChangesOf(Run(true)), ElementsAre(HasSubstr("removed")));
  EXPECT_FALSE(fs::exists(Golden("ltc+clip=gone")));
}

TEST_F(ImageCheck, OnePlantedNanFailsAndIsNeverStored) {
  const std::string golden = ReadText(Golden("ltc"));
  const ShaderLibrary library =
      Mutated("if (pixel == ivec2(20, 20)) specular.y = uintBitsToFloat(0x7fc00000u);");
  EXPECT_THAT(KindsOf(Run(false, library)), ElementsAre("drobot: not finite", "ltc: not finite"));
  EXPECT_THAT(KindsOf(Run(true, library)), ElementsAre("drobot: not finite", "ltc: not finite"));
  EXPECT_EQ(ReadText(Golden("ltc")), golden);
}

TEST_F(ImageCheck, OneFireflyFails) {
  const ShaderLibrary library = Mutated("if (pixel == ivec2(20, 20)) diffuse = vec3(1e4);");
  EXPECT_THAT(KindsOf(Run(false, library)), Contains("ltc: golden"));
}

// ltc's diffuse lobe is exact here: anything else is out of its band.
TEST_F(ImageCheck, AScaledImageLeavesItsBand) {
  const CheckResult result = Run(false, Mutated("diffuse *= 1.3; specular *= 1.3;"));
  EXPECT_THAT(KindsOf(result), Contains("ltc: band"));
  EXPECT_THAT(KindsOf(result), Contains("drobot: band"));
  EXPECT_THAT(KindsOf(result), Contains("ltc: golden"));
}

TEST_F(ImageCheck, ABandIsTwoSided) {
  const Band band = BandAround(0.1);
  EXPECT_TRUE(band.Holds(0.1));
  EXPECT_TRUE(band.Holds(0.081));
  EXPECT_FALSE(band.Holds(0.079));
  EXPECT_TRUE(band.Holds(0.124));
  EXPECT_FALSE(band.Holds(0.126));
  EXPECT_FALSE(band.Holds(kNotMeasured));
  EXPECT_TRUE(BandAround(3e-7).Holds(0.0));
  EXPECT_TRUE(BandAround(kNotMeasured).Holds(kNotMeasured));
  EXPECT_FALSE(BandAround(kNotMeasured).Holds(0.1));
}

TEST_F(ImageCheck, AMissingBandFails) {
  const fs::path file = folder_.path() / "goldens/bands.json";
  std::string text = ReadText(file);
  const std::size_t at = text.find("\"ltc\"");
  ASSERT_NE(at, std::string::npos);
  std::ofstream(file) << text.replace(at, 5, "\"gone\"");
  EXPECT_THAT(KindsOf(Run(false)), ElementsAre("ltc: missing band", "gone: stale band"));
}

TEST_F(ImageCheck, AShaderThatDoesNotCompileFailsAndTheRestGoesOn) {
  std::string text = *ShaderLibrary().Find("techniques/ltc.glsl");
  folder_.Write("glsl/techniques/ltc.glsl", text + "\nfloat broken(;\n");
  const CheckResult result = Run(false, ShaderLibrary(folder_.path() / "glsl"));
  EXPECT_THAT(KindsOf(result), ElementsAre("ltc: shader"));
}

TEST_F(ImageCheck, UpdateStoresTheChangeAndPrintsOldAndNewError) {
  const ShaderLibrary library = Mutated("specular *= 1.3;");
  const std::vector<std::string> changes = ChangesOf(Run(true, library));
  ASSERT_THAT(changes, SizeIs(2));
  EXPECT_THAT(
      changes[1],
      testing::MatchesRegex("golden changed .*; rel_rmse total 0\\.[0-9]+ -> 0\\.[0-9]+, diffuse .* -> .*"));
  EXPECT_THAT(KindsOf(Run(false, library)), IsEmpty());
  EXPECT_THAT(KindsOf(Run(false)), Contains("ltc: golden"));
}

TEST_F(ImageCheck, UpdateLeavesAFolderOfSomethingElseAlone) {
  fs::remove(folder_.path() / "goldens/bands.json");
  EXPECT_THROW(Run(true), InputError);
  EXPECT_TRUE(fs::exists(Golden("ltc")));
}

TEST_F(ImageCheck, ABrokenBandsFileIsToldByLine) {
  std::ofstream(folder_.path() / "goldens/bands.json") << "{\n  \"schema\": 1,\n  oops\n}\n";
  try {
    Run(false);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("bands.json:3: "));
  }
}

TEST_F(ImageCheck, TheGoldenTestHasAThreshold) {
  const RadianceImage golden = ReadExr(Golden("ltc"));
  RadianceImage image = golden;
  for (auto& v : image.diffuse) v *= 1.003f;  // below the threshold of 0.5 %
  EXPECT_FALSE(TestGolden(image, golden));
  for (auto& v : image.diffuse) v *= 1.005f;
  EXPECT_TRUE(TestGolden(image, golden));
  image = golden;
  image.diffuse[image.size() / 2] *= 1.2f;  // one pixel is within the fraction that is allowed
  EXPECT_FALSE(TestGolden(image, golden));
  RadianceImage damaged = golden;
  damaged.specular[7].z = std::numeric_limits<float>::infinity();
  EXPECT_EQ(TestGolden(golden, damaged)->kind, CheckKind::kNonfinite);
}

TEST_F(ImageCheck, ThePageShowsTheFailureAndHowToRepeatIt) {
  fs::copy_file(Golden("drobot"), Golden("ltc"), fs::copy_options::overwrite_existing);
  const fs::path out = folder_.path() / "out";
  WriteCheckReport(Run(false), out);
  const std::string html = ReadText(out / "check.html");
  EXPECT_THAT(html, HasSubstr("<pre>arealab check gloss --technique ltc</pre>"));
  EXPECT_THAT(html, HasSubstr("−2 % … +2 %"));
  EXPECT_THAT(html, HasSubstr("data:image/png;base64,iVBORw0KGgo"));  // PNG's signature
  EXPECT_THAT(html, Not(HasSubstr("<h2>gloss: drobot")));
  for (const char* name : {"result", "reference", "difference"})
    EXPECT_THAT(ReadText(out / fmt::format("pictures/gloss-ltc-{}.png", name)), HasSubstr("PNG")) << name;
  EXPECT_FALSE(fs::exists(out / "pictures/gloss-drobot-result.png"));
  const std::string junit = ReadText(out / "junit.xml");
  EXPECT_THAT(junit, HasSubstr("<testsuites name=\"arealab check\" tests=\"2\" failures=\"1\">"));
  EXPECT_THAT(junit, HasSubstr("<testcase classname=\"gloss\" name=\"drobot\"/>"));
  EXPECT_THAT(junit, HasSubstr("<failure type=\"golden\" message=\""));
  EXPECT_THAT(junit, HasSubstr("[[ATTACHMENT|" + (out / "pictures/gloss-ltc-difference.png").string()));
}

// A technique that a user brings passes, and does not once it lets roughness 0 through.
TEST_F(ImageCheck, AUsersTechniqueGoesThroughTheHardFamilies) {
  folder_.Write("glsl/techniques/mine.glsl", *ShaderLibrary().Find("techniques/point.glsl"));
  const ShaderLibrary library(folder_.path() / "glsl");
  const std::vector<Technique> techniques = LoadTechniques(library);
  CheckOptions options;
  options.scenes = {FindScene(kScene)};
  options.golden = folder_.path() / "mine";
  options.hard_cases = 2400;
  options.repeated = " --glsl 'a<b'";
  options.variants = {ParseVariant(techniques, "mine")};
  options.update = true;
  EXPECT_THAT(KindsOf(Check(*context_, library, options)), IsEmpty());
  options.update = false;
  const CheckResult good = Check(*context_, library, options);
  EXPECT_THAT(KindsOf(good), IsEmpty());
  EXPECT_GE(good.hard, 24);
  std::string surface = *ShaderLibrary().Find("surface.glsl");
  const std::string floor = "kMinAlpha = 1e-4";
  folder_.Write("glsl/surface.glsl", surface.replace(surface.find(floor), floor.size(), "kMinAlpha = 0.0"));
  const CheckResult bad = Check(*context_, library, options);
  EXPECT_THAT(KindsOf(bad), Contains("mine: hard case"));
  WriteCheckReport(bad, folder_.path() / "out");
  EXPECT_THAT(ReadText(folder_.path() / "out/check.html"), HasSubstr("<pre>arealab stress --technique mine --case 'shape="));
  EXPECT_THAT(ReadText(folder_.path() / "out/check.html"), HasSubstr(" --glsl 'a&lt;b'</pre>"));
}

// The stored goldens tell any two variants that share a scene apart, somewhere.
TEST(StoredGoldens, TellAnyTwoVariantsApart) {
  std::map<std::string, std::map<std::string, RadianceImage>> scenes;
  std::set<std::string> variants;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(AREALAB_SOURCE_DIR) / "tests/images")) {
    if (entry.path().extension() != ".exr") continue;
    const std::string variant = entry.path().stem().string();
    variants.insert(variant);
    scenes[entry.path().parent_path().filename().string()][variant] = ReadExr(entry.path());
  }
  ASSERT_GE(variants.size(), 2u);
  for (const std::string& a : variants) {
    for (const std::string& b : variants) {
      if (a == b) continue;
      bool shared = false, told = false;
      for (const auto& [scene, images] : scenes) {
        const auto first = images.find(a), second = images.find(b);
        if (first == images.end() || second == images.end()) continue;
        shared = true;
        told = told || TestGolden(first->second, second->second).has_value();
      }
      EXPECT_TRUE(told || !shared) << a << " and " << b;
    }
  }
}

// The program itself: its exit status, and the page that goes when all is well again.
TEST_F(ImageCheck, TheCommandSaysSoByItsExitStatus) {
  const fs::path goldens = folder_.path() / "goldens", out = folder_.path() / "out";
  const auto run = [&](const std::string& more) {
    const std::string command = std::string(AREALAB_PROGRAM) + " check gloss --technique ltc --golden " +
                                goldens.string() + " --out " + out.string() + more + " >" +
                                (folder_.path() / "log").string() + " 2>&1";
    const int raw = std::system(command.c_str());
    return WIFEXITED(raw) ? WEXITSTATUS(raw) : -1;
  };
  EXPECT_EQ(run(""), 0) << ReadText(folder_.path() / "log");
  fs::remove(Golden("ltc"));
  EXPECT_EQ(run(""), 1);
  EXPECT_THAT(ReadText(folder_.path() / "log"), HasSubstr("gloss: ltc: missing golden: "));
  EXPECT_THAT(ReadText(out / "check.html"), HasSubstr("arealab check gloss --technique ltc --golden"));
  EXPECT_EQ(run(" --update"), 0);
  EXPECT_EQ(run(""), 0);
  EXPECT_FALSE(fs::exists(out / "check.html"));
  fs::remove_all(goldens);
  EXPECT_EQ(run(""), 2);
}

}  // namespace
}  // namespace arealab::check_test
