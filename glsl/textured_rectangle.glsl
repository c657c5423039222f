#pragma once
// A textured rectangle's integrals without noise, by squares that are divided until the BRDF, the cosine and the solid angle change little
// over each; the texture enters by its weights in the rule of each square (glsl/light_textures.h). After a "brdf".
#include "light_texture.glsl"
#include "brdf.glsl"
#include "directions.glsl"

#if EFFECT_TEXTURED
#if LEVEL_DENSE
const float kEven = 0.06;   // squared change from a square's middle to its corners, relative to the kernel's own scale
const int kAtHorizon = 6;   // levels down to which what the horizon cuts is divided
#else
const float kEven = 0.15;
const int kAtHorizon = 5;
#endif
const int kDeepest = 15;        // a mirror of α = 1e-4 before a wide light
const int kMostSteps = 20000;

// Of the half vector between the direction to `place` and the viewer.
vec2 HalfSlope(vec3 place, vec3 view) {
  vec3 h = place * inversesqrt(dot(place, place)) + view;
  return vec2(h.x, h.y) / max(h.z, 1e-3);
}

// Whether over the square middle ± a ± b distance and slope change little.
bool IsEven(vec3 middle, vec3 a, vec3 b, vec3 view, float alpha) {
  if (dot(a, a) + dot(b, b) > kEven * dot(middle, middle)) return false;
  vec2 slope = HalfSlope(middle, view);
  float most = kEven * (alpha * alpha + dot(slope, slope));
  for (int i = 0; i < 4; ++i) {
    vec3 corner = middle + ((i & 1) == 0 ? a : -a) + ((i & 2) == 0 ? b : -b);
    vec2 change = HalfSlope(corner, view) - slope;
    if (corner.z > 0.0 && dot(change, change) > most) return false;
  }
  return true;
}

// Both lobes for unit radiance; the light faces the point.
Radiance TexturedRectangle(Surface surface, Light light, vec3 to_view) {
  Radiance result;
  result.diffuse = vec3(0.0);
  result.specular = vec3(0.0);
  float cos_v = clamp(dot(surface.normal, to_view), 1e-4, 1.0);
  vec3 across = to_view - surface.normal * dot(surface.normal, to_view);
  float across2 = dot(across, across);
  vec3 x_axis = AnyPerpendicular(surface.normal);
  if (across2 > 1e-10) x_axis = across * inversesqrt(across2);
  vec3 y_axis = cross(surface.normal, x_axis);
  vec3 view = vec3(sqrt(across2), 0.0, cos_v);
  vec3 to_center = light.center - surface.position;
  vec3 along_u = 2.0 * vec3(dot(x_axis, light.half_axis_x), dot(y_axis, light.half_axis_x), dot(surface.normal, light.half_axis_x));
  vec3 along_v = -2.0 * vec3(dot(x_axis, light.half_axis_y), dot(y_axis, light.half_axis_y), dot(surface.normal, light.half_axis_y));
  vec3 corner = vec3(dot(x_axis, to_center), dot(y_axis, to_center), dot(surface.normal, to_center)) - 0.5 * (along_u + along_v);
  float height = -dot(light.normal, to_center);
  int layer = int(light.image.x);
  int stored = 1;  // levels, with 3 × 3 nodes in the last
  while ((textureSize(light_weights, 0).x / 3) >> stored > 0) ++stored;

  int level = 0;
  int x = 0;
  int y = 0;
  for (int step = 0; step < kMostSteps; ++step) {
    float side = exp2(-float(level));
    vec3 a = along_u * (0.5 * side);
    vec3 b = along_v * (0.5 * side);
    vec3 middle = corner + along_u * ((float(x) + 0.5) * side) + along_v * ((float(y) + 0.5) * side);
    float reach = abs(a.z) + abs(b.z);
    bool above = middle.z + reach > 0.0;
    bool cut = abs(middle.z) < reach;
    if (above && level < kDeepest && ((cut && level < kAtHorizon) || !IsEven(middle, a, b, view, surface.alpha))) {
      level += 1;
      x *= 2;
      y *= 2;
      continue;
    }
    if (above) {
      for (int k = 0; k < 9; ++k) {
        int i = k % 3;
        int j = k / 3;
        // Gauss's three points: 0 and ±√(3/5) from the middle, weights 8 : 5.
        float s = float(i - 1) * 0.7745966692;
        float t = float(j - 1) * 0.7745966692;
        vec3 place = middle + a * s + b * t;
        if (place.z <= 0.0) continue;
        vec3 weight;
        if (level < stored) {
          weight = FetchLayer(light_weights, ivec3(3 * x + i, 3 * y + j, layer), stored - 1 - level);
        } else {
          vec2 uv = vec2(float(x) + 0.5 + 0.5 * s, float(y) + 0.5 + 0.5 * t) * side;
          weight = ExactTexel(light, uv) * ((i == 1 ? 4.0 : 2.5) * (j == 1 ? 4.0 : 2.5) / 81.0);
        }
        float inverse = inversesqrt(dot(place, place));
        float cos_l = place.z * inverse;
        weight *= light.area * side * side * height * inverse * inverse * inverse;
        result.diffuse += weight * (cos_l / kPi);
        vec3 sum = place * inverse + view;
        float across_h = sum.x * sum.x + sum.y * sum.y;
        float tan2 = across_h / (sum.z * sum.z);
        float length2 = across_h + sum.z * sum.z;
        float v_dot_h = 0.5 * sqrt(length2);
        // D(h) = α²/(π cos⁴ (α² + tan²)²).
        float inverse_cos2 = length2 / (sum.z * sum.z);
        float root = surface.alpha * inverse_cos2 / (surface.alpha * surface.alpha + tan2);
        float density = root * root / kPi;
        float lobe = density * cos_l * BrdfOverGgx(cos_v, cos_l, v_dot_h, tan2, surface.alpha);
#if EFFECT_FRESNEL
        float grazing = SchlickWeight(v_dot_h);
        result.specular += weight * lobe * (surface.f0 * (1.0 - grazing) + grazing);
#else
        result.specular += weight * lobe * surface.f0;
#endif
      }
    }
    // The next square: a quarter's neighbour, or that of the square that it ends.
    while (level > 0 && (x & 1) == 1 && (y & 1) == 1) {
      x >>= 1;
      y >>= 1;
      level -= 1;
    }
    if (level == 0) break;
    if ((x & 1) == 0) {
      x += 1;
    } else {
      x -= 1;
      y += 1;
    }
  }
  result.diffuse *= surface.diffuse_albedo;
  return result;
}
#endif
