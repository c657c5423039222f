// Exact horizon clipping of a rectangle without cases (ours). Dual; after an "edge".
//
// In the light's plane, let both sides rise: A and B are the full sides with A_z, B_z ≥ 0 and c the highest corner, so
// corners are c − A, c − B and, lowest, c − A − B. What is above the horizon is always the polygon
//   v0 = c − k0 A − k1 B,  v1 = c − k1 B,  c,  v3 = c − k2 A,  v4 = c − k2 A − k3 B
// with k0 and k1 the shares that are above of the two sides at the corner c − B, k2 and k3 of those at c − A; at most one of each pair is
// cut, and what is wholly below vanishes by itself. The closing side v4 v0 lies in the horizon, where an edge adds ±θ/2π. What a light
// wholly above its horizon does not need, the cut and that side, stands behind a branch that neighbouring pixels share.
#include "path.glsl"
#include "near.glsl"

struct HorizonShares {
  float k0, k1, k2, k3;
};

// Heights over the horizon: of the highest corner, of the sides (both ≥ 0).
HorizonShares CutAtHorizon(float top, float rise_a, float rise_b) {
  // A level side is wholly above or wholly below: any positive number far below a height serves for its rise.
  float inverse_a = 1.0 / max(rise_a, 1e-30);
  float inverse_b = 1.0 / max(rise_b, 1e-30);
  float end_b = top - rise_b;  // height of c − B
  float end_a = top - rise_a;  // height of c − A
  HorizonShares shares;
  shares.k0 = clamp(end_b * inverse_a, 0.0, 1.0);
  shares.k1 = clamp(end_b * inverse_b + 1.0, 0.0, 1.0);
  shares.k2 = clamp(end_a * inverse_a + 1.0, 0.0, 1.0);
  shares.k3 = clamp(end_a * inverse_b, 0.0, 1.0);
  return shares;
}

// The vector form factor of what is above the horizon; its z is the form factor for a clamped cosine about +z. Of the
// parallelogram center ± half_a ± half_b with half_a × half_b towards the origin; may_be_small: against its distance.
vec3 ClippedVector(vec3 center, vec3 half_a, vec3 half_b, bool may_be_small) {
  if (!Lit(!may_be_small)) {
    if (IsSmallParallelogram(center, half_a, half_b)) return ClippedSmallRectangle(center, half_a, half_b);
  }
  float sign_a = half_a.z < 0.0 ? -2.0 : 2.0;
  float sign_b = half_b.z < 0.0 ? -2.0 : 2.0;
  vec3 a = half_a * sign_a;
  vec3 b = half_b * sign_b;
  vec3 c = center + 0.5 * (a + b);
  if (WhollyBelow(c.z <= 0.0)) return vec3(0.0);
  bool above = WhollyAbove(c.z > a.z + b.z);
  HorizonShares k;
  k.k0 = k.k1 = k.k2 = k.k3 = 1.0;
  if (!above) k = CutAtHorizon(c.z, a.z, b.z);

  vec3 v1 = c - k.k1 * b;
  vec3 v0 = v1 - k.k0 * a;
  vec3 v3 = c - k.k2 * a;
  vec3 v4 = v3 - k.k3 * b;
  float d0 = dot(v0, v1);
  float d1 = dot(v1, c);
  float d2 = dot(c, v3);
  float d3 = dot(v3, v4);
  float l0 = dot(v0, v0);
  float l1 = dot(v1, v1);
  float lc = dot(c, c);
  float l3 = dot(v3, v3);
  float l4 = dot(v4, v4);
  // The edges' cross products over their shares: v0 v1 lies on the line through v1 along A, v3 v4 on that through v3 along B.
  vec3 c_a = cross(c, a);
  vec3 c_b = cross(c, b);
  vec3 a_b = cross(a, b);
  vec3 line0 = c_a + k.k1 * a_b;
  vec3 line3 = c_b - k.k2 * a_b;
  float t0 = EdgeRatio(d0, l0 * l1, k.k0, dot(line0, line0));
  float t1 = EdgeRatio(d1, l1 * lc, k.k1, dot(c_b, c_b));
  float t2 = EdgeRatio(d2, lc * l3, k.k2, dot(c_a, c_a));
  float t3 = EdgeRatio(d3, l3 * l4, k.k3, dot(line3, line3));
  if (kEdgeMirrored && HasObtuseSide(min(min(d0, d1), min(d2, d3)) < 0.0)) {
    t0 = MirroredEdge(t0, d0, dot(line0, line0));
    t1 = MirroredEdge(t1, d1, dot(c_b, c_b));
    t2 = MirroredEdge(t2, d2, dot(c_a, c_a));
    t3 = MirroredEdge(t3, d3, dot(line3, line3));
  }
  float closing = 0.0;
  if (!above) {
    vec2 chord = vec2(v4.x - v0.x, v4.y - v0.y);
    closing = EdgeAngle(dot(v4, v0), l4 * l0, abs(chord.x * v0.y - chord.y * v0.x));
  }
  // Sides rising the same way keep half_a × half_b towards the origin: then the polygon runs clockwise. A side in the
  // horizon adds its angle upwards.
  float scale = sign_a * sign_b * (-0.25 / kTurn);
  vec3 sum = ((t0 - t2) * scale) * c_a + ((t1 - t3) * scale) * c_b + ((t0 * k.k1 + t3 * k.k2) * scale) * a_b;
  return vec3(sum.x, sum.y, AsFormFactor(sum.z + closing * (1.0 / kTurn)));
}

