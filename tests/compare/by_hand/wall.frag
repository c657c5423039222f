// A matte grey wall under one white sphere far away, as a point: written for that scene alone.
#include "platform"
#include "lit.glsl"

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float diffuse = 0.0;
  vec4 position = texelFetch(gbuffer_position, pixel, 0);
  if (Lit(position.w == 1.0)) {
    vec3 normal = texelFetch(gbuffer_normal, pixel, 0).xyz;
    float albedo = texelFetch(gbuffer_base_color, pixel, 0).x;
    vec3 to_lamp = light_rows[0].xyz - position.xyz;
    float inverse = inversesqrt(dot(to_lamp, to_lamp));
    float intensity = light_rows[6].x * light_rows[4].w * 0.318309886;
    diffuse = albedo * intensity * max(dot(normal, to_lamp), 0.0) * (inverse * inverse * inverse);
  }
  out_diffuse = vec4(vec3(diffuse), 1.0);
  out_specular = vec4(0.0, 0.0, 0.0, 1.0);
}
