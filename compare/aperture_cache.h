// Apertures already baked, by content, on disk.
#pragma once

#include <filesystem>
#include <functional>

#include "scenes/scene.h"

namespace arealab {

// Bakes what the scene asks for (scenes/bake.h), or reads it from the folder where it is there; does nothing where the
// scene asks for none. The entry's name is a hash of the triangles and the settings; see compare/cache_file.h for how it is kept.
// True where they were there.
bool CachedApertures(Scene& scene, const std::filesystem::path& cache_folder,
                     const std::function<void(double)>& progress = {});

}  // namespace arealab
