// Shades points, each with a viewer and a light of its own: one per pixel, read from a texture. The host: compare/point_shader.h.
#include "surface.glsl"
#include "platform"

layout(binding = 15) uniform sampler2D cases;  // a case is a column of CASE_ROWS texels
uniform bool as_lighting_pass;                 // black where lighting.frag shades nothing

#define CASE_ROWS 15
vec4 CaseRow(int row) {
  vec4 texel = texelFetch(cases, ivec2(int(gl_FragCoord.x), int(gl_FragCoord.y) * CASE_ROWS + row), 0);
  return texel;
}

// Rows 0 to 7 are the light block's of the one light, 11 to 14 its corners.
#define LightRow(light, row) CaseRow(row)
#define CornerRow(light, row) CaseRow(11 + row)
#include "lights.glsl"
#include "technique"

void main() {
  vec4 place = CaseRow(8);
  vec4 facing = CaseRow(9);
  vec4 viewer = CaseRow(10);
  Surface surface;
  surface.position = place.xyz;
  surface.roughness = place.w;
  surface.alpha = max(place.w * place.w, kMinAlpha);
  surface.normal = facing.xyz;
  surface.diffuse_albedo = vec3(1.0);
  surface.f0 = vec3(facing.w);
  Light light = LoadLight(0);
  Radiance radiance = Radiance(vec3(0.0), vec3(0.0));
  if (!as_lighting_pass || (dot(surface.normal, viewer.xyz) > 0.0 && FaceLight(light, surface.position))) {
    radiance = ShadeLight(surface, light, viewer.xyz);
  }
  WriteRadiance(radiance.diffuse, radiance.specular);
}
