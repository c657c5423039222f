#pragma once
// How the shading text reads and writes when it computes in float. Not rewritten by the expander.
#include "platform_inputs.glsl"

vec4 FetchPosition(ivec2 pixel) { return texelFetch(gbuffer_position, pixel, 0); }
vec4 FetchNormal(ivec2 pixel) { return texelFetch(gbuffer_normal, pixel, 0); }
vec4 FetchBaseColor(ivec2 pixel) { return texelFetch(gbuffer_base_color, pixel, 0); }
#if EFFECT_APERTURE
vec4 FetchAperture(ivec2 pixel) { return texelFetch(gbuffer_aperture, pixel, 0); }
vec4 FetchFirstRegion(ivec2 pixel) { return texelFetch(gbuffer_first_region, pixel, 0); }
vec4 FetchSecondRegion(ivec2 pixel) { return texelFetch(gbuffer_second_region, pixel, 0); }
vec4 FetchBlocked(ivec2 pixel) { return texelFetch(gbuffer_blocked, pixel, 0); }
#endif
vec3 ViewPosition() { return view_position; }
#if EFFECT_SKY
vec3 SkyInput() { return sky_radiance; }
#endif
#if EFFECT_SKY_TEXTURE
float SkyTurn() { return sky_turn; }
#endif
vec4 LightRow(int light, int row) { return light_rows[light * LIGHT_ROWS + row]; }
#if EFFECT_POLYGON
vec4 CornerRow(int light, int row) { return corner_rows[light * CORNER_ROWS + row]; }
#endif

// Bilinear, clamped to the edge; texel (i, j)'s centre is uv = (i + ½, j + ½) / size.
vec4 SampleTable(sampler2D table, vec2 uv) { return textureLod(table, uv, 0.0); }

#if EFFECT_TEXTURED
vec3 FetchLayer(sampler2DArray map, ivec3 texel, int level) { return texelFetch(map, texel, level).rgb; }
#endif

#if EFFECT_TEXTURED || EFFECT_SKY_TEXTURE
// Trilinear, clamped to the edge; place: uv and layer.
vec4 SampleLayer(sampler2DArray map, vec3 place, float level) { return textureLod(map, place, level); }
#endif

void WriteRadiance(vec3 diffuse, vec3 specular) {
  out_diffuse = vec4(diffuse, 1.0);
  out_specular = vec4(specular, 1.0);
}
