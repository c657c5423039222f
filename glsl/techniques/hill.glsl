/*---
summary = "Linearly transformed cosines, horizon by the vector form factor's proxy sphere"
citation = "Hill & Heitz 2016; Heitz & Hill 2017; Snyder 1996; Heitz et al. 2016"
author_note = "Published: clipped sphere from a table, rational edge, disks by a cubic, tables fitted with an L3 norm, Fresnel averaged over the lobe; stored as their code ships it (the talk ends at norm=none+axis=cos). Ours: clipped sphere by a fit, disks and spheres by their cone, mirrored cosine edge, tables fitted on polygons and stored in the mirror frame, Fresnel towards the light. Of a textured light's prefilter the paper's idea is kept (one look-up a lobe, its level by distance²/area), the kernel is the cosine lobe's own, normalised over the light."
shapes = ["rectangle", "disk", "sphere", "polygon", "ellipse"]
lobes = ["diffuse", "specular"]
brdfs = ["ggx", "ggx_separable", "beckmann", "blinn_phong", "ward", "phong"]
diffuse_brdfs = ["lambert", "disney"]
effects = ["two_sided", "fresnel", "textured"]
exact = ["point_limit", "mirror_limit"]

[[option]]
name = "sphere"
summary = "Form factor of the proxy sphere above the horizon"
choices = [
  ["fit", "polynomial in elevation and size"],
  ["table", "table of the quotient to the unclipped one"],
  ["exact", "closed form"],
  ["cheap", "rational in size and height alone: no root, no case"],
]

[[option]]
name = "edge"
summary = "Angle over sine of the rectangle's edge integral"
choices = [
  ["mirrored", "polynomial in the acute angle's cosine, mirrored where obtuse by the exact cross product"],
  ["half_angle", "polynomial in the half angle's cosine, no case for near lights, fewer digits near π"],
  ["rational", "rational fit of angle over sine on unit vectors, mirrored where obtuse"],
  ["quadratic", "the rational fit for the specular lobe, a quadratic for the diffuse one"],
  ["acos", "the language's arc cosine"],
  ["fast_acos", "the four-term arc cosine that GPUs run"],
  ["arctangent", "the arc tangent of sine and cosine: all digits at every angle"],
]

[[option]]
name = "disk"
summary = "Disks and spheres"
choices = [
  ["cone", "the vector form factor of their cone of directions by one root"],
  ["eigen", "the cone's axes by a cubic, unguarded as published: in the light's plane it is no number"],
]

[[option]]
name = "fit"
summary = "What the transform was fitted on"
choices = [
  ["polygon", "integrals over polygons, the lobe's frame free"],
  ["l3", "the lobe with an L3 norm about its mean direction, as published"],
]

[[option]]
name = "lobes"
summary = "Lobes of the fit"
choices = [
  ["one", "one transformed cosine"],
  ["cosine", "and a signed share of the plain cosine, the diffuse integral reused", { fit = "polygon", frame = "mirror", norm = "middle", axis = "sqrt", brdf = "ggx" }],
  ["two", "two with matrices of their own: half the error of the fit, half as many cycles again", { fit = "polygon", frame = "mirror", norm = "middle", axis = "sqrt", brdf = "ggx" }],
]

[[option]]
name = "frame"
summary = "Frame in which the tables hold the transform"
choices = [
  ["mirror", "about the mirrored view, turned back after the look-up"],
  ["normal", "about the normal"],
]

[[option]]
name = "norm"
summary = "What the stored matrix is divided by"
choices = [
  ["middle", "its middle element: four terms"],
  ["none", "nothing: five terms, the smoothest about the normal", { fit = "l3", frame = "normal", brdf = "ggx", diffuse = "lambert" }],
  ["last", "its last element: four terms that band at grazing angles", { fit = "l3", frame = "normal", brdf = "ggx", diffuse = "lambert" }],
]

[[option]]
name = "axis"
summary = "View angles of the tables' rows"
choices = [
  ["sqrt", "over √(1 − cos θ)"],
  ["cos", "over cos θ", { fit = "l3", frame = "normal", brdf = "ggx", diffuse = "lambert" }],
  ["theta", "over θ", { fit = "l3", frame = "normal", brdf = "ggx", diffuse = "lambert" }],
]

[[option]]
name = "fresnel"
summary = "Where Schlick's Fresnel term is taken"
choices = [
  ["direction", "towards the light's part of the lobe, tending to the lobe's average as the light covers it"],
  ["lobe", "averaged over the whole lobe, wherever the light is"],
]

[[option]]
name = "texture"
summary = "Where the texture of a light is looked up"
choices = [
  ["normal", "along the polygon's normal, as the paper does"],
  ["vector", "along the vector form factor, as the talk proposes"],
]

[[option]]
name = "border"
summary = "What a look-up beside the light's edge finds"
choices = [
  ["yes", "the texture blurred around the light too"],
  ["no", "the nearest place on the light"],
]

[tables]
ltc_matrix = "ltc_{brdf}_{fit}_{lobes}_lobe_{frame}_{norm}_{axis}.exr"
ltc_terms = "ltc_{brdf}_{fit}_{lobes}_lobe_{axis}_terms.exr"
ltc_diffuse_matrix = "ltc_{diffuse}_diffuse_{fit}_one_lobe_normal_middle_sqrt.exr"
ltc_diffuse_terms = "ltc_{diffuse}_diffuse_{fit}_one_lobe_sqrt_terms.exr"
sphere = "sphere.exr"

[published]
sphere = "table"
edge = "rational"
disk = "eigen"
fit = "l3"
frame = "normal"
fresnel = "lobe"

[ideal]
sphere = "exact"
edge = "arctangent"
disk = "cone"
norm = "none"

[[departs]]
law = "point_limit"
lobe = "diffuse"
when = { diffuse = "disney" }
error = 0.012
why = "the fitted lobe"

[[departs]]
law = "point_limit"
lobe = "specular"
error = 0.49
why = "the fitted lobe"

[[departs]]
law = "additive"
error = 0.044
why = "a proxy sphere in place of each half, where the horizon crosses it"
---*/
#include "brdf.glsl"
#include "ltc_tables.glsl"
#include "fresnel"
#include "edge"
#include "sphere"
#include "clipped_proxy.glsl"
#include "disk"
#include "ltc_shading.glsl"
#include "shown_texture.glsl"
#if EFFECT_POLYGON
#include "polygon_light.glsl"
#endif

