#pragma once
// A rectangle light as a shaded point sees it. Dual: also compiles as C++ (glsl/dual_begin.h).
//
// The form factor of a polygon for a clamped cosine about +z is F_z with the vector form factor [Lambert 1760; Baum et al. 1989]
//   F = 1/(2π) Σ θ_i (v_i × v_{i+1}) / |v_i × v_{i+1}|,
// θ_i the angle between successive corners. An option "edge" gives the quotient θ/|v_i × v_{i+1}|, its angles in the unit of which kTurn
// make a full turn: 1, or 2π. A cross product along a side of a parallelogram is linear in where the side lies, so few of them are
// ever formed.
#include "lit.glsl"
#include "surface.glsl"

// A rectangle that is small against its distance.
//
// There the terms of opposite edges differ by size over distance of themselves, and their sum loses as many digits: 1e-7 · distance/size
// of it, all of it at 1e7. The centre alone is wrong by (size/distance)²; both are 1.6e-5 where the half diagonal is 1/250 of the distance.
const float kSmallRectangle = 1.6e-5;

// In the shading frame (tangent, bitangent, normal) and in the light's own axes. The light faces the point:
// half_a × half_b points to the origin's side.
struct RectangleView {
  vec3 center;     // m, shading frame, from the shaded point
  vec3 half_a;     // m, shading frame
  vec3 half_b;     // m, shading frame; perpendicular to half_a
  vec3 in_plane;   // m, the centre along the light's axis_x, axis_y and normal
  vec3 horizon;    // the shading normal along the same
  vec2 half_size;  // m, |half_a| and |half_b|
  bool small;      // against its distance
};

// position: m, world; the frame's three axes are unit and perpendicular.
RectangleView ViewRectangle(Light light, vec3 position, vec3 tangent, vec3 bitangent, vec3 normal) {
  vec3 to_center = light.center - position;
  RectangleView view;
  view.center = vec3(dot(tangent, to_center), dot(bitangent, to_center), dot(normal, to_center));
  view.horizon = vec3(dot(normal, light.axis_x), dot(normal, light.axis_y), dot(normal, light.normal));
  view.half_a = vec3(dot(tangent, light.half_axis_x), dot(bitangent, light.half_axis_x), view.horizon.x * light.half_size.x);
  view.half_b = vec3(dot(tangent, light.half_axis_y), dot(bitangent, light.half_axis_y), view.horizon.y * light.half_size.y);
  view.in_plane = vec3(dot(light.axis_x, to_center), dot(light.axis_y, to_center), dot(light.normal, to_center));
  view.half_size = light.half_size;
  view.small = dot(light.half_size, light.half_size) < kSmallRectangle * dot(view.in_plane, view.in_plane);
  return view;
}

// The third component of a × b.
float CrossZ(vec3 a, vec3 b) { return a.x * b.y - a.y * b.x; }

// Below any light's (length)⁴: 1e-30 is a light of 3e-8 m seen from as far. Keeps an edge through the point finite.
const float kSmallestEdge = 1e-30;

// θ/line, in turns, of an edge from the acute angle's, for an "edge" that leaves the mirroring to its caller: (π − θ')/line where d < 0.
float MirroredEdge(float acute, float d, float line2) { return d >= 0.0 ? acute : 0.5 * inversesqrt(line2 + kSmallestEdge) - acute; }

// A form factor lies in [0, 1]; rounding can leave that range.
float AsFormFactor(float value) { return clamp(value, 0.0, 1.0); }

// The same of any parallelogram, as a light is in a lobe's space.
bool IsSmallParallelogram(vec3 center, vec3 half_a, vec3 half_b) {
  return dot(half_a, half_a) + dot(half_b, half_b) < kSmallRectangle * dot(center, center);
}

// Its vector form factor over its direction, by its centre; half_a × half_b towards the origin. `inverse`: 1/|center|.
float SmallRectangleSize(vec3 center, vec3 half_a, vec3 half_b, float inverse) {
  return max(-dot(cross(half_a * inverse, half_b * inverse), center * inverse), 0.0) * (4.0 / kPi);
}

vec3 SmallRectangleVector(vec3 center, vec3 half_a, vec3 half_b) {
  float inverse = inversesqrt(dot(center, center));
  return center * (inverse * SmallRectangleSize(center, half_a, half_b, inverse));
}

// The same of what is above the horizon: the mean height over it, as if the heights were spread evenly, in place of the centre's.
vec3 ClippedSmallRectangle(vec3 center, vec3 half_a, vec3 half_b) {
  float inverse = inversesqrt(dot(center, center));
  float per_length = inverse * SmallRectangleSize(center, half_a, half_b, inverse);
  float reach = abs(half_a.z) + abs(half_b.z);
  float above = clamp(center.z, -reach, reach) + reach;
  float height = center.z > reach ? center.z : above * above / max(4.0 * reach, 1e-30);
  return vec3(center.x * per_length, center.y * per_length, height * per_length);
}
