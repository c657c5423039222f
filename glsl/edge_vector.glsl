// An edge's part of a polygon's vector form factor, without 1/(2π), from its two corners. Dual; after an "edge".

// A corner as the edges want it: see EdgeVertex. lambert: of the light itself rather than of the transformed one.
vec3 EdgeVector(vec4 v0, vec4 v1, bool lambert) {
  vec3 a = vec3(v0);
  vec3 b = vec3(v1);
  vec3 c = cross(a, b);
  float d = dot(a, b);
  float m2 = v0.w * v1.w;
  float line2 = dot(c, c);
  float ratio = lambert ? LambertEdgeRatio(d, m2, 1.0, line2) : EdgeRatio(d, m2, 1.0, line2);
  if (kEdgeMirrored) ratio = MirroredEdge(ratio, d, line2);
  return ratio * c;
}

// Where the side from a corner above to one below meets the horizon. Its place, not a multiple of it: the fourth power of a length is
// taken later, and lights are 1e-5 to 1e5 m large.
vec3 MeetHorizon(vec3 above, vec3 below) {
  float inverse = 1.0 / max(above.z - below.z, 1e-30);
  return vec3((above.z * below.x - below.z * above.x) * inverse, (above.z * below.y - below.z * above.y) * inverse, 0.0);
}

// From the sum of a polygon's edges.
vec3 VectorOfEdges(vec3 sum) { return vec3(sum.x * (0.5 / kPi), sum.y * (0.5 / kPi), AsFormFactor(sum.z * (0.5 / kPi))); }
