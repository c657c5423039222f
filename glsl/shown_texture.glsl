// A textured rectangle under linearly transformed cosines: each lobe's colour by one look-up in the prefiltered texture, form
// factors as of a plain light [Heitz et al. 2016; Hill & Heitz 2016]. After ltc.glsl, polygon.glsl and the option "texture".
#include "light_texture.glsl"
#include "texture"

#if EFFECT_TEXTURED
// The texel that stands for the parallelogram center ± a ± b, a × b towards the origin, under a cosine lobe there.
vec3 FilteredTexel(Light light, vec3 center, vec3 a, vec3 b, vec3 vector) {
  vec3 n = cross(a, b);
  float n2 = max(dot(n, n), 1e-30);
  float distance2;
  vec3 offset = LookUpPlace(center, n, n2, vector, distance2);
  vec2 place = vec2(dot(cross(offset, b), n), dot(cross(a, offset), n)) / n2;
  vec2 uv = vec2(0.5 + 0.5 * place.x, 0.5 - 0.5 * place.y);
  float level = BlurLevel(distance2 * 0.25 * inversesqrt(n2));
#if BORDER_YES
  return SampleLayer(light_cosine_border, vec3(0.125 + 0.75 * uv.x, 0.125 + 0.75 * uv.y, light.image.x), level).rgb;
#else
  return SampleLayer(light_cosine, vec3(uv, light.image.x), level).rgb;
#endif
}

// The vectors: the light's form factor seen from the point, in the shading frame, and that of the transformed light.
Radiance ShowTexture(Radiance plain, Light light, RectangleView view, vec4 m, vec3 vector, vec3 transformed) {
  Radiance shown;
  shown.diffuse = plain.diffuse * FilteredTexel(light, view.center, view.half_a, view.half_b, vector);
  shown.specular = plain.specular * FilteredTexel(light, LtcTransform(m, view.center), LtcTransform(m, view.half_a), LtcTransform(m, view.half_b), transformed);
  return shown;
}
#endif
