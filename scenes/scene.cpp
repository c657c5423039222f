#include "scenes/scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/gtc/constants.hpp>

#include "scenes/error.h"
#include "scenes/light_texture.h"

namespace arealab {
namespace {

namespace fs = std::filesystem;

// The order of the report: from the plainest question to the fullest picture. Scenes that are not named
// follow by name.
constexpr const char* kOrder[] = {"gloss",  "beckmann", "sinking", "grazing", "mirror", "strip",
                                  "shapes", "bulbs",    "spheres", "relief",  "scan",   "sixteen",
                                  "screen"};

fs::path SceneFolder() {
  const char* folder = std::getenv("AREALAB_SCENES");
  return folder && *folder ? folder : AREALAB_SCENE_DIR;
}

std::size_t Rank(const fs::path& file) {
  return static_cast<std::size_t>(std::find(std::begin(kOrder), std::end(kOrder), file.stem().string()) -
                                  std::begin(kOrder));
}

}  // namespace

const char* Name(LightShape shape) {
  switch (shape) {
    case LightShape::kRectangle:
      return "rectangle";
    case LightShape::kDisk:
      return "disk";
    case LightShape::kSphere:
      return "sphere";
    case LightShape::kPolygon:
      return "polygon";
    case LightShape::kEllipse:
      return "ellipse";
    case LightShape::kTube:
      return "tube";
  }
  return "";
}

const char* Name(Brdf brdf) {
  switch (brdf) {
    case Brdf::kGgx:
      return "ggx";
    case Brdf::kGgxSeparable:
      return "ggx_separable";
    case Brdf::kBeckmann:
      return "beckmann";
    case Brdf::kBlinnPhong:
      return "blinn_phong";
    case Brdf::kWard:
      return "ward";
    case Brdf::kPhong:
      return "phong";
    case Brdf::kLambert:
      return "lambert";
    case Brdf::kDisney:
      return "disney";
  }
  return "";
}

std::optional<std::string> WhyNotDiffuse(const Scene& scene) {
  if (scene.diffuse == Brdf::kLambert) return std::nullopt;
  const bool textured = std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light& light) { return light.texture != nullptr; });
  if (!scene.sky && !textured) return std::nullopt;
  return fmt::format("the diffuse BRDF {} reflects no {} here", Name(scene.diffuse), scene.sky ? "sky" : "light that shows a texture");
}

double Luminance(const glm::dvec3& color) {
  return glm::dot(color, glm::dvec3(0.2126, 0.7152, 0.0722));  // [ITU-R BT.709-6, item 3.2]
}

namespace {

double Cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

// Positive where the corners run counter-clockwise; triangles about the first, so that far corners keep their digits.
double TwiceArea(const std::vector<glm::dvec2>& corners) {
  double sum = 0.0;
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) sum += Cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
  return sum;
}

// The sine of the angle at a corner below which three lie in a line: float tells no smaller one from 0.
constexpr double kLeastBend = 1e-5;

}  // namespace

std::optional<std::string> WhyNoPolygon(const std::vector<glm::dvec2>& corners) {
  const std::size_t count = corners.size();
  if (count < 3) return fmt::format("{} corners enclose nothing", count);
  if (count > kMostCorners) return fmt::format("{} corners are too many", count);
  double turned = 0.0;
  double sense = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t before = (i + count - 1) % count;
    const glm::dvec2 here = corners[i] - corners[before], next = corners[(i + 1) % count] - corners[i];
    if (here == glm::dvec2(0.0)) return fmt::format("corners {} and {} are the same", before + 1, i + 1);
    const double bend = Cross(glm::normalize(here), glm::normalize(next));
    if (next != glm::dvec2(0.0) && std::abs(bend) < kLeastBend) {
      return fmt::format("corner {} lies in a line with its neighbours", i + 1);
    }
    if (bend * sense < 0.0) return fmt::format("the outline turns in at corner {}", i + 1);
    sense = bend;
    turned += std::atan2(bend, glm::dot(here, next) / (glm::length(here) * glm::length(next)));
  }
  if (std::abs(turned) > 3.0 * glm::pi<double>()) return "the outline crosses itself";  // a convex one turns by 2π
  return std::nullopt;
}

void SetCorners(Light& light, std::vector<glm::dvec2> corners) {
  if (TwiceArea(corners) < 0.0) std::reverse(corners.begin() + 1, corners.end());
  glm::dvec2 moment(0.0);  // of the triangles about the first corner, over it
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const glm::dvec2 a = corners[i] - corners[0], b = corners[i + 1] - corners[0];
    moment += Cross(a, b) * (a + b) / 3.0;
  }
  const double area = TwiceArea(corners);
  const glm::dvec2 centroid = corners[0] + (area > 0.0 ? moment / area : glm::dvec2(0.0));
  light.shape = LightShape::kPolygon;
  light.center += centroid.x * light.axis_x + centroid.y * light.axis_y;
  light.half_size = glm::dvec2(0.0);
  for (glm::dvec2& corner : corners) {
    corner -= centroid;
    light.half_size = glm::max(light.half_size, glm::abs(corner));
  }
  light.corners = std::move(corners);
}

void LayAlong(Light& light, const glm::dvec3& direction) {
  light.axis_x = glm::normalize(direction);
  const glm::dvec3 other = std::abs(light.axis_x.z) < 0.9 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(0.0, 1.0, 0.0);
  light.axis_y = glm::normalize(glm::cross(other, light.axis_x));
  light.normal = glm::cross(light.axis_x, light.axis_y);
}

double Light::Area() const {
  const double pi = glm::pi<double>();
  const double sides = two_sided ? 2.0 : 1.0;
  switch (shape) {
    case LightShape::kRectangle:
      return sides * 4.0 * half_size.x * half_size.y;
    case LightShape::kDisk:
    case LightShape::kEllipse:
      return sides * pi * half_size.x * half_size.y;
    case LightShape::kTube:
      return 4.0 * pi * half_size.x * half_size.y;
    case LightShape::kPolygon:
      return sides * 0.5 * TwiceArea(corners);
    case LightShape::kSphere:
      return 4.0 * pi * half_size.x * half_size.x;
  }
  return 0.0;
}

double Light::Flux() const {
  return Luminance(texture ? radiance * MeanTexel(*texture) : radiance) * glm::pi<double>() * Area();
}

std::vector<fs::path> BuiltInScenes() {
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(SceneFolder(), error)) {
    if (entry.path().extension() == ".toml" && entry.is_regular_file()) files.push_back(entry.path());
  }
  if (files.empty()) {
    throw InputError(
        fmt::format("{}: no scenes; expected a folder of scene files (*.toml), named by AREALAB_SCENES "
                    "or present since the build",
                    SceneFolder().string()));
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return std::pair(Rank(a), a.stem().string()) < std::pair(Rank(b), b.stem().string());
  });
  return files;
}

fs::path FindScene(const std::string& name_or_path) {
  std::vector<std::string> names;
  for (const fs::path& file : BuiltInScenes()) {
    if (file.stem().string() == name_or_path) return file;
    names.push_back(file.stem().string());
  }
  std::error_code error;
  if (fs::is_regular_file(name_or_path, error)) return name_or_path;
  throw InputError(fmt::format("no scene '{}'; expected a scene file's path or one of: {}", name_or_path,
                               fmt::join(names, ", ")));
}

}  // namespace arealab
