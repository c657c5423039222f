// That of GGX: the masking is smooth. Dual; see importance_cone.glsl.
#include "importance_cone/ggx.glsl"
