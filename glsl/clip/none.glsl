// No horizon clipping: what lies below the horizon is subtracted from what lies above. Dual; after an "edge".
float EdgeZ(vec4 v0, vec4 v1) {
  vec3 a = vec3(v0);
  vec3 b = vec3(v1);
  vec3 c = cross(a, b);
  return EdgeRatio(dot(a, b), v0.w * v1.w, 1.0, dot(c, c)) * c.z;
}

// For a cosine about +z, of the parallelogram center ± half_a ± half_b with half_a × half_b towards the origin; at least 0.
float ClippedFormFactor(vec3 center, vec3 half_a, vec3 half_b) {
  vec4 v0 = EdgeVertex(center + half_a + half_b);
  vec4 v1 = EdgeVertex(center + half_a - half_b);
  vec4 v2 = EdgeVertex(center - half_a - half_b);
  vec4 v3 = EdgeVertex(center - half_a + half_b);
  return AsFormFactor((EdgeZ(v0, v1) + EdgeZ(v1, v2) + EdgeZ(v2, v3) + EdgeZ(v3, v0)) * (0.5 / kPi));
}

float ClippedLambert(RectangleView view) { return ClippedFormFactor(view.center, view.half_a, view.half_b); }
