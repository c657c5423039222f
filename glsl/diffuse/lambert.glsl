// Lambert's, the default: the same in every direction [Lambert 1760]. Dual; after brdf.glsl.
float DiffuseOverLambert(float n_dot_v, float n_dot_l, float v_dot_h2, float roughness) { return 1.0; }

// The albedo of a Lambertian surface that reflects as much from `to_light` to `to_view`.
vec3 DiffuseAlbedo(Surface surface, vec3 to_view, vec3 to_light) { return surface.diffuse_albedo; }
