/*---
summary = "Linearly transformed cosines, clipped exactly at the horizon"
citation = "Heitz et al. 2016; Hill & Heitz 2016; Lambert 1760"
author_note = "Published: 16-case clip, rational edge, tables fitted with an L3 norm, Fresnel averaged over the lobe. Ours: branchless clip in the light's plane, mirrored half-angle edge, tables fitted on polygons and stored in the mirror frame, Fresnel towards the light."
shapes = ["rectangle"]
lobes = ["diffuse", "specular"]
brdfs = ["ggx"]
effects = ["two_sided", "fresnel"]
exact = ["lambert_rectangle", "point_limit"]

[[option]]
name = "clip"
summary = "Clipping at the horizon"
choices = [
  ["arc", "branchless in the light's plane, the closing side as an arc"],
  ["switch", "one case for each set of corners above the horizon"],
  ["stream", "on the fly, side by side as the edges are added"],
  ["none", "none: what is below subtracts"],
]

[[option]]
name = "edge"
summary = "Angle over sine of the edge integral"
choices = [
  ["mirrored", "polynomial in the acute half angle, mirrored where obtuse by the exact cross product"],
  ["half_angle", "polynomial in the half angle's cosine, fewer cycles, fewer digits near π"],
  ["rational", "rational fit of angle over sine on unit vectors, mirrored where obtuse"],
  ["quadratic", "the rational fit for the specular lobe, a quadratic for the diffuse one"],
  ["acos", "the language's arc cosine"],
  ["fast_acos", "the four-term arc cosine that GPUs run"],
]

[[option]]
name = "fit"
summary = "Tables of the transform"
choices = [
  ["polygon", "fitted on polygons, stored in the mirror frame, last row at 89°"],
  ["cosine", "as polygon, with a signed share of the plain cosine lobe"],
  ["l3", "fitted on the lobe with an L3 norm, stored in the normal's frame"],
]

[[option]]
name = "fresnel"
summary = "Where Schlick's Fresnel term is taken"
choices = [
  ["direction", "towards the light's part of the lobe, tending to the lobe's average as the light covers it"],
  ["lobe", "averaged over the whole lobe, wherever the light is"],
]

[tables]
ltc_matrix = "ltc_ggx_{fit}.exr"
ltc_terms = "ltc_ggx_{fit}_terms.exr"

[published]
clip = "switch"
edge = "rational"
fit = "l3"
fresnel = "lobe"
---*/
#include "brdf.glsl"
#include "ltc.glsl"
#include "fit"
#include "fresnel"
#include "edge"
#include "clip"

Radiance ShadeLight(Surface surface, Light light, vec3 to_view) {
  ShadingFrame frame = MakeShadingFrame(surface.normal, to_view);
  RectangleView view = ViewRectangle(light, surface.position, frame.tangent, frame.bitangent, frame.normal);
  vec2 uv = TableCoordinates(surface.roughness, LtcViewPosition(frame.n_dot_v, frame.sine));
  vec4 m = LtcUnpack(SampleTable(table_ltc_matrix, uv), frame.n_dot_v, frame.sine);
  vec4 terms = SampleTable(table_ltc_terms, uv);

  vec3 center = LtcTransform(m, view.center);
  vec3 half_a = LtcTransform(m, view.half_a);
  vec3 half_b = LtcTransform(m, view.half_b);
  float form_factor = ClippedLambert(view);
  vec3 transformed = ClippedVector(center, half_a, half_b);
  float lobe = LtcLobe(transformed.z, form_factor, terms);
  Radiance result;
  result.diffuse = surface.diffuse_albedo * light.radiance * form_factor;
  result.specular = LtcReflectance(surface.f0, terms, m, frame.n_dot_v, frame.sine, transformed) * light.radiance * lobe;
  return result;
}
