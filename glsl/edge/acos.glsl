// The edge integral by the language's arc cosine. On GPUs that is a polynomial of a few terms (edge=fast_acos), whose error rings
// where the light is bright and the receiver smooth [Hill & Heitz 2016, "acos: evil lurks within"]. Dual.
float ArcCosine(float x) { return acos(x); }
#include "arc_cosine_edge.glsl"
