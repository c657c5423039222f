// The edge integral with the language's own arc cosine, as the derivation has it [Hill & Heitz 2016, "EdgeIntegral"]. Dual.

// A corner as the edges want it: direction and length.
vec4 EdgeVertex(vec3 v) { return vec4(v, length(v)); }

// θ itself; `area` = |v0 × v1| is not needed.
float EdgeAngle(float d, float m, float area) { return acos(clamp(d / max(m, 1e-30), -1.0, 1.0)); }

// θ/line, θ the angle between v0 and v1, from d = v0·v1 and m = |v0||v1|, where |v0 × v1| = share · line, line2 = line².
float EdgeRatio(float d, float m, float share, float line2) {
  return EdgeAngle(d, m, 0.0) * inversesqrt(max(line2, 1e-30));
}