// The form factor of the light itself, above the horizon: in its own axes its sides are parallel to the axes, which leaves few products.
// Heights over the horizon are taken there too: in float the light's two descriptions differ by more than what matters at its sides.
float ClippedLambert(RectangleView view) {
  if (!Lit(!view.small)) return ClippedSmallRectangle(view.center, view.half_a, view.half_b).z;
  // Turned over where a side falls, light, point and horizon alike, which leaves the form factor as it is: now both rise.
  vec3 n = vec3(abs(view.horizon.x), abs(view.horizon.y), view.horizon.z);
  float side_x = 2.0 * view.half_size.x;
  float side_y = 2.0 * view.half_size.y;
  float x = view.half_size.x + (view.horizon.x < 0.0 ? -view.in_plane.x : view.in_plane.x);
  float y = view.half_size.y + (view.horizon.y < 0.0 ? -view.in_plane.y : view.in_plane.y);
  float z = view.in_plane.z;
  HorizonShares k;
  k.k0 = k.k1 = k.k2 = k.k3 = 1.0;
#if EFFECT_HORIZON
  float top = n.x * x + n.y * y + n.z * z;
  if (WhollyBelow(top <= 0.0)) return 0.0;
  bool above = WhollyAbove(top > n.x * side_x + n.y * side_y);
  if (!above) k = CutAtHorizon(top, n.x * side_x, n.y * side_y);
#else
  bool above = true;  // or wholly below: then the sum is negative
#endif

  float x0 = x - k.k0 * side_x;
  float y0 = y - k.k1 * side_y;
  float x4 = x - k.k2 * side_x;
  float y4 = y - k.k3 * side_y;
  float z2 = z * z;
  float row0 = y0 * y0 + z2;  // squared distance from the line of edge v0 v1
  float row = y * y + z2;     // of c v3
  float column = x * x + z2;  // of v1 c
  float column4 = x4 * x4 + z2;
  float d0 = x0 * x + row0;
  float d1 = y0 * y + column;
  float d2 = x * x4 + row;
  float d3 = y * y4 + column4;
  float l0 = x0 * x0 + row0;
  float l1 = x * x + row0;
  float lc = x * x + row;
  float l3 = x4 * x4 + row;
  float l4 = y4 * y4 + column4;
  // θ over the distance from the edge's line: that times the edge's length is its cross product.
  float t0 = LambertEdgeRatio(d0, l0 * l1, k.k0 * side_x, row0);
  float t1 = LambertEdgeRatio(d1, l1 * lc, k.k1 * side_y, column);
  float t2 = LambertEdgeRatio(d2, lc * l3, k.k2 * side_x, row);
  float t3 = LambertEdgeRatio(d3, l3 * l4, k.k3 * side_y, column4);
  if (kEdgeMirrored && HasObtuseSide(min(min(d0, d1), min(d2, d3)) < 0.0)) {
    t0 = MirroredEdge(t0, d0, row0);
    t1 = MirroredEdge(t1, d1, column);
    t2 = MirroredEdge(t2, d2, row);
    t3 = MirroredEdge(t3, d3, column4);
  }

  // The unit cross products along the normal, times the distance.
  float u0 = n.y * z - n.z * y0;
  float u1 = n.z * x - n.x * z;
  float u2 = n.y * z - n.z * y;
  float u3 = n.z * x4 - n.x * z;
  float closing = 0.0;
  if (!above) {
    float area = abs((y4 - y0) * (n.x * z - n.z * x0) - (x4 - x0) * u0);
    closing = EdgeAngle(x4 * x0 + y4 * y0 + z2, l4 * l0, area);
  }
  float sum = t2 * u2 - t0 * u0 + t3 * u3 - t1 * u1 + closing;
  return AsFormFactor(sum * (1.0 / kTurn));
}
