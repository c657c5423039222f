// Disney's: darker than Lambert's at grazing angles where smooth, brighter where rough, most so back towards the light
// [Burley 2012, section 5.3]. Dual; after brdf.glsl.
// (1 + (F90 − 1)(1 − n·l)⁵)(1 + (F90 − 1)(1 − n·v)⁵), F90 = ½ + 2 roughness (v·h)²; its roughness is the artist's, v_dot_h2 = (v·h)².
float DiffuseOverLambert(float n_dot_v, float n_dot_l, float v_dot_h2, float roughness) {
  float grazing = 2.0 * roughness * v_dot_h2 - 0.5;
  return (1.0 + grazing * SchlickWeight(n_dot_l)) * (1.0 + grazing * SchlickWeight(n_dot_v));
}

// The albedo of a Lambertian surface that reflects as much from `to_light` to `to_view`.
vec3 DiffuseAlbedo(Surface surface, vec3 to_view, vec3 to_light) {
  float v_dot_h2 = clamp(0.5 + 0.5 * dot(to_view, to_light), 0.0, 1.0);
  return surface.diffuse_albedo * DiffuseOverLambert(dot(surface.normal, to_view), dot(surface.normal, to_light), v_dot_h2, surface.roughness);
}
