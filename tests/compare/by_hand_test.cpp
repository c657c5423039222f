// What the host leaves of a shader is what one would write by hand for the scene: three minimal passes, written without a look at ours, draw the
// same picture, and ours costs at most a twentieth more.
#include <gtest/gtest.h>

#include "compare/context.h"
#include "compare/cost.h"
#include "glsl/renderer.h"
#include "scenes/error.h"
#include "tests/glsl/temporary_folder.h"

namespace arealab::by_hand_test {
namespace {

constexpr double kMostOver = 1.05;
constexpr double kTolerance = 1e-5;  // of the lobe's largest radiance; measured 1.7e-6

struct Case {
  const char* pass;
  const char* technique;
  std::string scene;
};

constexpr const char* kWall = R"(
[camera]
position = [0.0, -4.0, 1.0]
target = [0.0, 0.0, 1.0]
[[material]]
name = "wall"
base_color = 0.6
specular = 0.0
[[surface]]
type = "plane"
size = [4.0, 4.0]
position = [0.0, 0.0, 1.0]
rotation = [90.0, 0.0, 0.0]
material = "wall"
[[light]]
shape = "sphere"
position = [6.0, -8.0, 5.0]
radius = 0.2
radiance = 900.0
)";

const std::string kFloor = R"(
[camera]
position = [0.0, -4.0, 2.0]
target = [0.0, 0.2, 0.0]
[[material]]
name = "floor"
base_color = 0.3
roughness = 0.35
[[surface]]
type = "plane"
size = [4.0, 4.0]
material = "floor"
[[light]]
)";

constexpr const char* kBall = R"(shape = "sphere"
position = [0.0, 1.5, 1.6]
radius = 0.4
radiance = 20.0
)";

constexpr const char* kPanel = R"(shape = "rectangle"
position = [0.3, 2.4, 1.4]
normal = [-0.1, -1.0, -0.3]
size = [2.0, 1.0]
radiance = 5.0
)";

// The pass of a variant that the library says, without what no lit pixel pays.
ExpandedSource Pass(const ShaderLibrary& library, const Variant& variant, const Scene& scene) {
  EffectDefines defines = Defines(SceneEffects(scene));
  defines.emplace_back("PATH_LIT", 1);
  return Expand(library, "lighting.frag", variant, defines, Precision::kFloat, scene.brdf);
}

double Difference(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
  double apart = 0.0, most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    apart = std::max(apart, static_cast<double>(glm::length(a[i] - b[i])));
    most = std::max(most, static_cast<double>(glm::length(a[i])));
  }
  return apart / std::max(most, 1e-30);
}

class ByHand : public testing::TestWithParam<Case> {};

TEST_P(ByHand, ThePrunedPassIsAsGood) {
  const TemporaryFolder folder;
  const std::string by_hand = std::string(AREALAB_SOURCE_DIR "/tests/compare/by_hand/") + GetParam().pass + ".frag";
  std::filesystem::copy_file(by_hand, folder.path() / "lighting.frag");
  const ShaderLibrary ours, theirs(folder.path());
  const std::vector<Technique> techniques = LoadTechniques(ours);
  const Variant variant = ParseVariant(techniques, GetParam().technique);
  const Scene scene = LoadScene(folder.Write("scene.toml", GetParam().scene));

  const auto context = CreateContext(ContextKind::kOsmesa);
  const auto draw = [&](const ShaderLibrary& library) {
    Renderer renderer(context->gl(), library);
    renderer.DrawScene(scene, {64, 64});
    return renderer.Shade(variant);
  };
  const RadianceImage pruned = draw(ours), minimal = draw(theirs);
  EXPECT_GT(std::ranges::count_if(pruned.diffuse, [](const glm::vec3& v) { return v.x > 0.0f; }), 1000);
  EXPECT_LT(Difference(pruned.diffuse, minimal.diffuse), kTolerance);
  EXPECT_LT(Difference(pruned.specular, minimal.specular), kTolerance);
  fmt::print("{}: apart {:.1e}, {:.1e}\n", GetParam().pass, Difference(pruned.diffuse, minimal.diffuse), Difference(pruned.specular, minimal.specular));

  std::optional<CostMeter> meter;
  try {
    meter.emplace(std::vector<std::string>{"bonaire", "navi21"}, folder.path() / "cache");
  } catch (const InputError& error) {
    GTEST_SKIP() << "cycles: " << error.what();
  }
  const auto costs = meter->MeasurePasses(ours, {Pass(ours, variant, scene), Pass(theirs, variant, scene)});
  for (const std::string& gpu : meter->gpus()) {
    const int own = costs[0].at(gpu).cycles, least = costs[1].at(gpu).cycles;
    fmt::print("{} on {}: {} cycles, by hand {}\n", GetParam().pass, gpu, own, least);
    EXPECT_LE(own, kMostOver * least) << gpu;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ByHand,
                         testing::Values(Case{"wall", "point", kWall}, Case{"panel", "ltc", kFloor + kPanel}, Case{"ball", "karis", kFloor + kBall}),
                         [](const auto& param) { return std::string(param.param.pass); });

}  // namespace
}  // namespace arealab::by_hand_test
