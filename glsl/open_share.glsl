#pragma once
// How much of a cap of directions is open, where what is open is itself held by caps [Oat 2006].
#include "spherical_cap.glsl"
#include "surface.glsl"

// Of an axis and a versine in one.
Cap CapOf(vec4 axis_versine) {
  Cap cap;
  cap.axis = axis_versine.xyz;
  cap.versine = axis_versine.w;
  return cap;
}

Cap Hemisphere(Surface surface) { return CapOf(vec4(surface.normal, 1.0)); }

// ∫ cosθ/π dω over the cap above the horizon.
float CapFormFactor(Surface surface, Cap cap) {
  return clamp(dot(surface.normal, IntersectCaps(cap, Hemisphere(surface)).moment) / kPi, 0.0, 1.0);
}

// Of what the cap shows above the horizon, the share that the other covers, [0, 1]; `otherwise` where it shows nothing.
float CoveredShare(Surface surface, Cap cap, Cap other, float otherwise) {
  float above = IntersectCaps(Hemisphere(surface), cap).area;
  return above > 0.0 ? min(IntersectCaps(other, cap).area / above, 1.0) : otherwise;
}

#if EFFECT_APERTURE
// The same of the ambient aperture.
float OpenShare(Surface surface, Cap cap) {
  if (surface.aperture.w >= 1.0) return 1.0;  // all of the hemisphere
  // A light of which only a corner is above the horizon has a cap below it: then it is as visible as the hemisphere is.
  return CoveredShare(surface, cap, CapOf(surface.aperture), surface.aperture.w);
}
#endif
