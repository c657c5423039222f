// What `arealab export` writes stands alone: it compiles in every dialect, and a renderer that knows nothing of ours draws the same
// picture with it.
#include "glsl/export.h"

#include <gmock/gmock.h>

#include <cstdlib>

#include "compare/context.h"
#include "compare/subprocess.h"
#include "glsl/light_block.h"
#include "glsl/renderer.h"
#include "scenes/bake.h"
#include "tests/compare/stranger.h"
#include "tests/compare/stranger_vulkan.h"
#include "tests/glsl/temporary_folder.h"

namespace arealab::export_test {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr glm::ivec2 kSize(48, 48);

std::vector<float> Floats(const std::vector<glm::vec4>& texels) {
  const float* first = &texels[0].x;
  return {first, first + 4 * texels.size()};
}

// A scene's first light alone, drawn by AreaLab, with what a stranger needs to draw it too.
struct Drawn {
  stranger::Input input;
  RadianceImage image;
};

Drawn DrawOneLight(const GladGLContext& gl, const ShaderLibrary& library, const Variant& variant, const Scene& scene) {
  Renderer renderer(gl, library);
  const SurfacePixels& pixels = renderer.DrawScene(scene, kSize);
  Drawn drawn;
  drawn.input = {pixels.width, pixels.height, {}, {pixels.view_position.x, pixels.view_position.y, pixels.view_position.z},
                 Floats(LightBlockRows(scene.lights))};
  drawn.input.gbuffer = {{"gbuffer_position", Floats(pixels.position)},
                         {"gbuffer_normal", Floats(pixels.normal)},
                         {"gbuffer_base_color", Floats(pixels.base_color)}};
  if (!pixels.aperture.empty()) {
    drawn.input.gbuffer["gbuffer_aperture"] = Floats(pixels.aperture);
    // Read, but used by aperture=two and aperture=blocked alone.
    for (const char* name : {"gbuffer_first_region", "gbuffer_second_region", "gbuffer_blocked"}) {
      drawn.input.gbuffer[name].assign(4 * pixels.size(), 0.0f);
    }
  }
  const glm::vec3 sky(scene.sky.value_or(Sky()).radiance);
  drawn.input.sky = {sky.x, sky.y, sky.z};
  drawn.image = renderer.Shade(variant);
  return drawn;
}

void ExportTo(const std::filesystem::path& folder, const std::string& scene, const std::string& variant) {
  const ProcessResult result = RunProcess({AREALAB_PROGRAM, "export", scene, "--technique", variant, "--out", folder.string()}, {}, {});
  ASSERT_EQ(result.status, 0) << result.messages;
}

// The largest difference over the lobe's largest radiance.
double Difference(const std::vector<float>& theirs, const std::vector<glm::vec3>& ours) {
  double most = 0.0, apart = 0.0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      most = std::max(most, std::abs(static_cast<double>(ours[i][c])));
      apart = std::max(apart, std::abs(static_cast<double>(theirs[4 * i + static_cast<std::size_t>(c)]) - static_cast<double>(ours[i][c])));
    }
  }
  return apart / most;
}

// A built-in scene as a stranger draws it with what the export of each variant writes; `scene` is that scene.
void ExpectAStrangerDraws(const std::string& name, const Scene& scene, const std::vector<std::string>& variants) {
  const auto context = CreateContext(ContextKind::kOsmesa);
  const ShaderLibrary library;
  const std::vector<Technique> techniques = LoadTechniques(library);
  for (const std::string& variant_name : variants) {
    const TemporaryFolder folder;
    ExportTo(folder.path(), name, variant_name);
    const Variant variant = ParseVariant(techniques, variant_name);
    const Drawn drawn = DrawOneLight(context->gl(), library, variant, scene);
    const stranger::Output theirs = stranger::Draw(context->gl(), folder.path().string(), variant.technique->name, drawn.input);
    EXPECT_LT(Difference(theirs.diffuse, drawn.image.diffuse), 1e-5) << variant_name;
    EXPECT_LT(Difference(theirs.specular, drawn.image.specular), 1e-5) << variant_name;
  }
}

