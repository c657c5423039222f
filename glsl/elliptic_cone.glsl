#pragma once
// The cone of directions that an ellipse, a disk or a sphere covers.
#include "directions.glsl"

// The elliptic cone of directions that a disk or a sphere covers, as in compare/closed_forms.h: axis_1 is the wider one.
struct Cone {
  vec3 axis_1;
  vec3 axis_2;
  vec3 axis_3;
  float sin_1;
  float cos_1;
  float sin_2;
  float cos_2;
};

// Of an ellipse, its half axes perpendicular to each other and to the normal. μ is the largest of c's confocal coordinates, as in
// compare/closed_forms.cpp; the lesser eigenvalue across the axis comes of the determinant. Lengths over the longer half axis.
Cone EllipseCone(vec3 center, vec3 half_a, vec3 half_b, vec3 normal) {
  float length_a = length(half_a);
  float length_b = length(half_b);
  float unit = 1.0 / max(length_a, length_b);
  vec3 along_a = half_a / length_a;
  vec3 along_b = half_b / length_b;
  float a2 = length_a * unit * length_a * unit;
  float b2 = length_b * unit * length_b * unit;
  // Nearer the plane than this the cone is all rounding.
  vec3 c = vec3(dot(center, along_a) * unit, dot(center, along_b) * unit, min(dot(center, normal) * unit, -1e-6));
  vec3 square = c * c;
  float mu = max(square.z, square.x + square.y + square.z - 1.0);
  for (int step = 0; step < 24; ++step) {
    float u = square.x / (mu + a2);
    float v = square.y / (mu + b2);
    float w = square.z / mu;
    mu += max(u + v + w - 1.0, 0.0) / (u / (mu + a2) + v / (mu + b2) + w / mu);
  }
  vec3 e3 = normalize(vec3(c.x / (mu + a2), c.y / (mu + b2), c.z / mu));
  vec3 e1 = AnyPerpendicular(e3);
  vec3 e2 = cross(e3, e1);
  vec3 c_e = vec3(dot(c, e1), dot(c, e2), 0.0);
  float g11 = a2 * e1.x * e1.x + b2 * e1.y * e1.y - c_e.x * c_e.x;
  float g22 = a2 * e2.x * e2.x + b2 * e2.y * e2.y - c_e.y * c_e.y;
  float g12 = a2 * e1.x * e2.x + b2 * e1.y * e2.y - c_e.x * c_e.y;
  float difference = 0.5 * (g11 - g22);
  float root = sqrt(difference * difference + g12 * g12);
  float wide = max(0.5 * (g11 + g22) + root, 1e-30);
  float narrow = min(a2 * b2 * square.z / (mu * wide), wide);
  // 1e-18: a round cone has no axes of its own.
  vec2 turn = difference > 0.0 ? vec2(difference + root + 1e-18, g12) : vec2(g12, root - difference + 1e-18);
  turn *= inversesqrt(turn.x * turn.x + turn.y * turn.y);
  vec3 axis_1 = e1 * turn.x + e2 * turn.y;
  Cone cone;
  cone.axis_1 = along_a * axis_1.x + along_b * axis_1.y + normal * axis_1.z;
  cone.axis_3 = along_a * e3.x + along_b * e3.y + normal * e3.z;
  cone.axis_2 = cross(cone.axis_3, cone.axis_1);
  float inv_1 = inversesqrt(wide + mu);
  float inv_2 = inversesqrt(narrow + mu);
  cone.sin_1 = sqrt(wide) * inv_1;
  cone.cos_1 = sqrt(mu) * inv_1;
  cone.sin_2 = sqrt(narrow) * inv_2;
  cone.cos_2 = sqrt(mu) * inv_2;
  return cone;
}
