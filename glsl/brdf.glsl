#pragma once
// The default BRDF: GGX with height-correlated Smith masking and Schlick's Fresnel. Dual: also compiles as C++ (glsl/dual_begin.h).
// The specular BRDF is F · GgxDensity · SmithVisibility; times n·l and radiance, integrated over the light, it is what a
// specular technique approximates. alpha is the artist's roughness squared and at least kMinAlpha.
#include "surface.glsl"

// GGX density of facet normals D(h), 1/sr, isotropic; n_dot_h in [0, 1] [Walter 2007, eq. 33].
// The form with (1 − n·h)(1 + n·h) keeps its digits at the peak, where 1 + (α² − 1)(n·h)² cancels.
float GgxDensity(float n_dot_h, float alpha) {
  float n_dot_h_alpha = n_dot_h * alpha;
  float k = alpha / ((1.0 - n_dot_h) * (1.0 + n_dot_h) + n_dot_h_alpha * n_dot_h_alpha);
  return k * k / kPi;
}

// Masking of one direction G1, 1 where nothing is masked; n_dot_v in (0, 1] [Heitz 2014, eqs. 43 and 72].
float SmithG1(float n_dot_v, float alpha) {
  float cos2 = n_dot_v * n_dot_v;
  return 2.0 * n_dot_v / (n_dot_v + sqrt(cos2 + alpha * alpha * (1.0 - cos2)));
}

// Height-correlated masking and shadowing over the BRDF's denominator: G2 / (4 n·l n·v), 1/sr; both cosines positive
// [Heitz 2014, eq. 99, with n·v (1 + 2Λ) = √((n·v)² + α²(1 − (n·v)²)) put in].
float SmithVisibility(float n_dot_v, float n_dot_l, float alpha) {
  float alpha2 = alpha * alpha;
  float view_term = n_dot_l * sqrt(n_dot_v * n_dot_v * (1.0 - alpha2) + alpha2);
  float light_term = n_dot_v * sqrt(n_dot_l * n_dot_l * (1.0 - alpha2) + alpha2);
  return 0.5 / (view_term + light_term);
}

// Schlick's weight of F90 = 1 against F0: F = F0 + (1 − F0)·weight [Schlick 1994, eq. 15].
float SchlickWeight(float v_dot_h) {
  float m = clamp(1.0 - v_dot_h, 0.0, 1.0);
  float m2 = m * m;
  return m2 * m2 * m;
}
