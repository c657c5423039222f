// The texture is looked up along the vector form factor, which always meets the polygon, so that no border is needed [Hill & Heitz
// 2016, after Karis]. The talk gives no distance for the filter; ours is the one to the place (the plane's leaves a third more
// error in the diffuse lobe). Gives the place from the polygon's centre and the squared distance; n = a × b, towards the origin.
vec3 LookUpPlace(vec3 center, vec3 n, float n2, vec3 vector, out float distance2) {
  float along = dot(n, vector);
  vec3 place = along < 0.0 ? vector * (dot(n, center) / along) : center;  // a light that gives nothing has no vector
  distance2 = dot(place, place);
  return place - center;
}
