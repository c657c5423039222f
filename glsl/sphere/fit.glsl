// The form factor of a sphere clipped at the horizon, by a fit of ours without a table. Dual.
// size: sin² of the sphere's angular radius, its form factor when faced, [0, 1]; elevation: cosine between its centre and
// the normal.
//
// E(y) − E(−y) = size · y, so only the even part is fitted. With r = √size and t = y/r the horizon cuts where |t| < 1; the factor 1 − t² makes
// it meet size · y and 0 there, so that nothing leaks from below. c = √(1 − size) carries the singularity at size → 1.
// Mean absolute error 0.0010, max 0.0055, least squares reweighted towards the largest errors of E/r.
float ClippedSphere(float size, float elevation) {
  float inverse = inversesqrt(max(size, 1e-30));
  float r = size * inverse;
  float c = sqrt(max(1.0 - size, 0.0));
  float t = clamp(elevation * inverse, -1.0, 1.0);
  float t2 = t * t;
  float p = 0.002862 + c * (0.522738 - 0.253173 * c);
  float q = 0.015862 + c * (0.319367 - 0.433263 * c);
  return size * max(elevation, r * (0.5 + 0.5 * t - (1.0 - t2) * (p + q * t2)));
}
