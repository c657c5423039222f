// GGX with height-correlated Smith masking [Walter 2007, eq. 33; Heitz 2014, eq. 99], the default. Dual; after brdf.glsl.
float BrdfOverGgx(float n_dot_v, float n_dot_l, float v_dot_h, float tan2_h, float alpha) {
  return SmithVisibility(n_dot_v, n_dot_l, alpha);
}
