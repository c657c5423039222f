// The form factor of a sphere clipped at the horizon, by (|F|² + F_z)/(|F| + 1): no root, no case, as three.js and the authors' own
// example ship it. Error at most 0.135, at most 0.18 of |F|. Dual.
// size: sin² of the sphere's angular radius, its form factor when faced, [0, 1]; elevation: cosine between its centre and
// the normal.
float ClippedSphere(float size, float elevation) { return max(size * (size + elevation) / (size + 1.0), 0.0); }
