/*---
summary = "The rectangle clipped to a rectangle; its solid angle along an average direction; the lobe as a glossiness cone"
citation = "Mayaux 2017"
author_note = "'Adding Area Lights': the fake clipping both ways round, rho/pi (n.w) times the clipped rectangle's solid angle along its average direction, specular as the BRDF's integral times the mean radiance within the glossiness cone, faded round the light's border as his look-up fades, Ward's lobe or GGX's. rho/pi, counted twice in its eq. 1, is counted once here, and the radiance of the specular is a mean. The article has no formula for three of its parts; ours: the average direction (published: to the clipped rectangle's centre, as his test project has it; default: the mean over its solid angle), the cone (as wide as conserves the lobe's energy), the BRDF's integral (the lobe's whole energy, by a fit, times the cone's share that the rectangle covers, Fresnel split off). The diffuse lobe has no Fresnel term in the scenes: his F' is coupling=fresnel, as 1 - F. Nothing holds his form factor below 1: near the light it is up to 2. Textures by mip levels of the look-up's size, as his SampleAreaLight has them. No average tells where in a lobe a small light is: its shape is a plateau"
shapes = ["rectangle"]
lobes = ["diffuse", "specular"]
brdfs = ["ggx", "ward"]
diffuse_brdfs = ["lambert", "disney"]
effects = ["two_sided", "fresnel", "many_lights", "textured"]
exact = ["point_limit", "mirror_limit"]

[[option]]
name = "segment"
summary = "Clipping of a side that is not cut"
choices = [
  ["documented", "as the listing's comment says: its start where all is below"],
  ["printed", "as the listing does: its end where the side is level or rises"],
]

[[option]]
name = "average"
summary = "Average direction of the clipped rectangle"
choices = [
  ["mean", "the mean of its directions: exact for Lambert, but for the clipping (ours)"],
  ["center", "towards its centre"],
]

[[option]]
name = "coupling"
summary = "Fresnel in the diffuse lobe"
choices = [
  ["none", "none: the scenes' material"],
  ["fresnel", "1 - F towards the average direction (his F')"],
]

[[option]]
name = "alpha"
summary = "What the transparency of a textured light dims"
choices = [
  ["both", "both lobes: what the scene emits"],
  ["diffuse", "the diffuse lobe alone, the colours' mean and alpha's each by itself (his)"],
]

[published]
segment = "printed"
average = "center"
coupling = "none"
alpha = "diffuse"

[[departs]]
law = "point_limit"
lobe = "diffuse"
when = { coupling = "fresnel" }
error = 0.68
why = "the diffuse lobe loses what Fresnel reflects"

[[departs]]
law = "point_limit"
lobe = "specular"
error = 0.99
why = "a plateau over the glossiness cone"

[[departs]]
law = "additive"
lobe = "diffuse"
error = 0.16
why = "each half is clipped to a rectangle of its own"

[[departs]]
law = "additive"
lobe = "specular"
error = 0.24
why = "each half fades by itself at its border"
---*/
#include "brdf.glsl"
#include "diffuse"
#include "edge/mirrored.glsl"
#include "segment"
#include "fake_clip.glsl"
#include "importance_cone.glsl"
#include "light_texture.glsl"
#include "polygon.glsl"
#include "representative_point.glsl"
#include "solid_angle.glsl"
#include "specular_albedo"
#include "vector_form_factor.glsl"
#include "lit.glsl"

#if EFFECT_TEXTURED
// The texture's mean over about the rectangle center ± half_size (m, from the light's centre), by one trilinear look-up; w: alpha, where
// the colours are without it.
vec4 MipTexel(Light light, vec2 center, vec2 half_size) {
  vec2 delta_uv = 0.5 * half_size / light.half_size;
  float radius = 128.0 * 0.5 * (delta_uv.x + delta_uv.y);  // texels of level 0
  vec3 place = vec3(TextureCoordinates(light, center), light.image.x);
#if ALPHA_DIFFUSE
  return SampleLayer(light_straight, place, log2(1e-4 + radius));
#else
  return SampleLayer(light_means, place, log2(1e-4 + radius));
#endif
}
#endif

