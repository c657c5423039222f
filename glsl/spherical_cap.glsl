#pragma once
// Caps of the unit sphere, what two of them share, and a sphere light seen as one. Dual: also compiles as C++.
// A cap is held by its axis and its versine v = 1 − cos(angular radius), in [0, 2]: the cap's solid angle is 2π v, and
// nothing cancels for the tiny caps of far lights and sharp lobes, where a cosine has lost all its digits.
#include "directions.glsl"

struct Cap {
  vec3 axis;      // unit
  float versine;  // 1 − cos(radius)
};

// The part that two caps share.
struct CapOverlap {
  float area;   // sr
  vec3 moment;  // ∫ ω dω over it, sr; its length is at most the area
};

// The angle in [0, π] whose versine is given.
float AngleFromVersine(float versine) {
  return Arctangent(sqrt(max(versine * (2.0 - versine), 0.0)), 1.0 - versine);
}

// Of the angle between two unit vectors; half their squared distance keeps its digits where 1 − dot has none.
float VersineBetween(vec3 a, vec3 b) {
  vec3 difference = a - b;
  return min(0.5 * dot(difference, difference), 2.0);
}

// The whole sky that a sphere light covers, seen from `to_center` (m) away from its centre; from inside it is taken as
// touched from outside, half of all directions.
Cap SphereCap(vec3 to_center, float radius, vec3 fallback_axis) {
  float distance2 = dot(to_center, to_center);
  float sin2 = radius * radius < distance2 ? radius * radius / distance2 : 1.0;
  Cap cap;
  cap.axis = distance2 > 0.0 ? to_center * inversesqrt(distance2) : fallback_axis;
  cap.versine = sin2 / (1.0 + sqrt(1.0 - sin2));
  return cap;
}

// Area and first moment of the intersection of two caps, exact, in every case: apart, one inside the other, partial,
// and together covering the sphere. By Gauss–Bonnet on the spherical triangle of both axes and a crossing point of the
// rims, with triangle angles φ0, φ1 at the axes and excess E: area = 2 (φ0 v0 + φ1 v1 − E). It equals the form of
// [Oat 2006, "Spherical cap intersection"] with its third term's sign corrected, without its cancellation.
// The moment is ½ ∮ ω × dω along the two arcs.
CapOverlap IntersectCaps(Cap cap0, Cap cap1) {
  float v0 = cap0.versine;
  float v1 = cap1.versine;
  float vd = VersineBetween(cap0.axis, cap1.axis);
  float sin2_0 = max(v0 * (2.0 - v0), 0.0);
  float sin2_1 = max(v1 * (2.0 - v1), 0.0);
  float sin2_d = max(vd * (2.0 - vd), 0.0);
  // cos r1 − cos d cos r0 = sin d sin r0 cos φ0, and the same with the caps exchanged.
  float x0 = v0 + vd - v1 - v0 * vd;
  float x1 = v1 + vd - v0 - v1 * vd;
  float bound = sqrt(sin2_d * sin2_0);
  float triple2 = (bound - x0) * (bound + x0);
  CapOverlap overlap;
  if (triple2 > 0.0) {
    float triple = sqrt(triple2);  // sin d sin r0 sin φ0
    float phi0 = Arctangent(triple, x0);
    float phi1 = Arctangent(triple, x1);
    float excess = 2.0 * Arctangent(triple, 4.0 - v0 - v1 - vd);
    float chord = triple / max(sin2_d, 1e-30);  // the guard is below the square of float's rounding
    overlap.area = max(2.0 * (phi0 * v0 + phi1 * v1 - excess), 0.0);
    overlap.moment = cap0.axis * (phi0 * sin2_0 - chord * x0) + cap1.axis * (phi1 * sin2_1 - chord * x1);
  } else if (x0 > 0.0 && vd > v0) {  // apart
    overlap.area = 0.0;
    overlap.moment = vec3(0.0);
  } else if (x0 > 0.0 || (x0 == 0.0 && v1 <= v0)) {  // cap 1 lies in cap 0
    overlap.area = 2.0 * kPi * v1;
    overlap.moment = cap1.axis * (kPi * sin2_1);
  } else if (v0 + vd > 2.0) {  // the rest of each lies in the other
    overlap.area = 2.0 * kPi * (v0 + v1 - 2.0);
    overlap.moment = cap0.axis * (kPi * sin2_0) + cap1.axis * (kPi * sin2_1);
  } else {  // cap 0 lies in cap 1
    overlap.area = 2.0 * kPi * v0;
    overlap.moment = cap0.axis * (kPi * sin2_0);
  }
  return overlap;
}

// The same of a cap that lies wholly above the horizon of `up`, or wholly below.
CapOverlap WholeCap(Cap cap, vec3 up) {
  float above = dot(cap.axis, up) > 0.0 ? 1.0 : 0.0;
  CapOverlap overlap;
  overlap.area = above * 2.0 * kPi * cap.versine;
  overlap.moment = cap.axis * (above * kPi * max(cap.versine * (2.0 - cap.versine), 0.0));
  return overlap;
}

// The share of the smaller of two disks, or caps, that the other covers, from their radii and the distance of their
// centres: a smoothstep between touching and containing [Oat 2006, "Smoothstep saves the day"; Drobot 2014, eq. 1.21
// with its brackets corrected].
float SmoothstepOverlap(float radius0, float radius1, float center_distance) {
  float smaller = min(radius0, radius1);
  float larger = max(radius0, radius1);
  float depth = (center_distance - (larger - smaller)) / max(2.0 * smaller, 1e-30);
  float x = clamp(1.0 - depth, 0.0, 1.0);
  return x * x * (3.0 - 2.0 * x);
}

// How far from centre 0 towards centre 1 the middle of the shared part lies, as a fraction of their distance
// [Drobot 2014, eq. 1.22]. The clamp is the case of containment, where it is the smaller one's centre.
float OverlapCenter(float radius0, float radius1, float center_distance) {
  return clamp(0.5 + 0.5 * (radius0 - radius1) / max(center_distance, 1e-30), 0.0, 1.0);
}

// The point at a fraction of the great arc from a to b, unit vectors at an angle with the given versine.
vec3 AlongArc(vec3 a, vec3 b, float versine, float fraction) {
  float angle = AngleFromVersine(versine);
  float sin_angle = sin(angle);
  // Opposite or equal directions have no arc of their own; there the nearer of the two stands for it.
  vec3 arc = (a * sin((1.0 - fraction) * angle) + b * sin(fraction * angle)) / max(sin_angle, 1e-6);
  return sin_angle > 1e-6 ? arc : (fraction < 0.5 ? a : b);
}

// Form factor of a sphere, ∫ cosθ/π dω above the horizon, exact [Snyder 1996, derived anew as the moment of the sphere's
// cap cut by the hemisphere]; cos_center: n · direction to the centre; versine: the sphere's cap.
float SphereFormFactor(float cos_center, float versine) {
  float cos_radius = 1.0 - versine;
  float sin2 = versine * (2.0 - versine);
  float lit = max(cos_center, 0.0) * sin2;  // wholly above the horizon, or wholly below
#if EFFECT_HORIZON
  float w2 = sin2 - cos_center * cos_center;
  if (w2 > 0.0) {
    float w = sqrt(w2);
    lit = (Arctangent(w, cos_radius) + cos_center * sin2 * Arctangent(w, -cos_center * cos_radius) - cos_radius * w) / kPi;
  }
#endif
  return clamp(lit, 0.0, 1.0);
}
