// The texture is looked up where the polygon's plane is nearest to the lobe's origin, along its normal [Heitz et al. 2016, textured
// lights]. Gives the place from the polygon's centre and the squared distance; n = a × b, towards the origin.
vec3 LookUpPlace(vec3 center, vec3 n, float n2, vec3 vector, out float distance2) {
  float height = dot(n, center);
  distance2 = height * height / n2;
  return n * (height / n2) - center;
}
