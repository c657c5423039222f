// One side of the light against the horizon, as the article's listing does it [Mayaux 2017, "ClipSegment"]. Dual.
// It differs from its own comment where both ends are below and p1 is the higher, or the side is level: then p1 comes back.

// height0, height1: of p0 and p1 over the horizon, m; inset: of the side's length, by which a cut stops short.
vec2 ClipSegment(vec2 p0, vec2 p1, float height0, float height1, float inset) {
  float rise = height1 - height0;
  // A level side divides by 0: by the sign, infinity, clamped below; 0/0, whose clamp is 0 in HLSL, ends at p1 too.
  float t = rise != 0.0 ? -height0 / rise : (height0 < 0.0 ? 1e30 : -1e30);
  if (height0 < 0.0 || t >= 0.0) return p0 + (p1 - p0) * clamp(t - inset, 0.0, 1.0);
  return p1;
}
