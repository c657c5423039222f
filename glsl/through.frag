// Reads the G-buffer and writes it through: what every lighting pass pays beside shading, taken off in compare/timing.cpp.
#include "platform"

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  WriteRadiance(FetchPosition(pixel).xyz + FetchBaseColor(pixel).xyz, FetchNormal(pixel).xyz);
}
