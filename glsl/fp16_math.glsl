#pragma once
// What half floats make of a result and of the built-in functions: glsl/fp16_rewrite.h turns a + b into fp16(a + b) and dot(a, b)
// into fp16_dot(a, b). Every operation is rounded once, no product keeps its digits for a sum; quotients, roots and the
// transcendental functions of one operation are the nearest half float, which no hardware betters. This file is not rewritten.

// The nearest half float, ties to even: 13 bits of a float's fraction go. From 65520 on infinity; below 2^-14 it is 0, see glsl/fp16_rewrite.h.
float fp16(float x) {
  uint bits = floatBitsToUint(x);
  uint size = bits & 0x7fffffffu;
  uint near = (size + 0xfffu + ((size >> 13) & 1u)) & 0xffffe000u;
  near = near < 0x38800000u ? 0u : (near >= 0x47800000u ? 0x7f800000u : near);
  return size > 0x7f800000u ? x : uintBitsToFloat(near | (bits & 0x80000000u));  // what is no number stays so
}
vec2 fp16(vec2 v) { return vec2(fp16(v.x), fp16(v.y)); }
vec3 fp16(vec3 v) { return vec3(fp16(v.x), fp16(v.y), fp16(v.z)); }
vec4 fp16(vec4 v) { return vec4(fp16(v.x), fp16(v.y), fp16(v.z), fp16(v.w)); }
int fp16(int i) { return i; }
uint fp16(uint i) { return i; }
ivec2 fp16(ivec2 i) { return i; }
ivec3 fp16(ivec3 i) { return i; }
uvec2 fp16(uvec2 i) { return i; }
uvec3 fp16(uvec3 i) { return i; }
uvec4 fp16(uvec4 i) { return i; }

float fp16_dot(vec2 a, vec2 b) {
  vec2 p = fp16(a * b);
  return fp16(p.x + p.y);
}
float fp16_dot(vec3 a, vec3 b) {
  vec3 p = fp16(a * b);
  return fp16(fp16(p.x + p.y) + p.z);
}
float fp16_dot(vec4 a, vec4 b) {
  vec4 p = fp16(a * b);
  return fp16(fp16(fp16(p.x + p.y) + p.z) + p.w);
}
vec3 fp16_cross(vec3 a, vec3 b) { return fp16(fp16(a.yzx * b.zxy) - fp16(a.zxy * b.yzx)); }

// By their definitions (GLSL 4.50, section 8), as drivers compile them.
#define FP16_OF_SIZE(type)                                                                                            \
  float fp16_length(type v) { return fp16(sqrt(fp16_dot(v, v))); }                                                    \
  float fp16_distance(type a, type b) { return fp16_length(fp16(a - b)); }                                            \
  type fp16_normalize(type v) { return fp16(v * fp16(inversesqrt(fp16_dot(v, v)))); }                                 \
  type fp16_reflect(type i, type n) { return fp16(i - fp16(n * fp16(2.0 * fp16_dot(n, i)))); }                        \
  type fp16_refract(type i, type n, float eta) {                                                                      \
    float cosine = fp16_dot(n, i);                                                                                    \
    float k = fp16(1.0 - fp16(fp16(eta * eta) * fp16(1.0 - fp16(cosine * cosine))));                                  \
    return k < 0.0 ? type(0.0) : fp16(fp16(eta * i) - fp16(n * fp16(fp16(eta * cosine) + fp16(sqrt(k)))));            \
  }
FP16_OF_SIZE(vec2)
FP16_OF_SIZE(vec3)

#define FP16_COMPONENTS(type, condition)                                                                              \
  type fp16_mix(type a, type b, type t) { return fp16(fp16(a * fp16(1.0 - t)) + fp16(b * t)); }                       \
  type fp16_mix(type a, type b, condition second) { return mix(a, b, second); }                                       \
  type fp16_smoothstep(type low, type high, type x) {                                                                 \
    type t = clamp(fp16(fp16(x - low) / fp16(high - low)), type(0.0), type(1.0));                                     \
    return fp16(fp16(t * t) * fp16(3.0 - fp16(2.0 * t)));                                                             \
  }                                                                                                                   \
  type fp16_exp(type x) { return fp16(exp2(fp16(x * 1.4423828125))); }                                                \
  type fp16_log(type x) { return fp16(fp16(log2(x)) * 0.693359375); }                                                 \
  type fp16_pow(type x, type y) { return fp16(exp2(fp16(y * fp16(log2(x))))); }                                       \
  type fp16_mod(type x, type y) { return fp16(x - fp16(y * floor(fp16(x / y)))); }
FP16_COMPONENTS(float, bool)
FP16_COMPONENTS(vec2, bvec2)
FP16_COMPONENTS(vec3, bvec3)
FP16_COMPONENTS(vec4, bvec4)
vec2 fp16_mix(vec2 a, vec2 b, float t) { return fp16_mix(a, b, vec2(t)); }
vec3 fp16_mix(vec3 a, vec3 b, float t) { return fp16_mix(a, b, vec3(t)); }
vec4 fp16_mix(vec4 a, vec4 b, float t) { return fp16_mix(a, b, vec4(t)); }
