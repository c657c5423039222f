/*---
summary = "The point of a sphere or tube nearest to the mirror ray stands for it in the specular lobe, dimmed for the widening; diffuse as from a point"
citation = "Karis 2013"
author_note = "Real Shading in Unreal Engine 4, 'Area Lights': representative point (eq. 11), normalisation (eq. 14), the diffuse lobe as a point light's, which above the horizon is a sphere's; in the published form his windowed fall-off (eq. 9). For eq. 14 the notes point back to eq. 10, whose radius / (3 distance) is widening=third; his engine's code has radius / (2 distance), which alone keeps a mirror's radiance at normal incidence, and is taken for his form. Neither keeps it elsewhere: a mirror shows the sphere's radiance over n.v (third: 9/4 of that), which his engine's later form mends. The BRDF is the scene's (a diffuse one too, taken towards the centre), not his (Schlick's masking with a remapped roughness). Tubes: the line's irradiance as from a light that is as bright from all sides (eq. 16, in the published form with its square centimetres, in the other without), hence a tube's flux over 4π and not less along its axis, as a wall has it; the line's point by shortest distance to the mirror ray (eq. 19), then the sphere about it; eq. 20 does not say what alpha' is: length / (2 distance), as in his engine's code, or / (3 distance). He has spheres and tubes: no rectangle, no disk. The engine later changed both the normalisation and the horizon"
shapes = ["sphere", "tube"]
lobes = ["diffuse", "specular"]
brdfs = ["ggx"]
diffuse_brdfs = ["lambert", "disney"]
effects = ["fresnel", "many_lights"]
exact = ["point_limit"]

[[option]]
name = "widening"
summary = "By how much sphere and line widen the lobe (alpha' of eqs. 14 and 20)"
choices = [
  ["half", "radius or length / (2 distance), what the half vector turns (his engine's code)"],
  ["third", "radius or length / (3 distance) (eq. 10 by the word)"],
]

[[option]]
name = "falloff"
summary = "Fall-off with distance"
choices = [
  ["inverse_square", "physical"],
  ["windowed", "zero at the light's radius of influence, finite at its centre (eq. 9)"],
]

[[knob]]
name = "influence"
label = "Radius of influence (falloff=windowed)"
unit = "m"
initial = 10.0
min = 0.5
max = 1000.0

[published]
widening = "half"
falloff = "windowed"

[[departs]]
law = "point_limit"
when = { falloff = "windowed", shape = "sphere" }
error = 0.0053
why = "the window, at lights 1 to 4 m away"

[[departs]]
law = "point_limit"
when = { shape = "tube" }
error = 0.19
why = "a line that is as bright along itself as from the side"

[[departs]]
law = "additive"
when = { shape = "tube" }
error = 0.147
why = "the mean of the ends' cosines, cut off at the horizon as a whole; half a line widens the lobe by half"

[[departs]]
law = "scale"
when = { falloff = "windowed" }
error = 1.0
why = "the window and his square centimetre are lengths"

[[departs]]
law = "mirror_limit"
error = 3.0
why = "a mirror shows the radiance over n.v, with widening=third 9/4 of that"
---*/
#include "specular_lobe.glsl"
#include "diffuse"
#include "lit.glsl"

#if WIDENING_HALF
const float kWidening = 1.0 / 2.0;
#else
const float kWidening = 1.0 / 3.0;
#endif

Radiance ShadeLight(Surface surface, Light light, vec3 to_view) {
  Radiance result;
  result.diffuse = vec3(0.0);
  result.specular = vec3(0.0);
#if EFFECT_TUBE
  bool tube = light.shape == SHAPE_TUBE;
  float radius = tube ? light.half_size.y : light.half_size.x;
#else
  float radius = light.half_size.x;
#endif
  vec3 to_center = light.center - surface.position;
  float distance2 = max(dot(to_center, to_center), radius * radius);  // inside it is as on the sphere
  float inverse_distance = inversesqrt(distance2);
  float n_dot_l = dot(surface.normal, to_center) * inverse_distance;
#if EFFECT_TUBE
  float distance_product = distance2;
  float intensity = light.area;  // over the radiance
  if (tube) {
    vec3 to_start = to_center - light.half_axis_x;
    vec3 to_end = to_center + light.half_axis_x;
    float start2 = max(dot(to_start, to_start), 1e-30);
    float end2 = max(dot(to_end, to_end), 1e-30);
    n_dot_l = clamp(0.5 * (dot(surface.normal, to_start) * inversesqrt(start2) + dot(surface.normal, to_end) * inversesqrt(end2)), 0.0, 1.0);
    distance_product = max(0.5 * (sqrt(start2) * sqrt(end2) + dot(to_start, to_end)), radius * radius);
    intensity *= 0.25 * kPi;  // flux/4π
  }
#endif
  if (!Lit(n_dot_l > 0.0)) return result;

#if FALLOFF_WINDOWED
  float share2 = distance2 / (knob_influence * knob_influence);
  float window = clamp(1.0 - share2 * share2, 0.0, 1.0);
#if EFFECT_TUBE
  float falloff = window * window / (distance_product + 1e-4);
#else
  float falloff = window * window / (distance2 + 1e-4);  // his 1 is a square centimetre
#endif
#elif EFFECT_TUBE
  float falloff = 1.0 / distance_product;
#else
  float falloff = inverse_distance * inverse_distance;
#endif
#if EFFECT_TUBE
  vec3 irradiance = light.radiance * (intensity * falloff * n_dot_l);
#else
  vec3 irradiance = light.radiance * (light.area * falloff * n_dot_l);
#endif
  result.diffuse = DiffuseAlbedo(surface, to_view, to_center * inverse_distance) * irradiance / kPi;

  vec3 mirror = surface.normal * (2.0 * dot(surface.normal, to_view)) - to_view;
#if EFFECT_TUBE
  float line_normalization = 1.0;
  if (tube) {
    vec3 line = light.half_axis_x * 2.0;
    vec3 to_start = to_center - light.half_axis_x;
    float along = dot(mirror, line);
    float line2 = dot(line, line);
    float t = clamp(dot(to_start, mirror * along - line) / max(line2 - along * along, 1e-6 * line2), 0.0, 1.0);
    to_center = to_start + line * t;
    line_normalization = surface.alpha / min(surface.alpha + kWidening * sqrt(line2) * inverse_distance, 1.0);
  }
#endif
  vec3 center_to_ray = mirror * dot(mirror, to_center) - to_center;
  float gap2 = max(dot(center_to_ray, center_to_ray), 1e-30);
  vec3 closest = to_center + center_to_ray * min(radius * inversesqrt(gap2), 1.0);
  vec3 to_closest = closest * inversesqrt(max(dot(closest, closest), 1e-30));
  float widened = min(surface.alpha + kWidening * radius * inverse_distance, 1.0);
  float normalization = surface.alpha / widened;
  result.specular = SpecularBrdf(surface, to_view, to_closest) * irradiance * (normalization * normalization);
#if EFFECT_TUBE
  result.specular *= line_normalization;
#endif
  return result;
}
