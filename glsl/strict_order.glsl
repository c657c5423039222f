#pragma once
// min, max and clamp that pass a NaN on. GLSL leaves open what they make of one (4.50, section 8.3), and many drivers swallow it: a
// technique that is finite only there is black, or worse, elsewhere.

int StrictMin(int a, int b) { return a < b ? a : b; }
int StrictMax(int a, int b) { return a > b ? a : b; }
float StrictMin(float a, float b) { return isnan(a) || isnan(b) ? a + b : (a < b ? a : b); }
float StrictMax(float a, float b) { return isnan(a) || isnan(b) ? a + b : (a > b ? a : b); }
vec2 StrictMin(vec2 a, vec2 b) { return vec2(StrictMin(a.x, b.x), StrictMin(a.y, b.y)); }
vec2 StrictMax(vec2 a, vec2 b) { return vec2(StrictMax(a.x, b.x), StrictMax(a.y, b.y)); }
vec3 StrictMin(vec3 a, vec3 b) { return vec3(StrictMin(a.xy, b.xy), StrictMin(a.z, b.z)); }
vec3 StrictMax(vec3 a, vec3 b) { return vec3(StrictMax(a.xy, b.xy), StrictMax(a.z, b.z)); }
vec4 StrictMin(vec4 a, vec4 b) { return vec4(StrictMin(a.xyz, b.xyz), StrictMin(a.w, b.w)); }
vec4 StrictMax(vec4 a, vec4 b) { return vec4(StrictMax(a.xyz, b.xyz), StrictMax(a.w, b.w)); }
vec3 StrictMin(vec3 a, float b) { return StrictMin(a, vec3(b)); }
vec3 StrictMax(vec3 a, float b) { return StrictMax(a, vec3(b)); }
int StrictClamp(int x, int low, int high) { return StrictMin(StrictMax(x, low), high); }
float StrictClamp(float x, float low, float high) { return StrictMin(StrictMax(x, low), high); }
vec2 StrictClamp(vec2 x, vec2 low, vec2 high) { return StrictMin(StrictMax(x, low), high); }
vec3 StrictClamp(vec3 x, vec3 low, vec3 high) { return StrictMin(StrictMax(x, low), high); }
vec3 StrictClamp(vec3 x, float low, float high) { return StrictMin(StrictMax(x, vec3(low)), vec3(high)); }

#define min StrictMin
#define max StrictMax
#define clamp StrictClamp
