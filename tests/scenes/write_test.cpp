// What is edited goes back into a scene's text, and nothing else of it changes.
#include "scenes/write.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <string>

#include "scenes/error.h"
#include "scenes/replace_file.h"
#include "tests/scenes/scene_folder.h"

namespace arealab::write_test {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

const std::string kText = R"(# What changes? é
exposure = 0.5   # stops

[camera]
position = [0.0, -4.0, 2.0]
target = [0.0, 0.0, 0.0]

[[material]]
name = "floor"   # oak
base_color = [0.2, 0.3, 0.4]

[[surface]]
type = "plane"
size = [4.0, 4.0]
material = "floor"

# the one above
[[light]]
name = "é"
shape = "rectangle"
position = [
  0.0, 1.0,   # over the edge
  2.0]
target = [0.0, 0.0, 0.0]   # aimed
size = [1.0, 0.5]
flux = 20.0

[[light]]
shape = "sphere"
position = [1.0, 1.0, 1.0]
radius = 0.1   # a bulb
color = [1.0, 0.5, 0.25]
radiance = 5.0
)";

Scene Read(const std::string& text) { return ParseScene("scene.toml", text); }

// The edit, checked to read back; its text.
std::string Edited(const Scene& before, const Scene& after, const std::string& text = kText) {
  std::string result = EditedText(text, before, after);
  const Scene read = Read(result);
  EXPECT_EQ(read.lights.size(), after.lights.size());
  for (std::size_t i = 0; i < std::min(read.lights.size(), after.lights.size()); ++i) {
    const Light &a = read.lights[i], &b = after.lights[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_LT(glm::distance(a.center, b.center), 1e-6);
    EXPECT_LT(b.shape == LightShape::kSphere ? 0.0 : glm::distance(a.axis_x, b.axis_x), 1e-5);
    EXPECT_LT(IsFlat(b.shape) ? glm::distance(a.normal, b.normal) : 0.0, 1e-5);
    EXPECT_LT(glm::distance(a.half_size, b.half_size), 1e-6);
    EXPECT_LT(glm::distance(a.radiance, b.radiance), 1e-5 * glm::length(b.radiance));
    EXPECT_EQ(a.two_sided, b.two_sided);
  }
  return result;
}

TEST(SceneWriter, NothingEditedNothingWritten) {
  const Scene scene = Read(kText);
  EXPECT_EQ(EditedText(kText, scene, scene), kText);
}

TEST(SceneWriter, TheSkyStays) {
  std::string text = kText;
  text.insert(text.find("[camera]"), "[sky]\nradiance = 0.25   # dusk\ncolor = [0.5, 0.7, 1.0]\n\n");
  const Scene before = Read(text);
  Scene after = before;
  after.lights[1].radiance *= 2.0;
  const std::string edited = Edited(before, after, text);
  EXPECT_THAT(edited, HasSubstr("[sky]\nradiance = 0.25   # dusk\ncolor = [0.5, 0.7, 1.0]\n"));
  EXPECT_EQ(Read(edited).sky, before.sky);
}

TEST(SceneWriter, TheSkyChangesComesAndGoes) {
  std::string text = kText;
  text.insert(text.find("[camera]"), "[sky]\nradiance = 0.25   # dusk\ncolor = [0.5, 0.7, 1.0]\n\n");
  const auto edited = [](const std::string& from, const glm::dvec3& sky) {
    const Scene before = Read(from);
    Scene after = before;
    after.sky = sky;
    std::string to = Edited(before, after, from);
    EXPECT_LT(glm::distance(Read(to).sky->radiance, sky), 1e-5 * glm::length(sky));
    return to;
  };
  EXPECT_THAT(edited(text, 2.0 * Read(text).sky->radiance), HasSubstr("[sky]\nradiance = 0.5   # dusk\ncolor = [0.5, 0.7, 1.0]\n"));
  EXPECT_THAT(edited(text, {0.3, 0.2, 0.1}), HasSubstr("   # dusk\ncolor = [1.0, 0.6666667, 0.3333333]\n"));
  EXPECT_THAT(edited(kText, {0.3, 0.2, 0.1}), EndsWith("\n[sky]\nradiance = [0.3, 0.2, 0.1]\n"));
  edited(edited(kText, {0.3, 0.2, 0.1}), {0.1, 0.1, 0.1});

  const Scene before = Read(text);
  Scene after = before;
  after.sky.reset();
  EXPECT_FALSE(Read(Edited(before, after, text)).sky);
}

TEST(SceneWriter, OneNumberChangesOneLine) {
  const Scene before = Read(kText);
  Scene after = before;
  after.lights[1].half_size = glm::dvec2(0.25);
  std::string expected = kText;
  expected.replace(expected.find("0.1   #"), 3, "0.25");
  EXPECT_EQ(Edited(before, after), expected);
}

TEST(SceneWriter, AMovedLightKeepsItsAxes) {
  const Scene before = Read(kText);
  Scene after = before;
  after.lights[0].center += glm::dvec3(0.5, 0.0, 0.0);
  const std::string text = Edited(before, after);
  EXPECT_THAT(text, HasSubstr("position = [0.5, 1.0, 2.0]\n"));
  EXPECT_THAT(text, HasSubstr("normal = ["));
  EXPECT_THAT(text, HasSubstr("# aimed"));
  EXPECT_THAT(text, Not(HasSubstr("target = [0.0, 0.0, 0.0]   # aimed")));
}

TEST(SceneWriter, ATurnThatANormalCannotSayGetsAnUp) {
  const Scene before = Read(kText);
  Scene after = before;
  Light& light = after.lights[0];
  const glm::dvec3 x = light.axis_x;
  light.axis_x = std::cos(0.3) * x + std::sin(0.3) * light.axis_y;
  light.axis_y = glm::cross(light.normal, light.axis_x);
  EXPECT_THAT(Edited(before, after), HasSubstr("\nup = ["));
}

TEST(SceneWriter, ARotationStaysOne) {
  std::string text = kText;
  text.replace(text.find("target = [0.0, 0.0, 0.0]   # aimed"), 34, "rotation = [120.0, 20.0, -30.0]");
  const Scene before = Read(text);
  Scene after = before;
  Light& light = after.lights[0];
  light.normal = glm::normalize(light.normal + 0.4 * light.axis_x);
  light.axis_x = glm::normalize(glm::cross(light.axis_y, light.normal));
  light.axis_y = glm::cross(light.normal, light.axis_x);
  const std::string edited = Edited(before, after, text);
  EXPECT_THAT(edited, HasSubstr("rotation = ["));
  EXPECT_THAT(edited, Not(HasSubstr("\nnormal")));
}

TEST(SceneWriter, EmissionStaysInTheQuantityOfTheFile) {
  const Scene before = Read(kText);
  Scene after = before;
  after.lights[0].radiance *= 1.5;
  after.lights[1].radiance *= 2.0;
  const std::string text = Edited(before, after);
  EXPECT_THAT(text, HasSubstr("flux = 30.0\n"));
  EXPECT_THAT(text, HasSubstr("radiance = 10.0\n"));
  EXPECT_THAT(text, HasSubstr("color = [1.0, 0.5, 0.25]\n"));
  after.lights[1].radiance = {4.0, 8.0, 8.0};
  EXPECT_THAT(Edited(before, after), HasSubstr("color = [0.5, 1.0, 1.0]\n"));
}

TEST(SceneWriter, ShapesChange) {
  const Scene before = Read(kText);
  Scene after = before;
  after.lights[0].shape = LightShape::kSphere;
  after.lights[0].half_size = glm::dvec2(0.3);
  after.lights[1].shape = LightShape::kRectangle;
  after.lights[1].half_size = {0.2, 0.1};
  const std::string text = Edited(before, after);
  EXPECT_THAT(text, HasSubstr("radius = 0.3\n"));
  EXPECT_THAT(text, HasSubstr("size = [0.4, 0.2]"));
}

// A file's corners need not lie about their centroid; what is moved, turned or stretched reads back the same light.
TEST(SceneWriter, PolygonsAndEllipsesComeBack) {
  std::string text = kText;
  text += "[[light]]\nname = \"kite\"\nshape = \"polygon\"\nposition = [0.5, 0.0, 2.0]\ntarget = [0.0, 0.0, 0.0]\n"
          "corners = [[0.0, 0.0], [0.5, 0.1], [0.7, 0.8], [-0.1, 0.6]]\nradiance = 2.0\n";
  const Scene before = Read(text);
  EXPECT_EQ(EditedText(text, before, before), text);
  for (int edit = 0; edit < 5; ++edit) {
    Scene after = before;
    Light& light = after.lights.back();
    if (edit == 0) light.center.z += 0.5;
    if (edit == 1) std::swap(light.axis_x, light.axis_y), light.normal = -light.normal;
    if (edit == 2) {
      for (glm::dvec2& corner : light.corners) corner.x *= 1.5;
      light.half_size.x *= 1.5;
    }
    if (edit == 3) light.shape = LightShape::kEllipse, light.half_size = {0.4, 0.2}, light.corners.clear();
    if (edit == 4) SetCorners(after.lights[0], {{-0.2, 0.0}, {0.2, -0.1}, {0.1, 0.3}});
    const Scene read = ParseScene(before.file, Edited(before, after, text));
    const std::vector<glm::dvec2>& a = read.lights.back().corners;
    ASSERT_EQ(a.size(), light.corners.size()) << edit;
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_LT(glm::distance(a[i], light.corners[i]), 1e-5) << edit << " " << i;
    EXPECT_EQ(read.lights[0].shape, after.lights[0].shape);
  }
}

// A tube reads back as it was edited, and from and to other shapes.
TEST(SceneWriter, TubesComeBack) {
  std::string text = kText;
  text += "[[light]]\nname = \"tube\"\nshape = \"tube\"\nposition = [0.5, 0.0, 2.0]\nrotation = [0.0, 30.0, 10.0]\nlength = 1.2\nradius = 0.02\nradiance = 2.0\n";
  const Scene before = Read(text);
  EXPECT_EQ(EditedText(text, before, before), text);
  for (int edit = 0; edit < 6; ++edit) {
    Scene after = before;
    Light& light = after.lights.back();
    if (edit == 0) light.center.z += 0.5;
    if (edit == 1) light.half_size.x = 0.75;
    if (edit == 2) light.half_size.y = 0.05;
    if (edit == 3) LayAlong(light, {0.0, 1.0, 2.0});
    if (edit == 4) light.shape = LightShape::kSphere, light.half_size = glm::dvec2(0.2);
    if (edit == 5) after.lights[0].shape = LightShape::kTube, after.lights[0].half_size = {0.5, 0.1}, after.lights[0].two_sided = false;
    const std::string edited = Edited(before, after, text);
    const Scene read = ParseScene(before.file, edited);
    for (const std::size_t i : {std::size_t{0}, after.lights.size() - 1}) {
      const Light &a = read.lights[i], &b = after.lights[i];
      EXPECT_EQ(a.shape, b.shape);
      EXPECT_LT(glm::distance(a.center, b.center) + glm::distance(a.half_size, b.half_size), 1e-6) << edit;
      if (b.shape == LightShape::kTube) {
        EXPECT_LT(glm::distance(a.axis_x, b.axis_x), 1e-5) << edit;
      }
    }
    EXPECT_EQ(edited.find("rotation") != std::string::npos, edit != 3 && edit != 4) << edit;
  }
  Scene after = before;
  after.lights.push_back(before.lights.back());
  after.lights.back().name = "another";
  EXPECT_THAT(Edited(before, after, text), HasSubstr("shape = \"tube\"\nposition = [0.5, 0.0, 2.0]\naxis = "));
}

TEST(SceneWriter, LightsComeAndGo) {
  const Scene before = Read(kText);
  Scene after = before;
  Light added = before.lights[0];
  added.name = "added";
  added.two_sided = true;
  after.lights.push_back(added);
  EXPECT_THAT(Edited(before, after), testing::StartsWith(kText));
  after.lights.erase(after.lights.begin());
  const std::string text = Edited(before, after);
  EXPECT_THAT(text, HasSubstr("name = \"light 2\""));  // a name by place, which has changed
  EXPECT_THAT(text, Not(HasSubstr("aimed")));
}

TEST(SceneWriter, MaterialsExposureCamera) {
  const Scene before = Read(kText);
  Scene after = before;
  after.materials[0].roughness = glm::vec2(0.3f);
  after.materials[0].base_color = glm::vec3(0.1f);
  after.materials[0].specular = 0.5f;
  after.exposure = -1.0;
  after.camera.vertical_fov = glm::radians(50.0);
  const std::string text = Edited(before, after);
  EXPECT_THAT(text, HasSubstr("base_color = 0.1\nroughness = 0.3\nspecular = 0.5\n"));
  EXPECT_THAT(text, HasSubstr("exposure = -1.0   # stops"));
  EXPECT_THAT(text, HasSubstr("vertical_fov = 50.0\n"));
}

TEST(SceneWriter, AFileOfSomeoneElseIsNotOverwritten) {
  const auto file = std::filesystem::temp_directory_path() / "arealab_write_test.toml";
  ReplaceFile(file, kText);
  const Scene before = LoadScene(file);
  Scene after = before;
  after.lights[1].half_size = glm::dvec2(0.25);
  SaveScene(before, after);
  EXPECT_EQ(LoadScene(file).lights[1].half_size.x, 0.25);
  std::string other = ReadSceneText(file);
  other.replace(other.find("flux = 20"), 9, "flux = 99");
  ReplaceFile(file, other);
  EXPECT_THROW(SaveScene(before, after), InputError);
  EXPECT_EQ(ReadSceneText(file), other);
  std::filesystem::remove(file);
}

TEST(SceneWriter, EveryBuiltInSceneTakesAnEdit) {
  for (const auto& file : BuiltInScenes()) {
    if (file.stem() == "scan") continue;  // its mesh takes a second to read, its text has nothing that others lack
    const std::string text = ReadSceneText(file);
    const Scene before = LoadScene(file);
    EXPECT_EQ(EditedText(text, before, before), text) << file;
    Scene after = before;
    for (Light& light : after.lights) light.center.z += 0.125, light.radiance *= 1.25;
    const Scene read = ParseScene(file, EditedText(text, before, after));
    for (std::size_t i = 0; i < after.lights.size(); ++i) {
      EXPECT_LT(glm::distance(read.lights[i].center, after.lights[i].center), 1e-5) << file;
      EXPECT_LT(glm::distance(read.lights[i].normal, after.lights[i].normal), 1e-5) << file;
      EXPECT_LT(glm::distance(read.lights[i].radiance, after.lights[i].radiance), 1e-5 * glm::length(after.lights[i].radiance)) << file;
    }
  }
}

TEST_F(SceneFolder, TexturesOfLightsAreKeptAddedAndTakenAway) {
  Write("a.ppm", "P3 1 1 255  255 128 0\n");
  const std::string text = kCamera + kMaterial + kSurface + kLight + "texture = \"a.ppm\"\n";
  const Scene before = Load(text);
  const auto saved = [&](const Scene& after) {
    Write("test.toml", text);
    SaveScene(before, after);
    return LoadScene(folder_ / "test.toml");
  };
  Scene moved = before;
  moved.lights[0].center.z = 3.0;
  EXPECT_EQ(saved(moved).lights[0].texture_path, "a.ppm");
  Scene bare = before;
  bare.lights[0].texture = nullptr;
  bare.lights[0].texture_path.clear();
  EXPECT_FALSE(saved(bare).lights[0].texture);
  Scene doubled = before;
  doubled.lights.push_back(before.lights[0]);
  doubled.lights[1].name = "second";
  EXPECT_EQ(saved(doubled).lights[1].texture_path, "a.ppm");
}

TEST_F(SceneFolder, TheSkysTextureIsKeptAddedTurnedAndTakenAway) {
  Write("a.ppm", "P3 2 1 255  255 128 0  9 9 9\n");
  const std::string plain = kCamera + kMaterial + kSurface + kLight, text = plain + "[sky]\nradiance = 2.0  # dusk\ntexture = \"a.ppm\"\nrotation = 30.0\n";
  const auto saved = [&](const std::string& from, const auto& edit) {
    const Scene before = Load(from);
    Scene after = before;
    edit(after);
    SaveScene(before, after);
    return LoadScene(folder_ / "test.toml").sky;
  };
  const auto kept = saved(text, [](Scene& scene) { scene.lights[0].center.z = 3.0; });
  EXPECT_EQ(kept->texture_path, "a.ppm");
  EXPECT_NEAR(kept->turn, glm::radians(30.0), 1e-12);
  EXPECT_EQ(kept->radiance, glm::dvec3(2.0));
  EXPECT_EQ(kept->texture->width, 2);
  EXPECT_NEAR(saved(text, [](Scene& scene) { scene.sky->turn = 1.0; })->turn, 1.0, 1e-6);
  EXPECT_FALSE(saved(text, [](Scene& scene) { scene.sky->texture = nullptr, scene.sky->texture_path.clear(), scene.sky->turn = 0.0; })->texture);
  EXPECT_FALSE(saved(text, [](Scene& scene) { scene.sky.reset(); }));
  const auto sky = Load(text).sky;
  const auto added = saved(plain, [&](Scene& scene) { scene.sky = sky; });
  EXPECT_EQ(added->texture_path, "a.ppm");
  EXPECT_NEAR(added->turn, sky->turn, 1e-6);
  EXPECT_EQ(saved(plain + "[sky]\nradiance = 2.0\n", [&](Scene& scene) { scene.sky = sky; })->texture_path, "a.ppm");
}

}  // namespace
}  // namespace arealab::write_test
