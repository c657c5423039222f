#include "app/view/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <glm/gtc/constants.hpp>
#include <map>
#include <system_error>
#include <utility>

#include "compare/aperture_cache.h"
#include "scenes/error.h"
#include "scenes/light_texture.h"
#include "scenes/read.h"
#include "scenes/replace_file.h"
#include "scenes/sky.h"
#include "scenes/write.h"

namespace arealab {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMaxUndo = 500;

template <typename T>
bool SameAll(const std::vector<T>& a, const std::vector<T>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const T& x, const T& y) { return Same(x, y); });
}

}  // namespace

bool Same(const Light& a, const Light& b) {
  return a.name == b.name && a.shape == b.shape && a.center == b.center && a.axis_x == b.axis_x && a.axis_y == b.axis_y &&
         a.normal == b.normal && a.half_size == b.half_size && a.corners == b.corners && a.radiance == b.radiance &&
         a.two_sided == b.two_sided && a.texture == b.texture;
}

bool Same(const Material& a, const Material& b) {
  return a.name == b.name && a.base_color == b.base_color && a.roughness == b.roughness && a.metalness == b.metalness && a.specular == b.specular &&
         a.normal_scale == b.normal_scale && a.base_color_texture == b.base_color_texture &&
         a.metallic_roughness_texture == b.metallic_roughness_texture && a.normal_texture == b.normal_texture;
}

bool Same(const Edits& a, const Edits& b) {
  return a.exposure == b.exposure && a.sky == b.sky && SameAll(a.lights, b.lights) && SameAll(a.materials, b.materials);
}

bool Same(const Camera& a, const Camera& b) {
  return a.position == b.position && a.target == b.target && a.up == b.up && a.vertical_fov == b.vertical_fov;
}

Session::Session(Opened opened)
    : scene(std::move(opened.scene)), files(std::move(opened.files)), on_disk_(scene), text_(std::move(opened.text)), file_camera_(scene.camera),
      committed_(Current()) {}

const Snapshot* Session::SnapshotOf(const ShownVariant& pane) const {
  const auto found = std::ranges::find(snapshots, pane.name, &Snapshot::name);
  return found == snapshots.end() ? nullptr : &*found;
}

void Session::Keep(const ShadedVariant& picture) {
  if (snapshots.size() == kMostSnapshots) Drop(std::string(snapshots.front().name));
  Snapshot kept{fmt::format("#{}", ++snapshots_kept_), "", picture, picture};
  kept.label = fmt::format("{} {}", kept.name, picture.variant.name);
  constexpr int kWidth = 192;  // px of the thumbnail
  const RadianceImage& whole = *picture.image;
  const int width = std::min(kWidth, whole.width), height = std::max(1, whole.height * width / whole.width);
  auto image = std::make_shared<RadianceImage>(RadianceImage{width, height, {}, {}});
  auto emission = std::make_shared<std::vector<glm::vec3>>();
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto i = static_cast<std::size_t>(y * whole.height / height) * static_cast<std::size_t>(whole.width) + static_cast<std::size_t>(x * whole.width / width);
      image->diffuse.push_back(whole.diffuse[i]);
      image->specular.push_back(whole.specular[i]);
      emission->push_back((*picture.emission)[i]);
    }
  }
  kept.thumbnail.image = std::move(image);
  kept.thumbnail.emission = std::move(emission);
  snapshots.push_back(std::move(kept));
}

void Session::Drop(const std::string& snapshot) {
  const auto found = std::ranges::find(snapshots, snapshot, &Snapshot::name);
  if (found == snapshots.end()) return;
  for (ShownVariant& pane : panes) {
    if (pane.name == snapshot) pane = found->picture.variant;
  }
  snapshots.erase(found);
}

const std::vector<Effect>& Session::Effects() {
  if (!effects_of_ || !Same(std::get<Edits>(*effects_of_), Current()) || !Same(std::get<Camera>(*effects_of_), scene.camera) ||
      std::get<std::uint64_t>(*effects_of_) != geometry) {
    effects_ = SceneEffects(scene);
    effects_of_.emplace(Current(), scene.camera, geometry);
  }
  return effects_;
}

