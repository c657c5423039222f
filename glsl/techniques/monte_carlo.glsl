/*---
summary = "Samples of the light's solid angle and of the lobe, combined: unbiased, noisy"
citation = "Veach & Guibas 1995; Heitz 2018; Ureña et al. 2013; Burley 2020"
author_note = "Nobody's published form: what a user would otherwise do. Half of the samples on the light (rectangle: even in solid angle, by area below 0.01 sr; disk, ellipse, polygon and what is seen of a tube: by area; sphere: even over its cone), half along the mirrored visible normals of GGX (of the same alpha whatever the scene's BRDF: unbiased still), weighed by the balance heuristic; a lone sample is of either kind by chance. Owen-scrambled Sobol points, another scrambling for every pixel, light and seed, none for the time"
shapes = ["rectangle", "disk", "sphere", "polygon", "ellipse", "tube"]
lobes = ["diffuse", "specular"]
brdfs = ["ggx", "ggx_separable", "beckmann", "blinn_phong", "ward", "phong"]
diffuse_brdfs = ["lambert", "disney"]
yardstick = true
effects = ["two_sided", "fresnel", "many_lights", "textured"]

[[option]]
name = "samples"
summary = "Samples of each light in each pixel"
choices = [
  ["16", "eight on the light, eight along the lobe"],
  ["1", "one of either kind"],
  ["4", "two and two"],
  ["64", "thirty-two and thirty-two"],
]

[[knob]]
name = "seed"
label = "Seed"
unit = ""
initial = 0.0
min = 0.0
max = 1000000.0

[[departs]]
law = "point_limit"
error = 1.6
why = "noise: with samples=1 the one sample of the lobe misses a small light"

[[departs]]
law = "mirror_limit"
error = 1.0
why = "noise"

[[departs]]
law = "additive"
error = 1.0
why = "noise: each half has its own samples"

[[departs]]
law = "rotation"
error = 0.43
why = "noise: a sphere is sampled in a frame that does not turn with the scene"
---*/
#include "brdf.glsl"
#include "diffuse"
#include "ggx_sampling.glsl"
#include "light_sampling.glsl"
#include "light_texture.glsl"
#include "low_discrepancy.glsl"
#include "ltc.glsl"  // the shading frame
#include "specular_lobe.glsl"
#if EFFECT_TUBE
#include "tube_view.glsl"
#endif

#if SAMPLES_1
const int kSamples = 1;
#elif SAMPLES_4
const int kSamples = 4;
#elif SAMPLES_16
const int kSamples = 16;
#else
const int kSamples = 64;
#endif

#if EFFECT_POLYGON
// m, even over the polygon, from its centre: a triangle about corner 0 by its share of the area, then a point in it.
vec2 SamplePolygon(Light light, vec2 u) {
  vec2 first = LightCorner(light, 0);
  vec2 side = LightCorner(light, 1) - first;
  vec2 next = LightCorner(light, 2) - first;
  float target = u.x * light.area;
  float before = 0.0;
  float area = 0.5 * (side.x * next.y - side.y * next.x);
  for (int i = 3; i < light.corner_count; ++i) {
    if (target < before + area) break;
    before += area;
    side = next;
    next = LightCorner(light, i) - first;
    area = 0.5 * (side.x * next.y - side.y * next.x);
  }
  float r = sqrt(clamp((target - before) / max(area, 1e-30), 0.0, 1.0));
  return first + mix(side, next, u.y) * r;
}

// place: m, from the centre.
bool InPolygon(Light light, vec2 place) {
  vec2 from = LightCorner(light, light.corner_count - 1);
  bool inside = true;
  for (int i = 0; i < light.corner_count; ++i) {
    vec2 to = LightCorner(light, i);
    inside = inside && (to.x - from.x) * (place.y - from.y) >= (to.y - from.y) * (place.x - from.x);
    from = to;
  }
  return inside;
}
#endif

// Lights shaded so far in this pixel: each has points of its own.
uint lights_shaded = 0u;