TEST(Export, AStrangerDrawsTheSamePicture) {
  ExpectAStrangerDraws("gloss", LoadScene(FindScene("gloss")), {"ltc", "hill", "drobot", "ltc@published"});
}

// What a light shows goes along, prefiltered as each technique wants it.
TEST(Export, AStrangerDrawsALightsTexture) {
  ExpectAStrangerDraws("screen", LoadScene(FindScene("screen")), {"ltc", "ltc+border=no", "drobot", "mayaux"});
}

// Apertures and the sky are inputs like any other, for techniques that know of them and for those that do not.
TEST(Export, AStrangerDrawsAperturesAndSky) {
  Scene scene = LoadScene(FindScene("hovering"));
  scene.aperture->rays = 64;
  BakeApertures(scene);
  ExpectAStrangerDraws("hovering", scene, {"ltc", "oat", "oat@published"});
}

TEST(Export, EveryDefaultVariantIsDecidedAndCompiles) {
  const auto context = CreateContext(ContextKind::kOsmesa);
  const ShaderLibrary library;
  const std::vector<Technique> techniques = LoadTechniques(library);
  for (const Variant& variant : DefaultVariants(techniques)) {
    const Variant all = WithAllEffects(variant);
    for (const char* name : {"gloss", "bulbs", "sixteen", "screen"}) {
      const Scene scene = LoadScene(FindScene(name));
      if (WhyUnsupported(variant, scene)) continue;
      const std::vector<Effect> effects = SceneEffects(scene);
      for (const Variant& one : {variant, all}) {
        SCOPED_TRACE(one.Name() + " for " + name);
        const std::string text = ExportShader(library, one, effects, scene.brdf, GlslDialect::kCore330, 128).text;
        for (const char* ours : {"\n#if", "\n#else", "\n#endif", "\n#include", "EFFECT_", "AREALAB_", "PATH_", "/*---"}) EXPECT_THAT(text, Not(HasSubstr(ours)));
        EXPECT_NO_THROW(stranger::Compile(context->gl(), GL_FRAGMENT_SHADER, text));
        if (std::string(name) == "gloss" || std::string(name) == "screen") {
          const std::string es = ExportShader(library, one, effects, scene.brdf, GlslDialect::kEs300, 1).text;
          const ProcessResult glslang = RunProcess({"glslangValidator", "--stdin", "-S", "frag"}, {}, es);
          ASSERT_TRUE(glslang.started) << "glslangValidator (Debian: glslang-tools)";
          EXPECT_EQ(glslang.status, 0) << glslang.messages;
        }
      }
    }
  }
}

// Functions that nothing calls are gone: each declared function is called or is main.
TEST(Export, OnlyWhatIsUsedStays) {
  const ShaderLibrary library;
  const std::vector<Technique> techniques = LoadTechniques(library);
  const Scene scene = LoadScene(FindScene("gloss"));
  const ExportedShader shader = ExportShader(library, ParseVariant(techniques, "ltc"), SceneEffects(scene), scene.brdf, GlslDialect::kCore330, 1);
  EXPECT_THAT(shader.text, Not(HasSubstr("SphereView")));
  EXPECT_THAT(shader.text, Not(HasSubstr("light_count")));
  EXPECT_THAT(shader.text, HasSubstr("[Heitz et al. 2016]"));
  EXPECT_THAT(shader.text, HasSubstr("#define MAX_LIGHTS 1\n"));
  EXPECT_THAT(shader.tables, testing::ElementsAre("ltc_matrix", "ltc_terms"));
  const ExportedShader shapes =
      ExportShader(library, ParseVariant(techniques, "ltc+effects=all"), SceneEffects(scene), scene.brdf, GlslDialect::kCore330, 8);
  EXPECT_THAT(shapes.text, HasSubstr("SphereView"));
  EXPECT_THAT(shapes.text, HasSubstr("light_count"));
}

