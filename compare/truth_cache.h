// Truths already computed, by content, on disk: they survive the program, and a killed run's finished rows
// are used again.
#pragma once

#include <filesystem>
#include <string>

#include "compare/truth.h"

namespace arealab {

// The truth of the scene's lights on these pixels, from the folder where it is there, else computed and
// stored. The name of an entry is a hash of all that the truth depends on (lights, pixels, tolerance, the
// integrator's version); see compare/cache_file.h for how it is kept. `cached` says whether everything was there.
Truth CachedTruth(const Scene& scene, const SurfacePixels& pixels, const TruthOptions& options,
                  const std::filesystem::path& cache_folder);

// The name of the entry: 32 hexadecimal digits.
std::string TruthKey(const Scene& scene, const SurfacePixels& pixels, const TruthOptions& options);

}  // namespace arealab
