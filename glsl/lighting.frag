// The lighting pass: one technique over the G-buffer, diffuse and specular radiance to two targets.
#include "surface.glsl"
#include "platform"
#include "lights.glsl"
#include "lit.glsl"
#include "technique"
#if EFFECT_APERTURE || EFFECT_SKY
// In one condition: what both include is included once.
#include "visibility"
#include "sky"
#endif

void AddFacedLight(Light light, Surface surface, vec3 to_view, inout vec3 diffuse, inout vec3 specular) {
  Radiance radiance = ShadeLight(surface, light, to_view);
#if EFFECT_APERTURE
  float visible = Visibility(surface, light);
  radiance.diffuse *= visible;
  radiance.specular *= visible;
#endif
  // What is not added here is dead code, and the compiler drops it from the technique.
#if EFFECT_DIFFUSE
  diffuse += radiance.diffuse;
#endif
#if EFFECT_SPECULAR
  specular += radiance.specular;
#endif
}

void AddLight(int i, Surface surface, vec3 to_view, inout vec3 diffuse, inout vec3 specular) {
  Light light = LoadLight(i);
  if (!Lit(FaceLight(light, surface.position))) return;
#if EFFECT_SKY
#if EFFECT_TEXTURED
  // What a textured light hides of the sky is not textured.
  if (light.image.x != 0.0) {
    AddFacedLight(light, surface, to_view, diffuse, specular);
    light.image = vec3(0.0);
    light.radiance = vec3(0.0);
  }
#endif
  light.radiance = BeforeSky(surface, light);
#endif
  AddFacedLight(light, surface, to_view, diffuse, specular);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 diffuse = vec3(0.0);
  vec3 specular = vec3(0.0);
  vec4 position = FetchPosition(pixel);
  if (Lit(position.w == 1.0)) {
    vec4 normal = FetchNormal(pixel);
    vec4 base_color = FetchBaseColor(pixel);
    vec3 to_view = normalize(ViewPosition() - position.xyz);
    // A face turned away from the viewer is black.
#if EFFECT_TURNED_AWAY
    if (Lit(dot(normal.xyz, to_view) > 0.0))
#endif
    {
#if !EFFECT_MATERIAL_COLOR
      base_color.rgb = vec3(base_color.r);
#endif
#if !EFFECT_METAL
      float metalness = 0.0;
#elif EFFECT_SPECULAR && !EFFECT_SPECULAR_WEIGHT
      float metalness = base_color.w;
#else
      float metalness = max(base_color.w, 0.0);
#endif
      Surface surface;
      surface.position = position.xyz;
      surface.normal = normal.xyz;
      surface.roughness = normal.w;
      surface.alpha = max(normal.w * normal.w, kMinAlpha);
      surface.diffuse_albedo = base_color.rgb * (1.0 - metalness);
      surface.f0 = mix(vec3(0.04), base_color.rgb, metalness);
#if EFFECT_APERTURE
      surface.aperture = FetchAperture(pixel);
      surface.first_region = FetchFirstRegion(pixel);
      surface.second_region = FetchSecondRegion(pixel);
      surface.blocked = FetchBlocked(pixel);
      if (surface.aperture.xyz == vec3(0.0)) {  // nothing was baked: all is open
        surface.aperture = surface.first_region = vec4(surface.normal, 1.0);
        surface.second_region = surface.blocked = vec4(surface.normal, 0.0);
      }
#endif
#if EFFECT_MANY_LIGHTS
      for (int i = 0; i < light_count; ++i) AddLight(i, surface, to_view, diffuse, specular);
#else
      AddLight(0, surface, to_view, diffuse, specular);
#endif
#if EFFECT_SKY
      Radiance sky = ShadeSky(surface, to_view);
#if EFFECT_DIFFUSE
      diffuse += sky.diffuse;
#endif
#if EFFECT_SPECULAR
      specular += sky.specular;
#endif
#endif
#if EFFECT_SPECULAR_WEIGHT
      specular *= 1.0 + min(base_color.w, 0.0);
#endif
    }
  }
  WriteRadiance(diffuse, specular);
}
