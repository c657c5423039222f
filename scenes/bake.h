// What of its hemisphere each vertex sees, held as one spherical cap: the ambient aperture [Oat 2006].
#pragma once

#include <functional>

#include "scenes/scene.h"

namespace arealab {

// Fills every mesh's `apertures`. Of each vertex, by scene.aperture->rays even directions ω over the hemisphere about its
// normal, with V = 1 where a ray meets no surface:
//   xyz, unit: the mean visible direction ∫ V ω dω, normalised ["Visible direction"]; the normal where nothing is seen;
//   w: the versine 1 − cos r of the cap whose area 2π w is the visible area ∫ V dω ["Visible area", without its further
//      2π]: 0 where nothing is seen, 1 where all of the hemisphere is.
// Four floats. Lights stop no ray, surfaces do from either side. Same bits on any number of threads.
// progress: fraction of the vertices done; may be empty; called from one thread at a time.
void BakeApertures(Scene& scene, const std::function<void(double)>& progress = {});

// Whether every mesh has an aperture at each vertex.
bool HasApertures(const Scene& scene);

}  // namespace arealab
