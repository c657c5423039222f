// One side of the light against the horizon, as the article's listing does it [Mayaux 2017, "ClipSegment"]. Dual.
// It differs from its own comment where both ends are below and p1 is the higher, or the side is level: then p1 comes back.

// height0: of p0 over the horizon, rise: from p0 to p1, m; inset: of the side's length, by which a cut stops short.
vec2 ClipSegment(vec2 p0, vec2 p1, float height0, float rise, float inset) {
  // A level side divides by 0: by the sign, infinity, clamped below; 0/0, whose clamp is 0 in HLSL, ends at p1 too.
  float t = rise != 0.0 ? -height0 / rise : (height0 < 0.0 ? 1e30 : -1e30);
  if (height0 < 0.0 || t >= 0.0) return p0 + (p1 - p0) * clamp(t - inset, 0.0, 1.0);
  return p1;
}
