// Out of the ambient aperture [Oat 2006], for techniques that know of none.
#include "light_cap.glsl"

// Of what the light's cap shows above the horizon, the share that lies in the aperture, [0, 1].
float Visibility(Surface surface, Light light) {
  if (surface.aperture.w >= 1.0) return 1.0;  // all of the hemisphere
  Cap source = LightCap(light, surface.position, surface.normal);
  Cap aperture;
  aperture.axis = surface.aperture.xyz;
  aperture.versine = surface.aperture.w;
  Cap hemisphere;
  hemisphere.axis = surface.normal;
  hemisphere.versine = 1.0;
  float above = IntersectCaps(hemisphere, source).area;
  // A light of which only a corner is above the horizon has a cap below it: then it is as visible as the hemisphere is.
  return above > 0.0 ? min(IntersectCaps(aperture, source).area / above, 1.0) : aperture.versine;
}
