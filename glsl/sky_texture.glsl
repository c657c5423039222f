#pragma once
// What a textured sky sends from around a direction: look-ups in the forms of glsl/sky_maps.h, in units of the sky's radiance.
#include "platform"
#include "surface.glsl"

#if EFFECT_SKY_TEXTURE
const float kFirstSkyAlpha = 0.02454369260617026;  // two of 512 texels around
const float kSkyLobeLayers = 4.0;
const float kSkyLobeRows = 256.0;  // of level 0
const float kSkyCosineRows = 64.0;

// The image's middle is towards +y, its right half towards +x; a tenth of a form's width is margin.
vec2 SkyPlace(vec3 direction) {
  float around = 0.5 + SkyTurn() + atan(direction.x, direction.y) / (2.0 * kPi);
  return vec2(0.1 + 0.8 * (around - floor(around)), acos(clamp(direction.z, -1.0, 1.0)) / kPi);
}

vec3 SkyColor(vec4 texel) {
#if EFFECT_LIGHT_COLOR
  return texel.rgb;
#else
  return vec3(texel.r);
#endif
}

// The mean about a direction, over `solid_angle`: from the level whose texels are as high as its root. Levels end at 8 texels around.
vec3 SkyTowards(vec3 direction, float solid_angle) {
  float last = float(textureQueryLevels(sky_image) - 1);
  float level = last + log2(8.0 / (2.0 * kPi)) + 0.5 * log2(max(solid_angle, 1e-12));
  return SkyColor(SampleLayer(sky_image, vec3(SkyPlace(direction), 0.0), level));
}

// In a form whose first and last rows' middles are the poles.
vec2 PoleToPole(vec2 place, float rows) { return vec2(place.x, (0.5 + place.y * (rows - 1.0)) / rows); }

// The mean over the cosine lobe.
vec3 SkyOverCosine(vec3 normal) { return SkyColor(SampleLayer(sky_cosine, vec3(PoleToPole(SkyPlace(normal), kSkyCosineRows), 0.0), 0.0)); }

vec3 SkyLobeStep(vec2 place, float i) {
  float level = floor(i / kSkyLobeLayers);
  return SkyColor(SampleLayer(sky_lobes, vec3(PoleToPole(place, kSkyLobeRows * exp2(-level)), i - kSkyLobeLayers * level), level));
}

// The mean over the GGX lobe about the direction; between stored widths linear in their logarithm. Narrower than the narrowest it
// tends to the image, over the lobe's own 4πα² sr.
vec3 SkyOverLobe(vec3 direction, float alpha) {
  vec2 place = SkyPlace(direction);
  float width = max(kSkyLobeLayers * log2(alpha / kFirstSkyAlpha), 0.0);
  vec3 lobe = mix(SkyLobeStep(place, floor(width)), SkyLobeStep(place, floor(width) + 1.0), width - floor(width));
  if (alpha >= kFirstSkyAlpha) return lobe;
  return mix(SkyTowards(direction, 4.0 * kPi * alpha * alpha), lobe, alpha / kFirstSkyAlpha);
}
#endif
