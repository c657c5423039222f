// The edge integral as first written, θ times the unit cross product [Hill & Heitz 2016, "EdgeIntegral"]. Dual; after ArcCosine.
#include "unit_edge.glsl"

// θ; rounding can leave the arc cosine's domain.
float EdgeTheta(float d, float m2) { return ArcCosine(clamp(EdgeCosine(d, m2), -1.0, 1.0)); }

// θ/line, θ the angle between v0 and v1, from d = v0·v1 and m2 = |v0|²|v1|², where |v0 × v1| = share · line, line2 = line².
// An edge without length is none, whatever the cosine's rounding makes of its angle.
float EdgeRatio(float d, float m2, float share, float line2) {
  return share > 0.0 ? EdgeTheta(d, m2) * inversesqrt(max(line2, 1e-30)) : 0.0;
}

// Of the light itself, for the diffuse lobe.
float LambertEdgeRatio(float d, float m2, float share, float line2) { return EdgeRatio(d, m2, share, line2); }

// θ itself; `area` = |v0 × v1|.
float EdgeAngle(float d, float m2, float area) { return EdgeTheta(d, m2); }
