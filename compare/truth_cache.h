// Truths already computed, by content. Not stored yet: every call computes.
#pragma once
#include <filesystem>
#include "compare/truth.h"
namespace arealab {
inline Truth CachedTruth(const Scene& scene, const SurfacePixels& pixels, const TruthOptions& options, const std::filesystem::path&) {
  return ComputeTruth(scene, pixels, options);
}
}  // namespace arealab
