// Exact horizon clipping of a rectangle without a branch (ours). Dual; after an "edge".
//
// In the light's plane, let both sides rise: A and B are the full sides with A_z, B_z ≥ 0 and c the highest corner, so
// corners are c − A, c − B and, lowest, c − A − B. What is above the horizon is always the polygon
//   v0 = c − k0 A − k1 B,  v1 = c − k1 B,  c,  v3 = c − k2 A,  v4 = c − k2 A − k3 B
// with k0 and k1 the shares that are above of the two sides at the corner c − B, k2 and k3 of those at c − A; at most one of each pair is
// cut, and what is wholly below vanishes by itself. The closing side v4 v0 lies in the horizon, where an edge adds ±θ/2π.
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

// The vector form factor of what is above the horizon; its z is the form factor for a clamped cosine about +z. Of the parallelogram center ± half_a ± half_b with half_a × half_b towards the origin.
vec3 ClippedVector(vec3 center, vec3 half_a, vec3 half_b) {
  if (!Lit(!IsSmallRectangle(center, half_a, half_b))) return ClippedSmallRectangle(center, half_a, half_b);
  float sign_a = half_a.z < 0.0 ? -2.0 : 2.0;
  float sign_b = half_b.z < 0.0 ? -2.0 : 2.0;
  vec3 a = half_a * sign_a;
  vec3 b = half_b * sign_b;
  vec3 c = center + 0.5 * (a + b);
  HorizonShares k = CutAtHorizon(c.z, a.z, b.z);

  vec3 v1 = c - k.k1 * b;
  vec3 v0 = v1 - k.k0 * a;
  vec3 v3 = c - k.k2 * a;
  vec3 v4 = v3 - k.k3 * b;
  float l0 = length(v0);
  float l1 = length(v1);
  float lc = length(c);
  float l3 = length(v3);
  float l4 = length(v4);
  // The edges' cross products over their shares: v0 v1 lies on the line through v1 along A, v3 v4 on that through v3 along B.
  vec3 a_b = cross(a, b);
  vec3 line2 = cross(c, a);
  vec3 line0 = line2 + k.k1 * a_b;
  vec3 line1 = cross(c, b);
  vec3 line3 = line1 - k.k2 * a_b;
  float t0 = EdgeRatio(dot(v0, v1), l0 * l1, k.k0, dot(line0, line0));
  float t1 = EdgeRatio(dot(v1, c), l1 * lc, k.k1, dot(line1, line1));
  float t2 = EdgeRatio(dot(c, v3), lc * l3, k.k2, dot(line2, line2));
  float t3 = EdgeRatio(dot(v3, v4), l3 * l4, k.k3, dot(line3, line3));
  float closing = EdgeAngle(dot(v4, v0), l4 * l0, abs(CrossZ(v4, v0)));
  // Sides rising the same way keep half_a × half_b towards the origin: then the polygon runs clockwise. A side in the
  // horizon adds its angle upwards.
  float scale = sign_a * sign_b * (-0.125 / kPi);
  vec3 sum = scale * (t0 * line0 + t1 * line1 - t2 * line2 - t3 * line3);
  return vec3(sum.x, sum.y, AsFormFactor(sum.z + closing * (0.5 / kPi)));
}

// The form factor of the light itself, above the horizon: in its own axes its sides are parallel to the axes, which leaves few products.
// Heights over the horizon are taken there too: in float the light's two descriptions differ by more than what matters at its sides.
float ClippedLambert(RectangleView view) {
  if (!Lit(!IsSmallRectangle(view.center, view.half_a, view.half_b))) return ClippedSmallRectangle(view.center, view.half_a, view.half_b).z;
  vec3 n = view.horizon;
  float sign_a = n.x < 0.0 ? -2.0 : 2.0;
  float sign_b = n.y < 0.0 ? -2.0 : 2.0;
  float side_x = view.half_size.x * sign_a;
  float side_y = view.half_size.y * sign_b;
  float x = view.in_plane.x + 0.5 * side_x;
  float y = view.in_plane.y + 0.5 * side_y;
  float z = view.in_plane.z;
#if EFFECT_HORIZON
  HorizonShares k = CutAtHorizon(n.x * x + n.y * y + n.z * z, n.x * side_x, n.y * side_y);
#else
  HorizonShares k = HorizonShares(1.0, 1.0, 1.0, 1.0);  // wholly above, or wholly below: then the sum is negative
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
  float l0 = sqrt(x0 * x0 + row0);
  float l1 = sqrt(x * x + row0);
  float lc = sqrt(x * x + row);
  float l3 = sqrt(x4 * x4 + row);
  float l4 = sqrt(y4 * y4 + column4);
  float side_x2 = side_x * side_x;
  float side_y2 = side_y * side_y;
  float t0 = LambertEdgeRatio(x0 * x + row0, l0 * l1, k.k0, side_x2 * row0);
  float t1 = LambertEdgeRatio(y0 * y + column, l1 * lc, k.k1, side_y2 * column);
  float t2 = LambertEdgeRatio(x * x4 + row, lc * l3, k.k2, side_x2 * row);
  float t3 = LambertEdgeRatio(y * y4 + column4, l3 * l4, k.k3, side_y2 * column4);

  // n · (c × A), n · (c × B), n · (A × B).
  float c_a = side_x * (n.y * z - n.z * y);
  float c_b = side_y * (n.z * x - n.x * z);
  float a_b = side_x * side_y * n.z;
#if EFFECT_HORIZON
  // v4 × v0 from the shares.
  float area = abs((k.k2 - k.k0) * c_a + (k.k3 - k.k1) * c_b + (k.k1 * k.k2 - k.k0 * k.k3) * a_b);
  float closing = EdgeAngle(x4 * x0 + y4 * y0 + z2, l4 * l0, area);
#else
  float closing = 0.0;
#endif
  float sum = t0 * (c_a + k.k1 * a_b) + t1 * c_b - t2 * c_a - t3 * (c_b - k.k2 * a_b);
  return AsFormFactor(sign_a * sign_b * (-0.125 / kPi) * sum + closing * (0.5 / kPi));
}
