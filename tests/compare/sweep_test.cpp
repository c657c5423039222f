#include "compare/sweep.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "scenes/error.h"
#include "scenes/scene.h"
#include "tests/compare/synthetic_results.h"
#include "tests/glsl/temporary_folder.h"

namespace arealab::sweep_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(Sweep, EveryValueOfEveryAxisIsASceneThatReads) {
  const TemporaryFolder folder;
  for (const SweepAxis& axis : SweepAxes()) {
    for (const double value : axis.values) {
      const SweepPoint point = MakeSweepPoint(axis, value, {64, 48});
      const Scene scene = LoadScene(folder.Write("scene.toml", point.scene));
      EXPECT_FALSE(scene.lights.empty()) << axis.name << " " << value;
      if (axis.name == "lights") {
        EXPECT_EQ(scene.lights.size(), static_cast<std::size_t>(value));
      }
      if (axis.name == "pixels") {
        EXPECT_NEAR(point.size.x * point.size.y, 1e6 * value, 0.01e6 * value);
      }
      if (axis.name == "distance") {
        EXPECT_NEAR(glm::length(scene.lights[0].center), value, 1e-6);
      }
      if (axis.name == "roughness") {
        EXPECT_NEAR(scene.materials[0].roughness.x, value, 1e-6);
      }
    }
  }
  EXPECT_THAT([] { FindSweepAxis("hue"); }, ThrowsMessage<InputError>(HasSubstr("expected one of lights, pixels")));
  EXPECT_THAT([] { MakeSweepPoint(FindSweepAxis("lights"), 2.5, {8, 8}); }, ThrowsMessage<InputError>(HasSubstr("a whole number from 1 to 256")));
  EXPECT_THAT([] { MakeSweepPoint(FindSweepAxis("roughness"), std::nan(""), {8, 8}); }, ThrowsMessage<InputError>(HasSubstr("from 0 to 1")));
}

// Times that grow as the 0.9th power of the lights.
std::string Part(const std::vector<double>& values) {
  std::vector<SceneResult> scenes;
  for (const double value : values) {
    SceneResult scene = synthetic::MakeScene(fmt::format("lights-{}", value), "?", {}, {16, 12, 4}, false);
    for (VariantResult& variant : scene.variants) variant.time.ns_per_pixel = {std::pow(value, 0.9), 0.0, 0.0};
    scenes.push_back(scene);
  }
  return SweepResults(ResultsJson(synthetic::MakeResults(scenes)), FindSweepAxis("lights"), values);
}

TEST(Sweep, PartsJoinInOrderAndTheExponentIsFitted) {
  const TemporaryFolder folder;
  const std::string table = WriteSweep({Part({1, 16}), Part({4, 64}), Part({4})}, folder.path() / "out");
  EXPECT_THAT(table, HasSubstr("0.90"));
  std::ifstream in(folder.path() / "out/results.json");
  const nlohmann::json json = nlohmann::json::parse(in);
  std::vector<double> values;
  for (const auto& scene : json.at("scenes")) values.push_back(scene.at("sweep").at("value"));
  EXPECT_THAT(values, ElementsAre(1, 4, 16, 64));
  EXPECT_NEAR(json.at("exponents").at("ltc").get<double>(), 0.9, 1e-9);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "out/index.html"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "out/curves.csv"));
}

TEST(Sweep, PartsThatDoNotFitAreRefused) {
  const TemporaryFolder folder;
  std::string other = Part({1});
  for (std::size_t at; (at = other.find("\"lights\"")) != std::string::npos;) other.replace(at, 8, "\"pixels\"");
  EXPECT_THAT([&] { WriteSweep({Part({2}), other}, folder.path() / "out"); }, ThrowsMessage<InputError>(HasSubstr("expected one axis")));
  EXPECT_THAT([&] { WriteSweep({"{}"}, folder.path() / "out"); }, ThrowsMessage<InputError>(HasSubstr("`arealab sweep`")));
}

}  // namespace
}  // namespace arealab::sweep_test
