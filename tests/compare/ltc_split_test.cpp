// An LTC picture's error cause by cause: that the parts add up with hardly a remainder, that each vanishes where its cause is absent, and
// that E knows closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "compare/context.h"
#include "compare/ltc_split.h"
#include "scenes/shapes.h"
#include "tests/glsl/temporary_folder.h"

namespace arealab::ltc_split_test {
namespace {

// A floor of one roughness, which is a node of the tables, under a light that faces it or, sunk, is cut by its horizon.
Scene Floor(LightShape shape, bool sunk) {
  Scene scene;
  scene.camera.position = {0.0, -2.5, 1.5};
  scene.materials.emplace_back();
  scene.materials[0].roughness = glm::vec2(15.0f / 63.0f);
  scene.meshes.push_back(MakePlane({3.0, 3.0}, {}));
  Light light;
  light.shape = shape;
  light.center = sunk ? glm::dvec3(0.1, 0.8, 0.2) : glm::dvec3(0.1, 0.8, 1.2);
  light.normal = glm::normalize(glm::dvec3(0.0, -1.0, -0.4));
  light.axis_x = {1.0, 0.0, 0.0};
  light.axis_y = glm::cross(light.normal, light.axis_x);
  light.half_size = {0.5, shape == LightShape::kRectangle ? 0.35 : 0.5};
  light.radiance = glm::dvec3(2.0, 1.0, 0.5);
  scene.lights.push_back(light);
  return scene;
}

double Norm(const std::vector<glm::dvec3>& picture) {
  double sum = 0.0;
  for (const glm::dvec3& p : picture) sum += glm::dot(p, p);
  return std::sqrt(sum);
}

class LtcSplit : public testing::Test {
 protected:
  static void SetUpTestSuite() { fits_ = std::make_unique<TemporaryFolder>(); }
  static void TearDownTestSuite() { fits_.reset(); }
  // Each part's root of Σ² over the truth's, by name; "total" too.
  std::map<std::string, double> Split(const Scene& scene, const std::string& name) {
    constexpr glm::ivec2 kSize(32, 32);
    const Variant variant = ParseVariant(techniques_, name);
    const RadianceImage truth = ComputeTruth(scene, renderer_.DrawScene(scene, kSize)).radiance, image = renderer_.Shade(variant);
    EXPECT_FALSE(WhyNoCauses(variant, scene)) << name;
    const std::vector<CausePicture> causes = SplitByCause(renderer_, library_, variant, scene, kSize, image, truth, {}, fits_->path());
    std::vector<glm::dvec3> total(truth.size()), sum(truth.size(), glm::dvec3(0.0)), reference(truth.size());
    for (std::size_t i = 0; i < truth.size(); ++i) {
      total[i] = glm::dvec3(image.Total(i)) - glm::dvec3(truth.Total(i));
      reference[i] = glm::dvec3(truth.Total(i));
      for (const CausePicture& cause : causes) sum[i] += cause.error[i];
      sum[i] -= total[i];
    }
    const double scale = Norm(reference);
    EXPECT_LT(Norm(sum) / scale, 1e-6) << name;  // all parts and the remainder are the whole, but for float pictures added otherwise
    std::map<std::string, double> norms{{"total", Norm(total) / scale}};
    for (const CausePicture& cause : causes) norms[cause.name] = Norm(cause.error) / scale;
    return norms;
  }

