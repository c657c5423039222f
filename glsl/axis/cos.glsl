// The table's view angles over cos θ [Hill & Heitz 2016, "cheaper lookup"]. Dual.

// The table's second coordinate, [0, 1], from cosine and sine of the view angle.
float LtcViewPosition(float n_dot_v, float sine) { return 1.0 - n_dot_v; }
