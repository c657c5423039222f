// Truth in bands of rows: what the threads share out and what the cache stores as it goes.
#pragma once

#include <functional>
#include <vector>

#include "compare/truth.h"

namespace arealab {

constexpr int kTruthBandRows = 8;

struct TruthBand {
  std::vector<glm::vec3> diffuse, specular;
  std::vector<float> relative_error;
  double seconds = 0.0;  // of one thread
};

// Rows row_begin to row_end − 1.
TruthBand ShadeBand(const Scene& scene, const SurfacePixels& pixels, int row_begin, int row_end,
                    double tolerance);

// Shades the wanted bands on all threads; calls `done(band index, band)` from any of them as each is
// finished.
void ShadeBands(const Scene& scene, const SurfacePixels& pixels, const TruthOptions& options,
                std::vector<TruthBand>& bands, const std::vector<bool>& wanted,
                const std::function<void(int, const TruthBand&)>& done);

// The whole picture from all of its bands; `seconds` is their sum.
Truth AssembleTruth(const SurfacePixels& pixels, std::vector<TruthBand> bands);

}  // namespace arealab
