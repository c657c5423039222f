// A tube by the outline of what is seen of it, its rims as chains of three chords, streamed [ours]. After an "edge",
// streamed_outline.glsl and tube_view.glsl.

// The outline clipped at the horizon while its sides are added; it is not convex, and may cross the horizon more than twice.
struct TubeStream {
  vec3 sum;
  vec3 first;   // where it first comes up; 0: nowhere yet
  vec3 leave;   // where it last went down, not joined yet; 0: nowhere
};

TubeStream StreamTubeSide(TubeStream stream, vec3 a, vec3 b, bool lambert) {
  TubeStream next = stream;
  bool a_above = a.z > 0.0;
  bool b_above = b.z > 0.0;
  if (a_above || b_above) {
    vec3 from = a_above ? a : MeetHorizon(b, a);
    vec3 to = b_above ? b : MeetHorizon(a, b);
    next.sum += EdgeVector(EdgeVertex(from), EdgeVertex(to), lambert);
    if (!a_above) {
      next.sum += HorizonEdge(EdgeVertex(next.leave), EdgeVertex(from));
      if (next.leave == vec3(0.0)) next.first = from;
      next.leave = vec3(0.0);
    }
    if (!b_above) next.leave = to;
  }
  return next;
}

// The vector form factor of a tube's part above z = 0, its z the form factor for a clamped cosine about +z.
vec3 ChainVector(TubeChain chain, bool small, bool lambert) {
  float cosine = cos(chain.widest);
  float sine = sin(chain.widest);
  float growth = ChainGrowth(chain.widest, 3.0);
  float inner_cosine = growth * cos(chain.widest * (1.0 / 3.0));
  float inner_sine = growth * sin(chain.widest * (1.0 / 3.0));
  if (!Lit(!small)) return ClippedSmallRectangle(chain.center, chain.half_axis, -chain.side);
  vec3 p0 = ChainCorner(chain, vec2(cosine, -sine), 1.0);
  vec3 p1 = ChainCorner(chain, vec2(inner_cosine, -inner_sine), 1.0);
  vec3 p2 = ChainCorner(chain, vec2(inner_cosine, inner_sine), 1.0);
  vec3 p3 = ChainCorner(chain, vec2(cosine, sine), 1.0);
  vec3 p4 = ChainCorner(chain, vec2(cosine, sine), -1.0);
  vec3 p5 = ChainCorner(chain, vec2(inner_cosine, inner_sine), -1.0);
  vec3 p6 = ChainCorner(chain, vec2(inner_cosine, -inner_sine), -1.0);
  vec3 p7 = ChainCorner(chain, vec2(cosine, -sine), -1.0);
  TubeStream stream = TubeStream(vec3(0.0), vec3(0.0), vec3(0.0));
  stream = StreamTubeSide(stream, p0, p1, lambert);
  stream = StreamTubeSide(stream, p1, p2, lambert);
  stream = StreamTubeSide(stream, p2, p3, lambert);
  stream = StreamTubeSide(stream, p3, p4, lambert);
  stream = StreamTubeSide(stream, p4, p5, lambert);
  stream = StreamTubeSide(stream, p5, p6, lambert);
  stream = StreamTubeSide(stream, p6, p7, lambert);
  stream = StreamTubeSide(stream, p7, p0, lambert);
  return VectorOfEdges(stream.sum + HorizonEdge(EdgeVertex(stream.leave), EdgeVertex(stream.first)));
}

void TubeFactors(Light light, vec3 position, ShadingFrame frame, vec4 m, OUT(float) form_factor, OUT(vec3) transformed) {
  TubeView view = ViewTube(light, position);
  form_factor = 0.0;
  transformed = vec3(0.0);
  if (Lit(SeesTube(light, view))) {
    TubeChain chain = ChainOfTube(light, view, position, frame.tangent, frame.bitangent, frame.normal);
    bool small = dot(light.half_size, light.half_size) < kSmallRectangle * dot(chain.center, chain.center);
    form_factor = ChainVector(chain, small, true).z;
    TubeChain lobe = chain;
    lobe.center = LtcTransform(m, chain.center);
    lobe.half_axis = LtcTransform(m, chain.half_axis);
    lobe.front = LtcTransform(m, chain.front);
    lobe.side = LtcTransform(m, chain.side);
    transformed = ChainVector(lobe, IsSmallParallelogram(lobe.center, lobe.half_axis, lobe.side), false);
  }
}
