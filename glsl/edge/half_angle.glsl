// The edge integral by the half angle, without normalising and without a case for obtuse angles (ours). Dual.
//
// With m = |v0||v1|, d = v0·v1, q = m + d and u = √(q/m), the half angle's cosine is h = u/√2, and since sin θ = 2 h √(1 − h²),
//   θ/|v0 × v1| = 2 acos(h) / (2 m h √(1 − h²)) = √2 K(h) / √(m q), K(h) = acos(h)/√(1 − h²).
// K is smooth on [0, 1]: minimax polynomial of degree 6, relative error 2.9e-6.
const float kSqrtTwo = 1.41421356237309505;

float EdgeHalfAngle(float h) {
  return 1.57079183 + h * (-0.999546761 + h * (0.77772684 + h * (-0.615898099 + h * (0.417289994 +
         h * (-0.191650562 + h * 0.0412867612)))));
}

// Below any light's (length)⁴, m⁴: 1e-30 is a light of 3e-8 m seen from as far. Keeps an edge through the point finite.
const float kSmallestEdge = 1e-30;

// A corner as the edges want it: direction and length.
vec4 EdgeVertex(vec3 v) { return vec4(v, length(v)); }

// θ/|v0 × v1|, 1/m², of the angle θ between v0 and v1 from d = v0·v1 and m = |v0||v1|.
float EdgeRatio(float d, float m) {
  float q = m + d;
  float i = inversesqrt(max(abs(m * q), kSmallestEdge));
  return kSqrtTwo * i * EdgeHalfAngle(q * i / kSqrtTwo);
}

// θ itself; `area` = |v0 × v1|. Where the angle is obtuse the area says little, the half angle much: θ = 2 K(h) √(1 − h²).
float EdgeAngle(float d, float m, float area) {
  float q = m + d;
  float i = inversesqrt(max(abs(m * q), kSmallestEdge));
  float u = q * i;
  return kSqrtTwo * EdgeHalfAngle(u / kSqrtTwo) * (d > 0.0 ? i * area : sqrt(max(2.0 - u * u, 0.0)));
}
