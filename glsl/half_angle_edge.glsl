// The edge integral by the half angle's cosine over all angles (ours). Dual.

// P(u) = √2 acos(u/√2)/√(1 − u²/2) on [0, √2]: minimax polynomial of degree 7, relative error 4.3e-7.
float WholeEdgePolynomial(float u) {
  return 2.22144051 + u * (-0.999909759 + u * (0.553942327 + u * (-0.324588937 + u * (0.180520423 +
         u * (-0.0815341527 + u * (0.0243117182 - u * 0.00338516184))))));
}

// Below any light's (length)⁴: 1e-30 is a light of 3e-8 m seen from as far. Keeps an edge through the point finite.
const float kSmallestEdge = 1e-30;

// θ/line, θ the angle between v0 and v1, from d = v0·v1 and m = |v0||v1|, where |v0 × v1| = share · line.
float HalfAngleRatio(float d, float m, float share) {
  float q = m + d;
  float i = inversesqrt(m * abs(q) + kSmallestEdge);
  return share * i * WholeEdgePolynomial(q * i);
}
