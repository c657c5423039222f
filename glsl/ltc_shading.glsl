// What the LTC techniques share once a rectangle's form factors are known. After ltc_tables.glsl and the options
// "fresnel" and "disk".

#if EFFECT_DISK || EFFECT_SPHERE
// The form factor of a disk or a sphere, and the vector form factor of the light transformed into the lobe's space.
void RoundLightFactors(Light light, vec3 position, ShadingFrame frame, LtcCell cell, out float form_factor, out vec3 transformed) {
#if EFFECT_DISK
#if EFFECT_SPHERE
  if (light.shape == SHAPE_DISK)
#endif
  {
    DiskView view = ViewDisk(light, position, frame);
    form_factor = LambertDisk(view);
    transformed = LobeOfDisk(cell.m, view);
  }
#if EFFECT_SPHERE
  else
#endif
#endif
#if EFFECT_SPHERE
  {
    SphereView view = ViewSphere(light, position, frame);
    form_factor = LambertSphere(view);
    transformed = LobeOfSphere(cell.m, view);
  }
#endif
}
#endif

Radiance LtcRadiance(Surface surface, Light light, ShadingFrame frame, LtcCell cell, float form_factor, vec3 transformed) {
  float lobe = LtcLobe(transformed.z, form_factor, cell.terms);
  Radiance result;
#if DIFFUSE_LAMBERT
  result.diffuse = surface.diffuse_albedo * light.radiance * form_factor;
#else
  result.diffuse = surface.diffuse_albedo * light.radiance * (cell.terms.x * transformed.z);  // the cell is the diffuse lobe's
#endif
  result.specular = LtcReflectance(surface.f0, cell.terms, cell.m, frame.n_dot_v, frame.sine, transformed) * light.radiance * lobe;
  return result;
}
