#include "compare/truth_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <system_error>
#include <type_traits>

#include "compare/cache_file.h"
#include "compare/content_hash.h"
#include "compare/shadowed_truth.h"
#include "compare/truth_bands.h"

namespace arealab {
namespace {

// Changes whenever the integrator's results or the layout of the files change.
constexpr std::uint64_t kTruthVersion = 8;
constexpr std::uint64_t kShadowVersion = 5;  // of the visibility on top of it
constexpr std::uint64_t kTexturedSkyVersion = 1;
struct Header {
  std::uint64_t version, width, rows;
  double seconds;
};

// What Encode made for this size; nothing where it is anything else.
std::optional<TruthBand> Decode(const std::optional<std::string>& entry, int width, int rows) {
  const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(rows);
  Header header{};
  if (!entry || entry->size() != sizeof header + count * (2 * sizeof(glm::vec3) + sizeof(float))) return std::nullopt;
  const char* from = entry->data();
  const auto take = [&](void* data, std::size_t size) {
    std::memcpy(data, from, size);
    from += size;
  };
  take(&header, sizeof header);
  if (header.version != kTruthVersion || header.width != static_cast<std::uint64_t>(width) ||
      header.rows != static_cast<std::uint64_t>(rows)) {
    return std::nullopt;
  }
  TruthBand band;
  band.diffuse.resize(count);
  band.specular.resize(count);
  band.relative_error.resize(count);
  band.seconds = header.seconds;
  take(band.diffuse.data(), count * sizeof(glm::vec3));
  take(band.specular.data(), count * sizeof(glm::vec3));
  take(band.relative_error.data(), count * sizeof(float));
  return band;
}

std::string Encode(int width, int rows, const TruthBand& band) {
  const Header header{kTruthVersion, static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(rows), band.seconds};
  std::string bytes;
  const auto append = [&](const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); };
  append(&header, sizeof header);
  append(band.diffuse.data(), band.diffuse.size() * sizeof(glm::vec3));
  append(band.specular.data(), band.specular.size() * sizeof(glm::vec3));
  append(band.relative_error.data(), band.relative_error.size() * sizeof(float));
  return bytes;
}

void AddVector(ContentHash& hash, const glm::dvec3& v) {
  hash.Value(v.x);
  hash.Value(v.y);
  hash.Value(v.z);
}

void AddImage(ContentHash& hash, const Image& image) {
  hash.Value(image.width);
  hash.Value(image.height);
  hash.Bytes(image.pixels.data(), image.pixels.size() * sizeof(glm::vec4));
}

void AddTruth(ContentHash& hash, const Scene& scene, const SurfacePixels& pixels, const TruthOptions& options) {
  hash.Value(kTruthVersion);
  hash.Value(options.tolerance);
  hash.Value(pixels.width);
  hash.Value(pixels.height);
  AddVector(hash, glm::dvec3(pixels.view_position));
  if (scene.brdf != Brdf::kGgx) hash.Value(scene.brdf);  // left out, the default's truths keep their names
  if (scene.diffuse != Brdf::kLambert) hash.Value(scene.diffuse);
  if (scene.sky) AddVector(hash, scene.sky->radiance);
  if (scene.sky && scene.sky->texture) {
    hash.Value(kTexturedSkyVersion);
    hash.Value(scene.sky->turn);
    AddImage(hash, *scene.sky->texture);
  }
  for (const Light& light : scene.lights) {
    hash.Value(light.shape);
    hash.Value(light.two_sided);
    AddVector(hash, light.center);
    AddVector(hash, light.axis_x);
    AddVector(hash, light.axis_y);
    AddVector(hash, light.normal);
    hash.Value(light.half_size.x);
    hash.Value(light.half_size.y);
    for (const glm::dvec2& corner : light.corners) {
      hash.Value(corner.x);
      hash.Value(corner.y);
    }
    AddVector(hash, light.radiance);
    if (!light.texture) continue;
    AddImage(hash, *light.texture);
  }
  hash.Bytes(pixels.position.data(), pixels.position.size() * sizeof(glm::vec4));
  hash.Bytes(pixels.normal.data(), pixels.normal.size() * sizeof(glm::vec4));
  hash.Bytes(pixels.base_color.data(), pixels.base_color.size() * sizeof(glm::vec4));
}

}  // namespace

