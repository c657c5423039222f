// The unclipped vector form factor of a rectangle, F [Hill & Heitz 2016, "vector form factor"]. Dual; after an "edge".
//
// Around the corners (+,+), (−,+), (−,−), (+,−) of p ± a ± b the edges' crosses are twice
//   −(p × a − a × b), −(p × b − a × b), p × a + a × b, p × b + a × b;
// that runs clockwise seen from the origin, so F = −1/(2π) Σ θ cross/|cross|.
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

// Of the parallelogram center ± half_a ± half_b with half_a × half_b towards the origin.
VectorFormFactor ParallelogramVector(vec3 center, vec3 half_a, vec3 half_b) {
  if (!Lit(!IsSmallRectangle(center, half_a, half_b))) {
    vec3 small = SmallRectangleVector(center, half_a, half_b);
    return MakeVectorFormFactor(small, small.z);
  }
  vec3 sum = half_a + half_b;
  vec3 difference = half_a - half_b;
  vec3 v0 = center + sum;
  vec3 v1 = center - difference;
  vec3 v2 = center - sum;
  vec3 v3 = center + difference;
  float l0 = length(v0);
  float l1 = length(v1);
  float l2 = length(v2);
  float l3 = length(v3);
  vec3 p_a = cross(center, half_a);
  vec3 p_b = cross(center, half_b);
  vec3 a_b = cross(half_a, half_b);
  vec3 line0 = p_a - a_b;
  vec3 line1 = p_b - a_b;
  vec3 line2 = p_a + a_b;
  vec3 line3 = p_b + a_b;
  float t0 = EdgeRatio(dot(v0, v1), l0 * l1, 2.0, dot(line0, line0));
  float t1 = EdgeRatio(dot(v1, v2), l1 * l2, 2.0, dot(line1, line1));
  float t2 = EdgeRatio(dot(v2, v3), l2 * l3, 2.0, dot(line2, line2));
  float t3 = EdgeRatio(dot(v3, v0), l3 * l0, 2.0, dot(line3, line3));
  vec3 f = (t0 - t2) * p_a + (t1 - t3) * p_b - (t0 + t1 + t2 + t3) * a_b;
  f *= 0.5 / kPi;
  return MakeVectorFormFactor(f, f.z);
}

// The same for the light itself, in its own axes, where the crosses are p × a = |a| (0, z, −y), p × b = |b| (−z, 0, x) and
// a × b = |a||b| (0, 0, 1).
VectorFormFactor LambertVector(RectangleView view) {
  vec3 side_a = vec3(view.half_size.x, 0.0, 0.0);
  vec3 side_b = vec3(0.0, view.half_size.y, 0.0);
  if (!Lit(!IsSmallRectangle(view.in_plane, side_a, side_b))) {
    vec3 small = SmallRectangleVector(view.in_plane, side_a, side_b);
    return MakeVectorFormFactor(small, dot(view.horizon, small));
  }
  float x0 = view.in_plane.x + view.half_size.x;
  float x1 = view.in_plane.x - view.half_size.x;
  float y0 = view.in_plane.y + view.half_size.y;
  float y1 = view.in_plane.y - view.half_size.y;
  float z2 = view.in_plane.z * view.in_plane.z;
  float row0 = y0 * y0 + z2;  // squared distance from the line of edge v0 v1
  float row1 = y1 * y1 + z2;  // of v2 v3
  float column0 = x0 * x0 + z2;  // of v3 v0
  float column1 = x1 * x1 + z2;  // of v1 v2
  float l0 = sqrt(x0 * x0 + row0);
  float l1 = sqrt(x1 * x1 + row0);
  float l2 = sqrt(x1 * x1 + row1);
  float l3 = sqrt(x0 * x0 + row1);
  float along_x = x0 * x1;
  float along_y = y0 * y1;
  float a2 = view.half_size.x * view.half_size.x;
  float b2 = view.half_size.y * view.half_size.y;
  float t0 = LambertEdgeRatio(along_x + row0, l0 * l1, 2.0, a2 * row0);
  float t1 = LambertEdgeRatio(along_y + column1, l1 * l2, 2.0, b2 * column1);
  float t2 = LambertEdgeRatio(along_x + row1, l2 * l3, 2.0, a2 * row1);
  float t3 = LambertEdgeRatio(along_y + column0, l3 * l0, 2.0, b2 * column0);
  float alpha = view.half_size.x * (t0 - t2);
  float beta = view.half_size.y * (t1 - t3);
  float gamma = view.half_size.x * view.half_size.y * (t0 + t1 + t2 + t3);
  vec3 p = view.in_plane;
  vec3 f = vec3(-beta * p.z, alpha * p.z, beta * p.x - alpha * p.y - gamma);
  f *= 0.5 / kPi;
  return MakeVectorFormFactor(f, dot(view.horizon, f));
}
