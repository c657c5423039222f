#pragma once
// Where a light lies to a horizon, for text that branches on it. A compiler's count of branching code discounts what may be
// skipped, so `arealab cost` counts each path by itself: with one of PATH_* the answer is assumed, pixels with another one are
// discarded, and what follows counts in full. Where something is drawn none is on, and these return what they are given. Dual.

// The corners of a quadrilateral above a horizon, a bit each. Crossing: three of them, which leaves five corners.
int CornersAbove(int above) {
#if PATH_ABOVE
  const int assumed = 15;
#elif PATH_CROSSING
  const int assumed = 7;
#elif PATH_BELOW
  const int assumed = 0;
#endif
#if PATH_ABOVE || PATH_CROSSING || PATH_BELOW
  if (above != assumed) discard;
  return assumed;
#else
  return above;
#endif
}

// Whether a light is wholly above a horizon, wholly below, or one of both.
bool WhollyAbove(bool above) {
#if PATH_ABOVE
  if (!above) discard;
  return true;
#elif PATH_CROSSING || PATH_BELOW
  if (above) discard;
  return false;
#else
  return above;
#endif
}

bool WhollyOnOneSide(bool one_side) {
#if PATH_ABOVE || PATH_BELOW
  if (!one_side) discard;
  return true;
#elif PATH_CROSSING
  if (one_side) discard;
  return false;
#else
  return one_side;
#endif
}

bool WhollyBelow(bool below) {
#if PATH_BELOW
  if (!below) discard;
  return true;
#elif PATH_ABOVE || PATH_CROSSING
  if (below) discard;
  return false;
#else
  return below;
#endif
}
