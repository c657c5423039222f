// Blinn-Phong's importance cone. Dual; see importance_cone.glsl.

// Drobot's eq. 1.18 for the half vector: θ_h = √(2/(n + 2)), and n = 2/α² − 2 makes that α.
float ThresholdConeVersine(float alpha) {
  float sine = sin(alpha);
  return 2.0 * sine * sine;
}

// Ours: a mirror's limit (n·v)² over the peak (n + 8)/(8π) n·v is a solid angle of 8π n·v/(n + 8).
float WholeConeVersine(float alpha) { return 2.0 * alpha * alpha / (1.0 + 3.0 * alpha * alpha); }

float ConeAcross(float n_dot_v) { return n_dot_v; }
