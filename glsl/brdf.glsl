#pragma once
// What the specular BRDFs are made of. Dual: also compiles as C++ (glsl/dual_begin.h).
// The default is F · GgxDensity · SmithVisibility, with Schlick's Fresnel; times n·l and radiance, integrated over the light, it is
// what a specular technique approximates. alpha is the artist's roughness squared and at least kMinAlpha.
//
// The scene's choice is a file glsl/brdf/NAME.glsl, `#include "brdf"`, with one function, symmetric in v and l:
//   float BrdfOverGgx(float n_dot_v, float n_dot_l, float v_dot_h, float tan2_h, float alpha)
// the BRDF with Fresnel 1 over GgxDensity of the same alpha, 1; cosines positive, tan2_h = tan²θ of the half vector. All lobes have about the width
// of GGX's peak, so that what is left beside it is smooth, and a sharp peak keeps its digits in float.
//
// The scene's diffuse BRDF is a file glsl/diffuse/NAME.glsl, `#include "diffuse"`, with two functions: the BRDF over Lambert's, and what
// becomes of the albedo for one direction to the light. DIFFUSE_NAME is 1 for it, 0 for the others.
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

// Beckmann's density over GGX's: exp(−x)(1 + x)², x = tan²θh/α² [Walter 2007, eqs. 25 and 33].
float GaussOverGgx(float tan2_h, float alpha) {
  float x = min(tan2_h / (alpha * alpha), 1000.0);  // e^−1000 is 0 in double
  return (1.0 + x) * (1.0 + x) * exp(-x);
}

// ln(1 + x), x > −1, with its digits near 0: 2 artanh(z), z = x/(2 + x), by its series where |z| < 0.06 (next term 1e-14 of it).
float Log1p(float x) {
  float z = x / (2.0 + x);
  float z2 = z * z;
  if (abs(z) > 0.06) return log(1.0 + x);
  return 2.0 * z * (1.0 + z2 * (1.0 / 3.0 + z2 * (1.0 / 5.0 + z2 * (1.0 / 7.0 + z2 * (1.0 / 9.0 + z2 / 11.0)))));
}

// Schlick's weight of F90 = 1 against F0: F = F0 + (1 − F0)·weight [Schlick 1994, eq. 15].
float SchlickWeight(float v_dot_h) {
  float m = clamp(1.0 - v_dot_h, 0.0, 1.0);
  float m2 = m * m;
  return m2 * m2 * m;
}
