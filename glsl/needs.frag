// What the pixels of a tile need together: a fragment is a tile.
#include "needs.glsl"

const float kFar = 1e30;

void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * TILE_SIZE;
  ivec2 last = textureSize(gbuffer_position, 0) - 1;
  vec3 low = vec3(kFar), high = vec3(-kFar), normal_low = vec3(kFar), normal_high = vec3(-kFar);
#if EFFECT_DIFFUSE || EFFECT_SPECULAR
  int lobes = 0;
#else
  int lobes = NEEDS_DIFFUSE | NEEDS_SPECULAR;
#endif
  for (int y = 0; y < TILE_SIZE; ++y) {
    for (int x = 0; x < TILE_SIZE; ++x) {
      ivec2 pixel = min(first + ivec2(x, y), last);
      vec4 position = FetchPosition(pixel);
      vec3 normal = FetchNormal(pixel).xyz;
      if (position.w == 1.0) {
        low = min(low, position.xyz);
        high = max(high, position.xyz);
        normal_low = min(normal_low, normal);
        normal_high = max(normal_high, normal);
#if EFFECT_DIFFUSE || EFFECT_SPECULAR
        vec4 base_color = FetchBaseColor(pixel);
        if (base_color.w != 1.0 && base_color.rgb != vec3(0.0)) lobes |= NEEDS_DIFFUSE;
        if (base_color.w != -1.0) lobes |= NEEDS_SPECULAR;
#endif
      }
    }
  }
  int needs = 0;
  if (low.x <= high.x) {
    needs = BoundsNeeds(Bounds(0.5 * (low + high), 0.5 * (normal_low + normal_high), 0.5 * (high - low), 0.5 * (normal_high - normal_low)));
  }
  out_diffuse = vec4(needs == 0 ? 0.0 : float(needs | lobes));
}