Radiance ShadeLight(Surface surface, Light light, vec3 to_view) {
  Radiance result;
  result.diffuse = vec3(0.0);
  result.specular = vec3(0.0);
  // All in the light's frame.
  vec3 offset = surface.position - light.center;
  vec3 point = vec3(dot(offset, light.axis_x), dot(offset, light.axis_y), dot(offset, light.normal));
  point.z = max(point.z, 1e-6 * (light.half_size.x + light.half_size.y));  // touching is taken as just above
  vec3 normal = vec3(dot(surface.normal, light.axis_x), dot(surface.normal, light.axis_y), dot(surface.normal, light.normal));
  vec3 view = vec3(dot(to_view, light.axis_x), dot(to_view, light.axis_y), dot(to_view, light.normal));

  ClippedRectangle clipped = ClipToRectangle(point, normal, light.half_size);
  vec2 center = 0.5 * (clipped.low + clipped.high);
  vec2 half_size = max(0.5 * (clipped.high - clipped.low), vec2(0.0));
  if (!Lit(half_size.x * half_size.y > 1e-8 * light.area)) return result;
  vec3 from_center = point - vec3(center, 0.0);
  vec3 to_center = -from_center * inversesqrt(dot(from_center, from_center));

#if AVERAGE_CENTER
  vec3 average = to_center;
  float form_factor = max(dot(normal, average), 0.0) * RectangleSolidAngle(from_center, half_size) / kPi;
#else
  // The mean of unit directions over the solid angle is the vector form factor times π over the solid angle.
  RectangleView seen;
  seen.in_plane = -from_center;
  seen.horizon = normal;
  seen.half_size = half_size;
  seen.small = dot(half_size, half_size) < kSmallRectangle * dot(from_center, from_center);
  VectorFormFactor mean = LambertVector(seen);
  vec3 average = mean.f * inversesqrt(max(dot(mean.f, mean.f), 1e-30));
  float form_factor = clamp(mean.height, 0.0, 1.0);
#endif
  Surface local = surface;
  local.normal = normal;
  result.diffuse = DiffuseAlbedo(local, view, average) * light.radiance * form_factor;
#if EFFECT_TEXTURED
  vec4 texel = MipTexel(light, center, half_size);
#if ALPHA_DIFFUSE
  result.diffuse *= texel.w;
#endif
  result.diffuse *= texel.rgb;
#endif
#if COUPLING_FRESNEL
  vec3 sum = average + view;
  float v_dot_h = dot(view, sum) * inversesqrt(max(dot(sum, sum), 1e-20));
  result.diffuse *= (vec3(1.0) - surface.f0) * (1.0 - SchlickWeight(v_dot_h));
#endif

  // The glossiness cone's trace on the light's plane, seen from the clipped rectangle's centre.
  float n_dot_v = clamp(dot(surface.normal, to_view), 0.0, 1.0);
  vec3 mirror = normal * (2.0 * dot(normal, view)) - view;
  Footprint cone = ConeFootprint(from_center, mirror, EnergyConeVersine(surface.alpha, n_dot_v), true);
  if (!Lit(cone.radius > 0.0)) return result;
  vec2 nearest = ClosestOnRectangle(vec2(0.0), cone.center, half_size);
  // Over the trace's radius and, as his listing has it, a thousandth of the light's sides.
  float outside = min(length((cone.center - nearest) / (vec2(cone.radius) + 2e-3 * light.half_size)), 1.0);
  float fade = 1.0 - outside * outside * (3.0 - 2.0 * outside);
  cone.center = nearest;
  float share = FootprintOnRectangle(cone, half_size).area / (kPi * cone.radius * cone.radius);
  vec2 energy = LobeAlbedo(n_dot_v, surface.roughness);
#if EFFECT_FRESNEL
  vec3 reflectance = surface.f0 * (energy.x - energy.y) + vec3(energy.y);
#else
  vec3 reflectance = surface.f0 * energy.x;
#endif
  result.specular = reflectance * light.radiance * (min(share, 1.0) * fade);
#if EFFECT_TEXTURED
  result.specular *= MipTexel(light, center + cone.center, vec2(cone.radius)).rgb;
#endif
  return result;
}
