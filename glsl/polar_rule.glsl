#pragma once
// Noise-free specular integral over a light, in the plane of half-vector slopes. Dual: C++ too (glsl/dual_begin.h).
//
// Frame: the normal is z, the viewer v = (sin_v, 0, cos_v). A light direction l has the half-vector slope
// s = (l + v)_xy / (l + v)_z, which is 0 at the mirror direction. There GGX is round, P22(s) = α² / (π (α² + |s|²)²), and
// the hemisphere above the horizon is a disk: |s − v_xy/v_z| ≤ 1/v_z. With dω_l = 4 (v·h) dω_h,
//   ∫ D G2 / (4 cosθ_v) dω_l = ∫ P22(s) · 4 (sin_v s_x + cos_v) · V(n·v, n·l) n·l d²s,  V = G2 / (4 n·l n·v).
//
// The region is its outline: with rays from a center c, Σ over arcs ∫ dφ/dt ∫ from c to s(t) … r dr dt. c is 0 where the
// mirror direction is inside, else the outline's nearest point to 0; all rays stay in the disk, since it is convex, so the
// signed sum is right for every outline. Seen from c everything happens at the scale b² = α² + |c|² or coarser:
// - along a ray the nodes are Gauss points in ζ with (1 + (r/b)²)⁻¹ = cos⁸ζ, dense up to b and nearly even in log r beyond;
// - along an arc t = t_c + w sinh u about the point nearest to c, w the reach of √(b² + distance²) there;
// - shadowing makes one thin layer, n·l of the order of α: rays and arcs that end at the horizon get a second panel
//   that crowds towards that end.
#include "brdf.glsl"

// A layer or a tip gets a panel of its own where it is thinner than 1/kThinLayer of the way. At 6 instead of 4 ordinary
// lights near the horizon exceed the truth's tolerance twice as often; at 3 little more is gained.
const float kThinLayer = 4.0;

struct LobeView {
  float sin_v;  // ≥ 0
  float cos_v;  // > 0
  float alpha;
  float roughness;  // of a diffuse lobe, whose alpha is 1; else below 0, or nobody asks
};

// An arc of the outline: l(ψ) = axis_1 sin_1 cosψ + axis_2 sin_2 sinψ + axis_3 √((cos_1 cosψ)² + (cos_2 sinψ)²), unit, with
// t = tan(ψ/2) from t0 to t1 within [−1, 1]; sin_i² + cos_i² = 1. A great circle has cos_1 = cos_2 = 0, a circle both
// equal, the outline of a disk both different, and axis_1 is then its long half axis (cos_1 ≤ cos_2).
struct Arc {
  vec3 axis_1;
  vec3 axis_2;
  vec3 axis_3;
  float sin_1;
  float sin_2;
  float cos_1;
  float cos_2;
  float t0;
  float t1;
};

// Slope s and ds/dt at t.
void ArcSlope(Arc arc, LobeView view, float t, OUT(vec2) slope, OUT(vec2) derivative) {
  float c = 1.0 - t * t;  // (1 + t²) cosψ
  float d = 2.0 * t;      // (1 + t²) sinψ
  float g = 1.0 + t * t;
  float x1 = arc.cos_1 * c;
  float x2 = arc.cos_2 * d;
  float x3 = sqrt(x1 * x1 + x2 * x2);
  float dx3 = 2.0 * (arc.cos_2 * x2 - arc.cos_1 * x1 * t) / max(x3, 1e-30);  // 0 / 1e-30 on a great circle
  vec3 q = arc.axis_1 * (arc.sin_1 * c) + arc.axis_2 * (arc.sin_2 * d) + arc.axis_3 * x3;
  vec3 dq = arc.axis_1 * (arc.sin_1 * -d) + arc.axis_2 * (arc.sin_2 * 2.0) + arc.axis_3 * dx3;
  q.x += g * view.sin_v;
  q.z += g * view.cos_v;
  dq.x += d * view.sin_v;
  dq.z += d * view.cos_v;
  float inv = 1.0 / q.z;
  slope = vec2(q.x * inv, q.y * inv);
  derivative = vec2((dq.x - slope.x * dq.z) * inv, (dq.y - slope.y * dq.z) * inv);
}

