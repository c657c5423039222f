// The look-up of a lobe, as the options "lobes", "fit", "norm", "axis" and "frame" stored it: glsl/fit.h.
#include "ltc.glsl"
#include "lobes"
#include "fit"
#include "norm"
#include "axis"
#include "frame"

struct LtcCell {
  vec4 m;      // M⁻¹
  vec4 terms;  // magnitude, Schlick's term, cosine weight
};

vec2 LtcCoordinates(float roughness, ShadingFrame frame) {
  return TableCoordinates(roughness, LtcViewPosition(frame.n_dot_v, frame.sine));
}

#if !DIFFUSE_LAMBERT
// The diffuse lobe: one transformed cosine about the normal, whatever "lobes" and "frame" say.
LtcCell LookUpDiffuse(float roughness, ShadingFrame frame) {
  vec2 uv = LtcCoordinates(roughness, frame);
  LtcCell cell;
  cell.terms = vec4(SampleTable(table_ltc_diffuse_terms, uv).x, 0.0, 0.0, 0.0);
  cell.m = SampleTable(table_ltc_diffuse_matrix, uv);
  return cell;
}
#endif

vec4 LookUpMatrix(vec2 uv, vec4 terms, ShadingFrame frame) {
  return LtcUnturned(LtcNormalised(SampleTable(table_ltc_matrix, uv), terms), frame.n_dot_v, frame.sine);
}

LtcCell LookUpLtc(float roughness, ShadingFrame frame) {
  vec2 uv = LtcCoordinates(roughness, frame);
  LtcCell cell;
  cell.terms = SampleTable(table_ltc_terms, uv);
  cell.m = LookUpMatrix(FirstLobe(uv), cell.terms, frame);
  return cell;
}

#if LOBES_TWO
// The second lobe, as one by itself.
LtcCell LookUpSecond(float roughness, ShadingFrame frame, LtcCell first) {
  LtcCell cell;
  cell.terms = vec4(first.terms.x * first.terms.z, first.terms.w, 0.0, 0.0);
  cell.m = LookUpMatrix(SecondLobe(LtcCoordinates(roughness, frame)), cell.terms, frame);
  return cell;
}
#endif
