// Phong's lobe about the mirror direction r, (m + 2)/(2π) · (r·l)^m [Phong 1975; Lafortune & Willems 1994]. Dual; after brdf.glsl.
// m = 1/(2α²): at normal incidence l turns twice as far as h, and cos^m(2θ) ≈ exp(−2mθ²) is to be exp(−θ²/α²), a quarter
// of Blinn-Phong's exponent. The factor conserves energy at normal incidence.
// 1 − r·l = 1 + v·l − 2 (n·v)(n·l) = 2 ((v·h)² sin²θh + ((n·v − n·l)/2)²), without cancellation near the peak.
float BrdfOverGgx(float n_dot_v, float n_dot_l, float v_dot_h, float tan2_h, float alpha) {
  float alpha2 = alpha * alpha;
  float cos2_h = 1.0 / (1.0 + tan2_h);
  float d = n_dot_v - n_dot_l;
  float versine = 2.0 * v_dot_h * v_dot_h * tan2_h * cos2_h + 0.5 * d * d;
  if (versine >= 1.0) return 0.0;
  float t = (1.0 + tan2_h / alpha2) * cos2_h;
  // (m + 2)/(2π) over GGX's 1/(π α²) (cos²θh)⁻² t⁻² of the same terms: (m + 2) α²/2 = 1/4 + α².
  return (0.25 + alpha2) * t * t * exp(0.5 / alpha2 * Log1p(-versine));
}
