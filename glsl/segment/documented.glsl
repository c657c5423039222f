// One side of the light against the horizon, as the article's comment describes it [Mayaux 2017, "ClipSegment"]. Dual.

// height0: of p0 over the horizon, rise: from p0 to p1, m; inset: of the side's length, by which a cut stops short.
// Both below: p0; both above: p1; else where the side crosses it.
vec2 ClipSegment(vec2 p0, vec2 p1, float height0, float rise, float inset) {
  float height1 = height0 + rise;
  if (height0 <= 0.0 && height1 <= 0.0) return p0;
  if (height0 > 0.0 && height1 > 0.0) return p1;
  // The end stays above, whichever of them it is: the next side starts there.
  float t = -height0 / rise + (height0 > 0.0 ? -inset : inset);
  return p0 + (p1 - p0) * clamp(t, 0.0, 1.0);
}
