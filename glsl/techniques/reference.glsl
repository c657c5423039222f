/*---
summary = "The truth's own integrals in the shader: closed form factors, Gauss rays in the slope plane; no noise"
citation = "Lambert 1760; Walter et al. 2007; Heitz 2014"
author_note = "Ours: the rule of the ground truth at a fixed number of nodes, a tube's rims as chains of 8 chords; of a textured light, squares divided until the lobe is even over each, with the texture's own weights"
shapes = ["rectangle", "disk", "sphere", "polygon", "ellipse", "tube"]
lobes = ["diffuse", "specular"]
brdfs = ["ggx", "ggx_separable", "beckmann", "blinn_phong", "ward", "phong"]
diffuse_brdfs = ["lambert", "disney"]
effects = ["two_sided", "fresnel", "many_lights", "textured"]
exact = ["lambert_rectangle", "lambert_disk", "lambert_sphere", "lambert_tube", "specular_rectangle", "specular_disk", "specular_sphere", "specular_tube", "point_limit", "mirror_limit", "additive"]

[[option]]
name = "level"
summary = "Nodes along each part of the outline and along each ray from the lobe's centre"
choices = [
  ["normal", "8 and 6: about 1e-3 for GGX, up to 4e-2 for a sharp lobe with a steeper tail"],
  ["dense", "16 and 12: what float can hold, 1e-3 for a sharp lobe with a steeper tail"],
]

[[departs]]
law = "mirror_limit"
when = { brdf = ["beckmann", "blinn_phong", "ward", "phong"] }
error = 0.12
why = "too few nodes for a steep tail at the light's edge"

[[departs]]
law = "specular_rectangle"
when = { brdf = "phong" }
error = 0.003
why = "too few nodes for a step at the lobe's end"

[[departs]]
law = "specular_sphere"
when = { brdf = "phong" }
error = 0.0023
why = "too few nodes for a step at the lobe's end"

[[departs]]
law = "specular_tube"
when = { brdf = "phong" }
error = 0.0047
why = "too few nodes for a step at the lobe's end"

[[departs]]
law = "additive"
when = { brdf = "phong" }
error = 0.0066
why = "too few nodes for a step at the lobe's end"

[[departs]]
law = "additive"
when = { brdf = "beckmann", shape = "tube" }
error = 0.00024
why = "too few nodes for a steep tail"
---*/
#include "far_field.glsl"
#include "gauss_nodes.glsl"
#include "outline.glsl"
#include "brdf"
#include "diffuse"
#include "textured_rectangle.glsl"

// Half the nodes do where a ray's y or a panel's u is shorter, and all of them up to kLongestPart: Gauss's error falls with the
// stretch's 2N-th power. Of 7815 grazing views of tests/compare/hard_configurations.h 0.1 % are more than 10 % off, as with parts of 4,
// which cost 5 % more time; undivided it was 4.3 %.
const float kShortReach = 0.15;
const float kShortPanel = 1.2;
const float kLongestPart = 6.0;

