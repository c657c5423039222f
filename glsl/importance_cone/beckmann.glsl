// Beckmann's importance cone. Dual; see importance_cone.glsl.

// Where tanθ_h = α: alpha is the root mean square of the slope, and Drobot's cone for Phong coincides with it (eq. 1.18); the lobe is
// then 1/e of its peak but for 1/cos⁴θ_h.
float ThresholdConeVersine(float alpha) { return 2.0 * alpha * alpha / (1.0 + alpha * alpha); }

// Ours, as for GGX: the peak 1/(π α²) is the same.
float WholeConeVersine(float alpha) { return 2.0 * alpha * alpha; }

float ConeAcross(float n_dot_v) { return n_dot_v; }
