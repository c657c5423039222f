// The rectangle clipped at the horizon to a rectangle, whatever is really left of it [Mayaux 2017, "Fake Clipping"].
// Dual; after a "segment".

// Of a side's length, by which a cut stops short of the horizon, so that what starts there counts as above.
const float kSegmentInset = 1e-3;

// Axis-parallel in the light's plane, m from the light's centre.
struct ClippedRectangle {
  vec2 low;
  vec2 high;
};

float HeightOverHorizon(vec2 p, vec3 point, vec3 normal) {
  return dot(vec3(p.x - point.x, p.y - point.y, -point.z), normal);
}

// Widens the rectangle to the segment's clipped end and returns it.
vec2 FollowSegment(vec2 from, vec2 to, vec3 point, vec3 normal, INOUT(ClippedRectangle) clipped) {
  // The rise by itself: of a level side it is exactly 0.
  float rise = dot(to - from, vec2(normal.x, normal.y));
  vec2 p = ClipSegment(from, to, HeightOverHorizon(from, point, normal), rise, kSegmentInset);
  clipped.low = min(clipped.low, p);
  clipped.high = max(clipped.high, p);
  return p;
}

// `point` and the unit `normal` that makes its horizon in the light's frame (centre at the origin, z along the lit normal, m).
// What is wholly below is left with no area. From the corner highest over the horizon both ways round, each side from
// where the last one ended.
ClippedRectangle ClipToRectangle(vec3 point, vec3 normal, vec2 half_size) {
#if EFFECT_HORIZON || SEGMENT_PRINTED
  vec2 p0 = vec2(normal.x < 0.0 ? -half_size.x : half_size.x, normal.y < 0.0 ? -half_size.y : half_size.y);
  vec2 p1 = vec2(-p0.x, p0.y);
  vec2 p2 = -p0;
  vec2 p3 = vec2(p0.x, -p0.y);
  ClippedRectangle clipped;
  clipped.low = half_size;
  clipped.high = -half_size;
  vec2 p = FollowSegment(p0, p1, point, normal, clipped);
  p = FollowSegment(p, p2, point, normal, clipped);
  p = FollowSegment(p, p3, point, normal, clipped);
  FollowSegment(p, p0, point, normal, clipped);
  p = FollowSegment(p0, p3, point, normal, clipped);
  p = FollowSegment(p, p2, point, normal, clipped);
  p = FollowSegment(p, p1, point, normal, clipped);
  FollowSegment(p, p0, point, normal, clipped);
#else
  // Wholly above or wholly below.
  ClippedRectangle clipped;
  clipped.high = HeightOverHorizon(vec2(0.0), point, normal) > 0.0 ? half_size : vec2(0.0);
  clipped.low = -clipped.high;
#endif
  return clipped;
}
