#include "compare/aperture_cache.h"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <system_error>

#include "compare/content_hash.h"
#include "compare/truth_bands.h"
#include "scenes/bake.h"

namespace arealab {
namespace {

constexpr std::uint64_t kApertureVersion = 3;  // changes whenever the bake's results or the file's layout change

std::uint64_t Checksum(const Scene& scene) {
  ContentHash hash;
  for (const Mesh& mesh : scene.meshes) hash.Bytes(mesh.apertures.data(), mesh.apertures.size() * sizeof(Aperture));
  return hash.low();
}

// Every mesh's apertures, then the checksum.
bool Read(const std::filesystem::path& file, Scene& scene) {
  std::ifstream in(file, std::ios::binary);
  for (Mesh& mesh : scene.meshes) {
    mesh.apertures.resize(mesh.vertices.size());
    in.read(reinterpret_cast<char*>(mesh.apertures.data()),
            static_cast<std::streamsize>(mesh.apertures.size() * sizeof(Aperture)));
  }
  std::uint64_t checksum = 0;
  in.read(reinterpret_cast<char*>(&checksum), sizeof checksum);
  return in && in.peek() == std::ifstream::traits_type::eof() && checksum == Checksum(scene);
}

void Write(const std::filesystem::path& file, const Scene& scene) {
  std::filesystem::path part = file;
  part += fmt::format(".{}.tmp", ::getpid());
  std::error_code ignored;
  std::filesystem::create_directories(file.parent_path(), ignored);
  std::ofstream out(part, std::ios::binary | std::ios::trunc);
  for (const Mesh& mesh : scene.meshes) {
    out.write(reinterpret_cast<const char*>(mesh.apertures.data()),
              static_cast<std::streamsize>(mesh.apertures.size() * sizeof(Aperture)));
  }
  const std::uint64_t checksum = Checksum(scene);
  out.write(reinterpret_cast<const char*>(&checksum), sizeof checksum);
  out.close();
  if (out) std::filesystem::rename(part, file, ignored);
  if (!out || ignored) std::filesystem::remove(part, ignored);
}

}  // namespace

bool CachedApertures(Scene& scene, const std::filesystem::path& cache_folder,
                     const std::function<void(double)>& progress) {
  if (!scene.aperture) return false;
  ContentHash hash;
  hash.Value(kApertureVersion);
  hash.Value(scene.aperture->rays);
  AddTriangles(hash, scene);
  const std::filesystem::path file = cache_folder / (hash.Name() + ".apertures");
  if (Read(file, scene)) return true;
  BakeApertures(scene, progress);
  Write(file, scene);
  return false;
}

}  // namespace arealab
