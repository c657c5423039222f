// No horizon clipping: what lies below the horizon is subtracted from what lies above. Dual; after an "edge".
#include "edge_vector.glsl"

// The vector form factor, its z at least 0. Of the parallelogram center ± half_a ± half_b with half_a × half_b towards the origin.
vec3 WholeCorners(vec3 center, vec3 half_a, vec3 half_b, bool lambert) {
  vec4 v0 = EdgeVertex(center + half_a + half_b);
  vec4 v1 = EdgeVertex(center + half_a - half_b);
  vec4 v2 = EdgeVertex(center - half_a - half_b);
  vec4 v3 = EdgeVertex(center - half_a + half_b);
  return VectorOfEdges(EdgeVector(v0, v1, lambert) + EdgeVector(v1, v2, lambert) + EdgeVector(v2, v3, lambert) +
                       EdgeVector(v3, v0, lambert));
}

vec3 ClippedVector(vec3 center, vec3 half_a, vec3 half_b, bool may_be_small) { return WholeCorners(center, half_a, half_b, false); }

float ClippedLambert(RectangleView view) { return WholeCorners(view.center, view.half_a, view.half_b, true).z; }
