// Exact horizon clipping while the edges are added, one side at a time [Hill & Heitz 2016, "on the fly"; Sutherland & Hodgman 1974].
// Dual; after an "edge".
#include "streamed_outline.glsl"

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
  return CloseOutline(outline);
}

// Its z is the form factor for a clamped cosine about +z.
vec3 ClippedVector(vec3 center, vec3 half_a, vec3 half_b, bool may_be_small) { return StreamedCorners(center, half_a, half_b, false); }

// The form factor of the light itself.
float ClippedLambert(RectangleView view) { return StreamedCorners(view.center, view.half_a, view.half_b, true).z; }