// HLSL compiled back by glslang and drawn by a Vulkan that a CPU plays.
TEST(Export, HlslDrawsTheSamePicture) {
  if (!stranger::Vulkan().found()) GTEST_SKIP() << "no lavapipe (Debian: libvulkan1, mesa-vulkan-drivers)";
  const auto context = CreateContext(ContextKind::kOsmesa);
  const ShaderLibrary library;
  const std::vector<Technique> techniques = LoadTechniques(library);
  const TemporaryFolder folder;
  const auto words = [&](std::vector<std::string> command, const std::string& input) {
    const std::string file = (folder.path() / "compiled.spv").string();
    command.insert(command.begin(), {"glslangValidator", "-V", "-o", file});
    const ProcessResult result = RunProcess(command, {}, input);
    EXPECT_EQ(result.status, 0) << result.messages;
    const std::string bytes = stranger::ReadText(file);
    std::vector<std::uint32_t> found(bytes.size() / 4);
    std::memcpy(found.data(), bytes.data(), 4 * found.size());
    return found;
  };
  const std::vector<std::uint32_t> vertex = words({"--stdin", "-S", "vert"},
      "#version 450\nvoid main() { gl_Position = vec4(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0, 0.0, 1.0); }\n");
  for (const std::string name : {"ltc", "point", "oat"}) {
    ExportTo(folder.path(), "gloss", name);
    const std::string file = (folder.path() / (name + ".hlsl")).string();
    const std::vector<std::uint32_t> fragment =
        words({"-D", "-e", "main", "-S", "frag", "--stb", "0", "--ssb", std::to_string(stranger::kSamplerShift), "--scb", std::to_string(stranger::kBufferShift), file}, "");
    const Drawn drawn = DrawOneLight(context->gl(), library, ParseVariant(techniques, name), LoadScene(FindScene("gloss")));
    stranger::Vulkan vulkan;
    const stranger::Output theirs = vulkan.Draw(folder.path().string(), stranger::ReadText(file), vertex, fragment, drawn.input);
    EXPECT_LT(Difference(theirs.diffuse, drawn.image.diffuse), 1e-5) << name;
    EXPECT_LT(Difference(theirs.specular, drawn.image.specular), 1e-5) << name;
  }
}

TEST(Export, MistakesAreALine) {
  const TemporaryFolder folder;
  const auto fails = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {AREALAB_PROGRAM, "export", "--out", folder.path().string()});
    const ProcessResult result = RunProcess(arguments, {}, {});
    EXPECT_EQ(result.status, 2);
    return result.messages;
  };
  EXPECT_THAT(fails({}), HasSubstr("expected either a scene or --effects"));
  EXPECT_THAT(fails({"--effects", "rectangle,glow"}), HasSubstr("unknown effect \"glow\"; expected of rectangle"));
  EXPECT_THAT(fails({"bulbs", "--technique", "light_field"}), HasSubstr("light_field shades rectangles"));
  const ProcessResult none = RunProcess({AREALAB_PROGRAM, "export", "gloss", "--out", folder.path().string()}, {{"PATH", "/nowhere"}}, {});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.messages, HasSubstr("expected the Debian package glslang-tools"));
}

// Where AREALAB_EXPORT_SAMPLE names a folder: what export_webgl_test.py draws in a browser and what it should see.
TEST(Export, WritesTheSampleForTheBrowserTest) {
  const char* folder = std::getenv("AREALAB_EXPORT_SAMPLE");
  if (!folder) return;  // only that test asks
  const auto context = CreateContext(ContextKind::kOsmesa);
  const ShaderLibrary library;
  const std::vector<Technique> techniques = LoadTechniques(library);
  ExportTo(folder, "gloss", "ltc");
  const Drawn drawn = DrawOneLight(context->gl(), library, ParseVariant(techniques, "ltc"), LoadScene(FindScene("gloss")));
  nlohmann::json sample = {{"width", drawn.input.width}, {"height", drawn.input.height}, {"view_position", drawn.input.view_position},
                           {"light_rows", drawn.input.light_rows}, {"gbuffer", drawn.input.gbuffer}};
  for (const auto& [name, lobe] : {std::pair("diffuse", &drawn.image.diffuse), std::pair("specular", &drawn.image.specular)}) {
    for (const glm::vec3& radiance : *lobe) {
      for (int c = 0; c < 3; ++c) sample["expected"][name].push_back(radiance[c]);
    }
  }
  std::ofstream(std::filesystem::path(folder) / "sample.json") << sample;
}

}  // namespace
}  // namespace arealab::export_test