// The arc's point nearest to `to`: (t, the foot on the tangent there as an offset in t, speed²), and its slope.
vec3 NearestOnArc(Arc arc, LobeView view, vec2 to, out vec2 nearest) {
  const int kChords = 3;
  const int kCuts = 3;
  const int kSteps = 2;
  vec2 slope;
  vec2 derivative;
  ArcSlope(arc, view, arc.t0, slope, derivative);
  vec2 begin = slope - to;
  float t_begin = arc.t0;
  float least = 1e30;
  vec4 ends = vec4(0.0);  // of the nearest chord
  vec2 times = vec2(arc.t0, arc.t1);
  float part = 0.0;
  for (int i = 1; i <= kChords; ++i) {
    float t = mix(arc.t0, arc.t1, float(i) / float(kChords));
    ArcSlope(arc, view, t, slope, derivative);
    vec2 end = slope - to;
    vec2 along = end - begin;
    float x = clamp(-dot(begin, along) / max(dot(along, along), 1e-30), 0.0, 1.0);
    vec2 at = begin + along * x;
    if (dot(at, at) < least) {
      least = dot(at, at);
      ends = vec4(begin, end);
      times = vec2(t_begin, t);
      part = x;
    }
    begin = end;
    t_begin = t;
  }
  float low = times.x;
  float high = times.y;
  for (int cut = 0; cut < kCuts; ++cut) {
    float t = 0.5 * (times.x + times.y);
    ArcSlope(arc, view, t, slope, derivative);
    vec2 middle = slope - to;
    vec2 along_0 = middle - ends.xy;
    vec2 along_1 = ends.zw - middle;
    float x0 = clamp(-dot(ends.xy, along_0) / max(dot(along_0, along_0), 1e-30), 0.0, 1.0);
    float x1 = clamp(-dot(middle, along_1) / max(dot(along_1, along_1), 1e-30), 0.0, 1.0);
    vec2 at_0 = ends.xy + along_0 * x0;
    vec2 at_1 = middle + along_1 * x1;
    bool first = dot(at_0, at_0) <= dot(at_1, at_1);
    part = first ? x0 : x1;
    ends = first ? vec4(ends.xy, middle) : vec4(middle, ends.zw);
    times = first ? vec2(times.x, t) : vec2(t, times.y);
  }
  float t = mix(times.x, times.y, part);
  float offset = 0.0;
  float speed2 = 1.0;
  for (int i = 0; i <= kSteps; ++i) {
    ArcSlope(arc, view, t, slope, derivative);
    speed2 = max(dot(derivative, derivative), 1e-30);
    offset = -dot(slope - to, derivative) / speed2;
    if (i < kSteps) t = clamp(t + offset, low, high);
  }
  nearest = slope;
  return vec3(t, offset, speed2);
}

// The lobe's BRDF over GgxDensity.
float LobeOverGgx(LobeView view, SlopeLight light, float slope2) {
#if !DIFFUSE_LAMBERT
  if (view.roughness >= 0.0) return DiffuseOverLambert(view.cos_v, light.n_dot_l, light.v_dot_h * light.v_dot_h, view.roughness);
#endif
  return BrdfOverGgx(view.cos_v, light.n_dot_l, light.v_dot_h, slope2, view.alpha);
}

// ∫ r dr along a ray of the lobe over α²/π: from `origin`, r = origin + size·p(y), y up to `reach`.
vec2 RayIntegral(LobeView view, vec2 center, vec2 direction, float origin, float size, float reach) {
  vec2 sum = vec2(0.0);
  float alpha2 = view.alpha * view.alpha;
  float center2 = dot(center, center);
  float along = dot(center, direction);
  int first = reach < kShortReach ? 0 : FEW_RAY_NODES;
  int last = reach < kShortReach ? FEW_RAY_NODES : FEW_RAY_NODES + RAY_NODES;
  for (int i = first; i < last; ++i) {
    float p;
    float derivative;
    RayMap(reach * kRayNodes[i].x, p, derivative);
    float r = origin + size * p;
    float slope2 = max(center2 + r * (2.0 * along + r), 0.0);
    float tail = alpha2 + slope2;
    SlopeLight light = LightAtSlope(view, center.x + r * direction.x, slope2);
    sum += LobeWeights(light, LobeOverGgx(view, light, slope2)) * (kRayNodes[i].y * derivative * (r / tail) / tail);
  }
  return sum * (reach * size);
}

// asinh(x), with its digits near 0.
float Asinh(float x) {
  float a = abs(x);
  float u = Log1p(a + a * a / (1.0 + sqrt(a * a + 1.0)));
  return x < 0.0 ? -u : u;
}

