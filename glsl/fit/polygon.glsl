// Tables fitted on polygons (ours): over √(1 − cos θ) they end at 89°, since beyond sharp lobes are noise that spoils their
// neighbours. Dual; after ltc.glsl.

// √((1 − c)/(1 − cos 89°)), clamped to 1.
float LtcRootPosition(float n_dot_v, float sine) { return min(RootOfVersine(n_dot_v, sine) * sqrt(1.0 / 0.98254759356), 1.0); }
