#pragma once
// The cap of the sphere of directions that stands for a light: a sphere's own; of a flat light the cap of its
// solid angle about the direction to its centre; a tube is the strip that the point sees of it.
#include "solid_angle.glsl"
#if EFFECT_ELLIPSE
#include "elliptic_cone.glsl"
#endif
#include "spherical_cap.glsl"
#include "surface.glsl"
#if EFFECT_TUBE
#include "tube_view.glsl"
#endif

#if EFFECT_POLYGON
// Of a polygon, sr: triangles about corner 0 as in RectangleSolidAngle, their angles added as complex numbers.
float PolygonSolidAngle(Light light, vec3 point) {
  float height = max(point.z, 1e-5 * (light.half_size.x + light.half_size.y));
  vec2 first = LightCorner(light, 0);
  vec3 v0 = vec3(first.x - point.x, first.y - point.y, -height);
  vec3 u0 = v0 * inversesqrt(dot(v0, v0));
  vec2 corner = LightCorner(light, 1);
  vec3 v1 = vec3(corner.x - point.x, corner.y - point.y, -height);
  vec3 u1 = v1 * inversesqrt(dot(v1, v1));
  vec2 sum = vec2(1.0, 0.0);  // cosine and sine of half the solid angle, times a positive factor
  for (int i = 2; i < light.corner_count; ++i) {
    vec2 next = LightCorner(light, i);
    vec3 v2 = vec3(next.x - point.x, next.y - point.y, -height);
    float i2 = inversesqrt(dot(v2, v2));
    vec3 u2 = v2 * i2;
    float twice_area = (corner.x - first.x) * (next.y - first.y) - (corner.y - first.y) * (next.x - first.x);
    float volume = height * twice_area * inversesqrt(dot(v0, v0)) * inversesqrt(dot(v1, v1)) * i2;
    vec2 turn = vec2(1.0 + dot(u0, u1) + dot(u1, u2) + dot(u2, u0), max(volume, 0.0));
    turn *= inversesqrt(max(dot(turn, turn), 1e-30));
    sum = vec2(sum.x * turn.x - sum.y * turn.y, sum.x * turn.y + sum.y * turn.x);
    corner = next;
    v1 = v2;
    u1 = u2;
  }
  return 2.0 * Arctangent(max(sum.y, 1e-30), sum.x);
}
#endif

#if EFFECT_DISK
// Of a disk or an ellipse, sr.
float RoundSolidAngle(vec3 point, vec2 half_size) {
#if EFFECT_ELLIPSE
  if (half_size.x == half_size.y) return DiskSolidAngle(point, half_size.x);  // as where the scene has no ellipse
  // As DiskSolidAngle, from the tangents of the cone.
  vec3 to_center = vec3(-point.x, -point.y, -max(point.z, 1e-6 * (half_size.x + half_size.y)));
  Cone cone = EllipseCone(to_center, vec3(half_size.x, 0.0, 0.0), vec3(0.0, half_size.y, 0.0), vec3(0.0, 0.0, 1.0));
  float tangent_1 = cone.sin_1 / max(cone.cos_1, 1e-10);
  float tangent_2 = cone.sin_2 / max(cone.cos_2, 1e-10);
  float a2 = tangent_1 * tangent_1;
  float b2 = tangent_2 * tangent_2;
  float product = tangent_1 * tangent_2;
  float sum = 0.0;
  for (int i = 0; i < 8; ++i) {
    float cosine = cos((float(i) + 0.5) * (kPi / 16.0));
    float q = a2 + (b2 - a2) * cosine * cosine;
    float root = sqrt(1.0 + q);
    sum += product / (root * (1.0 + root));
  }
  return min(sum * (0.25 * kPi), 2.0 * kPi);
#else
  return DiskSolidAngle(point, half_size.x);
#endif
}
#endif

// Seen from `position` (m, world), off the light; fallback_axis (unit) where the position is its centre.
Cap LightCap(Light light, vec3 position, vec3 fallback_axis) {
#if EFFECT_TUBE
  if (light.shape == SHAPE_TUBE) light = StripOfTube(light, ViewTube(light, position));
#endif
  vec3 to_center = light.center - position;
  Cap cap;
#if EFFECT_SPHERE
#if EFFECT_RECTANGLE || EFFECT_DISK || EFFECT_POLYGON || EFFECT_TUBE
  if (light.shape == SHAPE_SPHERE)
#endif
  {
    cap = SphereCap(to_center, light.half_size.x, fallback_axis);
  }
#if EFFECT_RECTANGLE || EFFECT_DISK || EFFECT_POLYGON || EFFECT_TUBE
  else
#endif
#endif
#if EFFECT_RECTANGLE || EFFECT_DISK || EFFECT_POLYGON || EFFECT_TUBE
  {
    vec3 point = -vec3(dot(to_center, light.axis_x), dot(to_center, light.axis_y), dot(to_center, light.normal));
    float solid_angle = 0.0;
#if EFFECT_POLYGON
    if (light.shape == SHAPE_POLYGON) {
      solid_angle = PolygonSolidAngle(light, point);
    } else
#endif
    {
#if (EFFECT_RECTANGLE || EFFECT_TUBE) && EFFECT_DISK
      if (light.shape == SHAPE_DISK) {
        solid_angle = RoundSolidAngle(point, light.half_size);
      } else {
        solid_angle = RectangleSolidAngle(point, light.half_size);
      }
#elif EFFECT_DISK
      solid_angle = RoundSolidAngle(point, light.half_size);
#elif EFFECT_RECTANGLE || EFFECT_TUBE
      solid_angle = RectangleSolidAngle(point, light.half_size);
#endif
    }
    cap = SphereCap(to_center, 0.0, fallback_axis);
    cap.versine = solid_angle / (2.0 * kPi);
  }
#endif
  return cap;
}
