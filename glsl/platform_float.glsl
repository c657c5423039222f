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
vec4 LightRow(int light, int row) { return light_rows[light * LIGHT_ROWS + row]; }

// Bilinear, clamped to the edge; texel (i, j)'s centre is uv = (i + ½, j + ½) / size.
vec4 SampleTable(sampler2D table, vec2 uv) { return textureLod(table, uv, 0.0); }

void WriteRadiance(vec3 diffuse, vec3 specular) {
  out_diffuse = vec4(diffuse, 1.0);
  out_specular = vec4(specular, 1.0);
}
