// The halfway vector of unit vectors, as those of [Drobot 2014, eq. 1.9] are; of the two readings it errs less. Dual.

// Where the halfway vector between the directions (a, −z) and (b, −z) from the point meets the light's plane, from its foot, m: their
// bisector divides the segment as the distances do.
vec2 HalfwayHit(vec3 point, vec2 a, vec2 b) {
  float length_a = sqrt(dot(a, a) + point.z * point.z);
  float length_b = sqrt(dot(b, b) + point.z * point.z);
  return (a * length_b + b * length_a) / max(length_a + length_b, 1e-30);
}
