// Two transformed cosines, each with a matrix of its own (ours). Dual.

// The lobe's integral from the transformed and the light's own form factor; the terms are as in glsl/fit.h.
float LtcLobe(float transformed, float form_factor, vec4 terms) { return transformed; }

// Where in the table the matrices are: the second's nodes below the first's. At v = 0 and 1 they are met exactly, and none of the
// other lobe's is mixed in.
vec2 FirstLobe(vec2 uv) { return vec2(uv.x, 0.5 * uv.y); }
vec2 SecondLobe(vec2 uv) { return vec2(uv.x, 0.5 * uv.y + 0.5); }
