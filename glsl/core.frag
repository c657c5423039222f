// The technique core, which `arealab cost` compiles and nobody draws: position and normal as varyings, one light and one
// material as uniforms, one summed output. What it costs beyond the technique is the same for every technique.
#include "surface.glsl"
#include "platform"
#include "lights.glsl"
#include "technique"

layout(location = 0) in vec3 surface_position;  // m, world
layout(location = 1) in vec3 surface_normal;
uniform vec4 surface_material;  // diffuse albedo; w: roughness
uniform vec4 surface_f0;
#if EFFECT_APERTURE
uniform vec4 surface_aperture;
uniform vec4 surface_first_region;
uniform vec4 surface_second_region;
uniform vec4 surface_blocked;
#endif

void main() {
  Surface surface;
  surface.position = surface_position;
  surface.normal = normalize(surface_normal);
  surface.roughness = surface_material.w;
  surface.alpha = surface_material.w * surface_material.w;
  surface.diffuse_albedo = surface_material.xyz;
  surface.f0 = surface_f0.xyz;
#if EFFECT_APERTURE
  surface.aperture = surface_aperture;
  surface.first_region = surface_first_region;
  surface.second_region = surface_second_region;
  surface.blocked = surface_blocked;
#endif
  Radiance radiance = ShadeLight(surface, LoadLight(0), normalize(ViewPosition() - surface_position));
  vec3 sum = vec3(0.0);
#if EFFECT_DIFFUSE
  sum += radiance.diffuse;
#endif
#if EFFECT_SPECULAR
  sum += radiance.specular;
#endif
  out_diffuse = vec4(sum, 1.0);
}
