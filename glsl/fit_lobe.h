// The reflection lobe that the fitted tables approximate, in the local frame normal = +z, viewer = (sin θ, 0,
// cos θ), and quadrature rules that follow its peak: the fit's and the sky's (compare/truth.h). The fit's public interface is
// glsl/fit.h.
#pragma once

#include <glm/glm.hpp>
#include <utility>
#include <vector>

#include "scenes/scene.h"

namespace arealab::fit {

struct View {
  Brdf brdf = Brdf::kGgx;
  double alpha = 1.0;      // roughness², at least kMinAlpha of glsl/surface.glsl; 1 of a diffuse BRDF
  double roughness = 1.0;  // of a diffuse BRDF
  double cosine = 1.0;  // n·v in (0, 1]
  double sine = 0.0;

  glm::dvec3 ToView() const { return {sine, 0.0, cosine}; }
  glm::dvec3 Mirror() const { return {-sine, 0.0, cosine}; }
};

View MakeView(Brdf brdf, double roughness, double cosine);

// ρ = BRDF × n·l with Fresnel 1, 1/sr; 0 below the horizon. `to_light` is unit.
double LobeDensity(const View& view, const glm::dvec3& to_light);

// Quadrature nodes over directions: ∫ f dω ≈ Σ weight · f(x, y, z).
struct Nodes {
  std::vector<double> x, y, z;  // unit directions
  std::vector<double> weight;   // sr
  std::vector<double> density;  // ρ there, 1/sr
  std::vector<double> schlick;  // (1 − v·h)⁵ there

  std::size_t size() const { return x.size(); }
};

// Gauss–Legendre abscissas and weights on [0, 1].
const std::vector<std::pair<double, double>>& GaussRule(int count);

// Nodes above the horizon, on the half y ≥ 0 with doubled weights: the lobe is symmetric in y. Half vectors
// in polar coordinates, tan θh = α sinh t with t cut exactly where the light reaches the horizon, or before it where a steep
// lobe has less than e⁻³⁶ of its peak; `radial`
// points in t, `azimuthal` in φ ∈ [0, π], half of them on each side of π/2, where the cut turns quickly at
// grazing views. Of a diffuse lobe even in n·l and azimuth instead.
Nodes UpperNodes(const View& view, int radial, int azimuthal);

// The same nodes and their mirror images in y with single weights.
Nodes BothSides(const Nodes& half);

// ∫ρ, ∫ρ (1 − v·h)⁵ and the unit mean direction of ρ.
struct LobeMoments {
  double albedo = 0.0, schlick = 0.0;
  glm::dvec3 mean{0.0, 0.0, 1.0};
};
LobeMoments Moments(const Nodes& upper);

// The same by the estimator of the published fit: `count`² mid-point samples of the half vector by GGX's D, uniform
// in azimuth and in tan²θ/(α² + tan²θ). It cuts the lobe's tail short, which at grazing views moves the mean
// direction by degrees and the albedo by percents; the shipped tables carry that error.
LobeMoments SampledMoments(const View& view, int count);

// The axis that all tables share: position x ∈ [0, 1] of the view angle, x = √((1 − cos θ)/(1 − cos θ_last)).
double ViewCosine(double x, double last_cosine);
double ViewPosition(double cosine, double last_cosine);

}  // namespace arealab::fit
