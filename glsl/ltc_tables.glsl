// The look-up of a lobe, as the options "fit", "norm", "axis" and "frame" stored it: glsl/fit.h.
#include "ltc.glsl"
#include "fit"
#include "norm"
#include "axis"
#include "frame"

struct LtcCell {
  vec4 m;      // M⁻¹
  vec4 terms;  // magnitude, Schlick's term, cosine weight
};

LtcCell LookUpLtc(float roughness, ShadingFrame frame) {
  vec2 uv = TableCoordinates(roughness, LtcViewPosition(frame.n_dot_v, frame.sine));
  LtcCell cell;
  cell.terms = SampleTable(table_ltc_terms, uv);
  vec4 stored = LtcNormalised(SampleTable(table_ltc_matrix, uv), cell.terms);
  cell.m = LtcUnturned(stored, frame.n_dot_v, frame.sine);
  return cell;
}
