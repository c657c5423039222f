// Tables as published, fitted on the lobe with an L3 norm [Heitz et al. 2016]. Dual.

// √(1 − c), as the authors take it.
float LtcRootPosition(float n_dot_v, float sine) { return sqrt(1.0 - n_dot_v); }
