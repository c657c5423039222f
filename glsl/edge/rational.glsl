// The edge integral by the published rational fit, for both lobes. Dual.
#include "rational_edge.glsl"

// Of the light itself, for the diffuse lobe.
float LambertEdgeRatio(float d, float m2, float share, float line2) { return EdgeRatio(d, m2, share, line2); }
