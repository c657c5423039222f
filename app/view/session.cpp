#include "app/view/session.h"

#include <algorithm>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "scenes/write.h"

namespace arealab {
namespace {

constexpr std::size_t kMaxUndo = 500;

template <typename T>
bool SameAll(const std::vector<T>& a, const std::vector<T>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const T& x, const T& y) { return Same(x, y); });
}

}  // namespace

bool Same(const Light& a, const Light& b) {
  return a.name == b.name && a.shape == b.shape && a.center == b.center && a.axis_x == b.axis_x && a.axis_y == b.axis_y &&
         a.normal == b.normal && a.half_size == b.half_size && a.radiance == b.radiance && a.two_sided == b.two_sided;
}

bool Same(const Material& a, const Material& b) {
  return a.name == b.name && a.base_color == b.base_color && a.roughness == b.roughness && a.metalness == b.metalness &&
         a.normal_scale == b.normal_scale && a.base_color_texture == b.base_color_texture &&
         a.metallic_roughness_texture == b.metallic_roughness_texture && a.normal_texture == b.normal_texture;
}

bool Same(const Edits& a, const Edits& b) {
  return a.exposure == b.exposure && SameAll(a.lights, b.lights) && SameAll(a.materials, b.materials);
}

bool Same(const Camera& a, const Camera& b) {
  return a.position == b.position && a.target == b.target && a.up == b.up && a.vertical_fov == b.vertical_fov;
}

Session::Session(Scene opened) : scene(std::move(opened)), on_disk_(scene), file_camera_(scene.camera), committed_(Current()) {}

void Session::Set(const Edits& edits) {
  scene.lights = edits.lights;
  scene.materials = edits.materials;
  scene.exposure = edits.exposure;
  light = std::min(light, static_cast<int>(scene.lights.size()) - 1);
}

void Session::Commit() {
  Edits now = Current();
  if (Same(now, committed_)) return;
  undo_.push_back(std::exchange(committed_, std::move(now)));
  if (undo_.size() > kMaxUndo) undo_.erase(undo_.begin());
  redo_.clear();
}

void Session::Undo() {
  Commit();
  if (undo_.empty()) return;
  redo_.push_back(std::exchange(committed_, std::move(undo_.back())));
  undo_.pop_back();
  Set(committed_);
}

void Session::Redo() {
  Commit();
  if (redo_.empty()) return;
  undo_.push_back(std::exchange(committed_, std::move(redo_.back())));
  redo_.pop_back();
  Set(committed_);
}

bool Session::Dirty() const {
  return !Same(Current(), {on_disk_.lights, on_disk_.materials, on_disk_.exposure}) || !Same(file_camera_, on_disk_.camera);
}

void Session::Save() {
  Scene saved = scene;
  saved.camera = file_camera_;
  SaveScene(on_disk_, saved);
  on_disk_ = std::move(saved);
}

void Session::Replace(Scene from_disk, bool keep_camera) {
  const Camera camera = scene.camera;
  scene = std::move(from_disk);
  on_disk_ = scene;
  file_camera_ = scene.camera;
  ++geometry;
  if (keep_camera) scene.camera = camera;
  light = std::min(light, static_cast<int>(scene.lights.size()) - 1);
  material = std::min(material, static_cast<int>(scene.materials.size()) - 1);
  committed_ = Current();
  undo_.clear();
  redo_.clear();
}

Scene OpenScene(const std::string& name_or_path) {
  return LoadScene(FindScene(name_or_path));
}

std::filesystem::path ConfigFolder() {
  std::filesystem::path folder;
  if (const char* config = std::getenv("XDG_CONFIG_HOME"); config != nullptr && *config != '\0') {
    folder = config;
  } else if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0') {
    folder = std::filesystem::path(home) / ".config";
  } else {
    return {};
  }
  folder /= "arealab";
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  return error ? std::filesystem::path() : folder;
}

}  // namespace arealab
