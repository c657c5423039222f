// GGX's importance cone. Dual; see importance_cone.glsl.

// The versine where the lobe falls to 1/e of its peak, the threshold of Drobot's cone for Phong (eq. 1.18). With half vectors at θ_h
// from the normal, D(θ_h)/D(0) = σ gives sin²θ_h = (σ^−½ − 1) α²/(1 − α²); √e − 1 = 0.6487.
float ThresholdConeVersine(float alpha) {
  float alpha2 = alpha * alpha;
  return min(2.0 * 0.6487212707 * alpha2 / max(1.0 - alpha2, 1e-6), 2.0);
}

// Ours: the versine that conserves energy at normal incidence, peak · solid angle = what a mirror tends to. The lobe fills 4 n·v dω_h, so a
// cone in which it is as high as at the mirror direction has the solid angle 4π α² n·v. For small alpha this is the threshold σ = ¼.
float WholeConeVersine(float alpha) { return 2.0 * alpha * alpha; }

// How wide the lobe is across the plane of incidence, of its width in it: the half vector's turn counts 2 in the plane, 2 n·v across.
float ConeAcross(float n_dot_v) { return n_dot_v; }
