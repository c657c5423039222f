// What a technique of one or two transformed cosines shades of a light, the lobes one by one. After its ShadeLobe, which the option
// "lobes" asks once or twice, and once more where the diffuse BRDF is not Lambert's, of which it has the form factor anyway.
Radiance ShadeLight(Surface surface, Light light, vec3 to_view) {
  ShadingFrame frame = MakeShadingFrame(surface.normal, to_view);
  LtcCell cell = LookUpLtc(surface.roughness, frame);
  Radiance radiance = ShadeLobe(surface, light, frame, cell);
#if LOBES_TWO
  radiance.specular += ShadeLobe(surface, light, frame, LookUpSecond(surface.roughness, frame, cell)).specular;
#endif
#if !DIFFUSE_LAMBERT
  radiance.diffuse = ShadeLobe(surface, light, frame, LookUpDiffuse(surface.roughness, frame)).diffuse;
#endif
  return radiance;
}
