// Dual; see specular_albedo.glsl.
#include "specular_albedo.glsl"
