// Truth with visibility: what the lights do to each pixel past the scene's surfaces. It stands beside the
// unshadowed truth, which techniques are ranked against.
#pragma once

#include <filesystem>

#include "compare/truth.h"

namespace arealab {

struct ShadowOptions {
  double tolerance = 0.02;  // standard error aimed at, relative to the pixel's unshadowed radiance
  std::function<void(double)> progress;  // fraction done in [0, 1]; may be empty; called from one thread
};

struct ShadowedTruth {
  RadianceImage radiance;
  // Standard error per pixel, relative to its *unshadowed* radiance (over RGB sums); 0 where no ray was
  // needed.
  std::vector<float> relative_error;
  double mean_error = 0.0, p99_error = 0.0;  // of those, over the pixels that needed rays
  int sampled_pixels = 0;                    // how many did
  double seconds = 0.0;                      // computing time of the run that made it
  bool cached = false;
};

// Each pixel and light in the cheapest way that is right:
//   nothing can be in the way (RayQuery::MayBlock of the shaft from the point to the light): the unshadowed
//   value, bit for bit;
//   else the unshadowed noise-free integral times Σ f·V / Σ f over scrambled Sobol' directions, of the
//   light's solid angle and, where the lobe is narrow against the light, of the lobe's visible facets
//   (balance heuristic). The standard error is that of sixteen groups, each a net by itself; together they
//   are a finer net than sixteen at random, so that it is rather too large. The light that adds most to it is
//   sampled twice as densely until the tolerance is met, from 32 directions of a kind up to 512.
// If all rays of a light agree (all free, all blocked) the integral is taken whole or not at all, and half a
// ray's share is stated as its error. Same bits on any number of threads: the seeds are the pixel's and the
// light's numbers. `unshadowed` is ComputeTruth's of the same scene and pixels with truth_options.
ShadowedTruth ComputeShadowedTruth(const Scene& scene, const SurfacePixels& pixels,
                                   const RadianceImage& unshadowed, const TruthOptions& truth_options,
                                   const ShadowOptions& options = {});

// The same from the folder of compare/truth_cache.h where it is there, else computed and stored, by the same
// rules. The entry's name depends on the scene's triangles too.
ShadowedTruth CachedShadowedTruth(const Scene& scene, const SurfacePixels& pixels,
                                  const RadianceImage& unshadowed, const TruthOptions& truth_options,
                                  const ShadowOptions& options, const std::filesystem::path& cache_folder);
std::string ShadowKey(const Scene& scene, const SurfacePixels& pixels, const TruthOptions& truth_options,
                      const ShadowOptions& options);

}  // namespace arealab
