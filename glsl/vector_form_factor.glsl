// The unclipped vector form factor of a rectangle, F [Hill & Heitz 2016, "vector form factor"]. Dual; after an "edge".
//
// From the corner v of a parallelogram with the sides A and B, v, v − A, v − A − B, v − B, the edges' crosses are
//   −v × A, −(v × B − A × B), v × A + A × B, v × B;
// that runs clockwise seen from the origin, so F = −1/(2π) Σ θ cross/|cross|.
#include "near.glsl"

struct VectorFormFactor {
  vec3 f;        // of the parallelogram in its own frame; of the light along its axes
  float size;    // |F|, the form factor in F's own direction
  float inverse;  // 1/|F|, at most 1e15
  float height;  // F along the normal
};

// From the vector and its height.
VectorFormFactor MakeVectorFormFactor(vec3 f, float height) {
  VectorFormFactor result;
  result.f = f;
  float size2 = dot(f, f);
  result.inverse = inversesqrt(max(size2, 1e-30));
  result.size = size2 * result.inverse;
  result.height = height;
  return result;
}

// Of the parallelogram center ± half_a ± half_b with half_a × half_b towards the origin; may_be_small: against its distance.
VectorFormFactor ParallelogramVector(vec3 center, vec3 half_a, vec3 half_b, bool may_be_small) {
  if (!Lit(!may_be_small)) {
    if (IsSmallParallelogram(center, half_a, half_b)) {
      vec3 small = SmallRectangleVector(center, half_a, half_b);
      return MakeVectorFormFactor(small, small.z);
    }
  }
  vec3 a = 2.0 * half_a;
  vec3 b = 2.0 * half_b;
  vec3 v0 = center + half_a + half_b;
  vec3 v1 = v0 - a;
  vec3 v2 = v1 - b;
  vec3 v3 = v0 - b;
  float l0 = dot(v0, v0);
  float l1 = dot(v1, v1);
  float l2 = dot(v2, v2);
  float l3 = dot(v3, v3);
  float d0 = dot(v0, v1);
  float d1 = dot(v1, v2);
  float d2 = dot(v2, v3);
  float d3 = dot(v3, v0);
  vec3 p_a = cross(center, a);
  vec3 p_b = cross(center, b);
  vec3 a_b = cross(half_a, b);
  vec3 v_a = p_a - a_b;
  vec3 line1 = p_b - a_b;
  vec3 line2 = p_a + a_b;
  vec3 v_b = p_b + a_b;
  float t0 = EdgeRatio(d0, l0 * l1, 1.0, dot(v_a, v_a));
  float t1 = EdgeRatio(d1, l1 * l2, 1.0, dot(line1, line1));
  float t2 = EdgeRatio(d2, l2 * l3, 1.0, dot(line2, line2));
  float t3 = EdgeRatio(d3, l3 * l0, 1.0, dot(v_b, v_b));
  if (kEdgeMirrored && HasObtuseSide(min(min(d0, d1), min(d2, d3)) < 0.0)) {
    t0 = MirroredEdge(t0, d0, dot(v_a, v_a));
    t1 = MirroredEdge(t1, d1, dot(line1, line1));
    t2 = MirroredEdge(t2, d2, dot(line2, line2));
    t3 = MirroredEdge(t3, d3, dot(v_b, v_b));
  }
  vec3 f = ((t0 - t2) * p_a + (t1 - t3) * p_b - (t0 + t1 + t2 + t3) * a_b) * (1.0 / kTurn);
  return MakeVectorFormFactor(f, f.z);
}

// The same for the light itself, in its own axes, where the crosses are p × a = |a| (0, z, −y), p × b = |b| (−z, 0, x) and
// a × b = |a||b| (0, 0, 1): each along an axis of the light times |a| or |b|, by which the ratios are not divided.
VectorFormFactor LambertVector(RectangleView view) {
  vec3 p = view.in_plane;
  if (!Lit(!view.small)) {
    vec3 small = SmallRectangleVector(p, vec3(view.half_size.x, 0.0, 0.0), vec3(0.0, view.half_size.y, 0.0));
    return MakeVectorFormFactor(small, dot(view.horizon, small));
  }
  float x0 = p.x + view.half_size.x;
  float x1 = p.x - view.half_size.x;
  float y0 = p.y + view.half_size.y;
  float y1 = p.y - view.half_size.y;
  float z2 = p.z * p.z;
  float row0 = y0 * y0 + z2;  // squared distance from the line of edge v0 v1
  float row1 = y1 * y1 + z2;  // of v2 v3
  float column0 = x0 * x0 + z2;  // of v3 v0
  float column1 = x1 * x1 + z2;  // of v1 v2
  float l0 = x0 * x0 + row0;
  float l1 = x1 * x1 + row0;
  float l2 = x1 * x1 + row1;
  float l3 = x0 * x0 + row1;
  float d0 = x0 * x1 + row0;
  float d1 = y0 * y1 + column1;
  float d2 = x0 * x1 + row1;
  float d3 = y0 * y1 + column0;
  // θ over the distance from the edge's line.
  float length_x = 2.0 * view.half_size.x;
  float length_y = 2.0 * view.half_size.y;
  float t0 = LambertEdgeRatio(d0, l0 * l1, length_x, row0);
  float t1 = LambertEdgeRatio(d1, l1 * l2, length_y, column1);
  float t2 = LambertEdgeRatio(d2, l2 * l3, length_x, row1);
  float t3 = LambertEdgeRatio(d3, l3 * l0, length_y, column0);
  if (kEdgeMirrored && HasObtuseSide(min(min(d0, d1), min(d2, d3)) < 0.0)) {
    t0 = MirroredEdge(t0, d0, row0);
    t1 = MirroredEdge(t1, d1, column1);
    t2 = MirroredEdge(t2, d2, row1);
    t3 = MirroredEdge(t3, d3, column0);
  }
  float alpha = t0 - t2;
  float beta = t1 - t3;
  // Of the sides' distances from the point along their normals: Σ t |line's foot|.
  vec3 f = vec3(-beta * p.z, alpha * p.z, t1 * x1 - t3 * x0 - t0 * y0 + t2 * y1);
  f *= 1.0 / kTurn;
  return MakeVectorFormFactor(f, dot(view.horizon, f));
}
