// A smooth grey plastic floor under one white sphere, its representative point [Karis 2013]: written for that scene alone.
#include "platform"
#include "lit.glsl"

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float diffuse = 0.0;
  float specular = 0.0;
  vec4 position = texelFetch(gbuffer_position, pixel, 0);
  if (Lit(position.w == 1.0)) {
    vec4 normal_roughness = texelFetch(gbuffer_normal, pixel, 0);
    vec3 normal = normal_roughness.xyz;
    float alpha = normal_roughness.w * normal_roughness.w;
    float albedo = texelFetch(gbuffer_base_color, pixel, 0).x;
    vec3 to_view = normalize(view_position - position.xyz);

    vec3 to_center = light_rows[0].xyz - position.xyz;
    float radius = light_rows[2].w;
    float inverse = inversesqrt(dot(to_center, to_center));
    float irradiance = light_rows[6].x * light_rows[4].w * max(dot(normal, to_center), 0.0) * (inverse * inverse * inverse);
    diffuse = albedo * irradiance * 0.318309886;

    float n_dot_v = max(dot(normal, to_view), 1e-6);
    vec3 mirror = normal * (2.0 * n_dot_v) - to_view;
    vec3 to_ray = mirror * dot(mirror, to_center) - to_center;
    vec3 to_light = normalize(to_center + to_ray * min(radius * inversesqrt(dot(to_ray, to_ray)), 1.0));
    float n_dot_l = max(dot(normal, to_light), 1e-6);
    vec3 half_vector = normalize(to_view + to_light);
    float v_dot_h = dot(to_view, half_vector);
    // The sine, since near the peak the cosine has no digits left of it.
    vec3 c = cross(normal, half_vector);
    float sin2 = dot(c, c);
    float alpha2 = alpha * alpha;
    float k = alpha / (sin2 + (1.0 - sin2) * alpha2);
    float masking = n_dot_l * sqrt(n_dot_v * n_dot_v * (1.0 - alpha2) + alpha2) + n_dot_v * sqrt(n_dot_l * n_dot_l * (1.0 - alpha2) + alpha2);
    float m = 1.0 - v_dot_h;
    float fresnel = 0.04 + 0.96 * (m * m * m * m * m);
    float widened = alpha / min(alpha + 0.5 * radius * inverse, 1.0);
    specular = fresnel * irradiance * (k * k * 0.159154943) / masking * (widened * widened);
  }
  out_diffuse = vec4(vec3(diffuse), 1.0);
  out_specular = vec4(vec3(specular), 1.0);
}
