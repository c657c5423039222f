// The program as a person or a build server runs it: exit status, one-line errors.
#include "tests/app/program.h"

namespace arealab::cli_test {
namespace {

namespace fs = std::filesystem;

class Cli : public ProgramTest {};

TEST_F(Cli, ListNamesTechniquesWithWhatEachSupportsAndScenes) {
  const Outcome text = Arealab("list");
  EXPECT_EQ(text.status, 0);
  for (const char* word : {"point", "ltc", "hill", "drobot", "oat", "reference", "lights: ", "gloss"}) {
    EXPECT_NE(text.out.find(word), std::string::npos) << word;
  }
  const Outcome json = Arealab("list --json");
  EXPECT_EQ(json.status, 0);
  const nlohmann::json parsed = nlohmann::json::parse(json.out);
  EXPECT_GE(parsed.at("techniques").size(), 6u);
  EXPECT_GE(parsed.at("scenes").size(), 9u);
  for (const auto& technique : parsed.at("techniques")) EXPECT_FALSE(technique.at("shapes").empty());
}

TEST_F(Cli, BadUseIsOneLineAndStatusTwo) {
  ExpectRefused(Arealab("compare nosuchscene"), "gloss");
  ExpectRefused(Arealab("compare gloss --technique ltd"), "ltc");
  ExpectRefused(Arealab("compare gloss --technique ltc+clip=arch"), "arc");
  ExpectRefused(Arealab("compare gloss --size 0x4"), "--size 0x4");
  ExpectRefused(Arealab("compare gloss --limit rel_rms=1"), "rel_rmse");
  ExpectRefused(Arealab("compare gloss --limit rel_rmse"), "METRIC=NUMBER");
  ExpectRefused(Arealab("compare gloss --glsl " + Path("none")), "none");
  ExpectRefused(Arealab("compare gloss --contxt egl"), "contxt");
  ExpectRefused(Arealab("compare gloss --tolerance nan"), "nan is not from 1e-08 to 0.1");
  ExpectRefused(Arealab("stress --seed -1"), "-1 is not from 0");
  ExpectRefused(Arealab("stress --diffuse disney --technique oat"), "oat does not know the diffuse BRDF disney");
  ExpectRefused(Arealab("compare gloss --baseline " + WriteFile("none.json", "{")), "none.json:1: not JSON");  // before anything is drawn
  ExpectRefused(Arealab(""), "subcommand");
}

TEST_F(Cli, CompareWritesTheReportAndHoldsLimits) {
  const std::string compare = "compare gloss --size 48x48 --out " + Path("out") + Cache() + " --technique ltc --technique point";
  const Outcome kept = Arealab(compare + " --limit rel_rmse=100");
  ASSERT_EQ(kept.status, 0) << kept.out;
  EXPECT_NE(kept.out.find("index.html"), std::string::npos);
  const nlohmann::json results = ReadJson("out/results.json");
  EXPECT_EQ(results.at("schema"), 1);
  const nlohmann::json& scene = results.at("scenes").at(0);
  EXPECT_EQ(scene.at("width"), 48);
  EXPECT_FALSE(scene.at("truth").at("cached").get<bool>());
  ASSERT_EQ(scene.at("variants").size(), 2u);
  const double ltc = scene.at("variants").at(0).at("error").at("total").at("rel_rmse");
  const double point = scene.at("variants").at(1).at("error").at("total").at("rel_rmse");
  EXPECT_LT(ltc, 0.1);
  EXPECT_GT(point, 0.1);  // a point light under a near rectangle: if it were this good, something is swapped

  const Outcome exceeded = Arealab(compare + " --limit rel_rmse=0.05");
  EXPECT_EQ(exceeded.status, 1) << exceeded.out;
  EXPECT_NE(exceeded.out.find("gloss: point: rel_rmse"), std::string::npos) << exceeded.out;
  EXPECT_TRUE(ReadJson("out/results.json").at("scenes").at(0).at("truth").at("cached").get<bool>());
}

TEST_F(Cli, SavingSetsAVariantBesideItsProgramWithEveryEffect) {
  const Outcome outcome = Arealab("compare gloss --saving --size 32x32 --gpu none --out " + Path("out") + Cache() + " --technique point");
  ASSERT_EQ(outcome.status, 0) << outcome.out;
  const nlohmann::json saving = ReadJson("out/results.json").at("scenes").at(0).at("variants").at(0).at("saving");
  EXPECT_GT(saving.at("time_ratio").get<double>(), 0.0);
  EXPECT_LE(saving.at("interval").at(0), saving.at("time_ratio"));
  EXPECT_GE(saving.at("rounds"), 7);
}

TEST_F(Cli, SameInputGivesTheSameFigures) {
  const std::string compare = "compare spheres --size 40x30 --technique ltc --technique drobot";
  ASSERT_EQ(Arealab(compare + " --cache " + Path("a_cache") + " --out " + Path("a")).status, 0);
  ASSERT_EQ(Arealab(compare + " --cache " + Path("b_cache") + " --out " + Path("b")).status, 0);
  nlohmann::json a = ReadJson("a/results.json").at("scenes");
  nlohmann::json b = ReadJson("b/results.json").at("scenes");
  for (nlohmann::json* scenes : {&a, &b}) {
    (*scenes).at(0).at("truth").erase("seconds");
    (*scenes).at(0).at("truth").at("shadow").erase("seconds");
  }
  EXPECT_EQ(a, b);
}

TEST_F(Cli, UnwritableOutputIsRefusedAndAnEarlierReportSurvives) {
  ExpectRefused(Arealab("compare gloss --size 16x16 --technique point --out /dev/null/out" + Cache()), "/dev/null");
  const std::string compare = "compare gloss --size 16x16 --technique point --out " + Path("out") + Cache();
  ASSERT_EQ(Arealab(compare).status, 0);
  const auto before = fs::last_write_time(folder_ / "out/results.json");
  const std::string broken = WriteFile("broken.toml", "# What breaks?\n[camera]\nposition = [0, 0\n");
  ExpectRefused(Arealab("compare " + broken + " --out " + Path("out")), "broken.toml:3");
  EXPECT_EQ(fs::last_write_time(folder_ / "out/results.json"), before);
}

TEST_F(Cli, ATechniqueIsOneFileTriedLive) {
  WriteFile("glsl/techniques/flat.glsl",
            "/*---\nsummary = \"constant\"\ncitation = \"none\"\nauthor_note = \"none\"\n"
            "shapes = [\"rectangle\", \"disk\", \"sphere\"]\nlobes = [\"diffuse\"]\nbrdfs = [\"ggx\"]\neffects = [\"fresnel\"]\n---*/\n"
            "#include \"surface.glsl\"\n"
            "Radiance ShadeLight(Surface surface, Light light, vec3 to_view) {\n"
            "  return Radiance(surface.diffuse_albedo, vec3(0.0));\n}\n");
  const Outcome good = Arealab("compare gloss --size 16x16 --technique flat --glsl " + Path("glsl") + " --out " + Path("out") + Cache());
  EXPECT_EQ(good.status, 0) << good.out;
  EXPECT_NE(good.out.find("flat"), std::string::npos);
  // It claims one lobe: that one is measured, the other and the sum have no figure.
  std::ifstream results(folder_ / "out/results.json");
  const nlohmann::json error = nlohmann::json::parse(results)["scenes"][0]["variants"][0]["error"];
  EXPECT_TRUE(error["diffuse"]["rel_rmse"].is_number());
  EXPECT_TRUE(error["specular"]["rel_rmse"].is_null());
  EXPECT_TRUE(error["total"]["rel_rmse"].is_null());
  WriteFile("glsl/techniques/flat.glsl",
            "/*---\nsummary = \"constant\"\ncitation = \"none\"\nauthor_note = \"none\"\n"
            "shapes = [\"rectangle\"]\nlobes = [\"diffuse\", \"specular\"]\nbrdfs = [\"ggx\"]\neffects = [\"fresnel\"]\n---*/\n"
            "#include \"surface.glsl\"\n"
            "Radiance ShadeLight(Surface surface, Light light, vec3 to_view) {\n"
            "  return Radiance(surface.difuse_albedo, vec3(0.0));\n}\n");
  const Outcome bad = Arealab("compare gloss --size 16x16 --technique flat --glsl " + Path("glsl") + " --out " + Path("out2") + Cache());
  EXPECT_EQ(bad.status, 2);
  EXPECT_NE(bad.out.find("techniques/flat.glsl:12"), std::string::npos) << bad.out;
  EXPECT_FALSE(fs::exists(folder_ / "out2"));
}

TEST_F(Cli, ASweepInPartsIsTheWholeSweep) {
  const std::string rest = " --values 0.3,0.6,0.9 --technique point --technique ltc --size 32x32 --seconds 0 --context osmesa" + Cache();
  for (const std::string part : {"1/2", "2/2"}) {
    const Outcome outcome = Arealab("sweep roughness --shard " + part + " --out " + Path("part" + part.substr(0, 1)) + rest);
    ASSERT_EQ(outcome.status, 0) << outcome.out;
  }
  ASSERT_EQ(Arealab("sweep roughness --out " + Path("whole") + rest).status, 0);
  const Outcome merged = Arealab("compare --merge " + Path("part2") + " " + Path("part1") + " --out " + Path("merged"));
  ASSERT_EQ(merged.status, 0) << merged.out;
  const nlohmann::json a = ReadJson("whole/results.json"), b = ReadJson("merged/results.json");
  ASSERT_EQ(b.at("scenes").size(), 3u);
  for (std::size_t s = 0; s < 3; ++s) {
    EXPECT_EQ(a["scenes"][s]["sweep"], b["scenes"][s]["sweep"]);
    for (std::size_t v = 0; v < 2; ++v) {
      EXPECT_EQ(a["scenes"][s]["variants"][v]["error"], b["scenes"][s]["variants"][v]["error"]);
      EXPECT_EQ(a["scenes"][s]["variants"][v]["isa"], b["scenes"][s]["variants"][v]["isa"]);
    }
  }
  ExpectRefused(Arealab("sweep roughness --shard 3/2 --out " + Path("bad")), "expected i/n");
  ExpectRefused(Arealab("sweep hue --out " + Path("bad")), "expected one of lights");
  ExpectRefused(Arealab("compare --merge " + Path("nowhere") + " --out " + Path("bad")), "cannot be read");
}

TEST_F(Cli, MoreCyclesThanStoredAreStatusOne) {
  const auto cycles = nlohmann::json::parse(Arealab("cost --json --technique point --gpu bonaire" + Cache()).out);
  const int now = cycles.at("variants").at(0).at("isa").at("bonaire").at("core").at("cycles");
  const auto stored = [&](int count, const std::string& compilers) {
    const nlohmann::json file = {{"compilers", compilers}, {"cycles", {{"rectangle", {{"point", {{"bonaire", count}}}}}}}};
    return Arealab("cost --gpu bonaire --baseline " + WriteFile("cycles.json", file.dump()) + Cache());
  };
  const std::string compilers = cycles.at("compilers");
  EXPECT_EQ(stored(now, compilers).status, 0);
  EXPECT_EQ(stored(now + 1, compilers).status, 0);
  const Outcome more = stored(now - 1, compilers);
  EXPECT_EQ(more.status, 1);
  EXPECT_NE(more.out.find("point, bonaire: " + std::to_string(now - 1) + " → " + std::to_string(now)), std::string::npos) << more.out;
  const Outcome other = stored(1, "another compiler");
  EXPECT_EQ(other.status, 0);
  EXPECT_NE(other.out.find("not compared"), std::string::npos) << other.out;
  ExpectRefused(Arealab("cost --gpu voodoo"), "no GPU \"voodoo\"");
  ExpectRefused(Arealab("cost --baseline " + WriteFile("none.json", "{}") + Cache()), "no stored cycles");
}

}  // namespace
}  // namespace arealab::cli_test
