// What of its hemisphere each vertex sees, held as spherical caps: ambient apertures [Oat 2006].
#pragma once

#include <functional>

#include "scenes/scene.h"

namespace arealab {

// Fills every mesh's `apertures`. Of each vertex, by scene.aperture->rays even directions ω over the hemisphere about its
// normal, with V = 1 where a ray meets no surface:
// open.xyz, unit: the mean visible direction ∫ V ω dω, normalised ["Visible direction"]; the normal where nothing is seen;
// open.w: the versine 1 − cos r of the cap whose area 2π w is the visible area ∫ V dω ["Visible area", without its further
//   2π]: 0 where nothing is seen, 1 where all of the hemisphere is. These are his four floats.
// region: the same of the two largest contiguous sets of visible directions, the smaller sets joined to the nearer of them
//   ["Multiple visibility apertures"]; neighbouring vertices have them in the order that fits best. With one set the second
//   region is empty, of the first one's axis.
// blocked: the same of 1 − V ["Occlusion anti-apertures"].
// Lights stop no ray, surfaces do from either side. Same bits on any number of threads.
// progress: fraction of the vertices done; may be empty; called from one thread at a time.
void BakeApertures(Scene& scene, const std::function<void(double)>& progress = {});

// Whether every mesh has an aperture at each vertex.
bool HasApertures(const Scene& scene);

}  // namespace arealab
