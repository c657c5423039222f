// The whole energy of the scene's lobe: see specular_albedo.glsl. Dual.
#include "specular_albedo.glsl"

vec2 LobeAlbedo(float n_dot_v, float roughness) { return SpecularAlbedo(n_dot_v, roughness); }
