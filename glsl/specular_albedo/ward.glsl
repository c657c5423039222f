// The whole energy of Ward's lobe with bounded albedo (glsl/brdf/ward.glsl), as specular_albedo.glsl has GGX's. Dual.

// x: with Fresnel 1; y: with Schlick's weight. n_dot_v, roughness in [0, 1]. Least squares by us over 25×25 nodes of both against
// quadrature; root mean square error 0.016 and 0.011, at most 0.11 and 0.067, the largest at n·v < 0.04.
vec2 LobeAlbedo(float n_dot_v, float roughness) {
  float s = sqrt(n_dot_v);
  float r = roughness;
  float loss = 11.84164 - 33.51561 * s + 22.01141 * n_dot_v;
  loss += r * (-46.55365 + 151.78786 * s - 108.60159 * n_dot_v);
  loss += r * r * (59.31212 - 206.50166 * s + 155.54306 * n_dot_v);
  loss += r * r * r * (-24.68607 + 89.20698 * s - 69.22955 * n_dot_v);
  float m = 1.0 - n_dot_v;
  float m2 = m * m;
  float grazing = 1.01205 + 0.17152 * n_dot_v;
  grazing += r * (-1.43288 + 5.77478 * n_dot_v);
  grazing += r * r * (0.66136 - 16.42045 * n_dot_v);
  grazing += r * r * r * (-0.05173 + 10.45213 * n_dot_v);
  float energy = clamp(1.0 - r * r * loss, 0.0, 1.0);
  return vec2(energy, clamp(m2 * m2 * m * grazing, 0.0, energy));
}
