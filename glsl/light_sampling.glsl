#pragma once
// Directions to a light drawn with a known density. Dual: also compiles as C++.
// Rectangle and disk in the light's frame, seen from a point at `height` above their plane: vectors run from the point to
// the light, so z is −height. u is uniform in [0, 1)². Densities are per solid angle, 1/sr.
#include "directions.glsl"
#include "solid_angle.glsl"
#include "spherical_cap.glsl"

// Below this, sr, the spherical rectangle's angles have lost the solid angle's digits in float (their rounding is 1e-7), and
// points even over the area do as well.
const float kLeastSphericalRectangle = 1e-2;

// A rectangle on the sphere of directions [Ureña et al. 2013].
struct SphericalRectangle {
  vec2 low;           // m, from the point
  vec2 high;          // m
  float height;       // m, above 0
  float solid_angle;  // sr
  float begin;        // k of the paper: 2π less the angles at the corners of low.x
  vec2 tilt;          // b0, b1: cosines of the planes through the sides of low.y and high.y
};

// `point` as in solid_angle.glsl.
SphericalRectangle ViewSphericalRectangle(vec3 point, vec2 half_size) {
  SphericalRectangle r;
  r.height = max(point.z, 1e-5 * (half_size.x + half_size.y));
  r.low = -half_size - vec2(point.x, point.y);
  r.high = half_size - vec2(point.x, point.y);
  r.solid_angle = RectangleSolidAngle(point, half_size);
  // The angle between the planes through two sides that meet at (x, y): their normals' cross product has the length
  // height · √(x² + y² + height²), their dot product is ± x y.
  float h2 = r.height * r.height;
  float at_high = Angle(r.height * sqrt(r.low.x * r.low.x + r.high.y * r.high.y + h2), r.low.x * r.high.y);
  float at_low = Angle(r.height * sqrt(r.low.x * r.low.x + r.low.y * r.low.y + h2), -r.low.x * r.low.y);
  r.begin = 2.0 * kPi - at_high - at_low;
  r.tilt = vec2(-r.low.y * inversesqrt(r.low.y * r.low.y + h2), r.high.y * inversesqrt(r.high.y * r.high.y + h2));
  return r;
}

// m, from the point to the light.
vec3 SampleSphericalRectangle(SphericalRectangle r, vec2 u) {
  if (r.solid_angle < kLeastSphericalRectangle) return vec3(mix(r.low.x, r.high.x, u.x), mix(r.low.y, r.high.y, u.y), -r.height);
  float angle = u.x * r.solid_angle + r.begin;
  float sine = sin(angle);
  sine = abs(sine) < 1e-7 ? 1e-7 : sine;
  float f = (cos(angle) * r.tilt.x - r.tilt.y) / sine;
  float c = clamp((f > 0.0 ? 1.0 : -1.0) * inversesqrt(f * f + r.tilt.x * r.tilt.x), -1.0, 1.0);
  float x = clamp(c * r.height * inversesqrt(max(1.0 - c * c, 1e-12)), r.low.x, r.high.x);
  float d = sqrt(x * x + r.height * r.height);
  float sine_y = mix(r.low.y * inversesqrt(d * d + r.low.y * r.low.y), r.high.y * inversesqrt(d * d + r.high.y * r.high.y), u.y);
  float y = clamp(sine_y * d * inversesqrt(max(1.0 - sine_y * sine_y, 1e-12)), r.low.y, r.high.y);
  return vec3(x, y, -r.height);
}

// Of points even over a flat light of this area, in the direction of `to_light`, m: d² / (A cosθ).
float AreaDensity(vec3 to_light, float area) {
  float distance2 = dot(to_light, to_light);
  return distance2 * sqrt(distance2) / max(area * -to_light.z, 1e-30);
}

float SphericalRectangleDensity(SphericalRectangle r, vec3 to_light) {
  if (r.solid_angle >= kLeastSphericalRectangle) return 1.0 / r.solid_angle;
  return AreaDensity(to_light, (r.high.x - r.low.x) * (r.high.y - r.low.y));
}

// m, in the disk, from its centre.
vec2 SampleDisk(float radius, vec2 u) {
  float r = radius * sqrt(u.x);
  return vec2(r * cos(2.0 * kPi * u.y), r * sin(2.0 * kPi * u.y));
}

// Unit, even over the cap; its density is 1/(2π · versine).
vec3 SampleCap(Cap cap, vec2 u) {
  float versine = cap.versine * u.x;
  float sine = sqrt(max(versine * (2.0 - versine), 0.0));
  vec3 x_axis = AnyPerpendicular(cap.axis);
  vec3 y_axis = cross(cap.axis, x_axis);
  float phi = 2.0 * kPi * u.y;
  return cap.axis * (1.0 - versine) + x_axis * (sine * cos(phi)) + y_axis * (sine * sin(phi));
}