// One stretch of an arc, t = t_center + width·sinh u; a long one in parts, since a view that grazes spreads it over many widths.
vec2 PanelIntegral(Arc arc, LobeView view, vec2 center, float scale, float ring, float t0, float t1, float t_center, float width) {
  vec2 sum = vec2(0.0);
  float begin = Asinh((t0 - t_center) / width);
  float range = Asinh((t1 - t_center) / width) - begin;
  bool few = range < kShortPanel;
  int count = few ? FEW_NODES : NODES;
  int parts = int(clamp(ceil(range / kLongestPart), 1.0, 8.0));
  float part_range = range / float(parts);
  for (int i = 0; i < parts * count; ++i) {
    int before = i / count;
    vec2 node = kNodes[i - before * count + (few ? 0 : FEW_NODES)];
    float grow = exp(begin + part_range * (float(before) + node.x));
    float sinh_u = 0.5 * (grow - 1.0 / grow);
    float cosh_u = 0.5 * (grow + 1.0 / grow);
    vec2 slope;
    vec2 derivative;
    ArcSlope(arc, view, clamp(t_center + width * sinh_u, t0, t1), slope, derivative);
    vec2 offset = slope - center;
    float length2 = max(dot(offset, offset), 1e-30);
    float inv = inversesqrt(length2);
    vec2 direction = offset * inv;
    float span = length2 * inv - ring;
    float turn = (direction.x * derivative.y - direction.y * derivative.x) * inv * (width * cosh_u * part_range * node.y);
    float layer = LayerLength(view, slope, direction);
    bool layered = layer * kThinLayer < span;
    float part = layered ? min(sqrt(layer * span), 0.5 * span) : 0.0;
    vec2 ray = vec2(0.0);
    // One loop, so that the ray's text stands once in the compiled shader: the layer, seen from the far end, then the rest.
    for (int k = layered ? 0 : 1; k < 2; ++k) {
      float stretch = k == 0 ? part : span - part;
      float size = k == 0 ? layer : scale;
      float sense = k == 0 || stretch < 0.0 ? -1.0 : 1.0;
      vec2 integral = RayIntegral(view, center, direction, k == 0 ? ring + span : ring, sense * size, RayMapInverse(abs(stretch) / size));
      ray += k == 0 ? -integral : integral;
    }
    sum += ray * turn;
  }
  return sum;
}

// How much of an arc's end is a panel of its own: 0 where nothing there is thinner than the nodes lie.
float CrowdedEnd(float end, float size, float foot, float width, float range) {
  float spacing = sqrt(width * width + (end - foot) * (end - foot));
  return size * kThinLayer < min(spacing, range) ? min(sqrt(size * spacing), 0.5 * range) : 0.0;
}

// Whether a ray from the center to slope s passes close by 0, over the lobe's peak.
bool OverPeak(vec2 center, vec2 slope) {
  vec2 ray = slope - center;
  float length2 = dot(ray, ray);
  float back = -dot(ray, center);
  return back > 0.0 && back < length2 && back * back > 0.75 * dot(center, center) * length2;
}

