// Apertures already baked, by content, on disk.
#pragma once

#include <filesystem>
#include <functional>

#include "scenes/scene.h"

namespace arealab {

// Bakes what the scene asks for (scenes/bake.h), or reads it from the folder where it is there; does nothing where the
// scene asks for none. The entry's name is a hash of the triangles and the settings. Entries are written under another
// name and renamed; one that is short, damaged or foreign is baked again. A folder that cannot be written to costs the
// storing, not the apertures. True where they were there.
bool CachedApertures(Scene& scene, const std::filesystem::path& cache_folder,
                     const std::function<void(double)>& progress = {});

}  // namespace arealab