// Both lobes with one transformed cosine for the specular.
Radiance ShadeLobe(Surface surface, Light light, ShadingFrame frame, LtcCell cell) {
  float form_factor;
  vec3 transformed;
#if EFFECT_TEXTURED
  vec3 whole_transformed = vec3(0.0);  // unclipped
#endif
#if EFFECT_POLYGON
  if (light.shape == SHAPE_POLYGON) {
    PolygonView view = ViewPolygon(light, surface.position, frame);
    vec3 f = PolygonVector(light, view, true);
    form_factor = LambertProxy(MakeVectorFormFactor(f, f.z));
    vec3 lobe = PolygonVector(light, TransformPolygon(cell.m, view), false);
    transformed = vec3(lobe.x, lobe.y, ClippedProxy(MakeVectorFormFactor(lobe, lobe.z)));
  } else
#endif
  {
#if EFFECT_RECTANGLE
#if EFFECT_DISK || EFFECT_SPHERE
  if (light.shape == SHAPE_RECTANGLE)
#endif
  {
    RectangleView view = ViewRectangle(light, surface.position, frame.tangent, frame.bitangent, frame.normal);
    form_factor = LambertProxy(LambertVector(view));
    VectorFormFactor whole = ParallelogramVector(LtcTransform(cell.m, view.center), LtcTransform(cell.m, view.half_a), LtcTransform(cell.m, view.half_b), view.small);
    transformed = vec3(whole.f.x, whole.f.y, ClippedProxy(whole));
#if EFFECT_TEXTURED
    whole_transformed = whole.f;
#endif
  }
#if EFFECT_DISK || EFFECT_SPHERE
  else
#endif
#endif
#if EFFECT_DISK || EFFECT_SPHERE
  RoundLightFactors(light, surface.position, frame, cell, form_factor, transformed);
#endif
  }
  Radiance radiance = LtcRadiance(surface, light, frame, cell, form_factor, transformed);
#if EFFECT_TEXTURED
  RectangleView view = ViewRectangle(light, surface.position, frame.tangent, frame.bitangent, frame.normal);
#if TEXTURE_VECTOR
  vec3 vector = ParallelogramVector(view.center, view.half_a, view.half_b, view.small).f;
#else
  vec3 vector = vec3(0.0);
#endif
  radiance = ShowTexture(radiance, light, view, cell.m, vector, whole_transformed);
#endif
  return radiance;
}

#include "ltc_light.glsl"
