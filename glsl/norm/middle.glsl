// The matrix divided by its middle element, four terms, as the authors' later code ships it. Sharp lobes at grazing angles step
// from row to row in the normal's frame, in the mirror frame they do not. Dual.

// M⁻¹ with the middle element 1, in the stored frame, from the look-ups.
vec4 LtcNormalised(vec4 texel, vec4 terms) { return texel; }
