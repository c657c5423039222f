/*---
summary = "The light's spherical cap intersected with the cap of open sky, the hemisphere where nothing is baked"
citation = "Oat 2006"
author_note = "overlap=smoothstep, centroid=average are Oat's, for diffuse light from spheres; the exact overlap is the form of Tovchigrechko & Vakser 2001 that he shows and replaces, with a sign of its print corrected; ours: the overlap's centroid, rectangle and disk as the cap of equal solid angle about the direction to their centre, and the specular lobe as a GGX cone intersected with the light's cap, as bright in total as the lobe"
shapes = ["rectangle", "disk", "sphere"]
lobes = ["diffuse", "specular"]
brdfs = ["ggx"]
effects = ["two_sided", "fresnel", "many_lights", "aperture"]
exact = ["lambert_sphere", "point_limit"]

[[option]]
name = "overlap"
summary = "the area that two caps share"
choices = [
  ["exact", "by spherical geometry (the form he replaces)"],
  ["smoothstep", "the smaller cap times a smoothstep between touching and containing (his)"],
]

[[option]]
name = "centroid"
summary = "the direction at which Lambert's cosine is taken"
choices = [
  ["overlap", "the centroid of the shared part (ours)"],
  ["average", "halfway between the light's and the aperture's axis (his)"],
]

[published]
overlap = "smoothstep"
centroid = "average"

[[departs]]
law = "lambert_sphere"
when = { centroid = "average" }
error = 0.57
why = "the cosine at the average of both axes"

[[departs]]
law = "lambert_sphere"
when = { overlap = "smoothstep" }
error = 0.57
why = "the overlap by a smoothstep; with centroid=average, its"

[[departs]]
law = "point_limit"
lobe = "diffuse"
when = { centroid = "average" }
error = 0.47
why = "the cosine at the average of both axes"

[[departs]]
law = "point_limit"
lobe = "specular"
error = 0.94
why = "a plateau over the lobe's cone"

[[departs]]
law = "mirror_limit"
error = 0.17
why = "a cap has not the light's outline; a sphere's cap has"

[[departs]]
law = "additive"
lobe = "diffuse"
error = 0.23
why = "each half is its own cap"

[[departs]]
law = "additive"
lobe = "specular"
error = 0.37
why = "each half is its own cap"
---*/
#include "brdf.glsl"
#include "importance_cone.glsl"
#include "light_cap.glsl"
#include "specular_albedo.glsl"
#include "spherical_cap.glsl"

Radiance ShadeLight(Surface surface, Light light, vec3 to_view) {
  Cap source = LightCap(light, surface.position, surface.normal);
  Cap aperture;
#if EFFECT_APERTURE
  aperture.axis = surface.aperture.xyz;
  aperture.versine = surface.aperture.w;
#else
  aperture.axis = surface.normal;
  aperture.versine = 1.0;
#endif
  Cap lobe;
  float n_dot_v = clamp(dot(surface.normal, to_view), 0.0, 1.0);
  lobe.axis = surface.normal * (2.0 * dot(surface.normal, to_view)) - to_view;
  lobe.versine = max(EnergyConeVersine(surface.alpha, n_dot_v), 1e-12);  // below it float's directions are all alike

  // Areas over 2π: of the light's part in the aperture, of the aperture's part in the light's, of its part in the lobe.
#if !EFFECT_PROXY_HORIZON && !EFFECT_APERTURE
  CapOverlap open = WholeCap(source, aperture.axis);
  float open_area = open.area / (2.0 * kPi);
#elif OVERLAP_EXACT
  CapOverlap open = IntersectCaps(aperture, source);
  float open_area = open.area / (2.0 * kPi);
#else
  float open_area = min(aperture.versine, source.versine) *
                    SmoothstepOverlap(AngleFromVersine(aperture.versine), AngleFromVersine(source.versine),
                                      AngleFromVersine(VersineBetween(aperture.axis, source.axis)));
#endif
#if OVERLAP_EXACT
  float lobe_area = IntersectCaps(lobe, source).area / (2.0 * kPi);
#else
  float lobe_area = min(lobe.versine, source.versine) *
                    SmoothstepOverlap(AngleFromVersine(lobe.versine), AngleFromVersine(source.versine),
                                      AngleFromVersine(VersineBetween(lobe.axis, source.axis)));
#endif

#if CENTROID_AVERAGE
  vec3 sum = aperture.axis + source.axis;
  float cos_centroid = max(dot(surface.normal, sum) * inversesqrt(max(dot(sum, sum), 1e-20)), 0.0);
#elif OVERLAP_EXACT || (!EFFECT_PROXY_HORIZON && !EFFECT_APERTURE)
  float cos_centroid = max(dot(surface.normal, open.moment), 0.0) / max(open.area, 1e-30);
#else
  CapOverlap open = IntersectCaps(aperture, source);
  float cos_centroid = max(dot(surface.normal, open.moment), 0.0) / max(open.area, 1e-30);
#endif

  Radiance result;
  result.diffuse = light.radiance * surface.diffuse_albedo * (2.0 * open_area * min(cos_centroid, 1.0));
  // The lobe is taken as even over its cone, and as open as the light is.
  vec2 energy = SpecularAlbedo(n_dot_v, surface.roughness);
#if EFFECT_FRESNEL
  vec3 reflectance = surface.f0 * (energy.x - energy.y) + vec3(energy.y);
#else
  vec3 reflectance = surface.f0 * energy.x;
#endif
  float openness = min(open_area / max(source.versine, 1e-30), 1.0);
  result.specular = light.radiance * reflectance * (openness * min(lobe_area / lobe.versine, 1.0));
  return result;
}