void Session::Set(const Edits& edits) {
  scene.lights = edits.lights;
  scene.materials = edits.materials;
  scene.exposure = edits.exposure;
  scene.sky = edits.sky;
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
  return !Same(Current(), {on_disk_.lights, on_disk_.materials, on_disk_.exposure, on_disk_.sky}) || !Same(file_camera_, on_disk_.camera);
}

Scene Session::Saved() const {
  Scene saved = scene;
  saved.camera = file_camera_;
  return saved;
}

void Session::Save() {
  Scene saved = Saved();
  if (!text_.empty()) ReplaceFile(scene.file, text_);
  text_.clear();
  SaveScene(on_disk_, saved);
  on_disk_ = std::move(saved);
  std::error_code error;
  std::filesystem::remove(AutosaveFile(), error);
  autosaved_ = Current();
}

// Named by the scene file's whole path, of which any character may be in a file name but the separator.
fs::path Session::AutosaveFile() const {
  fs::path folder;
  if (const char* state = std::getenv("XDG_STATE_HOME"); state != nullptr && *state != '\0') {
    folder = state;
  } else if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0') {
    folder = fs::path(home) / ".local" / "state";
  } else {
    return {};
  }
  std::error_code error;
  std::string name = fs::absolute(scene.file, error).string();
  std::replace(name.begin(), name.end(), '/', '%');
  return folder / "arealab" / name;
}

void Session::Autosave() {
  const fs::path file = AutosaveFile();
  const Edits now = Current();
  if (file.empty() || (autosaved_ && Same(*autosaved_, now))) return;
  std::error_code error;
  if (!Dirty()) {
    // What an earlier session left stays until this one has something of its own to say.
    if (autosaved_) fs::remove(file, error);
    if (autosaved_) autosaved_ = now;
    return;
  }
  fs::create_directories(file.parent_path(), error);
  try {
    ReplaceFile(file, EditedSceneText());
  } catch (const InputError&) {
    // A folder that cannot be written to takes away the safety net, not the work.
  }
  autosaved_ = now;
}

bool Session::HasLeftBehind() const {
  std::error_code error;
  const fs::path file = AutosaveFile();
  return !file.empty() && fs::is_regular_file(file, error) &&
         fs::last_write_time(file, error) >= (fs::exists(scene.file, error) ? fs::last_write_time(scene.file, error) : fs::file_time_type::min());
}

void Session::Restore() {
  const Scene left = ParseScene(scene.file, ReadSceneText(AutosaveFile()));
  Set({left.lights, left.materials, left.exposure, left.sky});
  Commit();
}

std::set<fs::path> Session::Files() const {
  std::set<fs::path> all = files;
  all.insert(scene.file);
  const fs::path folder = FolderOf(scene.file);
  for (const Light& each : scene.lights) {
    if (each.texture) all.insert(folder / each.texture_path);
  }
  if (scene.sky && scene.sky->texture) all.insert(folder / scene.sky->texture_path);
  return all;
}

std::string Session::ImagePath(const std::string& light_name, const fs::path& file) const {
  const auto shown = std::ranges::find(scene.lights, light_name, &Light::name);
  if (shown != scene.lights.end() && shown->shape != LightShape::kRectangle) {
    throw InputError(fmt::format("{}: the light '{}' is a {}; expected a rectangle to show an image", file.string(), shown->name, Name(shown->shape)));
  }
  std::error_code error;
  const fs::path folder = FolderOf(scene.file);
  const fs::path relative = fs::relative(file, folder, error);
  if (error || relative.empty() || *relative.begin() == "..") {
    throw InputError(fmt::format("{}: outside {}; expected an image in the scene's folder, where the scene file can name it", file.string(), folder.string()));
  }
  return relative.generic_string();
}

