// Disks and spheres by their cone of directions, clipped as the sphere of the same vector form factor (ours). Dual; after ltc.glsl and
// a "sphere".
#include "light_cone.glsl"

// The vector form factor, its z that of the proxy sphere above the horizon.
vec3 ProxyOfCone(LightCone cone) {
  ConeVector whole = VectorOfCone(cone);
  return vec3(whole.axis.x * whole.size, whole.axis.y * whole.size, AsFormFactor(ClippedSphere(whole.size, whole.axis.z)));
}

// As LambertProxy: where no horizon cuts the sphere its clip leaves the height as it is.
float LambertCap(float size, float elevation) {
#if EFFECT_PROXY_HORIZON || SPHERE_TABLE || SPHERE_CHEAP
  return AsFormFactor(ClippedSphere(size, elevation));
#else
  return AsFormFactor(size * elevation);
#endif
}

// The form factor of the light itself; a sphere is its own proxy.
float LambertDisk(DiskView disk) {
  ConeVector whole = VectorOfCone(ConeOfDisk(vec4(1.0, 0.0, 0.0, 1.0), InOwnAxes(disk)));
  return LambertCap(whole.size, dot(whole.axis, disk.horizon));
}
float LambertSphere(SphereView sphere) { return LambertCap(sphere.sin2, sphere.direction.z); }

// The vector form factor of the light transformed by M⁻¹ = m.
vec3 LobeOfDisk(vec4 m, DiskView disk) { return ProxyOfCone(ConeOfDisk(m, disk)); }
vec3 LobeOfSphere(vec4 m, SphereView sphere) { return ProxyOfCone(ConeOfSphere(m, sphere)); }
