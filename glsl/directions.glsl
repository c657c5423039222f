#pragma once
// Angles, in more digits than drivers give, and perpendiculars. Dual: also compiles as C++.
#include "surface.glsl"

// atan(y / x), y ≥ 0, x ≥ 0: three halvings of the angle, then Taylor's series; 1e-13. Drivers' own is good to 2e-5 only.
float PositiveAngle(float y, float x) {
  bool steep = y > x;
  float t = min(y, x) / max(max(y, x), 1e-30);
  t = t / (1.0 + sqrt(1.0 + t * t));
  t = t / (1.0 + sqrt(1.0 + t * t));
  t = t / (1.0 + sqrt(1.0 + t * t));
  float t2 = t * t;
  float series = 1.0 + t2 * (-1.0 / 3.0 + t2 * (1.0 / 5.0 + t2 * (-1.0 / 7.0 + t2 * (1.0 / 9.0 - t2 / 11.0))));
  float angle = 8.0 * t * series;
  return steep ? 0.5 * kPi - angle : angle;
}

// The angle in (−π, π] of the direction (x, y).
float Angle(float y, float x) {
  float a = PositiveAngle(abs(y), abs(x));
  a = x < 0.0 ? kPi - a : a;
  return y < 0.0 ? -a : a;
}

vec3 AnyPerpendicular(vec3 v) {
  vec3 axis = abs(v.x) < 0.5 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
  vec3 p = cross(v, axis);
  return p * inversesqrt(dot(p, p));
}
