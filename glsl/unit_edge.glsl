// The edge integral on unit vectors, the obtuse angle mirrored [Hill & Heitz 2016]. Dual.

// A corner as the edges want it: unit, so that the products of lengths fold to 1.
vec4 EdgeVertex(vec3 v) { return vec4(v * inversesqrt(max(dot(v, v), 1e-30)), 1.0); }

// cos θ of an edge.
float EdgeCosine(float d, float m) { return d / max(m, 1e-30); }

// θ/sin θ from x = cos θ and the same of the acute angle. The talk mirrors without a clamp, infinite at π; the clamp is the one
// that the authors' code ships, which fails near π: kept, it is theirs.
float MirrorOverSine(float x, float acute) { return x > 0.0 ? acute : kPi * inversesqrt(max(1.0 - x * x, 1e-7)) - acute; }
