#pragma once
// A sky of one radiance in every direction, reflected: the diffuse lobe's form factor is 1, or that of the aperture's cap above the
// horizon; the specular lobe returns its whole energy, or as much as its cone has open.
#include "importance_cone.glsl"
#include "open_share.glsl"
#include "platform"
#include "specular_albedo.glsl"

#if EFFECT_SKY
vec3 SkyRadiance() {
#if EFFECT_LIGHT_COLOR
  return SkyInput();
#else
  return vec3(SkyInput().x);
#endif
}
#endif

// ∫ cosθ/π dω over the open sky: exact where all is open or what is open is a cap.
float OpenSky(Surface surface) {
#if EFFECT_APERTURE
  if (surface.aperture.w >= 1.0) return 1.0;
  return CapFormFactor(surface, CapOf(surface.aperture));
#else
  return 1.0;
#endif
}

// The GGX lobe's cone about the mirrored view, in which it is taken as even.
Cap LobeCone(Surface surface, vec3 to_view, float n_dot_v) {
  Cap lobe;
  lobe.axis = surface.normal * (2.0 * dot(surface.normal, to_view)) - to_view;
  lobe.versine = max(EnergyConeVersine(surface.alpha, n_dot_v), 1e-12);  // below it float's directions are all alike
  return lobe;
}

// What the whole lobe reflects of even light from everywhere.
vec3 LobeReflectance(Surface surface, float n_dot_v) {
  vec2 energy = SpecularAlbedo(n_dot_v, surface.roughness);
#if EFFECT_FRESNEL
  return surface.f0 * (energy.x - energy.y) + vec3(energy.y);
#else
  return surface.f0 * energy.x;
#endif
}

vec3 LobeOfSky(Surface surface, vec3 to_view) {
  float n_dot_v = clamp(dot(surface.normal, to_view), 0.0, 1.0);
#if EFFECT_APERTURE
  return LobeReflectance(surface, n_dot_v) * OpenShare(surface, LobeCone(surface, to_view, n_dot_v));
#else
  return LobeReflectance(surface, n_dot_v);
#endif
}
