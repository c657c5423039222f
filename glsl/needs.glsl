#pragma once
// What shading a patch of pixels needs, in bits NEEDS_* that the host sets (glsl/per_pixel.h), asked for where an EFFECT_* is on: the bounds of
// glsl/effects.cpp, from the boxes that hold the patch's positions and its normals. A bit is off only where that is certain; what is within
// 1e-5 of a limit counts as beyond it.
#include "platform"
#include "lights.glsl"

const float kNeedsMargin = 1e-5;           // of lengths
const float kStandInRadii = 2.41421356;    // 1 + √2, as there

// Middle and half size of both boxes.
struct Bounds {
  vec3 position;
  vec3 normal;
  vec3 position_half;
  vec3 normal_half;
};

// How far what lies in the boxes can be from the middle's value of normal · (point − position).
float HeightSpread(Bounds bounds, vec3 to_point) {
  return dot(abs(bounds.normal), bounds.position_half) + dot(bounds.normal_half, abs(to_point) + bounds.position_half);
}

// Half the extent of a light's half axis along any of the normals.
float AxisReach(Bounds bounds, vec3 half_axis) { return abs(dot(bounds.normal, half_axis)) + dot(bounds.normal_half, abs(half_axis)); }

// How far a light reaches at most from its centre along any of the normals, m; a polygon by the rectangle that holds it.
float Reach(Bounds bounds, Light light) {
#if EFFECT_SPHERE
  if (light.shape == SHAPE_SPHERE) return light.half_size.x;
#endif
  float x = AxisReach(bounds, light.half_axis_x);
#if EFFECT_TUBE
  if (light.shape == SHAPE_TUBE) return x + light.half_size.y;
#endif
  float y = AxisReach(bounds, light.half_axis_y);
#if EFFECT_DISK
  if (light.shape == SHAPE_DISK) return sqrt(x * x + y * y);
#endif
  return x + y;
}

float Manhattan(vec3 v) { return abs(v.x) + abs(v.y) + abs(v.z); }

int LightNeeds(Bounds bounds, Light light) {
  vec3 to_center = light.center - bounds.position;
  // Of the sphere that holds it, or a little more.
  float radius = light.shape == SHAPE_SPHERE ? light.half_size.x : light.half_size.x + light.half_size.y;
#if EFFECT_DISK
  if (light.shape == SHAPE_DISK) radius = max(light.half_size.x, light.half_size.y);
#endif
  float margin = kNeedsMargin * (Manhattan(bounds.position) + Manhattan(bounds.position_half) + Manhattan(light.center) + radius);
#if EFFECT_BEHIND
  bool has_back = light.shape != SHAPE_SPHERE && light.shape != SHAPE_TUBE && !light.two_sided;
  if (has_back && dot(light.normal, to_center) - dot(abs(light.normal), bounds.position_half) > margin) return 0;
#endif
  int needs = NEEDS_LIGHT;
  float height = abs(dot(bounds.normal, to_center)) - HeightSpread(bounds, to_center) - margin;
#if EFFECT_PROXY_HORIZON
  if (!(height > kStandInRadii * radius)) needs |= NEEDS_PROXY_HORIZON;
#endif
#if EFFECT_HORIZON
  if (!(height > Reach(bounds, light))) needs |= NEEDS_HORIZON;
#endif
  return needs;
}

int BoundsNeeds(Bounds bounds) {
#if EFFECT_TURNED_AWAY
  vec3 to_view = ViewPosition() - bounds.position;
  float margin = kNeedsMargin * (Manhattan(bounds.position) + Manhattan(bounds.position_half) + Manhattan(ViewPosition()));
  if (dot(bounds.normal, to_view) + HeightSpread(bounds, to_view) < -margin) return 0;
#endif
  int needs = 0;
#if EFFECT_SKY
  needs |= NEEDS_LIGHT;
#endif
#if EFFECT_MANY_LIGHTS
  for (int i = 0; i < light_count; ++i) needs |= LightNeeds(bounds, LoadLight(i));
#else
  needs |= LightNeeds(bounds, LoadLight(0));
#endif
  return needs;
}
