// An edge's part of a polygon's vector form factor, times kTurn, from its two corners. Dual; after an "edge".

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

// The same of a side in the horizon that closes an outline, of which it says only its angle: where the light's plane passes by the point
// its ends are opposite but for rounding, and then their cross product says nothing. A corner that is 0 stands for none.
vec3 HorizonEdge(vec4 v0, vec4 v1) {
  float d = v0.x * v1.x + v0.y * v1.y;
  float area = v0.x * v1.y - v0.y * v1.x;
  float sense = d < 0.0 || area > 0.0 ? 1.0 : (area < 0.0 ? -1.0 : 0.0);
  return vec3(0.0, 0.0, sense * EdgeAngle(d, v0.w * v1.w, abs(area)));
}

// Where the side from a corner above to one below meets the horizon. Edges that make corners unit ask for its direction alone; of others the
// fourth power of a length is taken, and lights are 1e-5 to 1e5 m large.
vec3 MeetHorizon(vec3 above, vec3 below) {
  vec3 place = above.z * below - below.z * above;
  return kEdgeUnit ? place : vec3(vec2(place) / max(above.z - below.z, 1e-30), 0.0);
}

// From the sum of a polygon's edges.
vec3 VectorOfEdges(vec3 sum) { return vec3(sum.x * (1.0 / kTurn), sum.y * (1.0 / kTurn), AsFormFactor(sum.z * (1.0 / kTurn))); }
