// Stored about the mirrored view (ours). Dual; after ltc.glsl.

// M⁻¹ from M⁻¹·R, R turning the normal onto the mirrored view, by the pixel's own angle. Sharp lobes hardly move in that frame from
// one view angle to the next, and interpolation between them errs little.
vec4 LtcUnturned(vec4 stored, float n_dot_v, float sine) {
  return stored * n_dot_v + vec4(-stored.z, -stored.w, stored.x, stored.y) * sine;
}
