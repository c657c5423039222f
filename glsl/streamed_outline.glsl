// A convex outline clipped at the horizon while its edges are added, one side at a time [Sutherland & Hodgman 1974]. Dual; after an
// "edge".
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
vec3 CloseOutline(StreamedOutline outline) {
  return VectorOfEdges(outline.sum + HorizonEdge(EdgeVertex(outline.leave), EdgeVertex(outline.enter)));
}