// ∫ D G2 / (4 cosθ_v) dω over the outlined region, with Fresnel 1 and with Schlick's weight.
vec2 SpecularIntegrals(Outline outline, LobeView view) {
  vec2 center = vec2(0.0);
  vec2 origin = vec2(0.0);
  float least = 1e30;
  float ring = 0.0;
  float scale = view.alpha;
  float blur = view.alpha;
  vec2 sum = vec2(0.0);
  // Pass 0 looks for the outline's nearest point to 0, pass 1 whether rays from there are good, pass 2 integrates: one loop,
  // so that the search's text stands once in the compiled shader.
  bool over_peak = false;
  for (int pass = outline.mirror_inside ? 2 : 0; pass < 3; ++pass) {
    if (pass == 1) {
      center = origin;
      scale = sqrt(view.alpha * view.alpha + dot(center, center));
      blur = scale;
    }
    if (pass == 2 && over_peak) {
      // Radial rays from the circle about 0 that touches the outline.
      ring = length(center);
      center = vec2(0.0);
      blur = 0.0;
    }
    for (int i = 0; i < outline.arc_count; ++i) {
      Arc arc = OutlineArc(outline, i);
      vec2 slope;
      if (pass == 1) {
        vec2 derivative;
        ArcSlope(arc, view, arc.t1, slope, derivative);
        over_peak = over_peak || (scale > 1.118 * view.alpha && OverPeak(center, slope));  // |center| > α/2
        continue;
      }
      vec3 nearest = NearestOnArc(arc, view, center, slope);
      if (pass == 0) {
        if (dot(slope, slope) < least) {
          least = dot(slope, slope);
          origin = slope;
        }
        continue;
      }
      vec2 offset = slope - center;
      float across = max(dot(offset, offset) - nearest.y * nearest.y * nearest.z, 0.0);
      float width = clamp(sqrt((blur * blur + across) / nearest.z), 1e-7, 8.0);
      float foot = nearest.x + nearest.y;
      float height;
      float rise;
      ArcHeight(arc, arc.t0, height, rise);
      float layer_0 = (max(height, 0.0) + LayerHeight(view)) / max(rise, 1e-9);
      ArcHeight(arc, arc.t1, height, rise);
      float layer_1 = (max(height, 0.0) + LayerHeight(view)) / max(-rise, 1e-9);
      if (arc.cos_2 > 0.0) {
        float tip = max(0.5 * arc.cos_1 / arc.cos_2, 1e-6);
        layer_0 = abs(arc.t0) < 1e-6 ? min(layer_0, tip) : layer_0;
        layer_1 = abs(arc.t1) < 1e-6 ? min(layer_1, tip) : layer_1;
      }
      float range = arc.t1 - arc.t0;
      float cut_0 = arc.t0 + CrowdedEnd(arc.t0, layer_0, foot, width, range);
      float cut_1 = arc.t1 - CrowdedEnd(arc.t1, layer_1, foot, width, range);
      for (int k = 0; k < 3; ++k) {
        float t0 = k == 0 ? cut_0 : (k == 1 ? arc.t0 : cut_1);
        float t1 = k == 0 ? cut_1 : (k == 1 ? cut_0 : arc.t1);
        float t_center = k == 0 ? foot : (k == 1 ? arc.t0 : arc.t1);
        float size = k == 0 ? width : (k == 1 ? layer_0 : layer_1);
        if (t1 > t0) {
          sum += PanelIntegral(arc, view, center, scale, ring, t0, t1, t_center, size);
        }
      }
    }
  }
  return max(sum * (view.alpha * view.alpha / kPi), vec2(0.0));
}

// Whether the light is so small, seen from here, that its far field is as near to the truth as float has its outline: within 1e-3 of its
// most, since over it neither the cosines nor the lobe, α wide about its peak and as wide as it is far elsewhere, change more.
bool IsFar(Surface surface, Light light, vec3 to_view) {
  vec3 to_center = light.center - surface.position;
  float distance2 = dot(to_center, to_center);
  float extent2 = light.products.x + light.products.y;
  if (extent2 > 1e-6 * distance2) return false;
  vec3 half_vector = to_view + to_center * inversesqrt(distance2);
  float height = dot(half_vector, surface.normal);
  float spread2 = dot(half_vector, half_vector) + (surface.alpha * surface.alpha - 1.0) * height * height;
  return extent2 * (1000.0 * height * height) < distance2 * spread2;
}

