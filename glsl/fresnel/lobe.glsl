// Schlick's Fresnel term averaged over the whole lobe, wherever the light is, as published: the tables' two terms. Dual.
// m: M⁻¹; terms: see glsl/fit.h; lobe: the transformed light's clipped vector form factor.
vec3 LtcReflectance(vec3 f0, vec4 terms, vec4 m, float n_dot_v, float sine, vec3 lobe) { return f0 * (terms.x - terms.y) + vec3(terms.y); }
