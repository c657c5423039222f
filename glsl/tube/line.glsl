// A tube as a line along its axis, as wide as a thin cylinder is seen [Heitz & Hill 2017b]; derived anew. After light_cone.glsl.

// The vector form factor of the line from p to q, of what is above z = 0, for a cylinder of radius 1 about it, thin: a part dl at the
// place x, under the angle γ to the line, covers 2 sinγ dl/|x|². With x = foot + l·along, d = |foot|, sinγ = d/|x|
//   1/π ∫ x/|x| · 2d/|x|³ dl = 1/π (foot Δ[l/(d (d² + l²)) + atan(l/d)/d²] + along Δ[−d/(d² + l²)]).
// Their eq. 1.23 has l²/(d (d² + l²)) for the last, which is 1/d more at both ends: the same difference, in fewer digits.
vec3 LineVector(vec3 p, vec3 q) {
  if (p.z <= 0.0 && q.z <= 0.0) return vec3(0.0);
  if (p.z < 0.0) p = (p * q.z - q * p.z) / (q.z - p.z);
  if (q.z < 0.0) q = (q * p.z - p * q.z) / (p.z - q.z);
  vec3 span = q - p;
  vec3 along = span * inversesqrt(max(dot(span, span), 1e-30));
  float l0 = dot(p, along);
  float l1 = dot(q, along);
  vec3 foot = p - along * l0;
  float d2 = max(dot(foot, foot), 1e-12 * (l0 * l0 + l1 * l1) + 1e-30);
  float inverse_d = inversesqrt(d2);
  float w0 = 1.0 / (d2 + l0 * l0);
  float w1 = 1.0 / (d2 + l1 * l1);
  float angle = Arctangent((l1 - l0) * d2 * inverse_d, d2 + l0 * l1);  // atan l1/d − atan l0/d, in [0, π)
  float on_foot = (l1 * w1 - l0 * w0 + angle * inverse_d) * inverse_d;
  float on_along = d2 * inverse_d * (w0 - w1);
  return (foot * on_foot + along * on_along) * (1.0 / kPi);
}

// The same of a tube transformed by M⁻¹ = m, a line again: the strip of half width R along the normal n of the plane of point and line
// becomes one of half width R det(M⁻¹) |n| / |adj(M⁻¹)ᵀ n| across the transformed plane. Never more than the whole hemisphere.
vec3 TubeVector(vec4 m, Light light, vec3 position, ShadingFrame frame) {
  vec3 to_center = light.center - position;
  vec3 center = vec3(dot(frame.tangent, to_center), dot(frame.bitangent, to_center), dot(frame.normal, to_center));
  vec3 half_axis = vec3(dot(frame.tangent, light.half_axis_x), dot(frame.bitangent, light.half_axis_x), dot(frame.normal, light.half_axis_x));
  vec3 n = cross(center, half_axis);
  vec3 across = LtcAdjoint(m, n);
  float width = light.half_size.y * abs(m.x * m.w - m.y * m.z) * sqrt(dot(n, n) / max(dot(across, across), 1e-30));
  vec3 f = LineVector(LtcTransform(m, center - half_axis), LtcTransform(m, center + half_axis)) * width;
  return vec3(f.x, f.y, AsFormFactor(f.z));
}

void TubeFactors(Light light, vec3 position, ShadingFrame frame, vec4 m, OUT(float) form_factor, OUT(vec3) transformed) {
  form_factor = TubeVector(vec4(1.0, 0.0, 0.0, 1.0), light, position, frame).z;
  transformed = TubeVector(m, light, position, frame);
}
