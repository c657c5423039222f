// The halfway vector as Drobot's pseudo code prints it [2014, §1.3.3]: the sum of both vectors as they come, normalised after. Dual.

// Where that between the directions (a, −z) and (b, −z) from the point meets the light's plane, from its foot, m: in their middle.
vec2 HalfwayHit(vec3 point, vec2 a, vec2 b) { return 0.5 * (a + b); }
