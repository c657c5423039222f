// Schlick's Fresnel term towards the light (ours). Dual; after ltc.glsl and brdf.glsl.
//
// The weight (1 − h·v)⁵ varies over a rough lobe from 0 to 1, and its average over the lobe, which the tables hold, is far from
// its value at a light that covers a part of it. It is taken where the lobe meets the light: at M F', the transformed light's vector
// form factor brought back. The table's average is right once the light covers the whole lobe, when F' has length 1:
// F'_z mixes the two.
// m: M⁻¹; terms: see glsl/fit.h; lobe: F', of the transformed light's part above the horizon.
vec3 LtcReflectance(vec3 f0, vec4 terms, vec4 m, float n_dot_v, float sine, vec3 lobe) {
  vec3 to_light = LtcUndo(m, lobe);
  // 1e-30: F' is 0 where there is no light.
  float v_dot_l = (sine * to_light.x + n_dot_v * to_light.z) * inversesqrt(max(dot(to_light, to_light), 1e-30));
  float v_dot_h = sqrt(clamp(0.5 + 0.5 * v_dot_l, 0.0, 1.0));
  float weight = mix(SchlickWeight(v_dot_h) * terms.x, terms.y, lobe.z);
  return f0 * (terms.x - weight) + vec3(weight);
}
