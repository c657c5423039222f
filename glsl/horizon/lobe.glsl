// The transformed lobe is clipped where it ends; what of it lies below the surface's horizon leaks, as in every published form. Dual;
// after ltc.glsl and a "clip".

// The vector form factor of the transformed light.
vec3 LobeVector(vec4 m, RectangleView view) {
  return ClippedVector(LtcTransform(m, view.center), LtcTransform(m, view.half_a), LtcTransform(m, view.half_b), view.small);
}
