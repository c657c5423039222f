// Stored about the normal, as published. Dual; after ltc.glsl.

// M⁻¹ from what is stored.
vec4 LtcUnturned(vec4 stored, float n_dot_v, float sine) { return stored; }
