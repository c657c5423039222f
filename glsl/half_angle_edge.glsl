// The edge integral by the half angle's cosine over all angles (ours). Dual.

// P(u) = √2 acos(u/√2)/√(1 − u²/2) on [0, √2]: minimax polynomial of degree 6, relative error 2.7e-6.
float WholeEdgePolynomial(float u) {
  return 2.2214355 + u * (-0.999569718 + u * (0.550147783 + u * (-0.308655568 + u * (0.148588736 +
         u * (-0.048631959 + u * 0.00748126049)))));
}

// Below any light's (length)⁴: 1e-30 is a light of 3e-8 m seen from as far. Keeps an edge through the point finite.
const float kSmallestEdge = 1e-30;

// θ/line, θ the angle between v0 and v1, from d = v0·v1 and m = |v0||v1|, where |v0 × v1| = share · line.
float HalfAngleRatio(float d, float m, float share) {
  float q = m + d;
  float i = inversesqrt(m * abs(q) + kSmallestEdge);
  return share * i * WholeEdgePolynomial(q * i);
}
