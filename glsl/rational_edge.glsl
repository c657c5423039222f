// The published rational fit of θ/sin θ [Hill & Heitz 2016, "rational fit"]. Dual.
//
// The coefficients are the talk's; relative error at most 1.46e-6. The authors' later code has others that close the talk's step of
// 3.2e-6 at the right angle, 1.42e-6. The best of this form has 5.6e-7:
//   (5.42776659 + 3.12996384 y + 0.0899517101 y²) / (3.45542545 + 4.19225187 y + y²).
#include "unit_edge.glsl"

// θ/sin θ from y = |cos θ|, θ acute.
float AcuteAngleOverSine(float y) { return (5.42031 + (3.12829 + 0.0902326 * y) * y) / (3.45068 + (4.18814 + y) * y); }

// θ/line, θ the angle between v0 and v1, from d = v0·v1 and m2 = |v0|²|v1|², where |v0 × v1| = share · line, line2 = line².
float EdgeRatio(float d, float m2, float share, float line2) {
  float x = EdgeCosine(d, m2);
  return MirrorOverSine(x, AcuteAngleOverSine(abs(x))) / EdgeLengths(m2) * share;
}

// θ itself; `area` = |v0 × v1|. Mirrored as an angle, where it needs no clamp.
float EdgeAngle(float d, float m2, float area) {
  float x = EdgeCosine(d, m2);
  float acute = AcuteAngleOverSine(min(abs(x), 1.0)) * area / EdgeLengths(m2);
  return x > 0.0 ? acute : kPi - acute;
}
