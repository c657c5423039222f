// The edge integral by the arc cosine that GPUs run [Abramowitz & Stegun 1964, 4.4.45; Hill & Heitz 2016, "acos: evil lurks
// within"]. Dual. Error at most 6.75e-5 rad; the best of its form has the same, to 2e-8: the minimax polynomial itself, rounded.
float ArcCosine(float x) {
  float y = abs(x);
  float s = ((-0.0187293 * y + 0.0742610) * y - 0.2121144) * y + 1.5707288;
  s = s * sqrt(1.0 - y);
  return x >= 0.0 ? s : kPi - s;
}
#include "arc_cosine_edge.glsl"
