/*---
summary = "The light's spherical cap intersected with the cap of open sky, the hemisphere where nothing is baked"
citation = "Oat 2006"
author_note = "overlap=smoothstep, centroid=average, fill=area are Oat's, for diffuse light from spheres; he leaves open what the fill is scaled by: here an open hemisphere reflects the sky's radiance × albedo; the exact overlap is the form of Tovchigrechko & Vakser 2001 that he shows and replaces, with a sign of its print corrected; ours: the overlap's centroid, the fill by moments, rectangle and disk as the cap of equal solid angle about the direction to their centre, and the specular lobe as a GGX cone intersected with the light's cap, as bright in total as the lobe"
shapes = ["rectangle", "disk", "sphere", "polygon", "ellipse"]
lobes = ["diffuse", "specular"]
brdfs = ["ggx"]
effects = ["two_sided", "fresnel", "many_lights", "aperture", "sky"]
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

[[option]]
name = "fill"
summary = "the sky's diffuse light where lights leave the aperture free"
choices = [
  ["moment", "by the cosine over the aperture's cap less the shared part (ours)"],
  ["area", "by the aperture's area less the shared one (his)"],
]

[[option]]
name = "aperture"
summary = "the caps that hold what is open, where a scene asks for visibility"
choices = [
  ["one", "a cap about the mean open direction (his)"],
  ["two", "the two largest contiguous regions, a cap each (he names it, ours in how)"],
  ["blocked", "the hemisphere less a cap about the mean blocked direction (his anti-aperture, ours in how)"],
]

[published]
overlap = "smoothstep"
centroid = "average"
fill = "area"

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
error = 0.36
why = "a cap has not the light's outline; a sphere's cap has"

[[departs]]
law = "additive"
lobe = "diffuse"
error = 0.23
why = "each half is its own cap"

[[departs]]
law = "additive"
lobe = "specular"
error = 1.0
why = "each half is its own cap"
---*/
#include "brdf.glsl"
#include "importance_cone.glsl"
#include "light_cap.glsl"
#include "specular_albedo.glsl"
#include "open_share.glsl"
#include "sky_fill.glsl"
#include "spherical_cap.glsl"

// The area over 2π that a cap lets through of the light's, and Lambert's cosine for it.
vec2 Through(Cap aperture, Cap source, vec3 normal) {
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
#if CENTROID_AVERAGE
  vec3 sum = aperture.axis + source.axis;
  float cos_centroid = max(dot(normal, sum) * inversesqrt(max(dot(sum, sum), 1e-20)), 0.0);
#elif OVERLAP_EXACT || (!EFFECT_PROXY_HORIZON && !EFFECT_APERTURE)
  float cos_centroid = max(dot(normal, open.moment), 0.0) / max(open.area, 1e-30);
#else
  CapOverlap open = IntersectCaps(aperture, source);
  float cos_centroid = max(dot(normal, open.moment), 0.0) / max(open.area, 1e-30);
#endif
  return vec2(open_area, min(cos_centroid, 1.0));
}

Radiance ShadeLight(Surface surface, Light light, vec3 to_view) {
  Cap source = LightCap(light, surface.position, surface.normal);
#if EFFECT_APERTURE && APERTURE_ONE
  vec2 open = Through(CapOf(surface.aperture), source, surface.normal);
#elif EFFECT_APERTURE && APERTURE_TWO
  vec2 first = Through(CapOf(surface.first_region), source, surface.normal);
  vec2 second = Through(CapOf(surface.second_region), source, surface.normal);
  float both = first.x + second.x;
  vec2 open = vec2(both, (first.x * first.y + second.x * second.y) / max(both, 1e-30));
#elif EFFECT_APERTURE
  // The overlap of the blocked cap is what is lost.
  vec2 above = Through(Hemisphere(surface), source, surface.normal);
  vec2 lost = Through(CapOf(surface.blocked), source, surface.normal);
  float left = max(above.x - lost.x, 0.0);
  vec2 open = vec2(left, clamp((above.x * above.y - lost.x * lost.y) / max(left, 1e-30), 0.0, 1.0));
#else
  vec2 open = Through(Hemisphere(surface), source, surface.normal);
#endif

  float n_dot_v = clamp(dot(surface.normal, to_view), 0.0, 1.0);
  Cap lobe = LobeCone(surface, to_view, n_dot_v);
#if OVERLAP_EXACT
  float lobe_area = IntersectCaps(lobe, source).area / (2.0 * kPi);
#else
  float lobe_area = min(lobe.versine, source.versine) *
                    SmoothstepOverlap(AngleFromVersine(lobe.versine), AngleFromVersine(source.versine),
                                      AngleFromVersine(VersineBetween(lobe.axis, source.axis)));
#endif

  // The light stands before the sky: what it adds is the difference; but his fill is less the shared area.
  vec3 diffuse_radiance = light.radiance;
  vec3 specular_radiance = light.radiance;
#if EFFECT_SKY
  specular_radiance -= SkyRadiance();
#if FILL_MOMENT
  diffuse_radiance -= SkyRadiance();
#endif
#endif
  Radiance result;
  result.diffuse = diffuse_radiance * surface.diffuse_albedo * (2.0 * open.x * open.y);
#if EFFECT_SKY && FILL_AREA
  result.diffuse -= SkyRadiance() * surface.diffuse_albedo * open.x;
#endif
  // The lobe is taken as even over its cone, and as open as the light is.
  float openness = min(open.x / max(source.versine, 1e-30), 1.0);
  result.specular = specular_radiance * LobeReflectance(surface, n_dot_v) * (openness * min(lobe_area / lobe.versine, 1.0));
  return result;
}

#if EFFECT_SKY
// What the sky fills where no light stands in the aperture; each light takes away what it covers.
Radiance ShadeSky(Surface surface, vec3 to_view) {
  float area = 1.0;         // of what is open, over 2π
  float form_factor = 1.0;  // of the same
  float lobe_share = 1.0;   // of the lobe's cone
#if EFFECT_APERTURE
  float n_dot_v = clamp(dot(surface.normal, to_view), 0.0, 1.0);
  Cap lobe = LobeCone(surface, to_view, n_dot_v);
#if APERTURE_ONE
  area = surface.aperture.w;
  form_factor = OpenSky(surface);
  lobe_share = OpenShare(surface, lobe);
#elif APERTURE_TWO
  Cap first = CapOf(surface.first_region);
  Cap second = CapOf(surface.second_region);
  area = first.versine + second.versine;
  form_factor = area < 1.0 ? CapFormFactor(surface, first) + CapFormFactor(surface, second) : 1.0;
  lobe_share = area < 1.0 ? CoveredShare(surface, lobe, first, first.versine) + CoveredShare(surface, lobe, second, second.versine) : 1.0;
#else
  Cap blocked = CapOf(surface.blocked);
  area = 1.0 - blocked.versine;
  form_factor = 1.0 - CapFormFactor(surface, blocked);
  lobe_share = 1.0 - CoveredShare(surface, lobe, blocked, blocked.versine);
#endif
#endif
  Radiance sky;
#if FILL_AREA
  sky.diffuse = SkyRadiance() * surface.diffuse_albedo * clamp(area, 0.0, 1.0);
#else
  sky.diffuse = SkyRadiance() * surface.diffuse_albedo * clamp(form_factor, 0.0, 1.0);
#endif
  sky.specular = SkyRadiance() * LobeReflectance(surface, clamp(dot(surface.normal, to_view), 0.0, 1.0)) * clamp(lobe_share, 0.0, 1.0);
  return sky;
}
#endif
