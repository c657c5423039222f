// The edge integral with the language's own arc cosine, as the derivation has it [Hill & Heitz 2016, "EdgeIntegral"]. Dual.

// A corner as the edges want it: direction and length.
vec4 EdgeVertex(vec3 v) { return vec4(v, length(v)); }

// θ itself; `area` = |v0 × v1| is not needed here.
float EdgeAngle(float d, float m, float area) { return acos(clamp(d / max(m, 1e-30), -1.0, 1.0)); }

// θ/|v0 × v1|, 1/m², of the angle θ between v0 and v1 from d = v0·v1 and m = |v0||v1|.
float EdgeRatio(float d, float m) {
  float sine2 = max((m - d) * (m + d), 0.0);  // |v0 × v1|²
  // Below it θ/sin θ is 1 to the last digit of a double.
  return sine2 > 1e-16 * m * m ? EdgeAngle(d, m, 0.0) * inversesqrt(sine2) : 1.0 / max(m, 1e-30);
}
