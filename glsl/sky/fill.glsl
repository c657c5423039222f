// The sky for techniques that know of none: all of it reflected, less what each light covers of it. Lambert's part is exact but for
// the lights' form factors, which are the technique's.
#include "sky_fill.glsl"

#if EFFECT_SKY
// A light hides the sky behind it: what it adds is the difference.
vec3 BeforeSky(vec3 radiance) { return radiance - SkyRadiance(); }

Radiance ShadeSky(Surface surface, vec3 to_view) {
  Radiance sky;
  sky.diffuse = SkyRadiance() * surface.diffuse_albedo * OpenSky(surface);
  sky.specular = SkyRadiance() * LobeOfSky(surface, to_view);
  return sky;
}
#endif
