// Beckmann's density with height-correlated Smith masking [Walter 2007, eq. 25; Heitz 2014, eqs. 68 and 99]. Dual; after brdf.glsl.

// cosθ Λ(cosθ) with Λ = exp(−a²)/(2a√π) − erfc(a)/2, a = cosθ/(α sinθ) [Heitz 2014, eqs. 69 and 72]: α sinθ/2 · ierfc(a), where
// ierfc(a) = exp(−a²)/√π − a·erfc(a) = exp(−a²) · t² · polynomial(t), t = 3/(3 + a): ours, Chebyshev on a ≤ 6, error 1.2e-8.
float BeckmannMasked(float n_dot_x, float alpha) {
  float slope = alpha * sqrt(max(1.0 - n_dot_x * n_dot_x, 0.0));
  float a = n_dot_x / max(slope, 1e-18);
  float t = 3.0 / (3.0 + a);
  float p = -0.7306059281 + t * 0.1155947268;
  p = 1.648224171 + t * p;
  p = -1.642300575 + t * p;
  p = 1.265535888 + t * p;
  p = -0.3855602753 + t * p;
  p = 0.2170606407 + t * p;
  p = 0.04367566088 + t * p;
  p = 0.03256526319 + t * p;
  return 0.5 * slope * exp(-min(a * a, 80.0)) * t * t * p;  // e^−80: no float is smaller beside 1
}

float BrdfOverGgx(float n_dot_v, float n_dot_l, float v_dot_h, float tan2_h, float alpha) {
  // 4 n·l n·v / G2 = 4 (n·l n·v (1 + Λ(v) + Λ(l))).
  float masked = n_dot_v * n_dot_l + n_dot_l * BeckmannMasked(n_dot_v, alpha) + n_dot_v * BeckmannMasked(n_dot_l, alpha);
  return GaussOverGgx(tan2_h, alpha) * 0.25 / max(masked, 1e-12);
}
