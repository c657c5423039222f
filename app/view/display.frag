// From linear radiance to a display's codes: exposure, view transform, encoding, once. Or from two pictures to a map of
// their difference. The host puts #version before this and defines
//   KIND       0 picture_a, 1 signed difference, 2 its magnitude, 3 false colour of picture_a's luminance
//   TRANSFORM  0 sRGB, 1 ACES fitted, 2 Khronos PBR Neutral, 3 AgX, 4 a view of an OpenColorIO configuration
//   VIEW_TABLE_LOW, VIEW_TABLE_HIGH  log2 of the radiance at the first and the last node of that view's table
//   EXACT      1 where the pictures are as large as the area, else they are magnified

layout(binding = 0) uniform sampler2D picture_a;  // rgb: radiance; a: 1 where an emitter or nothing is seen, not shaded
layout(binding = 1) uniform sampler2D picture_b;
layout(binding = 2) uniform sampler2D color_scale;  // sRGB codes of a map, from its low end to its high one

layout(binding = 3) uniform sampler3D view_table;  // display codes of an OpenColorIO view

uniform vec4 area;      // px: left, bottom, width, height in the window
uniform float gain;     // 2^EV
uniform float range;    // relative difference at the map's end
uniform int logarithmic;
uniform float floor_luminance;  // what stands in for a darker reference

out vec4 code;

const vec3 kLuminance = vec3(0.2126, 0.7152, 0.0722);  // [ITU-R BT.709-6]

vec4 Fetch(sampler2D picture, vec2 at) {  // at: px from the top left
#if EXACT
  return texelFetch(picture, ivec2(at), 0);
#else
  return texture(picture, at / area.zw);
#endif
}

vec3 EncodeSrgb(vec3 v) {
  v = clamp(v, 0.0, 1.0);
  return mix(12.92 * v, 1.055 * pow(v, vec3(1.0 / 2.4)) - 0.055, greaterThan(v, vec3(0.0031308)));
}

// The ACES reference rendering and sRGB output transforms, fitted [Hill 2016, BakingLab].
vec3 Aces(vec3 v) {
  v = vec3(dot(vec3(0.59719, 0.35458, 0.04823), v), dot(vec3(0.07600, 0.90834, 0.01566), v),
           dot(vec3(0.02840, 0.13383, 0.83777), v));
  v = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
  return vec3(dot(vec3(1.60475, -0.53108, -0.07367), v), dot(vec3(-0.10208, 1.10813, -0.00605), v),
              dot(vec3(-0.00327, -0.07276, 1.07602), v));
}

// [Khronos PBR Neutral Tone Mapper, specification 1.0]
vec3 PbrNeutral(vec3 v) {
  const float kStart = 0.8 - 0.04;
  const float kDesaturation = 0.15;
  float least = min(v.r, min(v.g, v.b));
  v -= least < 0.08 ? least - 6.25 * least * least : 0.04;
  float peak = max(v.r, max(v.g, v.b));
  if (peak < kStart) return v;
  float room = 1.0 - kStart;
  float new_peak = 1.0 - room * room / (peak + room - kStart);
  v *= new_peak / peak;
  return mix(v, vec3(new_peak), 1.0 - 1.0 / (kDesaturation * (peak - new_peak) + 1.0));
}

// Sobotka's AgX base look, its curve as a polynomial [Wrensch 2023]; what it returns is encoded already.
vec3 AgX(vec3 v) {
  const mat3 kInset = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051, 0.0784335999999992,
                           0.878468636469772, 0.0784336, 0.0792237451477643, 0.0791661274605434, 0.879142973793104);
  const mat3 kOutset =
      mat3(1.19687900512017, -0.0528968517574562, -0.0529716355144438, -0.0980208811401368, 1.15190312990417,
           -0.0980434501171241, -0.0990297440797205, -0.0989611768448433, 1.15107367264116);
  const float kMinEv = -12.47393;
  const float kMaxEv = 4.026069;
  v = clamp(log2(max(kInset * v, 1e-10)), kMinEv, kMaxEv);
  v = (v - kMinEv) / (kMaxEv - kMinEv);
  vec3 v2 = v * v;
  vec3 v4 = v2 * v2;
  v = 15.5 * v4 * v2 - 40.14 * v4 * v + 31.96 * v4 - 6.868 * v2 * v + 0.4298 * v2 + 0.1191 * v - 0.00232;
  return clamp(kOutset * v, 0.0, 1.0);
}

vec3 Displayed(vec3 radiance) {
  if (any(isnan(radiance)) || any(isinf(radiance))) return vec3(1.0, 0.0, 1.0);
  vec3 v = radiance * gain;
#if TRANSFORM == 1
  return EncodeSrgb(Aces(v));
#elif TRANSFORM == 2
  return EncodeSrgb(PbrNeutral(v));
#elif TRANSFORM == 3
  return AgX(v);
#elif TRANSFORM == 4
  float nodes = float(textureSize(view_table, 0).x);
  v = (log2(max(v, exp2(VIEW_TABLE_LOW))) - VIEW_TABLE_LOW) / (VIEW_TABLE_HIGH - VIEW_TABLE_LOW);
  return texture(view_table, (min(v, 1.0) * (nodes - 1.0) + 0.5) / nodes).rgb;
#else
  return EncodeSrgb(v);
#endif
}

vec3 Scale(float t) {  // t in [0, 1]
  float steps = float(textureSize(color_scale, 0).x - 1);
  return texelFetch(color_scale, ivec2(int(t * steps + 0.5), 0), 0).rgb;
}

// As in the report: (a − b) / b, of luminance where signed, else the greatest channel's; b at least the floor.
vec3 Difference(vec4 a, vec4 b) {
  if (any(isnan(a)) || any(isinf(a)) || any(isnan(b)) || any(isinf(b))) return vec3(1.0, 0.0, 1.0);
  if (a.a == 1.0 || (a.rgb == vec3(0.0) && b.rgb == vec3(0.0))) return vec3(84.0, 88.0, 95.0) / 255.0;
  float reference = dot(b.rgb, kLuminance);
  vec3 gap = abs(a.rgb - b.rgb);
  float d = KIND == 1 ? dot(a.rgb, kLuminance) - reference : max(gap.r, max(gap.g, gap.b));
  float u = abs(d) / max(max(reference, floor_luminance), 1e-30) / range;
  float t = logarithmic != 0 ? clamp((log2(max(u, 1e-30)) / 3.32192809488736 + 2.0) / 2.0, 0.0, 1.0) : min(u, 1.0);
  return Scale(KIND == 2 ? t : 0.5 + (d < 0.0 ? -0.5 : 0.5) * t);
}

void main() {
  vec2 at = gl_FragCoord.xy - area.xy;
  at.y = area.w - at.y;
  vec4 a = Fetch(picture_a, at);
#if KIND == 0
  code = vec4(Displayed(a.rgb), 1.0);
#elif KIND == 3
  float stops = log2(max(dot(a.rgb, kLuminance) * gain, 1e-30) / 0.18);  // from −8 to +4 about middle grey
  code = vec4(Scale(clamp((stops + 8.0) / 12.0, 0.0, 1.0)), 1.0);
#else
  code = vec4(Difference(a, Fetch(picture_b, at)), 1.0);
#endif
}
