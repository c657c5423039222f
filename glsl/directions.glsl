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

// The same for shading: in float a minimax polynomial in t², relative error 9.9e-8, about as long as what drivers make of atan.
float Arctangent(float y, float x) {
#if AREALAB_FLOAT
  float t = min(abs(y), abs(x)) / max(max(abs(y), abs(x)), 1e-30);
  float s = t * t;
  float a = t * (0.999999901 + s * (-0.333319907 + s * (0.199697239 + s * (-0.140194809 + s * (0.0991429286 +
            s * (-0.0594863935 + s * (0.0242524033 - 0.00469327606 * s)))))));
  a = abs(y) > abs(x) ? 0.5 * kPi - a : a;
  a = x < 0.0 ? kPi - a : a;
  return y < 0.0 ? -a : a;
#else
  return atan(y, x);
#endif
}

// acos(x); clamped.
float Arccosine(float x) { return Arctangent(sqrt(max((1.0 - x) * (1.0 + x), 0.0)), x); }

vec3 AnyPerpendicular(vec3 v) {
  vec3 axis = abs(v.x) < 0.5 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
  vec3 p = cross(v, axis);
  return p * inversesqrt(dot(p, p));
}
