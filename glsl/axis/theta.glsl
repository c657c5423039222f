// The table's view angles over θ, the talk's workaround for norm=last [Hill & Heitz 2016, "cheaper lookup"]. Dual.

// The table's second coordinate, [0, 1], from cosine and sine of the view angle.
float LtcViewPosition(float n_dot_v, float sine) { return acos(n_dot_v) * (2.0 / kPi); }
