// The edge integral by the half angle, without normalising and without a case for obtuse angles (ours). Dual.
//
// With m = |v0||v1|, d = v0·v1 and q = m + d, u = √(q/m) is √2 times the cosine of half the angle θ, and
//   θ/|v0 × v1| = P(u)/√(m q), P(u) = √2 acos(u/√2)/√(1 − u²/2),
// smooth on [0, √2], by a minimax polynomial of degree 7, relative error 4.3e-7; in turns. In float, q has few digits left as θ nears π.
#include "polygon.glsl"

// P/(2π).
float WholeEdgePolynomial(float u) {
  return 0.353553238 + u * (-0.159140581 + u * (0.0881626595 + u * (-0.0516599338 + u * (0.0287307176 +
         u * (-0.0129765634 + u * (0.00386933013 - u * 0.00053876524))))));
}

const float kTurn = 1.0;
const bool kEdgeMirrored = false;
const bool kEdgeUnit = false;

// A corner as the edges want it: direction and squared length.
vec4 EdgeVertex(vec3 v) { return vec4(v, dot(v, v)); }

// θ/line, θ the angle between v0 and v1, from d = v0·v1 and m2 = |v0|²|v1|², where |v0 × v1| = share · line, line2 = line².
float EdgeRatio(float d, float m2, float share, float line2) {
  float m = sqrt(m2);
  float q = m + d;
  float i = inversesqrt(m * abs(q) + kSmallestEdge);
  return share * i * WholeEdgePolynomial(q * i);
}

// Of the light itself, for the diffuse lobe.
float LambertEdgeRatio(float d, float m2, float share, float line2) { return EdgeRatio(d, m2, share, line2); }

// θ itself; `area` = |v0 × v1|. Where the angle is obtuse the area says little, the half angle much: θ = P(u) √(2 − u²).
float EdgeAngle(float d, float m2, float area) {
  float m = sqrt(m2);
  float q = m + d;
  float i = inversesqrt(m * abs(q) + kSmallestEdge);
  float u = q * i;
  return WholeEdgePolynomial(u) * (d > 0.0 ? i * area : sqrt(max(2.0 - u * u, 0.0)));
}
