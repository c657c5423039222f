// The technique knows of the sky: ShadeSky is its own.
vec3 BeforeSky(Surface surface, Light light) { return light.radiance; }