// Height l_z and d(l_z)/dt at t.
void ArcHeight(Arc arc, float t, OUT(float) height, OUT(float) rise) {
  float c = 1.0 - t * t;
  float d = 2.0 * t;
  float inv = 1.0 / (1.0 + t * t);
  float x1 = arc.cos_1 * c;
  float x2 = arc.cos_2 * d;
  float x3 = sqrt(x1 * x1 + x2 * x2);
  float dx3 = 2.0 * (arc.cos_2 * x2 - arc.cos_1 * x1 * t) / max(x3, 1e-30);
  height = (arc.axis_1.z * (arc.sin_1 * c) + arc.axis_2.z * (arc.sin_2 * d) + arc.axis_3.z * x3) * inv;
  rise = (arc.axis_1.z * (arc.sin_1 * -d) + arc.axis_2.z * (arc.sin_2 * 2.0) + arc.axis_3.z * dx3 - d * height) * inv;
}

// The n·l over which shadowing changes at the horizon: V has a branch point at about ± i α and a pole at about −n·v.
float LayerHeight(LobeView view) { return min(view.alpha, view.cos_v); }

// Where the ray of unit direction e ends at slope s: the length over which shadowing changes there, large where n·l does
// not fall towards the end.
float LayerLength(LobeView view, vec2 slope, vec2 e) {
  float inv = 1.0 / (1.0 + dot(slope, slope));
  float v = 2.0 * (view.sin_v * slope.x + view.cos_v) * inv;  // n·l + n·v
  float fall = 2.0 * inv * (v * dot(slope, e) - view.sin_v * e.x);
  return (max(v - view.cos_v, 0.0) + LayerHeight(view)) / max(fall, 1e-9);
}

// The map of the rays: p(y) with (1 + p²)⁻¹ = cos⁸ζ and y = tan(ζ/2) in [0, 1), and dp/dy.
void RayMap(float y, OUT(float) p, OUT(float) derivative) {
  float y2 = y * y;
  float c = 1.0 - y2;
  float g = 1.0 + y2;
  float c2 = c * c;
  float g2 = g * g;
  float q = sqrt((g2 + c2) * (g2 * g2 + c2 * c2));
  float inv = 1.0 / (c * q);
  float inv_c4 = 1.0 / (c2 * c2);
  p = 2.0 * y * q * inv_c4;
  derivative = 8.0 * g2 * g2 * g2 * g * inv * inv_c4;
}

// The y where p(y) = x ≥ 0; exact for small x too: with s = 1/cosζ, x² = s⁸ − 1 and y² = (s − 1)/(s + 1).
float RayMapInverse(float x) {
  float s4 = sqrt(1.0 + x * x);
  float s2 = sqrt(s4);
  float s = sqrt(s2);
  return x / ((1.0 + s) * sqrt((1.0 + s2) * (1.0 + s4)));
}

// Cosine n·l of the light direction whose half vector has the slope s.
float CosineFromSlope(LobeView view, float slope_x, float slope2) {
  return 2.0 * (view.sin_v * slope_x + view.cos_v) / (1.0 + slope2) - view.cos_v;
}

// The light direction whose half vector has the slope s.
struct SlopeLight {
  float n_dot_l;
  float v_dot_h;
  float stretch;  // (v·h) √(1 + |s|²)
};

SlopeLight LightAtSlope(LobeView view, float slope_x, float slope2) {
  SlopeLight light;
  float inv = 1.0 / (1.0 + slope2);
  light.stretch = view.sin_v * slope_x + view.cos_v;
  light.n_dot_l = max(2.0 * light.stretch * inv - view.cos_v, 0.0);
  light.v_dot_h = light.stretch * sqrt(inv);
  return light;
}

// What multiplies P22 of GGX: with Fresnel 1, and with Schlick's weight. brdf_over_ggx: the scene's BRDF there, see brdf.glsl.
vec2 LobeWeights(SlopeLight light, float brdf_over_ggx) {
  float lobe = 4.0 * light.stretch * brdf_over_ggx * light.n_dot_l;
  return vec2(lobe, lobe * SchlickWeight(light.v_dot_h));
}
