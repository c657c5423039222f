// Tables as published, fitted on the lobe with an L3 norm [Heitz et al. 2016]. Dual; after ltc.glsl.

// √(1 − c).
float LtcRootPosition(float n_dot_v, float sine) { return RootOfVersine(n_dot_v, sine); }