void Session::ShowImage(const std::string& light_name, const std::string& path, std::shared_ptr<const Image> image) {
  if (light_name.empty()) {
    if (!scene.sky) scene.sky.emplace(glm::dvec3(1.0));
    scene.sky->texture = std::move(image);
    scene.sky->texture_path = path;
    return;
  }
  const auto shown = std::ranges::find(scene.lights, light_name, &Light::name);
  if (shown == scene.lights.end() || shown->shape != LightShape::kRectangle) {
    throw InputError(fmt::format("{}: the light '{}' that it was for is gone; expected one to drop it on", path, light_name));
  }
  shown->texture = std::move(image);
  shown->texture_path = path;
  light = static_cast<int>(shown - scene.lights.begin());
}

std::shared_ptr<const Image> LoadShownImage(const fs::path& file, bool sky) {
  try {
    return sky ? LoadSkyTexture(file) : LoadLightTexture(file);
  } catch (const InputError& trouble) {
    throw InputError(fmt::format("{}: {}", file.string(), trouble.what()));
  }
}

int Session::AddLight() {
  Light added = light >= 0 ? scene.lights[static_cast<std::size_t>(light)] : scene.lights.front();
  added.center += glm::dvec3(2.2 * added.half_size.x, 0.0, 0.0);
  const auto taken = [&](const std::string& name) {
    return std::any_of(scene.lights.begin(), scene.lights.end(), [&](const Light& other) { return other.name == name; });
  };
  for (int i = 2; taken(added.name); ++i) added.name = fmt::format("light {}", i);
  scene.lights.push_back(std::move(added));
  return light = static_cast<int>(scene.lights.size()) - 1;
}

void Session::RemoveLight() {
  if (light < 0 || scene.lights.size() < 2) return;
  scene.lights.erase(scene.lights.begin() + light);
  light = -1;
}

void Session::Replace(Scene from_disk) {
  const Camera camera = scene.camera;
  scene = std::move(from_disk);
  on_disk_ = scene;
  file_camera_ = scene.camera;
  ++geometry;
  scene.camera = camera;
  light = std::min(light, static_cast<int>(scene.lights.size()) - 1);
  material = std::min(material, static_cast<int>(scene.materials.size()) - 1);
  committed_ = Current();
  undo_.clear();
  redo_.clear();
}

std::string Session::EditedSceneText() const { return EditedText(text_.empty() ? ReadSceneText(scene.file) : text_, on_disk_, Saved()); }

bool Session::Refresh(const Scene& edited) {
  const auto same = [](const Material& a, const Material& b) {
    const auto values = [](const Material& m) {
      return std::array{m.base_color.x, m.base_color.y, m.base_color.z, m.roughness.x, m.roughness.y, m.metalness, m.specular, m.normal_scale};
    };
    return a.name == b.name && std::ranges::equal(values(a), values(b), [](float x, float y) { return std::abs(x - y) <= 1e-6f * std::abs(x); });
  };
  if (!std::ranges::equal(edited.materials, scene.materials, same)) return false;
  std::map<const Image*, std::shared_ptr<const Image>> newer;
  const auto pair = [&](const std::shared_ptr<const Image>& old, const std::shared_ptr<const Image>& now) { newer[old.get()] = now; };
  for (const Light& now : edited.lights) {
    const auto old = std::ranges::find(scene.lights, now.name, &Light::name);
    if (old != scene.lights.end()) pair(old->texture, now.texture);
  }
  for (const Material& now : edited.materials) {
    const auto old = std::ranges::find(scene.materials, now.name, &Material::name);
    if (old == scene.materials.end()) continue;
    pair(old->base_color_texture, now.base_color_texture);
    pair(old->metallic_roughness_texture, now.metallic_roughness_texture);
    pair(old->normal_texture, now.normal_texture);
  }
  if (scene.sky && edited.sky) pair(scene.sky->texture, edited.sky->texture);
  newer.erase(nullptr);
  const auto renew = [&](auto& state) {  // a scene, or the edits of one
    const auto image = [&](std::shared_ptr<const Image>& one) {
      if (const auto found = newer.find(one.get()); found != newer.end()) one = found->second;
    };
    for (Light& each : state.lights) image(each.texture);
    for (Material& each : state.materials) {
      for (auto* texture : {&each.base_color_texture, &each.metallic_roughness_texture, &each.normal_texture}) image(*texture);
    }
    if (state.sky) image(state.sky->texture);
  };
  renew(scene);
  renew(on_disk_);
  renew(committed_);
  for (std::vector<Edits>* stack : {&undo_, &redo_}) std::ranges::for_each(*stack, renew);
  scene.meshes = edited.meshes;
  on_disk_.meshes = edited.meshes;
  ++geometry;
  return true;
}

