// The form factor of a sphere clipped at the horizon, by a fit of ours without a table. Dual.
// size: sin² of the sphere's angular radius, its form factor when faced, [0, 1]; elevation: cosine between its centre and
// the normal. E(y) − E(−y) = size · y, so only the even part is fitted, and c = √(1 − size) carries the singularity at
// size → 1. Mean absolute error 0.0017, max 0.011.
float ClippedSphere(float size, float elevation) {
  float y = elevation;
  float c = sqrt(max(1.0 - size, 0.0));
  float crossing = 0.5 * y + 0.4185 * c * y * y + (1.0 - c) * (0.5 + c * (-0.2084 + 0.5245 * c));
  return size * max(max(y, 0.0), crossing);
}
