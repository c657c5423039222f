#include "scenes/scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <glm/gtc/constants.hpp>

#include "scenes/error.h"

namespace arealab {
namespace {

namespace fs = std::filesystem;

// The order of the report: from the plainest question to the fullest picture. Scenes that are not named
// follow by name.
constexpr const char* kOrder[] = {"gloss",  "beckmann", "sinking", "grazing", "mirror", "strip",
                                  "shapes", "bulbs",    "spheres", "relief",  "scan",   "sixteen"};

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
  }
  return "";
}

double Luminance(const glm::dvec3& color) {
  return glm::dot(color, glm::dvec3(0.2126, 0.7152, 0.0722));  // [ITU-R BT.709-6, item 3.2]
}

double Light::Area() const {
  const double pi = glm::pi<double>();
  const double sides = two_sided ? 2.0 : 1.0;
  switch (shape) {
    case LightShape::kRectangle:
      return sides * 4.0 * half_size.x * half_size.y;
    case LightShape::kDisk:
      return sides * pi * half_size.x * half_size.y;
    case LightShape::kSphere:
      return 4.0 * pi * half_size.x * half_size.x;
  }
  return 0.0;
}

double Light::Flux() const {
  return Luminance(radiance) * glm::pi<double>() * Area();
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
