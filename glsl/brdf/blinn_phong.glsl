// Normalised Blinn-Phong without masking, (n + 8)/(8π) · (n·h)ⁿ [Akenine-Möller et al. 2008, § 7.6]. Dual; after brdf.glsl.
// n = 2/α² − 2 gives it Beckmann's curvature at the peak [Walter 2007, § 5.2; Karis 2013]. The factor makes the albedo at normal
// incidence about 1; a mirror's limit is (n·v)².
// Over GGX's density: (n + 8) α²/8 = (1 + 3α²)/4, (n·h)ⁿ⁺⁴ = (1 + tan²θh)^−(1/α² + 1).
float BrdfOverGgx(float n_dot_v, float n_dot_l, float v_dot_h, float tan2_h, float alpha) {
  float alpha2 = alpha * alpha;
  float t = min(1.0 + tan2_h / alpha2, 1e15);  // its square stays a float; where it would be more, the last factor is 0
  return (0.25 + 0.75 * alpha2) * t * t * exp(-(1.0 / alpha2 + 1.0) * Log1p(tan2_h));
}
