#include "compare/aperture_cache.h"

#include <cstring>
#include <optional>
#include <string>

#include "compare/cache_file.h"
#include "compare/content_hash.h"
#include "compare/truth_bands.h"
#include "scenes/bake.h"

namespace arealab {
namespace {

constexpr std::uint64_t kApertureVersion = 4;  // changes whenever the bake's results or the file's layout change

// Every mesh's apertures.
bool Decode(const std::optional<std::string>& entry, Scene& scene) {
  std::size_t size = 0;
  for (const Mesh& mesh : scene.meshes) size += mesh.vertices.size() * sizeof(Aperture);
  if (!entry || entry->size() != size) return false;
  const char* from = entry->data();
  for (Mesh& mesh : scene.meshes) {
    mesh.apertures.resize(mesh.vertices.size());
    std::memcpy(mesh.apertures.data(), from, mesh.apertures.size() * sizeof(Aperture));
    from += mesh.apertures.size() * sizeof(Aperture);
  }
  return true;
}

std::string Encode(const Scene& scene) {
  std::string bytes;
  for (const Mesh& mesh : scene.meshes) {
    bytes.append(reinterpret_cast<const char*>(mesh.apertures.data()), mesh.apertures.size() * sizeof(Aperture));
  }
  return bytes;
}

}  // namespace

bool CachedApertures(Scene& scene, const std::filesystem::path& cache_folder,
                     const std::function<void(double)>& progress) {
  if (!scene.aperture) return false;
  ContentHash hash;
  hash.Value(kApertureVersion);
  hash.Value(scene.aperture->rays);
  AddTriangles(hash, scene);
  const std::string name = hash.Name() + ".apertures";
  if (Decode(ReadCacheEntry(cache_folder, name), scene)) return true;
  BakeApertures(scene, progress);
  WriteCacheEntry(cache_folder, name, Encode(scene));
  return false;
}

}  // namespace arealab
