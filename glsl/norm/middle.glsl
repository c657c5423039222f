// The matrix divided by its middle element, four terms: smooth, as the authors' code ships it. Dual.

// M⁻¹ with the middle element 1, in the stored frame, from the look-ups.
vec4 LtcNormalised(vec4 texel, vec4 terms) { return texel; }
