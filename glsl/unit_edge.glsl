// The edge integral on unit vectors, the obtuse angle mirrored [Hill & Heitz 2016]. Dual.
#include "polygon.glsl"

const float kTurn = 2.0 * kPi;
const bool kEdgeMirrored = false;
const bool kEdgeUnit = true;  // whether EdgeVertex makes corners unit

// A corner as the edges want it: unit, so that the products of lengths fold to 1.
vec4 EdgeVertex(vec3 v) { return vec4(v * inversesqrt(max(dot(v, v), 1e-30)), 1.0); }

// m, and cos θ of an edge, from m2 = |v0|²|v1|². By a root and a quotient: the arc cosine has no digits to spare.
float EdgeLengths(float m2) { return sqrt(max(m2, kSmallestEdge)); }
float EdgeCosine(float d, float m2) { return d / EdgeLengths(m2); }

// θ/sin θ from x = cos θ and the same of the acute angle. The talk mirrors without a clamp, infinite at π; the clamp is the one
// that the authors' code ships, which fails near π: kept, it is theirs.
float MirrorOverSine(float x, float acute) { return x > 0.0 ? acute : kPi * inversesqrt(max(1.0 - x * x, 1e-7)) - acute; }
