#pragma once
// The specular BRDF at one pair of directions, for techniques that put a single direction into it. Dual: also compiles as C++.
#include "brdf.glsl"
#if !AREALAB_DUAL  // C++ includes one of glsl/brdf/ before this file
#include "brdf"
#endif

// GgxDensity of the angle between two unit vectors, from their cross product: in float the cosine alone cannot resolve
// the peak of a lobe with alpha below 1e-3.
float GgxDensityBetween(vec3 normal, vec3 half_vector, float alpha) {
  vec3 c = cross(normal, half_vector);
  float sin2 = min(dot(c, c), 1.0);
  float k = alpha / (sin2 + (1.0 - sin2) * alpha * alpha);
  return k * k / kPi;
}

// F·f, for ggx F·D·G2/(4 n·l n·v), 1/sr, per channel. Below the horizon it is what it tends to at the horizon.
vec3 SpecularBrdf(Surface surface, vec3 to_view, vec3 to_light) {
  float n_dot_v = max(dot(surface.normal, to_view), 1e-6);
  float n_dot_l = max(dot(surface.normal, to_light), 1e-6);
  vec3 sum = to_view + to_light;
  float length2 = max(dot(sum, sum), 1e-20);
  float inverse = inversesqrt(length2);
  vec3 half_vector = sum * inverse;
  float v_dot_h = min(0.5 * length2 * inverse, 1.0);  // |v + l|/2: at grazing directions v·h itself would have no digits
  vec3 c = cross(surface.normal, half_vector);
  float sin2 = min(dot(c, c), 1.0);
  float tan2 = sin2 / max(1.0 - sin2, 1e-12);
  float lobe = GgxDensityBetween(surface.normal, half_vector, surface.alpha) *
               BrdfOverGgx(n_dot_v, n_dot_l, v_dot_h, tan2, surface.alpha);
#if EFFECT_FRESNEL
  return (surface.f0 + (vec3(1.0) - surface.f0) * SchlickWeight(v_dot_h)) * lobe;
#else
  return surface.f0 * lobe;
#endif
}

// The same times the cosine towards the light; 0 below the horizon.
vec3 SpecularLobe(Surface surface, vec3 to_view, vec3 to_light) {
  return SpecularBrdf(surface, to_view, to_light) * max(dot(surface.normal, to_light), 0.0);
}
