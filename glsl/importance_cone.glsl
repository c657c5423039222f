#pragma once
// The cone of directions about the mirror direction that matter for a lobe [Drobot 2014, §1.3.4], and its footprint on a
// light. Dual: also compiles as C++. A cone is held by its versine (spherical_cap.glsl).
//
// The scene's BRDF says how wide it is in a file glsl/importance_cone/NAME.glsl, `#include "importance_cone"`:
//   float ThresholdConeVersine(float alpha)  where the lobe falls to 1/e of its peak, along the plane of incidence
//   float WholeConeVersine(float alpha)      as wide as conserves the lobe's energy, at normal incidence
//   float ConeAcross(float n_dot_v)          width across the plane of incidence over that along it
// With half vectors at θ_h from the normal the light's direction turns twice as far, and the versine of 2θ_h is 2 sin²θ_h.
#include "specular_lobe.glsl"
#include "spherical_cap.glsl"

#if !AREALAB_DUAL  // C++ includes one of glsl/importance_cone/ before this file
#include "importance_cone"
#endif

// Ours: the versine that conserves energy at every view angle: a round cone as large as the lobe is.
float EnergyConeVersine(float alpha, float n_dot_v) { return min(WholeConeVersine(alpha) * ConeAcross(n_dot_v), 2.0); }

// The cone's trace on the light's plane, taken as a disk [Drobot 2014, §1.3.4].
struct Footprint {
  vec2 center;   // m, in the light's plane
  vec2 offset;   // m, of the center from the foot of the point's perpendicular: its digits are lost in the center's
  float radius;  // m; 0 where the cone misses the plane
};

// The axis' cosine to the light's plane is held above this: a hit then stays within 100 heights, far outside every light
// that a footprint could resolve there.
const float kMinConeCosine = 0.01;

// `point` and the unit `mirror` direction in the light's frame (centre at the origin, z along the lit normal, m; point.z > 0).
// The radius is distance · tan(half angle), Drobot's, or with keep_solid_angle that of the disk which subtends the
// cone's own solid angle, ours. He is silent where the axis runs away from the plane. Ours: the axis is tilted up to the
// plane and the half angle loses what was tilted, so the footprint is continuous and gone where the whole cone misses.
Footprint ConeFootprint(vec3 point, vec3 mirror, float cone_versine, bool keep_solid_angle) {
  float cosine = max(-mirror.z, kMinConeCosine);
  float along = sqrt(mirror.x * mirror.x + mirror.y * mirror.y);
  float reach = point.z / cosine;
  float tilt = mirror.z > 0.0 ? Arctangent(mirror.z, along) : 0.0;
  float half_angle = max(AngleFromVersine(cone_versine) - tilt, 0.0);
  Footprint footprint;
  footprint.offset = vec2(mirror.x, mirror.y) * reach;
  footprint.center = vec2(point.x, point.y) + footprint.offset;
  if (keep_solid_angle) {
    float sine = sin(0.5 * half_angle);
    footprint.radius = reach * sine * 2.0 * inversesqrt(cosine);  // π radius² cosine / reach² = 4π sin²(half angle / 2)
  } else {
    footprint.radius = reach * tan(min(half_angle, 1.56));  // 89.4°: a wider cone covers the half space
  }
  return footprint;
}

// The part of a light that a footprint covers.
struct LitPart {
  vec2 shift;  // m, of its center from the footprint's; the center is on the light where the area is not 0
  float area;   // m²
};

// [Drobot 2014, eqs. 1.21 and 1.22]
LitPart FootprintOnDisk(Footprint footprint, float radius) {
  float center_distance = length(footprint.center);
  float smaller = min(footprint.radius, radius);
  LitPart part;
  part.shift = footprint.center * (OverlapCenter(radius, footprint.radius, center_distance) - 1.0);
  part.area = kPi * smaller * smaller * SmoothstepOverlap(radius, footprint.radius, center_distance);
  return part;
}

// [Drobot 2014, eq. 1.23, with the signs of its extent corrected]: the footprint as the square of equal area.
LitPart FootprintOnRectangle(Footprint footprint, vec2 half_size) {
  float half_side = footprint.radius * (0.5 * sqrt(kPi));
  // Widths and shifts from the half sides, not from the ends' places: of a small footprint on a large light, or the reverse, those
  // have no digits left.
  vec2 away = abs(footprint.center);
  vec2 inside = half_size - away;  // by itself: of a center on the edge it is exactly 0
  vec2 width = clamp(inside + vec2(half_side), vec2(0.0), 2.0 * min(vec2(half_side), half_size));
  LitPart part;
  part.shift = -sign(footprint.center) * clamp(0.5 * (vec2(half_side) - inside), max(-inside, vec2(0.0)), away);
  part.area = width.x * width.y;
  return part;
}
