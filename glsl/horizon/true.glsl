// The light is clipped at the surface's horizon, and then, transformed, where the lobe ends: nothing is reflected from below (ours).
// Both clips are streamed, whatever "clip" says of the diffuse lobe. Dual; after ltc.glsl and an "edge".
#include "streamed_outline.glsl"

// Adds the side from a to b above the surface's horizon to the transformed outline; `surface` notes where it crosses.
StreamedOutline StreamTransformed(StreamedOutline outline, INOUT(StreamedOutline) surface, vec4 m, vec3 a, vec3 b) {
  bool a_above = a.z > 0.0;
  bool b_above = b.z > 0.0;
  if (!a_above && !b_above) return outline;
  vec3 from = a_above ? a : MeetHorizon(b, a);
  vec3 to = b_above ? b : MeetHorizon(a, b);
  if (!a_above) surface.enter = from;
  if (!b_above) surface.leave = to;
  return StreamSide(outline, LtcTransform(m, from), LtcTransform(m, to), false);
}

// The vector form factor of the transformed light.
vec3 LobeVector(vec4 m, RectangleView view) {
  // Counter-clockwise seen from the origin.
  vec3 p0 = view.center + view.half_a + view.half_b;
  vec3 p1 = view.center + view.half_a - view.half_b;
  vec3 p2 = view.center - view.half_a - view.half_b;
  vec3 p3 = view.center - view.half_a + view.half_b;
  StreamedOutline surface = NoOutline();
  StreamedOutline outline = NoOutline();
  outline = StreamTransformed(outline, surface, m, p0, p1);
  outline = StreamTransformed(outline, surface, m, p1, p2);
  outline = StreamTransformed(outline, surface, m, p2, p3);
  outline = StreamTransformed(outline, surface, m, p3, p0);
  // The side in the surface's horizon; in the lobe's space it can lie anywhere.
  outline = StreamSide(outline, LtcTransform(m, surface.leave), LtcTransform(m, surface.enter), false);
  return CloseOutline(outline);
}
