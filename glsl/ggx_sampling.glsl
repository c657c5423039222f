#pragma once
// Half vectors drawn as the viewer sees GGX's facets [Heitz 2018]. Dual: also compiles as C++.
#include "brdf.glsl"

// A unit half vector about the normal z, for the viewer (√(1 − n_dot_v²), 0, n_dot_v); u uniform in [0, 1)². Its density is
// G1(v) D(h) max(v·h, 0) / (n·v), 1/sr of half vectors [Heitz 2018, eq. 3 and appendix A, for a round lobe].
vec3 SampleVisibleHalfVector(float n_dot_v, float alpha, vec2 u) {
  float stretched = alpha * sqrt(max(1.0 - n_dot_v * n_dot_v, 0.0));
  float inverse = inversesqrt(stretched * stretched + n_dot_v * n_dot_v);
  vec2 view = vec2(stretched, n_dot_v) * inverse;  // x and z; the second axis across it is y
  float radius = sqrt(u.x);
  float phi = 2.0 * kPi * u.y;
  float t1 = radius * cos(phi);
  float across = sqrt(max(1.0 - t1 * t1, 0.0));
  float t2 = mix(across, radius * sin(phi), 0.5 * (1.0 + view.y));
  float t3 = sqrt(max(1.0 - t1 * t1 - t2 * t2, 0.0));
  vec3 facet = vec3(t3 * view.x - t2 * view.y, t1, t2 * view.x + t3 * view.y);
  return normalize(vec3(alpha * facet.x, alpha * facet.y, max(facet.z, 1e-9)));
}

// The density of the light direction that such a half vector mirrors the viewer to, 1/sr: with dω_l = 4 (v·h) dω_h it is
// G1(v) D(h) / (4 n·v); `density` is D(h).
float VisibleMirrorDensity(float n_dot_v, float alpha, float density) {
  return SmithG1(n_dot_v, alpha) * density / (4.0 * n_dot_v);
}
