// The edge integral by the half angle of the acute angle, an obtuse one mirrored by the edge's own cross product (ours). Dual.
//
// With m = |v0||v1|, d = v0·v1 and q = m + |d|, u = √(q/m) is √2 times the cosine of half the acute angle θ', and
//   θ'/|v0 × v1| = P(u)/√(m q), P(u) = √2 acos(u/√2)/√(1 − u²/2),
// smooth on [1, √2], where degree 4 leaves a relative error of 7.1e-8: the arc cosine itself in float. Nothing cancels: q ≥ m,
// and π − θ' is divided by a cross product that the caller has without subtracting lengths.
float EdgePolynomial(float u) {
  return 2.20234978 + u * (-0.907734599 + u * (0.362776993 + u * (-0.0993743546 + u * 0.0127784005)));
}

// Below any light's (length)⁴: 1e-30 is a light of 3e-8 m seen from as far. Keeps an edge through the point finite.
const float kSmallestEdge = 1e-30;

// A corner as the edges want it: direction and length.
vec4 EdgeVertex(vec3 v) { return vec4(v, length(v)); }

// θ/line, θ the angle between v0 and v1, from d = v0·v1 and m = |v0||v1|, where |v0 × v1| = share · line, line2 = line².
float EdgeRatio(float d, float m, float share, float line2) {
  float q = m + abs(d);
  float i = inversesqrt(m * q + kSmallestEdge);
  float acute = share * i * EdgePolynomial(q * i);
  return d >= 0.0 ? acute : kPi * inversesqrt(line2 + kSmallestEdge) - acute;
}

// Of the light itself, for the diffuse lobe.
float LambertEdgeRatio(float d, float m, float share, float line2) { return EdgeRatio(d, m, share, line2); }

// θ itself; `area` = |v0 × v1|.
float EdgeAngle(float d, float m, float area) {
  float q = m + abs(d);
  float i = inversesqrt(m * q + kSmallestEdge);
  float acute = area * i * EdgePolynomial(q * i);
  return d >= 0.0 ? acute : kPi - acute;
}
