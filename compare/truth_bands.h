// Truth in bands of rows: what the threads share out and what the cache stores as it goes.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compare/truth.h"

namespace arealab {

constexpr int kTruthBandRows = 8;

struct TruthBand {
  std::vector<glm::vec3> diffuse, specular;
  std::vector<float> relative_error;
  double seconds = 0.0;  // of one thread
};

// One surface pixel as every integral over lights sees it; nothing for other pixels and for faces turned away
// from the viewer, which shade black.
class ContentHash;
// Positions, normals and indices.
void AddTriangles(ContentHash& hash, const Scene& scene);

struct ShadedPixel {
  ShadingPoint point;
  glm::dvec3 albedo, f0;
  double specular_weight;  // of the whole lobe
};
std::optional<ShadedPixel> ShadedPixelAt(const Scene& scene, const SurfacePixels& pixels, std::size_t i);

// Rows row_begin to row_end − 1 of a picture.
using BandShader = std::function<TruthBand(int row_begin, int row_end)>;

BandShader UnshadowedBands(const Scene& scene, const SurfacePixels& pixels, double tolerance);

// Shades the wanted bands on all threads; calls `done(band index, band)` from any of them as each is
// finished, and `progress` (may be empty) from the calling one.
void ShadeBands(int height, const BandShader& shade, const std::function<void(double)>& progress,
                std::vector<TruthBand>& bands, const std::vector<bool>& wanted,
                const std::function<void(int, const TruthBand&)>& done);

// Bands from the cache folder where they are there; else computed by the shader that `make_shader` gives, and
// stored, whole pictures under `key` (see compare/truth_cache.h). `make_shader` is called only where bands
// are missing.
struct CachedPicture {
  TruthBand whole;
  bool cached = false;
};
CachedPicture CachedBands(const SurfacePixels& pixels, const std::string& key,
                          const std::function<BandShader()>& make_shader,
                          const std::function<void(double)>& progress, const std::filesystem::path& cache_folder);

// All rows of the picture in one band; `seconds` is the sum.
TruthBand JoinBands(std::vector<TruthBand> bands);

Truth AssembleTruth(const SurfacePixels& pixels, TruthBand whole);

// The nearest rank of `share` in [0, 1] among the values; 0 where there are none.
double Quantile(std::vector<float> values, double share);

}  // namespace arealab