  static std::unique_ptr<TemporaryFolder> fits_;  // of fine tables, for all tests
  std::unique_ptr<Context> context_ = CreateContext(ContextKind::kOsmesa);
  ShaderLibrary library_;
  std::vector<Technique> techniques_ = LoadTechniques(library_);
  Renderer renderer_{context_->gl(), library_};
};

std::unique_ptr<TemporaryFolder> LtcSplit::fits_;

TEST_F(LtcSplit, PartsVanishWhereTheirCauseDoes) {
  const Scene above = Floor(LightShape::kRectangle, false), sunk = Floor(LightShape::kRectangle, true);
  auto parts = Split(above, "ltc");
  EXPECT_LT(parts["remainder"], 2e-6);  // E knows all of the text
  EXPECT_EQ(parts["horizon"], 0.0);     // every light is above it
  EXPECT_EQ(parts["texture"], 0.0);
  EXPECT_LT(parts["rounding"], 1e-5);
  EXPECT_LT(parts["edge"], 5e-6);
  EXPECT_GT(parts["fit"], 0.5 * parts["total"]);
  EXPECT_LT(parts["interpolation"], 0.1 * parts["fit"]);

  EXPECT_EQ(Split(above, "ltc+edge=arctangent")["edge"], 0.0);
  EXPECT_GT(Split(above, "ltc+edge=quadratic")["edge"], 1e-4);

  parts = Split(sunk, "ltc");
  EXPECT_GT(parts["horizon"], 1e-4);  // the lobe leaks below the surface
  EXPECT_LT(parts["remainder"], 2e-6);
  parts = Split(sunk, "ltc+horizon=true");
  EXPECT_EQ(parts["horizon"], 0.0);
  EXPECT_LT(parts["remainder"], 2e-6);
  parts = Split(sunk, "ltc+clip=none");
  EXPECT_GT(parts["horizon"], 0.01);
  EXPECT_LT(parts["remainder"], 2e-6);
  parts = Split(sunk, "hill+sphere=cheap");
  EXPECT_GT(parts["horizon"], Split(sunk, "hill")["horizon"]);
  EXPECT_LT(parts["remainder"], 2e-6);
}

// Storage, Fresnel, lobes, round lights: E knows them all. (Round lights are 256 sides to it.)
TEST_F(LtcSplit, LeavesHardlyARemainder) {
  const Scene sunk = Floor(LightShape::kRectangle, true);
  for (const char* name : {"ltc@published", "ltc+lobes=cosine", "ltc@published+norm=last+axis=theta"}) EXPECT_LT(Split(sunk, name)["remainder"], 5e-6) << name;
  Scene rough = sunk;  // where little hangs on rougher columns: a fine table of two lobes for all takes minutes
  rough.materials[0].roughness = glm::vec2(0.95f);
  for (const char* name : {"ltc+lobes=two", "hill+lobes=two"}) EXPECT_LT(Split(rough, name)["remainder"], 5e-6) << name;
  for (const LightShape shape : {LightShape::kDisk, LightShape::kSphere}) {
    EXPECT_LT(Split(Floor(shape, true), "ltc")["remainder"], 2e-4) << Name(shape);
    EXPECT_LT(Split(Floor(shape, false), "hill")["remainder"], 2e-4) << Name(shape);
  }
}

// Half bright on one side: the filter is the only new part, and what it leaves of the others is theirs.
TEST_F(LtcSplit, TexturesHaveAPartOfTheirOwn) {
  Scene scene = Floor(LightShape::kRectangle, false);
  const double plain = Split(scene, "ltc")["fit"];
  auto image = std::make_shared<Image>(Image{8, 1, {}});
  for (int i = 0; i < 8; ++i) image->pixels.emplace_back(glm::vec3(i < 4 ? 1.0f : 0.1f), 1.0f);
  scene.lights[0].texture = image;
  auto parts = Split(scene, "ltc");
  EXPECT_GT(parts["texture"], 0.02);
  EXPECT_LT(parts["rounding"], 1e-5);  // the double text reads the same texels
  EXPECT_LT(parts["remainder"], 2e-6);
  EXPECT_NEAR(parts["fit"], plain, 0.5 * plain);
  scene.lights[0].texture = std::make_shared<Image>(Image{2, 1, std::vector(2, glm::vec4(0.5f, 0.5f, 0.5f, 1.0f))});
  parts = Split(scene, "ltc");
  EXPECT_LT(parts["texture"], 1e-6);  // a constant is no picture
}

// A table of twice the nodes has about a quarter of the part between them.
TEST_F(LtcSplit, InterpolationShrinksWithALargerTable) {
  Scene scene = Floor(LightShape::kRectangle, false);
  scene.materials[0].roughness = glm::vec2(0.5f);
  const SurfacePixels& pixels = renderer_.DrawScene(scene, {32, 32});
  const auto fitted = [&](int size) {
    LtcForm form;
    FitOptions options;
    options.size = size;
    form.tables = FitLtcColumns(Brdf::kGgx, FitKind::kPolygon, options, {(size - 1) / 2});
    return form;
  };
  const auto apart = [&](const LtcForm& a, const LtcForm& b) {
    const LobePictures x = LtcPicture(scene, pixels, a), y = LtcPicture(scene, pixels, b);
    std::vector<glm::dvec3> difference(x.specular.size());
    for (std::size_t i = 0; i < difference.size(); ++i) difference[i] = x.specular[i] - y.specular[i];
    return Norm(difference) / Norm(y.specular);
  };
  const LtcForm fine = fitted(97);
  const double coarse = apart(fitted(13), fine), middle = apart(fitted(25), fine);
  EXPECT_GT(coarse, 1e-3);
  EXPECT_LT(middle, 0.5 * coarse);
}

// E under an identity, a plain cosine: the closed form of a disk that faces the point, sin² of its half angle.
TEST_F(LtcSplit, LobeUnderTheIdentityIsTheFormFactor) {
  Scene scene = Floor(LightShape::kDisk, false);
  scene.camera.position = {0.0, -0.01, 0.9};  // under the light
  scene.lights[0].normal = {0.0, 0.0, -1.0};
  scene.lights[0].axis_y = {0.0, -1.0, 0.0};
  scene.lights[0].center = {0.0, 0.0, 1.0};
  scene.materials[0].base_color = glm::vec3(1.0f);
  scene.materials[0].metalness = 0.0f;
  LtcForm form;
  form.fresnel_direction = false;
  form.tables.size = 2;
  form.tables.storage.frame = LtcFrame::kNormal;
  form.tables.matrix.assign(4, glm::vec4(1.0f, 0.0f, 0.0f, 1.0f));
  form.tables.terms.assign(4, glm::vec4(1.0f, 1.0f, 0.0f, 0.0f));  // all is reflected
  const SurfacePixels& pixels = renderer_.DrawScene(scene, {33, 33});
  const LobePictures picture = LtcPicture(scene, pixels, form);
  const std::size_t middle = 16 * 33 + 16;
  ASSERT_LT(glm::length(glm::vec2(pixels.position[middle])), 0.02f);
  EXPECT_NEAR(picture.specular[middle].y, 0.25 / 1.25, 1e-4);
  EXPECT_NEAR(picture.diffuse[middle].y, 0.25 / 1.25, 1e-4);
}

}  // namespace
}  // namespace arealab::ltc_split_test
