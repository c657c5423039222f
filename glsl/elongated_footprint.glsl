#pragma once
// The importance cone's footprint as a parallelogram that is as long as the lobe is, clipped against the rectangle: what Drobot
// proposes and prototyped [2014, §1.6]. Dual: also compiles as C++.
#include "importance_cone.glsl"

// A polygon's corners as they come: area by Gauss's formula and first moment, both from its first corner.
struct CornerSum {
  int count;
  vec2 first;
  vec2 last;
  float area;   // m², twice the signed area
  vec2 moment;  // m³, six times that about the first corner
};

void AddCorner(INOUT(CornerSum) sum, vec2 p) {
  if (sum.count == 0) {
    sum.first = p;
  } else {
    vec2 a = sum.last - sum.first;
    vec2 b = p - sum.first;
    float doubled = a.x * b.y - a.y * b.x;
    sum.area += doubled;
    sum.moment += (a + b) * doubled;
  }
  sum.last = p;
  sum.count += 1;
}

// Along one axis: the side of the window where an edge from p by d comes in and the one where it leaves, and the parameters there.
void WindowSides(float p, float d, float low, float high, OUT(vec2) sides, OUT(vec2) times) {
  sides = d > 0.0 || (d == 0.0 && p > high) ? vec2(low, high) : vec2(high, low);
  times = d != 0.0 ? (sides - vec2(p)) / d : vec2(-1e30, p >= low && p <= high ? 1e30 : -1e30);
}

// One edge of a polygon, from p to q, clipped against the window low to high, with the window's corners that the outline turns
// around [Liang & Barsky 1983]. An outline may run along the window's border and back, which has no area.
void AddClippedEdge(INOUT(CornerSum) sum, vec2 p, vec2 q, vec2 low, vec2 high) {
  vec2 d = q - p;
  vec2 side_x;
  vec2 side_y;
  vec2 time_x;
  vec2 time_y;
  WindowSides(p.x, d.x, low.x, high.x, side_x, time_x);
  WindowSides(p.y, d.y, low.y, high.y, side_y, time_y);
  float first_in = min(time_x.x, time_y.x);
  float last_in = max(time_x.x, time_y.x);
  float first_out = min(time_x.y, time_y.y);
  if (first_in > 1.0) return;
  if (first_in > 0.0) AddCorner(sum, vec2(side_x.x, side_y.x));
  if (last_in > 1.0 || (last_in <= 0.0 && first_out <= 0.0)) return;
  if (last_in > first_out) {  // it passes by a corner
    AddCorner(sum, time_x.x > time_y.x ? vec2(side_x.x, side_y.y) : vec2(side_x.y, side_y.x));
    return;
  }
  if (last_in > 0.0) AddCorner(sum, time_x.x > time_y.x ? vec2(side_x.x, p.y + time_x.x * d.y) : vec2(p.x + time_y.x * d.x, side_y.x));
  if (first_out < 1.0) {
    AddCorner(sum, time_x.y < time_y.y ? vec2(side_x.y, p.y + time_x.y * d.y) : vec2(p.x + time_y.y * d.x, side_y.y));
  } else {
    AddCorner(sum, q);
  }
}

// The part of the rectangle that the parallelogram center ± a ± b covers; m, in the light's plane.
LitPart ParallelogramOnRectangle(vec2 center, vec2 a, vec2 b, vec2 half_size) {
  // Counted from the middle of the smaller one, whose sides need the digits.
  float area = 4.0 * abs(a.x * b.y - a.y * b.x);
  vec2 origin = area < 4.0 * half_size.x * half_size.y ? center : vec2(0.0);
  vec2 middle = center - origin;
  vec2 low = -half_size - origin;
  vec2 high = half_size - origin;
  CornerSum sum;
  sum.count = 0;
  sum.first = vec2(0.0);
  sum.last = vec2(0.0);
  sum.area = 0.0;
  sum.moment = vec2(0.0);
  AddClippedEdge(sum, middle + a + b, middle - a + b, low, high);
  AddClippedEdge(sum, middle - a + b, middle - a - b, low, high);
  AddClippedEdge(sum, middle - a - b, middle + a - b, low, high);
  AddClippedEdge(sum, middle + a - b, middle + a + b, low, high);
  LitPart part;
  part.area = min(0.5 * abs(sum.area), area);
  vec2 at = abs(sum.area) > 1e-30 ? sum.first + sum.moment / (3.0 * sum.area) : middle;
  part.shift = clamp(at, low, high) - middle;
  return part;
}

// Ours: the footprint's area as the projection, along the mirror direction, of a rectangle across it whose sides are as the lobe's
// widths along and across the plane of incidence; `across` is their ratio. All in the light's frame.
LitPart ElongatedFootprintOnRectangle(Footprint footprint, vec3 point, vec3 normal, vec3 mirror, float across, vec2 half_size) {
  float n_dot_m = dot(normal, mirror);
  vec3 along = normal - mirror * n_dot_m;
  float sine2 = dot(along, along);
  if (sine2 > 1e-8) {
    along *= inversesqrt(sine2);
  } else {
    along = AnyPerpendicular(mirror);
  }
  vec3 aside = cross(mirror, along) * max(across, 1e-3);
  vec2 slope = footprint.offset / point.z;
  vec2 a = vec2(along.x, along.y) + slope * along.z;
  vec2 b = vec2(aside.x, aside.y) + slope * aside.z;
  // 4 |a × b| = π radius²
  float scale = footprint.radius * (0.5 * sqrt(kPi)) * inversesqrt(max(abs(a.x * b.y - a.y * b.x), 1e-12));
  return ParallelogramOnRectangle(footprint.center, a * scale, b * scale, half_size);
}
