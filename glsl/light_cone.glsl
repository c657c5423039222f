#pragma once
// The cone of directions that an elliptic disk or a sphere fills, and its form factor [ours]. Dual.
//
// An ellipse with centre C and half axes V1, V2 seen from the origin is touched by the planes with normal g for which
// gᵀGg = 0, G = CCᵀ − V1V1ᵀ − V2V2ᵀ; a sphere of radius R transformed by M⁻¹ by those with G = (M⁻¹c)(M⁻¹c)ᵀ − R² M⁻¹M⁻ᵀ. In both
// G = CCᵀ − B, and G has one positive eigenvalue μ, whose eigenvector is the cone's axis and the direction of the vector form factor F.
// No other eigenvalue is needed for F: with D² = det G, b = tr B − |C|² and k the sum of G's principal minors,
//   μ³ + bμ² + kμ − D² = 0,   |F| = D/√(μ²(2μ + b) + D²),   F ∥ adj(μI + B) C = μ((μ + tr B) C − B C) + adj(B) C.
// Form factors do not depend on lengths: all of this is scaled by 1/(|C|² + tr B), so that nothing overflows.
#include "directions.glsl"
#include "ltc.glsl"
#include "path.glsl"

// The adjugate's transpose of M⁻¹: it takes normals to normals. M⁻¹ as in ltc.glsl.
vec3 LtcAdjoint(vec4 m, vec3 v) { return vec3(m.w * v.x - m.y * v.z, (m.x * m.w - m.y * m.z) * v.y, m.x * v.z - m.z * v.x); }

struct LightCone {
  vec3 center;    // C
  vec3 half_a;    // B = half_a half_aᵀ + half_b half_bᵀ + across · yyᵀ
  vec3 half_b;
  float across;   // 0 of a disk
  vec3 adjugate;  // adj(B) C
  float trace;    // of B
  float minors;   // k
  float root;     // D ≥ 0
};

// A disk or ellipse as a shaded point sees it, in the shading frame.
struct DiskView {
  vec3 center;  // m, from the shaded point
  vec3 half_a;  // m
  vec3 half_b;  // m, perpendicular to half_a
  vec3 normal;  // unit
  vec3 place;   // center = place.x · half_a + place.y · half_b + place.z · normal
  vec3 horizon;    // the shading normal along the disk's axes and normal
  vec2 half_size;  // m, |half_a| and |half_b|
};

// position: m, world; the frame is that of the surface.
DiskView ViewDisk(Light light, vec3 position, ShadingFrame frame) {
  RectangleView view = ViewRectangle(light, position, frame.tangent, frame.bitangent, frame.normal);
  DiskView disk;
  disk.center = view.center;
  disk.half_a = view.half_a;
  disk.half_b = view.half_b;
  disk.normal = vec3(dot(frame.tangent, light.normal), dot(frame.bitangent, light.normal), view.horizon.z);
  disk.place = vec3(view.in_plane.x / view.half_size.x, view.in_plane.y / view.half_size.y, view.in_plane.z);
  disk.horizon = view.horizon;
  disk.half_size = view.half_size;
  return disk;
}

// The disk in its own axes, where most products are none.
DiskView InOwnAxes(DiskView disk) {
  DiskView own = disk;
  own.half_a = vec3(disk.half_size.x, 0.0, 0.0);
  own.half_b = vec3(0.0, disk.half_size.y, 0.0);
  own.normal = vec3(0.0, 0.0, 1.0);
  own.center = vec3(disk.place.x * disk.half_size.x, disk.place.y * disk.half_size.y, disk.place.z);
  return own;
}

// A sphere as a shaded point sees it, in the shading frame.
struct SphereView {
  vec3 direction;  // unit, to the centre
  float sin2;      // of its angular radius
};

