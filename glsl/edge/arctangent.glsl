// The edge integral by the arc tangent of sine and cosine (ours): as many digits at every angle. The arc cosine loses half of a small
// angle's, and with them, where opposite sides cancel, a light that is far: what the other forms are held against. Dual.
#include "polygon.glsl"

const float kTurn = 2.0 * kPi;
const bool kEdgeMirrored = false;
const bool kEdgeUnit = false;

// A corner as the edges want it: as it is, since no length is asked.
vec4 EdgeVertex(vec3 v) { return vec4(v, 1.0); }

// θ itself; `area` = |v0 × v1|, d = v0·v1.
float EdgeAngle(float d, float m2, float area) { return area > 0.0 ? atan(area, d) : 0.0; }

// θ/line where |v0 × v1| = share · line, line2 = line².
float EdgeRatio(float d, float m2, float share, float line2) {
  float line = sqrt(line2);
  return line > 0.0 ? EdgeAngle(d, m2, share * line) / line : 0.0;
}

// Of the light itself, for the diffuse lobe.
float LambertEdgeRatio(float d, float m2, float share, float line2) { return EdgeRatio(d, m2, share, line2); }
