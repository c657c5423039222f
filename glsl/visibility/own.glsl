// The technique has looked at the aperture itself.
float Visibility(Surface surface, Light light) { return 1.0; }