// From inside, where a sphere sends nothing, it is taken as nearly touched from outside: sin² at most 1 − 2⁻²⁰, which float holds exactly: it has
// no digits to spare in what is left to 1.
SphereView ViewSphere(Light light, vec3 position, ShadingFrame frame) {
  vec3 to_center = light.center - position;
  float distance2 = dot(to_center, to_center);
  float inverse = inversesqrt(max(distance2, 1e-30));
  SphereView sphere;
  sphere.direction = vec3(dot(frame.tangent, to_center), dot(frame.bitangent, to_center), dot(frame.normal, to_center)) * inverse;
  if (distance2 < 1e-30) sphere.direction = vec3(0.0, 0.0, 1.0);
  sphere.sin2 = min(light.half_size.x * inverse * light.half_size.x * inverse, 1.0 - 9.5367431640625e-7);
  return sphere;
}

// Of a disk transformed by M⁻¹ = m. With C = x V1 + y V2 + h Z the minors lose no digits in the disk's plane and near its rim.
LightCone ConeOfDisk(vec4 m, DiskView disk) {
  vec3 center = LtcTransform(m, disk.center);
  vec3 a = LtcTransform(m, disk.half_a);
  vec3 b = LtcTransform(m, disk.half_b);
  // 1e-30: a point in the middle of a disk of the least size allowed is at 1e-12.
  float scale = inversesqrt(max(dot(center, center) + dot(a, a) + dot(b, b), 1e-30));
  center *= scale;
  a *= scale;
  b *= scale;
  vec3 z = LtcTransform(m, disk.normal) * (scale * disk.place.z);
  vec3 n = cross(a, b);
  vec3 n_x = n * disk.place.x + cross(z, b);  // C × V2
  vec3 n_y = n * disk.place.y + cross(a, z);  // V1 × C
  float n_dot_c = dot(n, z);
  LightCone cone;
  cone.center = center;
  cone.half_a = a;
  cone.half_b = b;
  cone.across = 0.0;
  cone.adjugate = n * n_dot_c;
  cone.trace = dot(a, a) + dot(b, b);
  cone.minors = dot(n, n) - dot(n_x, n_x) - dot(n_y, n_y);
  cone.root = abs(n_dot_c);
  return cone;
}

// Of a sphere transformed by M⁻¹ = m.
LightCone ConeOfSphere(vec4 m, SphereView sphere) {
  vec3 center = LtcTransform(m, sphere.direction);
  vec3 adjoint = LtcAdjoint(m, sphere.direction);
  float determinant = m.x * m.w - m.y * m.z;
  float squares = dot(m, m) + 1.0;  // of M⁻¹'s elements
  float scale2 = 1.0 / (dot(center, center) + sphere.sin2 * squares);
  float scale = sqrt(scale2);
  float spread = sphere.sin2 * scale2;
  float cos2 = 1.0 - sphere.sin2;
  LightCone cone;
  cone.center = center * scale;
  float spread_root = sqrt(spread);
  cone.half_a = vec3(m.x, 0.0, m.y) * spread_root;
  cone.half_b = vec3(m.z, 0.0, m.w) * spread_root;
  cone.across = spread;
  cone.adjugate = adjoint * (spread * spread * determinant * scale);
  cone.trace = spread * squares;
  cone.minors = spread * scale2 * (dot(adjoint, adjoint) - cos2 * (dot(m, m) + determinant * determinant));
  cone.root = spread * scale * abs(determinant) * sqrt(cos2);
  return cone;
}

// The unclipped vector form factor.
struct ConeVector {
  vec3 axis;   // unit, F's direction
  float mu;    // the positive eigenvalue of G
  float size;  // |F|, [0, 1]
};

