// Ground truth: the light's own integrals over the G-buffer, in double, on all cores, deterministic.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "glsl/pixels.h"
#include "scenes/scene.h"

namespace arealab {

// What one light does to one shaded point, for white albedo and unit radiance.
struct LightIntegrals {
  double form_factor = 0.0;  // ∫ cosθ_i / π dω over the visible light; of another diffuse BRDF than Lambert's ∫ f cosθ_i dω
  double specular = 0.0;     // ∫ f cosθ_i dω with Fresnel 1; of ggx ∫ D G2 / (4 cosθ_o) dω
  double specular_grazing =
      0.0;  // the same weighted by (1 − h·v)^5: radiance = F0·(specular − grazing) + grazing
  double form_factor_error = 0.0;  // absolute, estimated, each at least its rounding error
  double specular_error = 0.0;
  double specular_grazing_error = 0.0;
};

struct ShadingPoint {
  glm::dvec3 position;  // m, world
  glm::dvec3 normal;    // unit
  glm::dvec3 to_view;   // unit
  double alpha;         // roughness²
  Brdf brdf = Brdf::kGgx;
  Brdf diffuse = Brdf::kLambert;
  double roughness = 0.0;  // for a diffuse BRDF other than Lambert's
};

// Throws nothing. The specular lobe is that of `brdf`, which may be a diffuse one too, with alpha = 1. A point turned away from the viewer, or a light wholly below the horizon or facing away,
// gives zeros.
LightIntegrals IntegrateLight(const ShadingPoint& point, const Light& light, double tolerance);

struct Truth {
  RadianceImage radiance;
  std::vector<float> relative_error;  // per pixel, of the total; 0 where nothing is lit
  double worst_relative_error = 0.0;  // over pixels, at p99.9
  double seconds = 0.0;               // computing time of the run that made it
  bool cached = false;
};

struct TruthOptions {
  double tolerance = 1e-4;               // relative, per pixel and light
  std::function<void(double)> progress;  // fraction done in [0, 1]; may be empty; called from one thread
};

// Unshadowed truth of every surface pixel. Lights hide each the sky behind them, from their lit sides; the dark side of a light is
// not there. Same bits on any number of threads.
Truth ComputeTruth(const Scene& scene, const SurfacePixels& pixels, const TruthOptions& options = {});

}  // namespace arealab
