// The edge integral by the published rational fit of θ/sin θ, on unit vectors [Hill & Heitz 2016, "rational fit"]. Dual.
// The coefficients are the talk's. The authors' later code has others that close the talk's step of 3.2e-6 at the right angle;
// both err by 1.4e-6 at most and differ by 1.0e-6. The talk mirrors the fit where obtuse without a clamp, infinite at π; the clamp
// is the one that the authors' code ships, which fails near π: kept, it is theirs.

// A corner as the edges want it: unit, so that the products of lengths fold to 1.
vec4 EdgeVertex(vec3 v) { return vec4(v * inversesqrt(max(dot(v, v), 1e-30)), 1.0); }

// θ/sin θ from |cos θ|, θ acute.
float AcuteAngleOverSine(float y) {
  return (5.42031 + (3.12829 + 0.0902326 * y) * y) / (3.45068 + (4.18814 + y) * y);
}

// θ/line, θ the angle between v0 and v1, from d = v0·v1 and m = |v0||v1|, where |v0 × v1| = share · line, line2 = line².
float EdgeRatio(float d, float m, float share, float line2) {
  float inverse = 1.0 / max(m, 1e-30);
  float x = d * inverse;
  float acute = AcuteAngleOverSine(abs(x));
  return (x > 0.0 ? acute : kPi * inversesqrt(max(1.0 - x * x, 1e-7)) - acute) * inverse * share;
}

// θ itself; `area` = |v0 × v1|. Mirrored as an angle, where it needs no clamp.
float EdgeAngle(float d, float m, float area) {
  float inverse = 1.0 / max(m, 1e-30);
  float acute = AcuteAngleOverSine(min(abs(d) * inverse, 1.0)) * area * inverse;
  return d > 0.0 ? acute : kPi - acute;
}