void AddTriangles(ContentHash& hash, const Scene& scene) {
  for (const Mesh& mesh : scene.meshes) {
    hash.Value(mesh.vertices.size());
    hash.Value(mesh.indices.size());
    for (const Vertex& vertex : mesh.vertices) {
      hash.Bytes(&vertex.position, sizeof vertex.position);
      hash.Bytes(&vertex.normal, sizeof vertex.normal);
    }
    hash.Bytes(mesh.indices.data(), mesh.indices.size() * sizeof mesh.indices[0]);
  }
}

std::string TruthKey(const Scene& scene, const SurfacePixels& pixels, const TruthOptions& options) {
  ContentHash hash;
  AddTruth(hash, scene, pixels, options);
  return hash.Name();
}

std::string ShadowKey(const Scene& scene, const SurfacePixels& pixels, const TruthOptions& truth_options,
                      const ShadowOptions& options) {
  ContentHash hash;
  AddTruth(hash, scene, pixels, truth_options);
  hash.Value(kShadowVersion);
  hash.Value(options.tolerance);
  AddTriangles(hash, scene);
  return hash.Name();
}

CachedPicture CachedBands(const SurfacePixels& pixels, const std::string& key,
                          const std::function<BandShader()>& make_shader,
                          const std::function<void(double)>& progress, const std::filesystem::path& cache_folder) {
  const std::string whole_name = key + ".truth", parts = key + ".parts";
  if (auto whole = Decode(ReadCacheEntry(cache_folder, whole_name), pixels.width, pixels.height)) {
    return {std::move(*whole), true};
  }
  auto start = std::chrono::steady_clock::now();
  const auto part_name = [&](int band) { return fmt::format("{}/{}.rows", parts, band * kTruthBandRows); };
  auto rows = [&](int band) { return std::min(kTruthBandRows, pixels.height - band * kTruthBandRows); };

  int band_count = (pixels.height + kTruthBandRows - 1) / kTruthBandRows;
  std::vector<TruthBand> bands(static_cast<std::size_t>(band_count));
  std::vector<bool> wanted(bands.size(), true);
  double reused_seconds = 0.0;
  for (int b = 0; b < band_count; ++b) {
    if (auto band = Decode(ReadCacheEntry(cache_folder, part_name(b)), pixels.width, rows(b))) {
      reused_seconds += band->seconds;
      bands[static_cast<std::size_t>(b)] = std::move(*band);
      wanted[static_cast<std::size_t>(b)] = false;
    }
  }
  const bool missing = std::find(wanted.begin(), wanted.end(), true) != wanted.end();
  ShadeBands(pixels.height, missing ? make_shader() : BandShader(), progress, bands, wanted,
             [&](int b, const TruthBand& band) {
               WriteCacheEntry(cache_folder, part_name(b), Encode(pixels.width, rows(b), band));
             });
  TruthBand whole = JoinBands(std::move(bands));
  whole.seconds =
      reused_seconds + std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  WriteCacheEntry(cache_folder, whole_name, Encode(pixels.width, pixels.height, whole));
  std::error_code ignored;
  std::filesystem::remove_all(cache_folder / parts, ignored);
  return {std::move(whole), false};
}

Truth CachedTruth(const Scene& scene, const SurfacePixels& pixels, const TruthOptions& options,
                  const std::filesystem::path& cache_folder) {
  CachedPicture picture = CachedBands(
      pixels, TruthKey(scene, pixels, options),
      [&] { return UnshadowedBands(scene, pixels, options.tolerance); }, options.progress, cache_folder);
  Truth truth = AssembleTruth(pixels, std::move(picture.whole));
  truth.cached = picture.cached;
  return truth;
}

}  // namespace arealab
