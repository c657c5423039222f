// Tables fitted on polygons, stored in the mirror frame; the view angles end at 89° (ours). Dual; after ltc.glsl.

// The table's second coordinate, [0, 1], from cosine and sine of the view angle.
float LtcViewPosition(float n_dot_v, float sine) { return ViewPositionTo89(n_dot_v, sine); }

// M⁻¹ from a texel.
vec4 LtcUnpack(vec4 texel, float n_dot_v, float sine) { return FromMirrorFrame(texel, n_dot_v, sine); }

// The lobe's integral from the transformed and the light's own form factor; the terms are as in glsl/fit.h.
float LtcLobe(float transformed, float form_factor, vec4 terms) { return transformed; }
