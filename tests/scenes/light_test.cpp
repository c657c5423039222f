#include <fmt/format.h>

#include <glm/gtc/constants.hpp>

#include "scenes/light_texture.h"
#include "tests/scenes/scene_folder.h"

namespace arealab::light_test {
namespace {

constexpr double kPi = glm::pi<double>();

class LightTest : public SceneFolder {
 protected:
  // The light that `lines` describe.
  Light Read(const std::string& lines, const std::string& units = "radiometric") const {
    return Load(fmt::format("units = \"{}\"\n", units) + kCamera + kMaterial + kSurface + "[[light]]\n" +
                lines)
        .lights.at(0);
  }
};

void ExpectRightHanded(const Light& light) {
  EXPECT_NEAR(glm::length(light.axis_x), 1.0, 1e-12);
  EXPECT_NEAR(glm::length(light.axis_y), 1.0, 1e-12);
  EXPECT_NEAR(glm::length(light.normal), 1.0, 1e-12);
  EXPECT_NEAR(glm::dot(light.axis_x, light.axis_y), 0.0, 1e-12);
  EXPECT_LT(glm::length(glm::cross(light.axis_x, light.axis_y) - light.normal), 1e-12);
}

const std::string kRectangle = "shape = \"rectangle\"\nposition = [1.0, 2.0, 3.0]\nsize = [4.0, 0.5]\n";
const std::string kDisk = "shape = \"disk\"\nposition = [1.0, 2.0, 3.0]\nradius = 0.25\n";
const std::string kSphere = "shape = \"sphere\"\nposition = [1.0, 2.0, 3.0]\nradius = 0.25\n";
const std::string kEllipse = "shape = \"ellipse\"\nposition = [1.0, 2.0, 3.0]\nradii = [0.5, 0.25]\n";
const std::string kTube = "shape = \"tube\"\nposition = [1.0, 2.0, 3.0]\nlength = 4.0\nradius = 0.25\n";
// A right triangle of 3 m² whose centroid is at (1, 2/3).
const std::string kPolygon = "shape = \"polygon\"\nposition = [1.0, 2.0, 3.0]\ncorners = [[0.0, 0.0], [3.0, 0.0], [0.0, 2.0]]\n";
const std::string kAimed = "target = [0.0, 0.0, 0.0]\n";

TEST_F(LightTest, AreaAndFluxOfUnitRadianceAreTheClosedForms) {
  const std::string unit = "radiance = 1.0\n";
  const std::string both = "two_sided = true\n";
  EXPECT_NEAR(Read(kRectangle + kAimed + unit).Flux(), kPi * 2.0, 1e-14);
  EXPECT_NEAR(Read(kRectangle + kAimed + unit + both).Flux(), kPi * 4.0, 1e-14);
  EXPECT_NEAR(Read(kDisk + kAimed + unit).Flux(), kPi * kPi * 0.0625, 1e-14);
  EXPECT_NEAR(Read(kDisk + kAimed + unit + both).Flux(), 2.0 * kPi * kPi * 0.0625, 1e-14);
  EXPECT_NEAR(Read(kEllipse + kAimed + unit).Flux(), kPi * kPi * 0.125, 1e-14);
  EXPECT_NEAR(Read(kPolygon + kAimed + unit).Flux(), kPi * 3.0, 1e-14);
  EXPECT_NEAR(Read(kPolygon + kAimed + unit + both).Flux(), kPi * 6.0, 1e-14);
  EXPECT_NEAR(Read(kSphere + unit).Flux(), 4.0 * kPi * kPi * 0.0625, 1e-14);
  EXPECT_NEAR(Read(kSphere + unit).Area(), 4.0 * kPi * 0.0625, 1e-14);
  EXPECT_NEAR(Read(kTube + "axis = [0.0, 2.0, 0.0]\n" + unit).Flux(), 2.0 * kPi * kPi, 1e-13);
}

TEST_F(LightTest, FluxComesBackThroughRadiance) {
  for (const std::string& shape : {kRectangle + kAimed, kRectangle + kAimed + "two_sided = true\n",
                                   kDisk + kAimed, kDisk + kAimed + "two_sided = true\n", kSphere, kEllipse + kAimed, kPolygon + kAimed,
                                   kTube + "axis = [1.0, 1.0, 0.0]\n"}) {
    for (const std::string color : {"", "color = [1.0, 0.5, 0.1]\n", "color = [0.0, 0.0, 7.0]\n"}) {
      EXPECT_NEAR(Read(shape + color + "flux = 123.0\n").Flux(), 123.0, 1e-11);
      EXPECT_NEAR(Read(shape + color + "luminous_flux = 800.0\n", "photometric").Flux(), 800.0, 1e-10);
    }
  }
}

// sRGB integers become linear, floats are; flux counts the texture's mean luminance; the image is upright, its row 0 at the top.
TEST_F(LightTest, TextureMultipliesTheRadiance) {
  Write("two.ppm", "P3 2 1 255  255 255 255  188 188 188\n");
  WriteImage("two.exr", {2.0f, 0.5f, 1.0f});
  const Light light = Read(kRectangle + kAimed + "texture = \"two.ppm\"\nradiance = 3.0\n");
  ASSERT_TRUE(light.texture);
  EXPECT_EQ(light.texture_path, "two.ppm");
  EXPECT_NEAR(MeanTexel(*light.texture).g, 0.5 * (1.0 + 0.502886), 1e-5);
  EXPECT_NEAR(Luminance(light.radiance), 3.0, 1e-14);
  EXPECT_NEAR(light.Flux(), kPi * 2.0 * 3.0 * 0.5 * (1.0 + 0.502886), 1e-4);
  EXPECT_NEAR(Read(kRectangle + kAimed + "texture = \"two.ppm\"\ncolor = [1.0, 0.5, 0.1]\nflux = 123.0\n").Flux(), 123.0, 1e-11);
  const Light half = Read(kRectangle + kAimed + "texture = \"two.exr\"\nradiance = 1.0\n");
  EXPECT_EQ(MeanTexel(*half.texture), glm::dvec3(3.5 / 3.0));
  const glm::dvec3 left = half.center - 2.0 * half.axis_x, right = half.center + 2.0 * half.axis_x;
  EXPECT_EQ(TextureAt(*half.texture, TextureCoordinates(half, left, false)).r, 2.0);
  EXPECT_EQ(TextureAt(*half.texture, TextureCoordinates(half, right, false)).r, 1.0);
  EXPECT_EQ(TextureAt(*half.texture, TextureCoordinates(half, right, true)).r, 2.0);
  EXPECT_NEAR(TextureAt(*half.texture, {1.0 / 3.0, 0.7}).r, 1.25, 1e-12);
  EXPECT_NEAR(TextureCoordinates(half, half.center + 0.25 * half.axis_y, false).y, 0.0, 1e-15);
}

TEST_F(LightTest, ColorGivesTheHueAndRadianceTheLuminance) {
  const Light light = Read(kSphere + "color = [1.0, 0.5, 0.25]\nradiance = 3.0\n");
  EXPECT_NEAR(Luminance(light.radiance), 3.0, 1e-14);
  EXPECT_NEAR(light.radiance.g / light.radiance.r, 0.5, 1e-15);
  EXPECT_NEAR(light.radiance.b / light.radiance.r, 0.25, 1e-15);
  EXPECT_EQ(Read(kSphere + "radiance = [1.0, 0.0, 0.25]\n").radiance, glm::dvec3(1.0, 0.0, 0.25));
  EXPECT_EQ(Read(kSphere + "luminance = [5.0, 6.0, 7.0]\n", "photometric").radiance,
            glm::dvec3(5.0, 6.0, 7.0));
  EXPECT_NEAR(Luminance(glm::dvec3(1.0)), 1.0, 1e-15);
}

TEST_F(LightTest, TargetTurnsTheLitSideThere) {
  const Light light = Read(kRectangle + kAimed + "radiance = 1.0\n");
  ExpectRightHanded(light);
  EXPECT_EQ(light.center, glm::dvec3(1.0, 2.0, 3.0));
  EXPECT_EQ(light.half_size, glm::dvec2(2.0, 0.25));
  EXPECT_LT(glm::length(light.normal + glm::normalize(light.center)), 1e-14);
  EXPECT_NEAR(light.axis_x.z, 0.0, 1e-15);  // level, since up is z
  EXPECT_GT(light.axis_y.z, 0.0);
}

TEST_F(LightTest, NormalAndUpGiveTheTurn) {
  const Light light = Read(kDisk + "normal = [0.0, -3.0, 0.0]\nup = [1.0, 1.0, 0.0]\nradiance = 1.0\n");
  ExpectRightHanded(light);
  EXPECT_EQ(light.half_size, glm::dvec2(0.25));
  EXPECT_LT(glm::length(light.normal - glm::dvec3(0, -1, 0)), 1e-15);
  EXPECT_LT(glm::length(light.axis_y - glm::dvec3(1, 0, 0)), 1e-15);
}

TEST_F(LightTest, FacingStraightDownTakesYForUp) {
  const Light light = Read(kRectangle + "normal = [0.0, 0.0, -1.0]\nradiance = 1.0\n");
  ExpectRightHanded(light);
  EXPECT_LT(glm::length(light.axis_y - glm::dvec3(0, 1, 0)), 1e-15);
}

TEST_F(LightTest, RotationTurnsALightThatFacesUp) {
  const Light level = Read(kRectangle + "rotation = [0.0, 0.0, 0.0]\nradiance = 1.0\n");
  ExpectRightHanded(level);
  EXPECT_EQ(level.normal, glm::dvec3(0, 0, 1));
  const Light turned = Read(kRectangle + "rotation = [90.0, 0.0, 30.0]\nradiance = 1.0\n");
  ExpectRightHanded(turned);
  EXPECT_LT(glm::length(turned.normal - glm::dvec3(0.5, -std::sqrt(0.75), 0.0)), 1e-15);
  ExpectRightHanded(Read(kRectangle + "rotation = [12345.6, -7.8, 91.2]\nradiance = 1.0\n"));
}

// The same light whichever way its corners run; its centre is the centroid, its corners counter-clockwise about it.
TEST_F(LightTest, APolygonsCornersRunEitherWay) {
  const std::string flat = "normal = [0.0, 0.0, 1.0]\nup = [0.0, 1.0, 0.0]\nradiance = 1.0\n";
  const Light light = Read(kPolygon + flat);
  ExpectRightHanded(light);
  EXPECT_LT(glm::distance(light.center, glm::dvec3(2.0, 2.0 + 2.0 / 3.0, 3.0)), 1e-14);
  EXPECT_LT(glm::distance(light.half_size, glm::dvec2(2.0, 4.0 / 3.0)), 1e-14);
  ASSERT_EQ(light.corners.size(), 3u);
  EXPECT_LT(glm::distance(light.corners[1], glm::dvec2(2.0, -2.0 / 3.0)), 1e-14);
  EXPECT_LT(glm::distance(light.corners[2], glm::dvec2(-1.0, 4.0 / 3.0)), 1e-14);
  const Light other = Read("shape = \"polygon\"\nposition = [1.0, 2.0, 3.0]\ncorners = [[0.0, 0.0], [0.0, 2.0], [3.0, 0.0]]\n" + flat);
  EXPECT_EQ(other.corners, light.corners);
  EXPECT_EQ(other.center, light.center);
}

TEST_F(LightTest, LightsWithoutNamesAreNumbered) {
  const Scene scene = Load(kCamera + kMaterial + kSurface + "[[light]]\n" + kSphere +
                           "flux = 1\n[[light]]\n" + kSphere + "flux = 2\n");
  EXPECT_EQ(scene.lights[0].name, "light 1");
  EXPECT_EQ(scene.lights[1].name, "light 2");
}

}  // namespace
}  // namespace arealab::light_test
