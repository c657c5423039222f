// A pass that branches: its pixel's own needs say whether it is shaded by the lighting pass of a variant or by the same without horizons;
// both stand above this text, see glsl/per_pixel.h.
#include "needs.glsl"

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 position = FetchPosition(pixel);
  int needs = position.w == 1.0 ? BoundsNeeds(Bounds(position.xyz, FetchNormal(pixel).xyz, vec3(0.0), vec3(0.0))) : 0;
  if ((needs & (NEEDS_HORIZON | NEEDS_PROXY_HORIZON)) != 0) {
    ShadeWithHorizon();
  } else {
    ShadeWithoutHorizon();
  }
}
