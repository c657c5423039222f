// Exact horizon clipping by a case for each of the 16 sets of corners above the horizon [Hill & Heitz 2016, "ClipQuadToHorizon"].
// The print has lost parts of it: all cases are derived anew. Dual; after an "edge".
#include "edge_vector.glsl"
#include "path.glsl"

// The vector form factor of what is above the horizon. Of the parallelogram center ± half_a ± half_b with half_a × half_b towards
// the origin.
vec3 ClippedCorners(vec3 center, vec3 half_a, vec3 half_b, bool lambert) {
  // Counter-clockwise seen from the origin.
  vec3 p0 = center + half_a + half_b;
  vec3 p1 = center + half_a - half_b;
  vec3 p2 = center - half_a - half_b;
  vec3 p3 = center - half_a + half_b;
  int above = 0;
  if (p0.z > 0.0) above += 1;
  if (p1.z > 0.0) above += 2;
  if (p2.z > 0.0) above += 4;
  if (p3.z > 0.0) above += 8;
  above = CornersAbove(above);

  vec3 v0 = p0;
  vec3 v1 = p1;
  vec3 v2 = p2;
  vec3 v3 = p3;
  vec3 v4 = p3;
  int count = 0;
  // 0: nothing is above. 5, 10: two opposite corners cannot be without a third.
  if (above == 1) {
    count = 3;
    v1 = MeetHorizon(p0, p1);
    v2 = MeetHorizon(p0, p3);
  } else if (above == 2) {
    count = 3;
    v0 = MeetHorizon(p1, p0);
    v2 = MeetHorizon(p1, p2);
  } else if (above == 3) {
    count = 4;
    v2 = MeetHorizon(p1, p2);
    v3 = MeetHorizon(p0, p3);
  } else if (above == 4) {
    count = 3;
    v0 = MeetHorizon(p2, p3);
    v1 = MeetHorizon(p2, p1);
  } else if (above == 6) {
    count = 4;
    v0 = MeetHorizon(p1, p0);
    v3 = MeetHorizon(p2, p3);
  } else if (above == 7) {
    count = 5;
    v3 = MeetHorizon(p2, p3);
    v4 = MeetHorizon(p0, p3);
  } else if (above == 8) {
    count = 3;
    v0 = MeetHorizon(p3, p0);
    v1 = MeetHorizon(p3, p2);
    v2 = p3;
  } else if (above == 9) {
    count = 4;
    v1 = MeetHorizon(p0, p1);
    v2 = MeetHorizon(p3, p2);
  } else if (above == 11) {
    count = 5;
    v2 = MeetHorizon(p1, p2);
    v3 = MeetHorizon(p3, p2);
    v4 = p3;
  } else if (above == 12) {
    count = 4;
    v0 = MeetHorizon(p3, p0);
    v1 = MeetHorizon(p2, p1);
  } else if (above == 13) {
    count = 5;
    v1 = MeetHorizon(p0, p1);
    v2 = MeetHorizon(p2, p1);
    v3 = p2;
    v4 = p3;
  } else if (above == 14) {
    count = 5;
    v0 = MeetHorizon(p1, p0);
    v4 = MeetHorizon(p3, p0);
  } else if (above == 15) {
    count = 4;
  }
  if (count == 0) return vec3(0.0);
  if (count == 3) v3 = v0;
  if (count == 4) v4 = v0;

  vec4 e0 = EdgeVertex(v0);
  vec4 e1 = EdgeVertex(v1);
  vec4 e2 = EdgeVertex(v2);
  vec4 e3 = EdgeVertex(v3);
  vec4 e4 = EdgeVertex(v4);
  vec3 sum = EdgeVector(e0, e1, lambert) + EdgeVector(e1, e2, lambert) + EdgeVector(e2, e3, lambert);
  if (count >= 4) sum += EdgeVector(e3, e4, lambert);
  if (count == 5) sum += EdgeVector(e4, e0, lambert);
  return VectorOfEdges(sum);
}

// Its z is the form factor for a clamped cosine about +z.
vec3 ClippedVector(vec3 center, vec3 half_a, vec3 half_b, bool may_be_small) { return ClippedCorners(center, half_a, half_b, false); }

// The form factor of the light itself.
float ClippedLambert(RectangleView view) { return ClippedCorners(view.center, view.half_a, view.half_b, true).z; }