Radiance ShadeLight(Surface surface, Light light, vec3 to_view) {
  if (IsFar(surface, light, to_view)) return FarField(surface, light, to_view);
#if EFFECT_TEXTURED
  if (light.image.x > 0.0) {
    Radiance textured = TexturedRectangle(surface, light, to_view);
    textured.diffuse *= light.radiance;
    textured.specular *= light.radiance;
    return textured;
  }
#endif
  LobeView view;
  view.cos_v = clamp(dot(surface.normal, to_view), 1e-4, 1.0);
  view.alpha = surface.alpha;
  vec3 across = to_view - surface.normal * dot(surface.normal, to_view);
  float across2 = dot(across, across);
  view.sin_v = sqrt(across2);
  vec3 x_axis = AnyPerpendicular(surface.normal);
  if (across2 > 1e-10) {
    x_axis = across * inversesqrt(across2);
  }
  vec3 y_axis = cross(surface.normal, x_axis);
  vec3 mirror = vec3(-view.sin_v, 0.0, view.cos_v);
  vec3 to_center = light.center - surface.position;
  vec3 center = vec3(dot(x_axis, to_center), dot(y_axis, to_center), dot(surface.normal, to_center));

  Outline outline;
  outline.corner_count = 0;
  outline.chord_count = 0;
  outline.arc_count = 0;
  outline.form_factor = 0.0;
  outline.mirror_inside = true;
#if EFFECT_TUBE
  if (light.shape == SHAPE_TUBE) {
    TubeView tube = ViewTube(light, surface.position);
    if (SeesTube(light, tube)) {
      TubeOutline(ChainOfTube(light, tube, surface.position, x_axis, y_axis, surface.normal), mirror, outline);
      vec3 mirrored = x_axis * mirror.x + surface.normal * mirror.z;
      outline.mirror_inside = DistanceToTube(light, tube, to_center, mirrored) > 0.0;
    }
  } else
#endif
#if EFFECT_POLYGON
  if (light.shape == SHAPE_POLYGON) {
    vec3 along_x = vec3(dot(x_axis, light.axis_x), dot(y_axis, light.axis_x), dot(surface.normal, light.axis_x));
    vec3 along_y = vec3(dot(x_axis, light.axis_y), dot(y_axis, light.axis_y), dot(surface.normal, light.axis_y));
    PolygonOutline(light, center, along_x, along_y, mirror, outline);
  } else
#endif
  if (light.shape == SHAPE_RECTANGLE) {
#if EFFECT_RECTANGLE
    vec3 half_a = vec3(dot(x_axis, light.half_axis_x), dot(y_axis, light.half_axis_x), dot(surface.normal, light.half_axis_x));
    vec3 half_b = vec3(dot(x_axis, light.half_axis_y), dot(y_axis, light.half_axis_y), dot(surface.normal, light.half_axis_y));
    RectangleOutline(center, half_a, half_b, mirror, outline);
#endif
  } else if (light.shape == SHAPE_DISK) {
#if EFFECT_DISK
    vec3 normal = vec3(dot(x_axis, light.normal), dot(y_axis, light.normal), dot(surface.normal, light.normal));
    if (dot(normal, center) < 0.0) {
#if EFFECT_ELLIPSE
      if (light.half_size.x != light.half_size.y) {
        vec3 half_a = vec3(dot(x_axis, light.half_axis_x), dot(y_axis, light.half_axis_x), dot(surface.normal, light.half_axis_x));
        vec3 half_b = vec3(dot(x_axis, light.half_axis_y), dot(y_axis, light.half_axis_y), dot(surface.normal, light.half_axis_y));
        ConeOutline(EllipseCone(center, half_a, half_b, normal), mirror, outline);
      } else
#endif
      ConeOutline(DiskCone(center, normal, light.half_size.x), mirror, outline);
    }
#endif
  } else {
#if EFFECT_SPHERE
    // Where the point is inside it sees no outside.
    if (dot(center, center) > 1.000001 * light.half_size.x * light.half_size.x) {
      ConeOutline(SphereCone(center, light.half_size.x), mirror, outline);
    }
#endif
  }
  Radiance result;
#if DIFFUSE_LAMBERT
  result.diffuse = surface.diffuse_albedo * light.radiance * clamp(outline.form_factor, 0.0, 1.0);
  vec2 specular = SpecularIntegrals(outline, view);
#else
  // Both lobes in one loop, so that the rule's text stands once in the compiled shader.
  result.diffuse = vec3(0.0);
  vec2 specular = vec2(0.0);
  for (int lobe = 1 - EFFECT_DIFFUSE; lobe < 1 + EFFECT_SPECULAR; ++lobe) {
    view.alpha = lobe == 0 ? 1.0 : surface.alpha;
    view.roughness = lobe == 0 ? surface.roughness : -1.0;
    specular = SpecularIntegrals(outline, view);
    if (lobe == 0) result.diffuse = surface.diffuse_albedo * light.radiance * specular.x;
  }
#endif
#if EFFECT_FRESNEL
  result.specular = light.radiance * (surface.f0 * (specular.x - specular.y) + specular.y);
#else
  result.specular = light.radiance * surface.f0 * specular.x;
#endif
  return result;
}
