#pragma once
// What a light shows [the scene's `texture`]: its radiance at a place is light.radiance × the texel. Texture coordinates run from the
// upper left of the image as the lit side shows it.
#include "surface.glsl"
#include "platform"

#if EFFECT_TEXTURED
// `place` in the light's plane, m from its centre along axis_x and axis_y.
vec2 TextureCoordinates(Light light, vec2 place) {
  return vec2(0.5 + 0.5 * place.x / light.half_size.x, 0.5 - 0.5 * place.y / light.half_size.y);
}

// Bilinear between the texels' centres, held beyond the outermost.
vec3 ExactTexel(Light light, vec2 uv) {
  if (light.image.x == 0.0) return vec3(1.0);
  vec2 last = vec2(light.image.y, light.image.z) - 1.0;
  vec2 p = clamp(uv * vec2(light.image.y, light.image.z) - 0.5, vec2(0.0), last);
  ivec2 low = ivec2(p);
  ivec2 high = min(low + 1, ivec2(last));
  vec2 f = p - vec2(low);
  int layer = int(light.image.x);
  vec3 above = mix(FetchLayer(light_image, ivec3(low, layer), 0), FetchLayer(light_image, ivec3(high.x, low.y, layer), 0), f.x);
  vec3 below = mix(FetchLayer(light_image, ivec3(low.x, high.y, layer), 0), FetchLayer(light_image, ivec3(high, layer), 0), f.x);
  return mix(above, below, f.y);
}

// The level of a blurred form for a distance or radius r: l is for r = (2^l − 1)/32 of √area (glsl/light_textures.h).
float BlurLevel(float r2_over_area) { return log2(1.0 + 32.0 * sqrt(r2_over_area)); }

const int kMeanOfAll = 7;  // the level of light_means, 128 × 128 at level 0, that is one texel
vec3 MeanTexel(Light light) { return FetchLayer(light_means, ivec3(0, 0, int(light.image.x)), kMeanOfAll); }
#endif

// Averaged over the light.
vec3 MeanRadiance(Light light) {
#if EFFECT_TEXTURED
  return light.radiance * MeanTexel(light);
#else
  return light.radiance;
#endif
}
