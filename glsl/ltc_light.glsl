// What a technique of one or two transformed cosines shades of a light, the lobes one by one. After its ShadeLobe, which the option
// "lobes" asks once or twice; the diffuse lobe is of the first.
Radiance ShadeLight(Surface surface, Light light, vec3 to_view) {
  ShadingFrame frame = MakeShadingFrame(surface.normal, to_view);
  LtcCell cell = LookUpLtc(surface.roughness, frame);
  Radiance radiance = ShadeLobe(surface, light, frame, cell);
#if LOBES_TWO
  radiance.specular += ShadeLobe(surface, light, frame, LookUpSecond(surface.roughness, frame, cell)).specular;
#endif
  return radiance;
}
