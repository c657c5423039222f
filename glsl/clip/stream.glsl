// Exact horizon clipping while the edges are added, one side at a time [Hill & Heitz 2016, "on the fly"; Sutherland & Hodgman 1974].
// Dual; after an "edge".
#include "edge_vector.glsl"

// What is kept of the outline so far. It crosses the horizon twice or not at all.
struct StreamedOutline {
  vec3 sum;    // of the edges
  vec3 enter;  // where it comes up; 0: nowhere yet
  vec3 leave;  // where it goes down
};

StreamedOutline NoOutline() {
  StreamedOutline outline;
  outline.sum = vec3(0.0);
  outline.enter = vec3(0.0);
  outline.leave = vec3(0.0);
  return outline;
}

// Adds the side from a to b, or what is above of it.
StreamedOutline StreamSide(StreamedOutline outline, vec3 a, vec3 b, bool lambert) {
  StreamedOutline next = outline;
  bool a_above = a.z > 0.0;
  bool b_above = b.z > 0.0;
  if (a_above || b_above) {
    vec3 from = a_above ? a : MeetHorizon(b, a);
    vec3 to = b_above ? b : MeetHorizon(a, b);
    next.sum += EdgeVector(EdgeVertex(from), EdgeVertex(to), lambert);
    if (!a_above) next.enter = from;
    if (!b_above) next.leave = to;
  }
  return next;
}

// The side in the horizon closes the outline.
vec3 CloseOutline(StreamedOutline outline, bool lambert) {
  return VectorOfEdges(outline.sum + EdgeVector(EdgeVertex(outline.leave), EdgeVertex(outline.enter), lambert));
}

// The vector form factor of what is above the horizon. Of the parallelogram center ± half_a ± half_b with half_a × half_b towards
// the origin.
vec3 StreamedCorners(vec3 center, vec3 half_a, vec3 half_b, bool lambert) {
  vec3 p0 = center + half_a + half_b;
  vec3 p1 = center + half_a - half_b;
  vec3 p2 = center - half_a - half_b;
  vec3 p3 = center - half_a + half_b;
  StreamedOutline outline = NoOutline();
  outline = StreamSide(outline, p0, p1, lambert);
  outline = StreamSide(outline, p1, p2, lambert);
  outline = StreamSide(outline, p2, p3, lambert);
  outline = StreamSide(outline, p3, p0, lambert);
  return CloseOutline(outline, lambert);
}

// Its z is the form factor for a clamped cosine about +z.
vec3 ClippedVector(vec3 center, vec3 half_a, vec3 half_b) { return StreamedCorners(center, half_a, half_b, false); }

// The form factor of the light itself.
float ClippedLambert(RectangleView view) { return StreamedCorners(view.center, view.half_a, view.half_b, true).z; }
