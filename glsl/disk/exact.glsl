// Disks and spheres by their cone of directions, clipped exactly at the horizon (ours). Dual; after ltc.glsl.
#include "light_cone.glsl"
#include "sphere/exact.glsl"

// The form factor of the light itself.
#if EFFECT_HORIZON
float LambertDisk(DiskView disk) { return ClippedConeVector(ConeOfDisk(vec4(1.0, 0.0, 0.0, 1.0), disk)).z; }
float LambertSphere(SphereView sphere) { return AsFormFactor(ClippedSphere(sphere.sin2, sphere.direction.z)); }
#else
float LambertDisk(DiskView disk) {
  ConeVector whole = VectorOfCone(ConeOfDisk(vec4(1.0, 0.0, 0.0, 1.0), disk));
  return AsFormFactor(whole.size * whole.axis.z);
}
float LambertSphere(SphereView sphere) { return AsFormFactor(sphere.sin2 * sphere.direction.z); }
#endif

// The vector form factor of the light transformed by M⁻¹ = m, its part above the horizon.
vec3 LobeOfDisk(vec4 m, DiskView disk) { return ClippedConeVector(ConeOfDisk(m, disk)); }
vec3 LobeOfSphere(vec4 m, SphereView sphere) { return ClippedConeVector(ConeOfSphere(m, sphere)); }
