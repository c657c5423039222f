// The edge integral by the acute angle's cosine, an obtuse angle mirrored by the edge's own cross product (ours). Dual.
//
// With d = v0·v1 and m² = |v0|²|v1|² the acute angle θ' has the cosine y = |d|/m, and
//   θ'/|v0 × v1| = F(y)/m, F(y) = acos(y)/√(1 − y²),
// smooth on [0, 1], by a minimax polynomial of degree 6, relative error 3.0e-6, pinned to π/2 at 0, where both cases meet; in turns, so
// that the sum of the edges needs no 1/(2π). No root but 1/m is taken, and nothing cancels: π − θ' is divided by a cross product that the caller has without subtracting lengths.
#include "polygon.glsl"

// F/(2π).
float EdgePolynomial(float y) {
  return 0.25 + y * (-0.159106273 + y * (0.123987928 + y * (-0.0988044665 + y * (0.0678184036 + y * (-0.031704947 + y * 0.00696477934)))));
}

const float kTurn = 1.0;

// Ratios are of the acute angle: the caller mirrors (MirroredEdge).
const bool kEdgeMirrored = true;
const bool kEdgeUnit = false;

// A corner as the edges want it: direction and squared length.
vec4 EdgeVertex(vec3 v) { return vec4(v, dot(v, v)); }

// θ'/line from d = v0·v1 and m2 = |v0|²|v1|², where |v0 × v1| = share · line, line2 = line².
float EdgeRatio(float d, float m2, float share, float line2) {
  float i = inversesqrt(m2 + kSmallestEdge);
  return share * i * EdgePolynomial(abs(d) * i);
}

// Of the light itself, for the diffuse lobe.
float LambertEdgeRatio(float d, float m2, float share, float line2) { return EdgeRatio(d, m2, share, line2); }

// θ itself; `area` = |v0 × v1|.
float EdgeAngle(float d, float m2, float area) {
  float acute = EdgeRatio(d, m2, area, 1.0);
  return d >= 0.0 ? acute : 0.5 * kTurn - acute;
}
