// The material key `specular` weighs a non-metal's specular lobe, in the truth and in every technique alike, and nothing else.
#include <gtest/gtest.h>

#include "compare/context.h"
#include "compare/truth.h"
#include "glsl/renderer.h"

namespace arealab::specular_weight_test {
namespace {

TEST(SpecularWeight, WeighsTheSpecularLobeAlone) {
  const auto context = CreateContext(ContextKind::kOsmesa);
  const ShaderLibrary library;
  const std::vector<Technique> techniques = LoadTechniques(library);
  Renderer renderer(context->gl(), library);
  Scene scene = LoadScene(FindScene("gloss"));
  constexpr glm::ivec2 kSize(16, 16);
  TruthOptions options;
  options.tolerance = 1e-3;
  const Truth whole = ComputeTruth(scene, renderer.DrawScene(scene, kSize), options);
  const Variant ltc = ParseVariant(techniques, "ltc");
  const RadianceImage whole_ltc = renderer.Shade(ltc);
  for (const float weight : {0.25f, 0.0f}) {
    scene.materials[0].specular = weight;
    const Truth truth = ComputeTruth(scene, renderer.DrawScene(scene, kSize), options);
    const RadianceImage image = renderer.Shade(ltc);
    for (std::size_t i = 0; i < image.size(); ++i) {
      ASSERT_EQ(truth.radiance.diffuse[i], whole.radiance.diffuse[i]);
      ASSERT_EQ(truth.radiance.specular[i], weight * whole.radiance.specular[i]);  // powers of two: exact
      for (int c = 0; c < 3; ++c) {
        ASSERT_NEAR(image.diffuse[i][c], whole_ltc.diffuse[i][c], 1e-6f * whole_ltc.diffuse[i][c]);
        ASSERT_NEAR(image.specular[i][c], weight * whole_ltc.specular[i][c], 1e-6f * whole_ltc.specular[i][c]);
      }
    }
  }
}

}  // namespace
}  // namespace arealab::specular_weight_test
