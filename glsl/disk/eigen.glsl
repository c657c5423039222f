// Disks and spheres by the axes of their cone, the eigenvectors of a 3×3 matrix [Heitz & Hill 2017], clipped as the sphere of the same
// form factor. Dual; after ltc.glsl and a "sphere".
//
// As published, without guards: in the light's plane, and where two eigenvalues are nearly equal and the discriminant of their cubic is
// rounding, the result may be no number.
#include "light_cone.glsl"

// One of the two outer roots of Aλ³ + 3Bλ² + 3Cλ + D [Blinn 2006, "How to Solve a Cubic Equation", algorithms A and D]:
// candidates 2√(−δ) cos(θ), 2√(−δ) cos(θ + 2π/3) with 3θ the angle of (−bend, swing).
vec2 OuterCandidates(float delta, float bend, float swing) {
  float theta = atan(swing, -bend) * (1.0 / 3.0);
  float radius = 2.0 * sqrt(-delta);
  return vec2(radius * cos(theta), radius * cos(theta + 2.0 * kPi / 3.0));
}

// The roots of λ³ + c2 λ² + c1 λ + c0, all real: the least in y.
vec3 RootsLeastInMiddle(float c0, float c1, float c2) {
  float b = c2 * (1.0 / 3.0);
  float c = c1 * (1.0 / 3.0);
  float d = c0;
  float delta1 = c - b * b;
  float delta2 = d - b * c;
  float delta3 = b * d - c * c;
  float swing = sqrt(4.0 * delta1 * delta3 - delta2 * delta2);
  vec2 large = OuterCandidates(delta1, delta2 - 2.0 * b * delta1, swing);
  float large_root = (large.x + large.y > 2.0 * b ? large.x : large.y) - b;
  vec2 small = OuterCandidates(delta3, 2.0 * c * delta3 - d * delta2, d * swing);
  float small_below = (small.x + small.y < 2.0 * c ? small.x : small.y) + c;  // the small root is −d over this
  // What the two leave of the cubic, as a linear factor.
  float e = small_below;
  float f = d - large_root * small_below;
  float g = -large_root * d;
  vec3 roots = vec3(-d / small_below, (c * f - b * g) / (c * e - b * f), large_root);
  if (roots.x < roots.y && roots.x < roots.z) return vec3(roots.y, roots.x, roots.z);
  if (roots.z < roots.x && roots.z < roots.y) return vec3(roots.x, roots.z, roots.y);
  return roots;
}

// Of the ellipse center ± a ± b, the half axes possibly skew.
vec3 ProxyOfEllipse(vec3 center, vec3 a, vec3 b) {
  // Its principal axes: eigenvectors of the 2×2 Gram matrix, whose root gives the eigenvalues.
  float d11 = dot(a, a);
  float d22 = dot(b, b);
  float d12 = dot(a, b);
  float inverse1;  // over the squared half axes
  float inverse2;
  vec3 axis1;
  vec3 axis2;
  if (abs(d12) * inversesqrt(d11 * d22) > 1e-4) {
    float trace = d11 + d22;
    float area = sqrt(d11 * d22 - d12 * d12);
    float u = 0.5 * sqrt(trace - 2.0 * area);
    float v = 0.5 * sqrt(trace + 2.0 * area);
    float greater = (u + v) * (u + v);
    float lesser = (u - v) * (u - v);
    vec3 longer = d11 > d22 ? a : b;
    vec3 shorter = d11 > d22 ? b : a;
    float longest = max(d11, d22);
    axis1 = normalize(d12 * longer + (greater - longest) * shorter);
    axis2 = normalize(d12 * longer + (lesser - longest) * shorter);
    inverse1 = 1.0 / greater;
    inverse2 = 1.0 / lesser;
  } else {
    inverse1 = 1.0 / d11;
    inverse2 = 1.0 / d22;
    axis1 = a * sqrt(inverse1);
    axis2 = b * sqrt(inverse2);
  }
  vec3 axis3 = cross(axis1, axis2);
  if (dot(center, axis3) < 0.0) axis3 = -axis3;

  // In this frame the cone is p(x − x0 z)² + q(y − y0 z)² = z².
  float distance = dot(axis3, center);
  float x0 = dot(axis1, center) / distance;
  float y0 = dot(axis2, center) / distance;
  float p = inverse1 * distance * distance;
  float q = inverse2 * distance * distance;
  vec3 roots = RootsLeastInMiddle(p * q, p * q * (1.0 + x0 * x0 + y0 * y0) - p - q,
                                  1.0 - p * (1.0 + x0 * x0) - q * (1.0 + y0 * y0));
  vec3 local = vec3(p * x0 / (p - roots.y), q * y0 / (q - roots.y), 1.0);
  vec3 direction = normalize(local.x * axis1 + local.y * axis2 + local.z * axis3);
  float tan2_1 = -roots.y / roots.z;
  float tan2_2 = -roots.y / roots.x;
  float size = sqrt(tan2_1) * sqrt(tan2_2) * inversesqrt((1.0 + tan2_1) * (1.0 + tan2_2));
  return vec3(direction.x * size, direction.y * size, ClippedSphere(size, direction.z));
}

// The form factor of the light itself; a sphere is its own proxy.
float LambertDisk(DiskView disk) { return ProxyOfEllipse(disk.center, disk.half_a, disk.half_b).z; }
float LambertSphere(SphereView sphere) { return AsFormFactor(ClippedSphere(sphere.sin2, sphere.direction.z)); }

// The vector form factor of the light transformed by M⁻¹ = m, its z that of the proxy sphere above the horizon.
vec3 LobeOfDisk(vec4 m, DiskView disk) {
  return ProxyOfEllipse(LtcTransform(m, disk.center), LtcTransform(m, disk.half_a), LtcTransform(m, disk.half_b));
}

// A sphere fills the directions of the disk that its rim bounds.
vec3 LobeOfSphere(vec4 m, SphereView sphere) {
  vec3 center = sphere.direction;
  vec3 side = abs(center.z) < 0.9 ? vec3(-center.y, center.x, 0.0) : vec3(center.z, 0.0, -center.x);
  float tangent = sqrt(sphere.sin2 / (1.0 - sphere.sin2));
  side *= tangent * inversesqrt(dot(side, side));
  return ProxyOfEllipse(LtcTransform(m, center), LtcTransform(m, side), LtcTransform(m, cross(center, side)));
}
