// Phong's importance cone. Dual; see importance_cone.glsl.

// The half angle √(2/(m + 2)) [Drobot 2014, eq. 1.18, which has the full angle], m = 1/(2α²): 2α/√(1 + 4α²). A versine is twice the squared sine
// of the half.
float ThresholdConeVersine(float alpha) {
  float sine = sin(alpha * inversesqrt(1.0 + 4.0 * alpha * alpha));
  return 2.0 * sine * sine;
}

// Ours: peak (m + 2)/(2π) · solid angle = 1, its whole energy at normal incidence; 2π/(m + 2). Beside the threshold's there is little to tell.
float WholeConeVersine(float alpha) { return 2.0 * alpha * alpha / (1.0 + 4.0 * alpha * alpha); }

// The lobe is round about the mirror direction.
float ConeAcross(float n_dot_v) { return 1.0; }
