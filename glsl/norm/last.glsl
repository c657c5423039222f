// The matrix divided by its last element, four terms [Hill & Heitz 2016, "normalise matrix: 4 terms!"]. At grazing angles that
// element tends to 0, the terms no longer interpolate, and the highlight bands: the talk's own warning. Dual.

// M⁻¹ with the middle element 1, in the stored frame, from the look-ups.
vec4 LtcNormalised(vec4 texel, vec4 terms) { return vec4(texel.x, texel.y, texel.z, 1.0) / texel.w; }
