// The sky for techniques that know of none: all of it reflected, less what each light covers of it. Lambert's part is exact but for
// the lights' form factors, which are the technique's.
#include "sky_fill.glsl"
#include "sky_texture.glsl"

#if EFFECT_SKY
// A light hides the sky behind it: what it adds is the difference. A textured sky's mean about the light's middle, over the solid angle
// that the light fills there.
vec3 BeforeSky(Surface surface, Light light) {
#if EFFECT_SKY_TEXTURE
  vec3 to_light = light.center - surface.position;
  float distance2 = max(dot(to_light, to_light), 1e-12);
  float facing = light.shape == SHAPE_SPHERE || light.shape == SHAPE_TUBE ? 1.0 : abs(dot(to_light, light.normal)) * inversesqrt(distance2);
  // A disk's of that area at that distance: 2π (1 − 1/√(1 + A cosθ/(π r²))), as t/(1 + t + √(1 + t)).
  float t = light.area * facing / (kPi * distance2);
  float solid_angle = 2.0 * kPi * t / (1.0 + t + sqrt(1.0 + t));
  return light.radiance - SkyRadiance() * SkyTowards(to_light * inversesqrt(distance2), solid_angle);
#else
  return light.radiance - SkyRadiance();
#endif
}

Radiance ShadeSky(Surface surface, vec3 to_view) {
  Radiance sky;
  sky.diffuse = SkyRadiance() * surface.diffuse_albedo * OpenSky(surface);
  sky.specular = SkyRadiance() * LobeOfSky(surface, to_view);
#if EFFECT_SKY_TEXTURE
  // Prefiltered as seen along the normal, times the lobe's energy in its own view: a split sum [Karis 2013], looked up where the lobe
  // leans back to the normal [after Lagarde 2014, by α].
  sky.diffuse *= SkyOverCosine(surface.normal);
  vec3 mirror = surface.normal * (2.0 * dot(surface.normal, to_view)) - to_view;
  float smoothness = 1.0 - surface.alpha;
  vec3 lobe = normalize(mix(surface.normal, mirror, smoothness * (sqrt(smoothness) + surface.alpha)));
  sky.specular *= SkyOverLobe(lobe, surface.alpha);
#endif
  return sky;
}
#endif