ConeVector VectorOfCone(LightCone cone) {
  float b = cone.trace - dot(cone.center, cone.center);
  float k = cone.minors;
  float d2 = cone.root * cone.root;
  // The largest root: 2√q cos(⅓ acos r) − b over 3, its cosine as a polynomial in s = √½(1 + r), which carries the singularity at
  // r = −1; error 7e-6. 1e-30 and the like keep zeros from meeting.
  float q = max(b * b - 3.0 * k, 1e-20);
  float inverse = inversesqrt(q);
  float r = (b * (4.5 * k - b * b) + 13.5 * d2) * inverse * inverse * inverse;
  float s = sqrt(clamp(0.5 + 0.5 * r, 0.0, 1.0));
  float third = 0.333340406 + s * (0.384541661 + s * (-0.0709959939 + s * (0.0255686063 - 0.00579223456 * s)));
  float mu = max(q * inverse * third - b * (1.0 / 3.0), 0.0);
  // A small root is a difference of large terms: there the cubic is divided by its other end.
  if (mu < 0.25 * b) {
    float sum = b + mu;
    float root = sqrt(k * k + 4.0 * sum * d2);
    mu = k > 0.0 ? 2.0 * d2 / (k + root) : (root - k) / (2.0 * sum);
  }
  ConeVector result;
  result.mu = mu;
  result.size = min(cone.root * inversesqrt(max(mu * mu * (2.0 * mu + b) + d2, 1e-30)), 1.0);
  vec3 spread_c = cone.half_a * dot(cone.half_a, cone.center) + cone.half_b * dot(cone.half_b, cone.center);
  spread_c.y += cone.across * cone.center.y;
  vec3 axis = mu * ((mu + cone.trace) * cone.center - spread_c) + cone.adjugate;
  result.axis = axis * inversesqrt(max(dot(axis, axis), 1e-37));
  return result;
}

// ar tanh(κ s1) − ar tanh(κ s0) over κ, for s within [−1, 1] and κ within [0, 1].
float ArtanhSpan(float kappa, float s0, float s1) {
  float difference = kappa * (s1 - s0);
  float u = difference / max(1.0 - kappa * kappa * s0 * s1, 1e-7);
  float u2 = u * u;
  float series = (s1 - s0) / max(1.0 - kappa * kappa * s0 * s1, 1e-7) * (1.0 + u2 * (1.0 / 3.0 + u2 * (0.2 + u2 / 7.0)));
  // 1e-7: both ends of a sliver, where κ s is 1 in float.
  float ratio = ((1.0 - kappa * s0) * (1.0 + kappa * s1) + 1e-7) / ((1.0 + kappa * s0) * (1.0 - kappa * s1) + 1e-7);
  return abs(u) < 0.1 ? series : 0.5 * log(ratio) / kappa;
}

