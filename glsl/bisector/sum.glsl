// The halfway vector as Drobot's pseudo code prints it [2014, §1.3.3]: the sum of both vectors as they come, normalised after. Dual.

// Where that between point + (a, −z) and point + (b, −z) meets the light's plane, in the light's frame, m: in their middle.
vec2 HalfwayHit(vec3 point, vec2 a, vec2 b) { return vec2(point.x, point.y) + 0.5 * (a + b); }
