// The edge integral by the published rational fit for the specular lobe, by the cheaper quadratic for the diffuse one
// [Hill & Heitz 2016, "cheaper diffuse"]. Dual.
//
// The coefficients are the talk's, exact at 0 and 1; relative error at most 7.3e-3. The best quadratic has 4.5e-3:
//   1.56375926 − 0.860683851 y + 0.301404526 y².
#include "rational_edge.glsl"

// Of the light itself, for the diffuse lobe.
float LambertEdgeRatio(float d, float m2, float share, float line2) {
  float x = EdgeCosine(d, m2);
  float y = abs(x);
  return MirrorOverSine(x, 1.5708 + (-0.879406 + 0.308609 * y) * y) / EdgeLengths(m2) * share;
}
