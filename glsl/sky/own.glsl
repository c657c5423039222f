// The technique knows of the sky: ShadeSky is its own.
vec3 BeforeSky(vec3 radiance) { return radiance; }
