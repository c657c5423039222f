#pragma once
// Linearly transformed cosines [Heitz et al. 2016]: the frame and the transform. Dual.
//
// A lobe of the BRDF × cosine is R · (the clamped cosine transformed by M); its integral over a polygon is R times the
// form factor of the polygon transformed by M⁻¹. M⁻¹ = [p 0 q; 0 1 0; r 0 s] (rows), held as vec4(p, r, q, s), the tables' order.
#include "polygon.glsl"

struct ShadingFrame {
  vec3 tangent;    // unit, on the viewer's side
  vec3 bitangent;  // unit
  vec3 normal;     // unit
  float n_dot_v;   // at least kMinViewCosine
  float sine;      // of the view angle, from the tangent's own length: near the normal n·v has no digits left of it
};

// cos 89.95°: the last row of the published tables.
const float kMinViewCosine = 8e-4;

// to_view: unit, above the surface.
ShadingFrame MakeShadingFrame(vec3 normal, vec3 to_view) {
  ShadingFrame frame;
  float cosine = dot(normal, to_view);
  vec3 tangent = to_view - normal * cosine;
  float length2 = dot(tangent, tangent);
  frame.sine = min(sqrt(length2), 1.0);
  // Within 1e-4 rad of the normal the difference is rounding, and lobes are round: any tangent serves.
  if (length2 < 1e-8) {
    tangent = abs(normal.x) < 0.5 ? vec3(0.0, -normal.z, normal.y) : vec3(normal.z, 0.0, -normal.x);
    length2 = dot(tangent, tangent);
  }
  frame.tangent = tangent * inversesqrt(length2);
  frame.bitangent = cross(normal, frame.tangent);
  frame.normal = normal;
  frame.n_dot_v = clamp(cosine, kMinViewCosine, 1.0);
  return frame;
}

// Texture coordinates in a table of 64 × 64 nodes whose node i stands for i/63.
vec2 TableCoordinates(float x, float y) { return vec2(x * (63.0 / 64.0) + 0.5 / 64.0, y * (63.0 / 64.0) + 0.5 / 64.0); }

// √(1 − c), from the sine: 1 − c = s²/(1 + c).
float RootOfVersine(float n_dot_v, float sine) { return sine * inversesqrt(1.0 + n_dot_v); }

// M⁻¹ v.
vec3 LtcTransform(vec4 m, vec3 v) { return vec3(m.x * v.x + m.z * v.z, v.y, m.y * v.x + m.w * v.z); }

// M v, but for a positive factor, by the adjugate of M⁻¹.
vec3 LtcUndo(vec4 m, vec3 v) { return vec3(m.w * v.x - m.z * v.z, (m.x * m.w - m.y * m.z) * v.y, m.x * v.z - m.y * v.x); }
