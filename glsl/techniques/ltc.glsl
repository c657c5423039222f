/*---
summary = "Linearly transformed cosines, clipped exactly at the horizon"
citation = "Heitz et al. 2016; Hill & Heitz 2016; Heitz & Hill 2017, 2017b; Lambert 1760"
author_note = "Published: 16-case clip, rational edge, disks by a cubic and a proxy sphere (no exact clip was), tubes as a line (their discs at the ends left out: a tube here is open), tables fitted with an L3 norm, Fresnel averaged over the lobe; stored as their code ships it (the talk ends at norm=none+axis=cos). Ours: clip without cases in the light's plane, disks and spheres by their cone and exactly clipped, tubes by their outline in place of a line, mirrored cosine edge, tables fitted on polygons and stored in the mirror frame, Fresnel towards the light. Of a textured light's prefilter the paper's idea is kept (one look-up a lobe, its level by distance²/area), the kernel is the cosine lobe's own, normalised over the light."
shapes = ["rectangle", "disk", "sphere", "polygon", "ellipse", "tube"]
lobes = ["diffuse", "specular"]
brdfs = ["ggx", "ggx_separable", "beckmann", "blinn_phong", "ward", "phong"]
diffuse_brdfs = ["lambert", "disney"]
effects = ["two_sided", "fresnel", "textured"]
exact = ["lambert_rectangle", "lambert_disk", "lambert_sphere", "lambert_polygon", "lambert_ellipse", "point_limit", "mirror_limit", "additive"]

[[option]]
name = "clip"
summary = "Clipping of rectangles at the horizon; polygons are streamed, or not clipped"
choices = [
  ["arc", "in the light's plane without cases, the closing side as an arc"],
  ["switch", "one case for each set of corners above the horizon"],
  ["stream", "on the fly, side by side as the edges are added"],
  ["none", "none: what is below subtracts"],
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
  ["exact", "the cone of their directions by one root, clipped exactly"],
  ["proxy", "the cone's axes by a cubic, the proxy sphere from a table, unguarded as published: in the light's plane it is no number"],
]

[[option]]
name = "tube"
summary = "Tubes"
choices = [
  ["outline", "the outline of what is seen of the wall, its rims in three chords each, streamed"],
  ["strip", "the flat strip between the lines of contact, as a rectangle: the rims' bulges are left out"],
  ["line", "a line as wide as a thin cylinder is seen: too bright where the tube is thick or near"],
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
  ["cosine", "and a signed share of the plain cosine, the diffuse integral reused", { fit = "polygon", frame = "mirror", norm = "middle", axis = "sqrt", horizon = "lobe", brdf = "ggx" }],
  ["two", "two with matrices of their own: half the error of the fit, half as many cycles again", { fit = "polygon", frame = "mirror", norm = "middle", axis = "sqrt", horizon = "lobe", brdf = "ggx" }],
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
name = "horizon"
summary = "Which horizon clips the specular lobe"
choices = [
  ["lobe", "the transformed lobe's own"],
  ["true", "the surface's too, both streamed, with tables fitted for it", { fit = "polygon", lobes = "one", frame = "mirror", brdf = "ggx", diffuse = "lambert", shape = "rectangle" }],
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
ltc_matrix = "ltc_{brdf}_{fit}_{lobes}_{horizon}_{frame}_{norm}_{axis}.exr"
ltc_terms = "ltc_{brdf}_{fit}_{lobes}_{horizon}_{axis}_terms.exr"
ltc_diffuse_matrix = "ltc_{diffuse}_diffuse_{fit}_one_lobe_normal_middle_sqrt.exr"
ltc_diffuse_terms = "ltc_{diffuse}_diffuse_{fit}_one_lobe_sqrt_terms.exr"
sphere = "sphere.exr"

[published]
clip = "switch"
edge = "rational"
disk = "proxy"
tube = "line"
fit = "l3"
frame = "normal"
fresnel = "lobe"

[ideal]
clip = "stream"
edge = "arctangent"
disk = "exact"
norm = "none"

[[departs]]
law = "lambert_rectangle"
when = { clip = "none" }
error = 0.045
why = "what lies below the horizon counts"

[[departs]]
law = "lambert_rectangle"
when = { edge = "quadratic" }
error = 0.0027
why = "the edge fit"

[[departs]]
law = "lambert_polygon"
when = { clip = "none" }
error = 0.11
why = "what lies below the horizon counts"

[[departs]]
law = "lambert_polygon"
when = { edge = "quadratic" }
error = 0.0051
why = "the edge fit"

[[departs]]
law = "lambert_disk"
when = { disk = "proxy" }
error = 0.019
why = "a proxy sphere where the horizon crosses the disk"

[[departs]]
law = "lambert_ellipse"
when = { disk = "proxy" }
error = 0.026
why = "a proxy sphere where the horizon crosses the ellipse"

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
law = "mirror_limit"
when = { tube = "line", shape = "tube" }
error = 0.92
why = "a line has no width to be reflected: across it the light goes on as far as the lobe does"

[[departs]]
law = "additive"
when = { clip = "none" }
error = 0.082
why = "the part below the horizon is cut off for each half as a whole"

[[departs]]
law = "additive"
lobe = "diffuse"
when = { edge = "quadratic" }
error = 0.0055
why = "the edge fit"

[[departs]]
law = "additive"
lobe = "specular"
when = { fresnel = "direction", clip = ["arc", "switch", "stream"] }
error = 0.0088
why = "each half has its own direction for the Fresnel term"
---*/
#include "brdf.glsl"
#include "ltc_tables.glsl"
#include "fresnel"
#include "edge"
#include "clip"
#include "horizon"
#include "disk"
#include "ltc_shading.glsl"
#include "shown_texture.glsl"
#if EFFECT_POLYGON || EFFECT_TUBE
#include "streamed_outline.glsl"
#endif
#if EFFECT_POLYGON
#include "polygon_light.glsl"
#endif
#if EFFECT_TUBE
#include "light_cone.glsl"
#include "tube_view.glsl"
#include "tube"
#endif

