// The cache's readers. The first byte chooses the entry, and whether the others are its file or what a sound envelope holds.
#include <fmt/format.h>

#include <cstring>

#include "compare/aperture_cache.h"
#include "compare/cache_file.h"
#include "compare/truth_cache.h"
#include "scenes/bake.h"
#include "scenes/shapes.h"
#include "tests/fuzz/targets.h"

namespace arealab::fuzz {
namespace {

Scene TinyScene() {
  Scene scene;
  scene.materials.emplace_back();
  scene.meshes.push_back(MakePlane({1.0, 1.0}, {}));
  Light& light = scene.lights.emplace_back();
  light.center = {0.0, 0.0, 1.0};
  light.axis_y = {0.0, -1.0, 0.0};
  light.normal = {0.0, 0.0, -1.0};
  scene.aperture.emplace().rays = 16;
  return scene;
}

SurfacePixels TinyPixels() {
  SurfacePixels pixels;
  pixels.width = 2;
  pixels.height = 1;
  pixels.view_position = {0.0f, -1.0f, 1.0f};
  pixels.position.assign(2, {0.1f, 0.2f, 0.0f, static_cast<float>(PixelKind::kSurface)});
  pixels.normal.assign(2, {0.0f, 0.0f, 1.0f, 0.5f});
  pixels.base_color.assign(2, {0.8f, 0.8f, 0.8f, 0.0f});
  return pixels;
}

}  // namespace

void CacheEntry(Bytes bytes) {
  static const Scene scene = TinyScene();
  static const SurfacePixels pixels = TinyPixels();
  static const Truth truth = ComputeTruth(scene, pixels);
  static const std::string key = TruthKey(scene, pixels, {});
  static const Scene baked = [] {
    Scene made = scene;
    BakeApertures(made);
    return made;
  }();
  static const std::string aperture_name = [] {
    Scene made = scene;
    CachedApertures(made, Folder() / "name");
    return std::filesystem::directory_iterator(Folder() / "name")->path().filename().string();
  }();
  if (bytes.empty()) return;
  const std::filesystem::path cache = Folder() / "cache";
  const std::string names[] = {key + ".truth", fmt::format("{0}.parts/0.rows", key), aperture_name};
  const std::string& name = names[bytes[0] / 2 % std::size(names)];
  const bool sound_envelope = bytes[0] % 2 == 1;
  const std::string text = Text(bytes.subspan(1));
  std::filesystem::create_directories((cache / name).parent_path());
  if (sound_envelope) {
    WriteCacheEntry(cache, name, text);
  } else {
    File("cache/" + name, text);
  }
  const int damaged = DamagedCacheEntries();
  if (name == aperture_name) {
    Scene read = scene;
    const bool cached = CachedApertures(read, cache);
    Require(read.meshes[0].apertures.size() == baked.meshes[0].apertures.size(), "apertures missing");
    const auto size = baked.meshes[0].apertures.size() * sizeof(Aperture);
    Require(cached || std::memcmp(read.meshes[0].apertures.data(), baked.meshes[0].apertures.data(), size) == 0, "other apertures");
    Require(!cached || sound_envelope || DamagedCacheEntries() == damaged, "a damaged entry was taken");
  } else {
    const Truth read = CachedTruth(scene, pixels, {}, cache);
    Require(read.radiance.diffuse.size() == pixels.size() && read.radiance.specular.size() == pixels.size(), "pixels missing");
    const bool same = std::memcmp(read.radiance.diffuse.data(), truth.radiance.diffuse.data(), 2 * sizeof(glm::vec3)) == 0 &&
                      std::memcmp(read.radiance.specular.data(), truth.radiance.specular.data(), 2 * sizeof(glm::vec3)) == 0;
    Require(same || DamagedCacheEntries() == damaged, "a damaged entry was taken");
  }
  std::filesystem::remove_all(cache);
}

}  // namespace arealab::fuzz
