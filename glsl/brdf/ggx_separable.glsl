// GGX with separable Smith masking: G2 = G1(v) G1(l) [Walter 2007, eqs. 23, 33 and 34]. Dual; after brdf.glsl.
// G1(c)/(2c) = 1/(c + √(c² + α²(1 − c²))), once for each direction.
float BrdfOverGgx(float n_dot_v, float n_dot_l, float v_dot_h, float tan2_h, float alpha) {
  float alpha2 = alpha * alpha;
  float view_term = n_dot_v + sqrt(n_dot_v * n_dot_v * (1.0 - alpha2) + alpha2);
  float light_term = n_dot_l + sqrt(n_dot_l * n_dot_l * (1.0 - alpha2) + alpha2);
  return 1.0 / (view_term * light_term);
}
