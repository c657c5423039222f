#pragma once
// The solid angle of a rectangle and of a disk. Dual: also compiles as C++.
// `point` is the seeing point in the light's frame: centre at the origin, z along the lit side's normal, m; point.z > 0.
#include "directions.glsl"

// Two triangles after [Van Oosterom & Strackee 1983, eq. 8], their angles added as complex numbers; exact, sr, in [0, 2π).
// The numerators are volumes, so a small or far rectangle keeps its digits.
float RectangleSolidAngle(vec3 point, vec2 half_size) {
  // Nearer the plane than this the cosines below are all rounding in float.
  float height = max(point.z, 1e-5 * (half_size.x + half_size.y));
  vec3 v0 = vec3(half_size.x - point.x, half_size.y - point.y, -height);
  vec3 v1 = vec3(-half_size.x - point.x, half_size.y - point.y, -height);
  vec3 v2 = vec3(-half_size.x - point.x, -half_size.y - point.y, -height);
  vec3 v3 = vec3(half_size.x - point.x, -half_size.y - point.y, -height);
  vec3 u0 = v0 * inversesqrt(dot(v0, v0));
  vec3 u2 = v2 * inversesqrt(dot(v2, v2));
  float i1 = inversesqrt(dot(v1, v1));
  float i3 = inversesqrt(dot(v3, v3));
  float volume = 4.0 * half_size.x * half_size.y * height * inversesqrt(dot(v0, v0)) * inversesqrt(dot(v2, v2));
  float diagonal = 1.0 + dot(u0, u2);
  float n1 = volume * i1;
  float n3 = volume * i3;
  float d1 = diagonal + (dot(u0, v1) + dot(u2, v1)) * i1;
  float d3 = diagonal + (dot(u0, v3) + dot(u2, v3)) * i3;
  return 2.0 * Arctangent(max(n1 * d3 + n3 * d1, 1e-30), d1 * d3 - n1 * n3);
}

// The disk's elliptic cone has the squared tangents a² = 4R²·g/Q (in the plane of symmetry) and b² = 4R²/Q (across), with
// l1, l2 the distances to the nearest and farthest point of the rim, Q = (l1 + l2)² − 4R², g = ((l1 + l2)² − 4ρ²)/(l1 + l2)².
// Its solid angle ∮ ab dt/(√(1+q)(1+√(1+q))), q = a² cos²t + b² sin²t, is taken by the midpoint rule at four t of a quarter.
// Relative error at most 2.5e-5 farther than 0.2 R from the rim, 2e-2 anywhere, against the contour integral; exact on the axis.
float DiskSolidAngle(vec3 point, float radius) {
  float radius2 = radius * radius;
  float rho2 = point.x * point.x + point.y * point.y;
  float height2 = max(point.z * point.z, 1e-12 * radius2);
  // Each (l1 + l2)² − x² = 2 (e + √(e² + 4 x² h²)) with its own e, written so that a negative e cancels nothing.
  float e = rho2 + height2 - radius2;
  float f = radius2 + height2 - rho2;
  float product = sqrt(e * e + 4.0 * radius2 * height2);  // l1 l2
  float q_scale = e > 0.0 ? 2.0 * (e + product) : 8.0 * radius2 * height2 / (product - e);
  float g_scale = f > 0.0 ? 2.0 * (f + product) : 8.0 * rho2 * height2 / (product - f);
  float g = min(g_scale / (q_scale + 4.0 * radius2), 1.0);
  float numerator = 4.0 * radius2 * sqrt(g);
  float sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    float cosine = cos((float(i) + 0.5) * (kPi / 8.0));
    float q = q_scale + 4.0 * radius2 * (1.0 + (g - 1.0) * cosine * cosine);
    sum += numerator / (q + sqrt(q_scale * q));
  }
  return min(sum * (0.5 * kPi), 2.0 * kPi);
}