// The vector form factor of the cone's part above the horizon z = 0, exact but for the root's polynomial: the contour integral
// ½π⁻¹ ∮ p × dp / |p|² over the rim p(φ) = √μ e3 + √ma cos φ e1 + √mb sin φ e2 and the closing side in the horizon.
vec3 ClippedConeVector(LightCone cone) {
  ConeVector whole = VectorOfCone(cone);
  float height = whole.size * whole.axis.z;
  // The horizon is a tangent plane of the cone or misses it.
  bool one_side = cone.center.z * cone.center.z >= cone.half_a.z * cone.half_a.z + cone.half_b.z * cone.half_b.z;
  if (WhollyOnOneSide(one_side)) return whole.axis * (cone.center.z > 0.0 ? whole.size : 0.0);

  // A cone this narrow is cut by its mean height, spread evenly, as a small rectangle is (polygon.glsl).
  float distance2 = dot(cone.center, cone.center);
  if (!Lit(cone.trace >= kSmallRectangle * distance2)) {
    float reach = sqrt(cone.half_a.z * cone.half_a.z + cone.half_b.z * cone.half_b.z);
    float above = clamp(cone.center.z, -reach, reach) + reach;
    return vec3(whole.axis.x, whole.axis.y, above * above / max(4.0 * reach, 1e-30) * inversesqrt(distance2)) * whole.size;
  }

  // G across e3, over a horizontal axis u and an upward one v, turned to its own axes; −ma ≤ −mb are its eigenvalues.
  vec3 e3 = whole.axis;
  float mu = whole.mu;
  float level2 = e3.x * e3.x + e3.y * e3.y;
  float inverse_level = inversesqrt(max(level2, 1e-30));
  vec3 u = level2 > 1e-30 ? vec3(-e3.y * inverse_level, e3.x * inverse_level, 0.0) : vec3(1.0, 0.0, 0.0);
  vec3 v = cross(e3, u);
  vec3 over_u = vec3(dot(cone.half_a, u), dot(cone.half_b, u), dot(cone.center, u));
  vec3 over_v = vec3(dot(cone.half_a, v), dot(cone.half_b, v), dot(cone.center, v));
  float g_uu = over_u.x * over_u.x + over_u.y * over_u.y + cone.across * u.y * u.y - over_u.z * over_u.z;
  float g_vv = over_v.x * over_v.x + over_v.y * over_v.y + cone.across * v.y * v.y - over_v.z * over_v.z;
  float g_uv = over_u.x * over_v.x + over_u.y * over_v.y + cone.across * u.y * v.y - over_u.z * over_v.z;
  float half_difference = 0.5 * (g_uu - g_vv);
  float root = sqrt(half_difference * half_difference + g_uv * g_uv);
  float ma = max(0.5 * (g_uu + g_vv) + root, 1e-30);
  float mb = min(cone.root * cone.root / max(mu * ma, 1e-37), ma);
  // 1e-18: a round cone has no axes of its own.
  vec2 turn = half_difference > 0.0 ? vec2(half_difference + root + 1e-18, g_uv) : vec2(g_uv, root - half_difference + 1e-18);
  turn *= inversesqrt(turn.x * turn.x + turn.y * turn.y);
  vec3 e1 = u * turn.x + v * turn.y;
  vec3 e2 = v * turn.x - u * turn.y;

  // The rim's ends in the horizon, counter-clockwise, as cosine and sine of φ.
  float root_mu = sqrt(mu);
  float root_ma = sqrt(ma);
  float root_mb = sqrt(mb);
  vec2 top = vec2(root_ma * e1.z, root_mb * e2.z);
  top *= inversesqrt(max(top.x * top.x + top.y * top.y, 1e-37));
  float m = clamp(-root_mu * e3.z / max(root_ma * e1.z * top.x + root_mb * e2.z * top.y, 1e-18), -1.0, 1.0);
  float w = sqrt(1.0 - m * m);
  vec2 from = vec2(m * top.x + w * top.y, m * top.y - w * top.x);
  vec2 to = vec2(m * top.x - w * top.y, m * top.y + w * top.x);

  float sum_a = mu + ma;
  float sum_b = max(mu + mb, 1e-20);
  float kappa = sqrt((ma - mb) / sum_a);
  float j = sqrt(max((ma - mb) / sum_b, 1e-8));
  float along_e1 = root_mb * root_mu / sum_a * ArtanhSpan(kappa, from.y, to.y);
  float along_e2 = root_ma * root_mu / sum_b * Arctangent(j * (to.x - from.x), 1.0 + j * j * from.x * to.x) / j;
  // The turn of the rim's image on the sphere, in [0, 2π).
  vec2 from_sphere = vec2(from.x * inversesqrt(sum_b), from.y * inversesqrt(sum_a));
  vec2 to_sphere = vec2(to.x * inversesqrt(sum_b), to.y * inversesqrt(sum_a));
  float psi = Arctangent(from_sphere.x * to_sphere.y - from_sphere.y * to_sphere.x, dot(from_sphere, to_sphere));
  if (psi < 0.0) psi += 2.0 * kPi;
  vec3 p_from = root_mu * e3 + root_ma * from.x * e1 + root_mb * from.y * e2;
  vec3 p_to = root_mu * e3 + root_ma * to.x * e1 + root_mb * to.y * e2;
  float closing = Arctangent(max(CrossZ(p_to, p_from), 0.0), p_to.x * p_from.x + p_to.y * p_from.y);
  vec3 f = (along_e2 * e2 - along_e1 * e1 + whole.size * psi * e3) * (0.5 / kPi);
  // Next to either end ψ may leap between 0 and 2π, by F: what the clip adds to F lies between.
  return vec3(f.x, f.y, clamp(f.z + closing * (0.5 / kPi), max(height, 0.0), whole.size));
}
