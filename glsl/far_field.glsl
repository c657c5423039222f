#pragma once
// A light so far that it is a point: what any light tends to.
#include "brdf.glsl"
#include "diffuse"
#include "light_texture.glsl"
#include "lit.glsl"
#include "specular_lobe.glsl"

// m²: below it no float position tells the centre from the point; there the direction is 0 and so is the radiance.
const float kMinDistance2 = 1e-20;

// A point at the light's centre with the light's intensity towards the surface [Drobot 2014, eq. 1.16].
Radiance FarField(Surface surface, Light light, vec3 to_view) {
  Radiance radiance = Radiance(vec3(0.0), vec3(0.0));
  vec3 to_center = light.center - surface.position;
  float distance2 = max(dot(to_center, to_center), kMinDistance2);
  float inverse = inversesqrt(distance2);
  vec3 to_light = to_center * inverse;
#if EFFECT_SPECULAR
  float n_dot_l = dot(surface.normal, to_light);  // the specular lobe's too
#else
  float n_dot_l = dot(surface.normal, to_center) * inverse;
#endif
  if (!Lit(n_dot_l > 0.0)) return radiance;

  // Intensity L·A·cosθ_l, W/sr; area is a sphere's cross-section and a sphere has no cosine.
  float cos_light = light.shape == SHAPE_SPHERE ? 1.0 : max(-dot(light.normal, to_light), 0.0);
#if EFFECT_TUBE
  if (light.shape == SHAPE_TUBE) cos_light = length(cross(light.axis_x, to_light));  // how long it is seen
#endif
  vec3 irradiance = MeanRadiance(light) * (light.area * cos_light * n_dot_l * (inverse * inverse));

  radiance.diffuse = DiffuseAlbedo(surface, to_view, to_light) * irradiance / kPi;

  radiance.specular = SpecularBrdf(surface, to_view, to_light) * irradiance;
  return radiance;
}
