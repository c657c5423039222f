#pragma once
// The whole energy of the GGX lobe (D·G2/(4 n·v) over the hemisphere). Dual: also compiles as C++.

// x: with Fresnel 1; y: with Schlick's weight, so that the reflected share is F0·(x − y) + y. n_dot_v, roughness in [0, 1].
// Least squares by us over 25×25 nodes of both against quadrature; root mean square error 0.009 and 0.011, at most 0.043 and
// 0.077, the largest at n·v < 0.04.
vec2 SpecularAlbedo(float n_dot_v, float roughness) {
  float s = sqrt(n_dot_v);
  float r = roughness;
  float loss = 9.20699 - 23.58657 * s + 14.13227 * n_dot_v;
  loss += r * (-37.73608 + 110.15193 * s - 72.54534 * n_dot_v);
  loss += r * r * (49.19391 - 151.47128 * s + 106.22564 * n_dot_v);
  loss += r * r * r * (-20.78929 + 66.21319 * s - 48.31052 * n_dot_v);
  float m = 1.0 - n_dot_v;
  float m2 = m * m;
  float grazing = 1.10113 - 0.15869 * n_dot_v;
  grazing += r * (-2.86503 + 10.08037 * n_dot_v);
  grazing += r * r * (2.35334 - 22.66772 * n_dot_v);
  grazing += r * r * r * (-0.52594 + 12.94019 * n_dot_v);
  float energy = clamp(1.0 - r * r * loss, 0.0, 1.0);
  return vec2(energy, clamp(m2 * m2 * m * grazing, 0.0, energy));
}