Radiance ShadeLight(Surface surface, Light light, vec3 to_view) {
  Radiance result;
  result.diffuse = vec3(0.0);
  result.specular = vec3(0.0);
  lights_shaded += 1u;
  uint seed = HashCombine(HashCombine(Hash(uint(gl_FragCoord.x) + 65536u * uint(gl_FragCoord.y)), lights_shaded), uint(knob_seed));
  uint light_seed = HashCombine(seed, 1u);
  uint lobe_seed = HashCombine(seed, 2u);

  ShadingFrame frame = MakeShadingFrame(surface.normal, to_view);
  float n_dot_v = clamp(dot(surface.normal, to_view), 1e-6, 1.0);
  float sin_v = sqrt(1.0 - n_dot_v * n_dot_v);

  vec3 to_center = light.center - surface.position;
  vec3 point = -vec3(dot(light.axis_x, to_center), dot(light.axis_y, to_center), dot(light.normal, to_center));
#if EFFECT_TUBE
  TubeView tube;
  float widest = 0.0;  // rad, of the wall that is seen, to either side
  if (light.shape == SHAPE_TUBE) {
    tube = ViewTube(light, surface.position);
    if (!SeesTube(light, tube)) return result;
    widest = Arccosine(light.half_size.y / tube.distance);
  }
#endif
#if EFFECT_SPHERE
  Cap cap;
  if (light.shape == SHAPE_SPHERE) {
    // From inside nothing of its outside is seen.
    if (dot(to_center, to_center) <= light.half_size.x * light.half_size.x) return result;
    cap = SphereCap(to_center, light.half_size.x, surface.normal);
  }
#endif
#if EFFECT_RECTANGLE
  SphericalRectangle rectangle = ViewSphericalRectangle(point, light.half_size);
#endif

  for (int i = 0; i < kSamples; ++i) {
    bool of_light = kSamples == 1 ? (seed & 1u) == 0u : (i & 1) == 0;
    vec2 u = SobolPoint(uint(i >> 1), of_light ? light_seed : lobe_seed);
    vec3 to_light = vec3(0.0);  // unit, world
    if (!of_light) {
      vec3 h = SampleVisibleHalfVector(n_dot_v, surface.alpha, u);
      float v_dot_h = sin_v * h.x + n_dot_v * h.z;
      vec3 local = vec3(2.0 * v_dot_h * h.x - sin_v, 2.0 * v_dot_h * h.y, 2.0 * v_dot_h * h.z - n_dot_v);
      to_light = frame.tangent * local.x + frame.bitangent * local.y + frame.normal * local.z;
    }
    float light_density = 0.0;  // stays 0 where the lobe's sample misses the light
#if EFFECT_TEXTURED
    vec3 texel = vec3(1.0);
#endif
#if EFFECT_SPHERE
    if (light.shape == SHAPE_SPHERE) {
      if (of_light) to_light = SampleCap(cap, u);
      if (of_light || VersineBetween(to_light, cap.axis) <= cap.versine) light_density = 1.0 / (2.0 * kPi * max(cap.versine, 1e-30));
    }
#endif
#if EFFECT_TUBE
    if (light.shape == SHAPE_TUBE) {
      float radius = light.half_size.y;
      vec3 on_light = to_light;  // m, from the point
      bool met = of_light;
      if (of_light) {
        float angle = widest * (2.0 * u.x - 1.0);
        on_light = to_center + light.axis_x * (light.half_size.x * (2.0 * u.y - 1.0)) +
                   (tube.toward * cos(angle) + cross(light.axis_x, tube.toward) * sin(angle)) * radius;
        to_light = on_light * inversesqrt(dot(on_light, on_light));
      } else {
        float distance_to_wall = DistanceToTube(light, tube, to_center, to_light);
        met = distance_to_wall > 0.0;
        on_light = to_light * distance_to_wall;
      }
      if (met) {
        vec3 from_axis = on_light - to_center;
        from_axis -= light.axis_x * dot(from_axis, light.axis_x);
        float area = 4.0 * widest * radius * light.half_size.x;
        light_density = dot(on_light, on_light) / max(area * -dot(from_axis, to_light) / radius, 1e-30);
      }
    }
#endif
#if EFFECT_RECTANGLE || EFFECT_DISK || EFFECT_POLYGON
#if EFFECT_TUBE
    if (light.shape != SHAPE_SPHERE && light.shape != SHAPE_TUBE)
#else
    if (light.shape != SHAPE_SPHERE)
#endif
    {
      float height = max(point.z, 1e-5 * (light.half_size.x + light.half_size.y));
      vec3 on_light = vec3(0.0, 0.0, -height);  // m, from the point, in the light's frame
      if (of_light) {
#if EFFECT_RECTANGLE
        if (light.shape == SHAPE_RECTANGLE) on_light = SampleSphericalRectangle(rectangle, u);
#endif
#if EFFECT_DISK
#if EFFECT_ELLIPSE
        if (light.shape == SHAPE_DISK) on_light = vec3(SampleDisk(1.0, u) * light.half_size - vec2(point.x, point.y), -height);
#else
        if (light.shape == SHAPE_DISK) on_light = vec3(SampleDisk(light.half_size.x, u) - vec2(point.x, point.y), -height);
#endif
#endif
#if EFFECT_POLYGON
        if (light.shape == SHAPE_POLYGON) on_light = vec3(SamplePolygon(light, u) - vec2(point.x, point.y), -height);
#endif
        to_light = (light.axis_x * on_light.x + light.axis_y * on_light.y + light.normal * on_light.z) * inversesqrt(dot(on_light, on_light));
      } else {
        float fall = max(-dot(light.normal, to_light), 1e-9);
        on_light = vec3(dot(light.axis_x, to_light), dot(light.axis_y, to_light), -fall) * (height / fall);
      }
      vec2 place = vec2(point.x + on_light.x, point.y + on_light.y);
      bool faced = dot(light.normal, to_light) < 0.0;
#if EFFECT_TEXTURED
      texel = ExactTexel(light, TextureCoordinates(light, place));
#endif
#if EFFECT_RECTANGLE
      if (light.shape == SHAPE_RECTANGLE && faced && (of_light || (abs(place.x) <= light.half_size.x && abs(place.y) <= light.half_size.y))) {
        light_density = SphericalRectangleDensity(rectangle, on_light);
      }
#endif
#if EFFECT_POLYGON
      if (light.shape == SHAPE_POLYGON && faced && (of_light || InPolygon(light, place))) light_density = AreaDensity(on_light, light.area);
#endif
#if EFFECT_DISK
#if EFFECT_ELLIPSE
      vec2 share = place / light.half_size;
      bool in_disk = dot(share, share) <= 1.0;
#else
      bool in_disk = dot(place, place) <= light.half_size.x * light.half_size.x;
#endif
      if (light.shape == SHAPE_DISK && faced && (of_light || in_disk)) {
        light_density = AreaDensity(on_light, light.area);
      }
#endif
    }
#endif
    float n_dot_l = dot(surface.normal, to_light);
    if (light_density > 0.0 && n_dot_l > 0.0) {
      vec3 sum = to_view + to_light;
      vec3 half_vector = sum * inversesqrt(max(dot(sum, sum), 1e-20));
      float lobe_density = VisibleMirrorDensity(n_dot_v, surface.alpha, GgxDensityBetween(surface.normal, half_vector, surface.alpha));
#if EFFECT_TEXTURED
      vec3 weight = texel * (2.0 / (light_density + lobe_density));
#else
      float weight = 2.0 / (light_density + lobe_density);
#endif
      result.diffuse += DiffuseAlbedo(surface, to_view, to_light) * (weight * n_dot_l / kPi);
      result.specular += SpecularLobe(surface, to_view, to_light) * weight;
    }
  }
  result.diffuse *= light.radiance / float(kSamples);
  result.specular *= light.radiance / float(kSamples);
  return result;
}
