// One transformed cosine and a signed share of the plain one, whose integral the diffuse part needs anyway (ours). Dual.

// The lobe's integral from the transformed and the light's own form factor; the terms are as in glsl/fit.h.
float LtcLobe(float transformed, float form_factor, vec4 terms) { return max(transformed + terms.z * form_factor, 0.0); }

// Where in the table the first lobe's matrix is.
vec2 FirstLobe(vec2 uv) { return uv; }
