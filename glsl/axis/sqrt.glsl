// The table's view angles over √(1 − cos θ), as the authors' code ships it. Dual; after a "fit".

// The table's second coordinate, [0, 1], from cosine and sine of the view angle.
float LtcViewPosition(float n_dot_v, float sine) { return LtcRootPosition(n_dot_v, sine); }
