// One transformed cosine. Dual.

// The lobe's integral from the transformed and the light's own form factor; the terms are as in glsl/fit.h.
float LtcLobe(float transformed, float form_factor, vec4 terms) { return transformed; }

// Where in the table the first lobe's matrix is.
vec2 FirstLobe(vec2 uv) { return uv; }
