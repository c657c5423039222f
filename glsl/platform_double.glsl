#pragma once
// How the shading text reads and writes when it computes in double: the inputs are the very floats that the float form
// gets. Not rewritten by the expander.
#include "platform_inputs.glsl"

dvec4 FetchPosition(ivec2 pixel) { return dvec4(texelFetch(gbuffer_position, pixel, 0)); }
dvec4 FetchNormal(ivec2 pixel) { return dvec4(texelFetch(gbuffer_normal, pixel, 0)); }
dvec4 FetchBaseColor(ivec2 pixel) { return dvec4(texelFetch(gbuffer_base_color, pixel, 0)); }
#if EFFECT_APERTURE
dvec4 FetchAperture(ivec2 pixel) { return dvec4(texelFetch(gbuffer_aperture, pixel, 0)); }
dvec4 FetchFirstRegion(ivec2 pixel) { return dvec4(texelFetch(gbuffer_first_region, pixel, 0)); }
dvec4 FetchSecondRegion(ivec2 pixel) { return dvec4(texelFetch(gbuffer_second_region, pixel, 0)); }
dvec4 FetchBlocked(ivec2 pixel) { return dvec4(texelFetch(gbuffer_blocked, pixel, 0)); }
#endif
dvec3 ViewPosition() { return dvec3(view_position); }
#if EFFECT_SKY
dvec3 SkyInput() { return dvec3(sky_radiance); }
#endif
#if EFFECT_SKY_TEXTURE
double SkyTurn() { return double(sky_turn); }
#endif
dvec4 LightRow(int light, int row) { return dvec4(light_rows[light * LIGHT_ROWS + row]); }
#if EFFECT_POLYGON
dvec4 CornerRow(int light, int row) { return dvec4(corner_rows[light * CORNER_ROWS + row]); }
#endif

// Bilinear, clamped to the edge; texel (i, j)'s centre is uv = (i + ½, j + ½) / size. By hand: samplers weigh in float.
dvec4 SampleTable(sampler2D table, dvec2 uv) {
  ivec2 last = textureSize(table, 0) - 1;
  dvec2 p = clamp(uv * dvec2(last + 1) - 0.5lf, dvec2(0.0lf), dvec2(last));
  ivec2 low = clamp(ivec2(p), ivec2(0), last);
  ivec2 high = min(low + 1, last);
  dvec2 f = p - dvec2(low);
  dvec4 row_low = mix(dvec4(texelFetch(table, low, 0)), dvec4(texelFetch(table, ivec2(high.x, low.y), 0)), f.x);
  dvec4 row_high = mix(dvec4(texelFetch(table, ivec2(low.x, high.y), 0)), dvec4(texelFetch(table, high, 0)), f.x);
  return mix(row_low, row_high, f.y);
}

#if EFFECT_TEXTURED
dvec3 FetchLayer(sampler2DArray map, ivec3 texel, int level) { return dvec3(texelFetch(map, texel, level).rgb); }
#endif

#if EFFECT_TEXTURED || EFFECT_SKY_TEXTURE
dvec4 SampleLayerOnce(sampler2DArray map, dvec3 place, int level) {
  // Not textureSize(map, level): llvmpipe asks it once for pixels whose levels differ.
  ivec2 last = max(textureSize(map, 0).xy >> level, ivec2(1)) - 1;
  int layer = int(place.z);
  dvec2 p = clamp(place.xy * dvec2(last + 1) - 0.5lf, dvec2(0.0lf), dvec2(last));
  ivec2 low = clamp(ivec2(p), ivec2(0), last);
  ivec2 high = min(low + 1, last);
  dvec2 f = p - dvec2(low);
  dvec4 row_low = mix(dvec4(texelFetch(map, ivec3(low, layer), level)), dvec4(texelFetch(map, ivec3(high.x, low.y, layer), level)), f.x);
  dvec4 row_high = mix(dvec4(texelFetch(map, ivec3(low.x, high.y, layer), level)), dvec4(texelFetch(map, ivec3(high, layer), level)), f.x);
  return mix(row_low, row_high, f.y);
}

// Trilinear, clamped to the edge; place: uv and layer.
dvec4 SampleLayer(sampler2DArray map, dvec3 place, double level) {
  double most = double(textureQueryLevels(map) - 1);
  double held = clamp(level, 0.0lf, most);
  int low = int(held);
  int high = min(low + 1, int(most));
  return mix(SampleLayerOnce(map, place, low), SampleLayerOnce(map, place, high), held - double(low));
}
#endif

void WriteRadiance(dvec3 diffuse, dvec3 specular) {
  out_diffuse = vec4(vec3(diffuse), 1.0);
  out_specular = vec4(vec3(specular), 1.0);
}