// Both lobes with one transformed cosine for the specular.
Radiance ShadeLobe(Surface surface, Light light, ShadingFrame frame, LtcCell cell) {
  float form_factor;
  vec3 transformed;
#if EFFECT_TUBE && TUBE_STRIP
  if (light.shape == SHAPE_TUBE) {
    TubeView tube = ViewTube(light, surface.position);
    if (!Lit(SeesTube(light, tube))) return Radiance(vec3(0.0), vec3(0.0));
    light = StripOfTube(light, tube);
  }
#endif
#if EFFECT_TUBE && !TUBE_STRIP
  if (light.shape == SHAPE_TUBE) {
    TubeFactors(light, surface.position, frame, cell.m, form_factor, transformed);
  } else
#endif
#if EFFECT_POLYGON
  if (light.shape == SHAPE_POLYGON) {
    PolygonView view = ViewPolygon(light, surface.position, frame);
#if CLIP_NONE || !EFFECT_HORIZON
    form_factor = UnclippedPolygon(light, view, true).z;
#else
    form_factor = ClippedPolygon(light, view, true).z;
#endif
#if CLIP_NONE
    transformed = UnclippedPolygon(light, TransformPolygon(cell.m, view), false);
#else
    transformed = ClippedPolygon(light, TransformPolygon(cell.m, view), false);
#endif
  } else
#endif
  {
#if EFFECT_RECTANGLE || (EFFECT_TUBE && TUBE_STRIP)
#if EFFECT_DISK || EFFECT_SPHERE
  if (light.shape == SHAPE_RECTANGLE)
#endif
  {
    RectangleView view = ViewRectangle(light, surface.position, frame.tangent, frame.bitangent, frame.normal);
    form_factor = ClippedLambert(view);
    transformed = LobeVector(cell.m, view);
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
  radiance = ShowTexture(radiance, light, view, cell.m, LobeVector(vec4(1.0, 0.0, 0.0, 1.0), view), transformed);
#else
  radiance = ShowTexture(radiance, light, view, cell.m, vec3(0.0), transformed);
#endif
#endif
  return radiance;
}

#include "ltc_light.glsl"
