#pragma once
// One point of a rectangle or a disk that stands for the whole in the diffuse integral [Drobot 2014, §1.3.3].
// Dual: also compiles as C++. Everything is in the light's frame: centre at the origin, z along the lit side's normal,
// m; `point` is shaded, point.z > 0; `normal` is its unit normal.
#include "surface.glsl"

// Where the surface turns away from the light's plane the ray along its normal never meets it, and cosθ_i grows towards
// the plane's infinity. Drobot says that the ray is to be skewed towards the plane and gives no formula. Ours: the
// direction n − max(kSkew + n_z, 0)·z, continuous, whose cosine to the plane is never below kSkew. Over 4000 random lights
// the diffuse error does not tell 0.01 from 0.3 (relative RMSE 0.51 to 0.52); 0.1 leaves all but the last 6° as they are.
const float kSkew = 0.1;

// p' − p in the light's plane: the (skewed) ray along the normal, where cosθ_i is greatest.
vec2 NormalHit(vec3 point, vec3 normal) { return vec2(normal.x, normal.y) * (point.z / max(-normal.z, kSkew)); }

// p'' − p in the light's plane, where 1/r² is greatest above the horizon: the foot of the perpendicular, or the point of
// the horizon's line nearest to it where the foot lies below. Where the whole plane lies below there is none; what is
// returned is then far away, finite.
vec2 NearestHit(vec3 point, vec3 normal) {
  float tangent2 = max(normal.x * normal.x + normal.y * normal.y, kSkew * kSkew);
  return vec2(normal.x, normal.y) * (point.z * max(normal.z, 0.0) / tangent2);
}

// The places of the light nearest to foot + hit, from the foot as `hit` is: near the light's plane that is shorter than the
// last digit of a place.
vec2 ClosestOnRectangle(vec2 foot, vec2 hit, vec2 half_size) { return clamp(hit, -half_size - foot, half_size - foot); }

vec2 ClosestOnDisk(vec2 foot, vec2 hit, float radius) {
  vec2 p = foot + hit;
  return hit + p * (radius / max(radius, length(p)) - 1.0);
}
