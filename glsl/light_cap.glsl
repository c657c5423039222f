#pragma once
// The cap of the sphere of directions that stands for a light: a sphere's own; of a rectangle and a disk the cap of their
// solid angle about the direction to their centre.
#include "solid_angle.glsl"
#include "spherical_cap.glsl"
#include "surface.glsl"

// Seen from `position` (m, world), off the light; fallback_axis (unit) where the position is its centre.
Cap LightCap(Light light, vec3 position, vec3 fallback_axis) {
  vec3 to_center = light.center - position;
  Cap cap;
#if EFFECT_SPHERE
#if EFFECT_RECTANGLE || EFFECT_DISK
  if (light.shape == SHAPE_SPHERE)
#endif
  {
    cap = SphereCap(to_center, light.half_size.x, fallback_axis);
  }
#if EFFECT_RECTANGLE || EFFECT_DISK
  else
#endif
#endif
#if EFFECT_RECTANGLE || EFFECT_DISK
  {
    vec3 point = -vec3(dot(to_center, light.axis_x), dot(to_center, light.axis_y), dot(to_center, light.normal));
    float solid_angle = 0.0;
#if EFFECT_RECTANGLE && EFFECT_DISK
    if (light.shape == SHAPE_DISK) {
      solid_angle = DiskSolidAngle(point, light.half_size.x);
    } else {
      solid_angle = RectangleSolidAngle(point, light.half_size);
    }
#elif EFFECT_DISK
    solid_angle = DiskSolidAngle(point, light.half_size.x);
#else
    solid_angle = RectangleSolidAngle(point, light.half_size);
#endif
    cap = SphereCap(to_center, 0.0, fallback_axis);
    cap.versine = solid_angle / (2.0 * kPi);
  }
#endif
  return cap;
}
