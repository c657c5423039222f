// The matrix undivided, five terms, the fifth beside the magnitude [Hill & Heitz 2016, "the original five components"]:
// the smoothest in the normal's frame. Dual.

// M⁻¹ with the middle element 1, in the stored frame, from the look-ups.
vec4 LtcNormalised(vec4 texel, vec4 terms) { return texel / terms.w; }