namespace {

bool IsMesh(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const char* known : {".gltf", ".glb", ".obj", ".ply", ".stl", ".3ds"}) {
    if (extension == known) return true;
  }
  return false;
}

// A mesh of a metre's height on a floor, a softbox at its upper left, a camera that holds all of it.
Opened MeshScene(const fs::path& mesh) {
  const bool gltf = mesh.extension() == ".gltf" || mesh.extension() == ".glb";
  const auto text = [&](const glm::dvec3& eye, double floor) {
    return fmt::format(
        "# How does {0} look under a softbox?\n[camera]\nposition = [{1:.3f}, {2:.3f}, {3:.3f}]\ntarget = [0.0, 0.0, 0.45]\n"
        "vertical_fov = 35.0\n\n[[material]]\nname = \"clay\"\nbase_color = 0.5\nroughness = 0.4\n\n[[material]]\n"
        "name = \"floor\"\nbase_color = 0.25\nroughness = 0.35\n\n[[surface]]\ntype = \"mesh\"\nfile = \"{0}\"\nheight = 1.0\n{5}"
        "\n[[surface]]\ntype = \"plane\"\nsize = [{4:.3f}, {4:.3f}]\nmaterial = \"floor\"\n\n[[light]]\nname = \"softbox\"\n"
        "shape = \"rectangle\"\nposition = [-1.6, -0.9, 1.9]\ntarget = [0.0, 0.0, 0.45]\nsize = [1.4, 1.4]\nradiance = 6.0\n",
        mesh.filename().string(), eye.x, eye.y, eye.z, floor, gltf ? "" : mesh.extension() == ".obj" ? "up = \"y\"\nmaterial = \"clay\"\n" : "material = \"clay\"\n");
  };
  fs::path file = mesh;
  file.replace_extension(".toml");
  if (fs::exists(file)) file.replace_filename(mesh.stem().string() + "_view.toml");
  const glm::dvec3 eye(0.9, -3.2, 1.5);
  Scene scene = ParseScene(file, text(eye, 6.0));
  // The floor is the last surface; the rest is what the camera is to hold.
  double radius = 0.5;
  for (std::size_t i = 0; i + 1 < scene.meshes.size(); ++i) {
    for (const Vertex& vertex : scene.meshes[i].vertices) {
      radius = std::max(radius, glm::distance(glm::dvec3(vertex.position), glm::dvec3(0.0, 0.0, 0.45)));
    }
  }
  const double reach = radius / std::sin(0.5 * scene.camera.vertical_fov);
  const glm::dvec3 target(0.0, 0.0, 0.45);
  const std::string framed = text(target + reach * glm::normalize(eye - target), std::max(6.0, 8.0 * radius));
  Opened opened{{}, framed};
  opened.scene = ParseScene(file, framed, opened.files);
  return opened;
}

}  // namespace

Opened OpenScene(const std::string& name_or_path, const fs::path& cache) {
  if (IsMesh(name_or_path) && fs::is_regular_file(name_or_path)) return MeshScene(name_or_path);
  Opened opened;
  opened.scene = LoadWithApertures(FindScene(name_or_path), cache, opened.files);
  return opened;
}

Scene LoadWithApertures(const fs::path& file, const fs::path& cache, std::set<fs::path>& files, const std::string& text) {
  files.insert(file);
  Scene scene = ParseScene(file, text.empty() ? ReadSceneText(file) : text, files);
  CachedApertures(scene, cache);
  return scene;
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
