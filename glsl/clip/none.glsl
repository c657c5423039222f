// No horizon clipping: what lies below the horizon is subtracted from what lies above. Dual; after an "edge".
vec3 EdgeVector(vec4 v0, vec4 v1) {
  vec3 a = vec3(v0);
  vec3 b = vec3(v1);
  vec3 c = cross(a, b);
  return EdgeRatio(dot(a, b), v0.w * v1.w, 1.0, dot(c, c)) * c;
}

// The vector form factor, its z at least 0. Of the parallelogram center ± half_a ± half_b with half_a × half_b towards the origin.
vec3 ClippedVector(vec3 center, vec3 half_a, vec3 half_b) {
  vec4 v0 = EdgeVertex(center + half_a + half_b);
  vec4 v1 = EdgeVertex(center + half_a - half_b);
  vec4 v2 = EdgeVertex(center - half_a - half_b);
  vec4 v3 = EdgeVertex(center - half_a + half_b);
  vec3 sum = EdgeVector(v0, v1) + EdgeVector(v1, v2) + EdgeVector(v2, v3) + EdgeVector(v3, v0);
  return vec3(sum.x * (0.5 / kPi), sum.y * (0.5 / kPi), AsFormFactor(sum.z * (0.5 / kPi)));
}

float ClippedLambert(RectangleView view) { return ClippedVector(view.center, view.half_a, view.half_b).z; }
