#include "compare/truth_cache.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>
#include <system_error>
#include <type_traits>

#include "compare/content_hash.h"
#include "compare/shadowed_truth.h"
#include "compare/truth_bands.h"

namespace arealab {
namespace {

// Changes whenever the integrator's results or the layout of the files change.
constexpr std::uint64_t kTruthVersion = 6;
constexpr std::uint64_t kShadowVersion = 4;  // of the visibility on top of it
constexpr std::array<char, 8> kMagic = {'A', 'L', 'T', 'R', 'U', 'T', 'H', '1'};

struct Header {
  std::array<char, 8> magic;
  std::array<char, 32> key;
  std::uint64_t version, width, rows, checksum;
  double seconds;
};

std::size_t PixelCount(const Header& header) {
  return static_cast<std::size_t>(header.width * header.rows);
}

std::uint64_t Checksum(const TruthBand& band) {
  ContentHash hash;
  hash.Bytes(band.diffuse.data(), band.diffuse.size() * sizeof(glm::vec3));
  hash.Bytes(band.specular.data(), band.specular.size() * sizeof(glm::vec3));
  hash.Bytes(band.relative_error.data(), band.relative_error.size() * sizeof(float));
  return hash.low();
}

// Reads what Write wrote for this key and size; nothing where it is anything else.
std::optional<TruthBand> Read(const std::filesystem::path& file, const std::string& key, int width,
                              int rows) {
  std::ifstream in(file, std::ios::binary);
  Header header{};
  if (!in.read(reinterpret_cast<char*>(&header), sizeof header) || header.magic != kMagic ||
      header.version != kTruthVersion || std::string_view(header.key.data(), header.key.size()) != key ||
      header.width != static_cast<std::uint64_t>(width) || header.rows != static_cast<std::uint64_t>(rows)) {
    return std::nullopt;
  }
  TruthBand band;
  std::size_t count = PixelCount(header);
  band.diffuse.resize(count);
  band.specular.resize(count);
  band.relative_error.resize(count);
  band.seconds = header.seconds;
  auto read = [&](void* data, std::size_t size) {
    in.read(static_cast<char*>(data), static_cast<std::streamsize>(size));
  };
  read(band.diffuse.data(), count * sizeof(glm::vec3));
  read(band.specular.data(), count * sizeof(glm::vec3));
  read(band.relative_error.data(), count * sizeof(float));
  if (!in || in.peek() != std::ifstream::traits_type::eof() || Checksum(band) != header.checksum) {
    return std::nullopt;
  }
  return band;
}

// Under a name of its own, then renamed: a reader sees all of it or nothing. Failures are silent, see
// CachedTruth.
void Write(const std::filesystem::path& file, const std::string& key, int width, int rows,
           const TruthBand& band) {
  static std::atomic<unsigned> serial{0};
  std::filesystem::path part = file;
  part += fmt::format(".{}-{}.tmp", ::getpid(), serial++);
  std::error_code ignored;
  {
    std::ofstream out(part, std::ios::binary | std::ios::trunc);
    Header header{kMagic,
                  {},
                  kTruthVersion,
                  static_cast<std::uint64_t>(width),
                  static_cast<std::uint64_t>(rows),
                  Checksum(band),
                  band.seconds};
    std::memcpy(header.key.data(), key.data(), header.key.size());
    auto write = [&](const void* data, std::size_t size) {
      out.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
    };
    write(&header, sizeof header);
    write(band.diffuse.data(), band.diffuse.size() * sizeof(glm::vec3));
    write(band.specular.data(), band.specular.size() * sizeof(glm::vec3));
    write(band.relative_error.data(), band.relative_error.size() * sizeof(float));
    if (!out.flush()) {
      out.close();
      std::filesystem::remove(part, ignored);
      return;
    }
  }
  std::filesystem::rename(part, file, ignored);
  if (ignored) {
    std::filesystem::remove(part, ignored);
  }
}

void AddVector(ContentHash& hash, const glm::dvec3& v) {
  hash.Value(v.x);
  hash.Value(v.y);
  hash.Value(v.z);
}

void AddTruth(ContentHash& hash, const Scene& scene, const SurfacePixels& pixels, const TruthOptions& options) {
  hash.Value(kTruthVersion);
  hash.Value(options.tolerance);
  hash.Value(pixels.width);
  hash.Value(pixels.height);
  AddVector(hash, glm::dvec3(pixels.view_position));
  if (scene.brdf != Brdf::kGgx) hash.Value(scene.brdf);  // left out, the default's truths keep their names
  if (scene.sky) AddVector(hash, *scene.sky);
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
    hash.Value(light.texture->width);
    hash.Value(light.texture->height);
    hash.Bytes(light.texture->pixels.data(), light.texture->pixels.size() * sizeof(glm::vec4));
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
  const std::filesystem::path whole_file = cache_folder / (key + ".truth"),
                              parts = cache_folder / (key + ".parts");
  if (auto whole = Read(whole_file, key, pixels.width, pixels.height)) {
    return {std::move(*whole), true};
  }
  auto start = std::chrono::steady_clock::now();
  std::error_code ignored;
  std::filesystem::create_directories(parts, ignored);
  auto part_file = [&](int band) { return parts / fmt::format("{}.rows", band * kTruthBandRows); };
  auto rows = [&](int band) { return std::min(kTruthBandRows, pixels.height - band * kTruthBandRows); };

  int band_count = (pixels.height + kTruthBandRows - 1) / kTruthBandRows;
  std::vector<TruthBand> bands(static_cast<std::size_t>(band_count));
  std::vector<bool> wanted(bands.size(), true);
  double reused_seconds = 0.0;
  for (int b = 0; b < band_count; ++b) {
    if (auto band = Read(part_file(b), key, pixels.width, rows(b))) {
      reused_seconds += band->seconds;
      bands[static_cast<std::size_t>(b)] = std::move(*band);
      wanted[static_cast<std::size_t>(b)] = false;
    }
  }
  const bool missing = std::find(wanted.begin(), wanted.end(), true) != wanted.end();
  ShadeBands(pixels.height, missing ? make_shader() : BandShader(), progress, bands, wanted,
             [&](int b, const TruthBand& band) { Write(part_file(b), key, pixels.width, rows(b), band); });
  TruthBand whole = JoinBands(std::move(bands));
  whole.seconds =
      reused_seconds + std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  Write(whole_file, key, pixels.width, pixels.height, whole);
  std::filesystem::remove_all(parts, ignored);
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
