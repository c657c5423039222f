/*---
summary = "Arvo's light-field vector of the polygon: its cosine for the diffuse lobe, its direction put into the BRDF for the specular"
citation = "Light field 2013; Arvo 1994; Lambert 1760"
author_note = "Published: the vector normalised, which the text says is what its listing does: form factor and fall-off are lost, a light is as bright from afar as from near; the language's arc cosine, Sutherland-Hodgman clipping. Default: Arvo's vector irradiance as it stands, exact for Lambert. In both, the test for lights wholly above or below comes first, and the specular is the BRDF towards the vector times its irradiance: a highlight of a point, brighter without bound as roughness falls, never the light's own outline. The listing's slips (two names for one polygon, a fixed count of corners, the same test twice) are corrected"
shapes = ["rectangle", "polygon"]
lobes = ["diffuse", "specular"]
brdfs = ["ggx", "ggx_separable", "beckmann", "blinn_phong", "ward", "phong"]
diffuse_brdfs = ["lambert", "disney"]
effects = ["two_sided", "fresnel", "many_lights"]
exact = ["lambert_rectangle", "lambert_polygon", "point_limit", "additive"]

[[option]]
name = "vector"
summary = "What the polygon's edges are summed to"
choices = [
  ["irradiance", "vector irradiance: form factor and fall-off (Arvo's)"],
  ["unit", "its direction alone (the published listing)"],
]

[[option]]
name = "clip"
summary = "Clipping where the light crosses the horizon"
choices = [
  ["arc", "in the light's plane without cases, the closing side as an arc"],
  ["stream", "side by side as the edges are added (Sutherland & Hodgman's, the published one)"],
  ["switch", "one case for each set of corners above the horizon"],
]

[[option]]
name = "edge"
summary = "Angle over sine of the edge integral"
choices = [
  ["mirrored", "polynomial in the acute angle's cosine, mirrored where obtuse by the exact cross product"],
  ["half_angle", "polynomial in the half angle's cosine, no case for near lights, fewer digits near π"],
  ["acos", "the language's arc cosine (the published one)"],
  ["arctangent", "the arc tangent of sine and cosine: all digits at every angle"],
]

[published]
vector = "unit"
clip = "stream"
edge = "acos"

[ideal]
clip = "stream"
edge = "arctangent"

[[departs]]
law = "lambert_rectangle"
when = { vector = "unit" }
error = 9.9
why = "the direction alone: form factor and fall-off are lost"

[[departs]]
law = "lambert_polygon"
when = { vector = "unit" }
error = 14.0
why = "the direction alone: form factor and fall-off are lost"

[[departs]]
law = "point_limit"
when = { vector = "unit" }
error = 21000000.0
why = "as bright from a light of no size"

[[departs]]
law = "additive"
lobe = "diffuse"
when = { vector = "unit" }
error = 0.97
why = "each half is as bright as the whole"

[[departs]]
law = "additive"
lobe = "diffuse"
when = { vector = "irradiance", diffuse = "disney" }
error = 0.0026
why = "the diffuse BRDF in one direction of each half"

[[departs]]
law = "additive"
lobe = "specular"
when = { shape = "rectangle" }
error = 1.0
why = "each half has its own direction"

[[departs]]
law = "additive"
lobe = "specular"
when = { shape = "polygon" }
error = 21.0
why = "each half has its own direction, which may be that of the mirror"

[[departs]]
law = "mirror_limit"
error = 1.0
why = "the highlight is a point's: dark but along the vector, brighter there without bound"
---*/
#include "ltc.glsl"
#include "edge"
#include "clip"
#include "specular_lobe.glsl"
#include "diffuse"
#include "vector_form_factor.glsl"
#include "lit.glsl"
#include "path.glsl"
#if EFFECT_POLYGON
#include "polygon_light.glsl"
#endif

Radiance ShadeLight(Surface surface, Light light, vec3 to_view) {
  Radiance result;
  result.diffuse = vec3(0.0);
  result.specular = vec3(0.0);
  ShadingFrame frame = MakeShadingFrame(surface.normal, to_view);
  vec3 field;  // vector irradiance over π·radiance, world
#if EFFECT_POLYGON
  if (light.shape == SHAPE_POLYGON) {
    PolygonView view = ViewPolygon(light, surface.position, frame);
    float highest = -1e30;
    float lowest = 1e30;
    for (int i = 0; i < light.corner_count; ++i) {
      float height = PolygonCorner(light, view, i).z;
      highest = max(highest, height);
      lowest = min(lowest, height);
    }
    if (WhollyBelow(highest <= 0.0)) return result;
    vec3 f;
    if (WhollyAbove(lowest > 0.0)) {
      f = PolygonVector(light, view, true);
    } else {
      f = ClippedPolygon(light, view, true);
    }
    field = frame.tangent * f.x + frame.bitangent * f.y + frame.normal * f.z;
  } else
#endif
#if EFFECT_RECTANGLE
  {
    RectangleView view = ViewRectangle(light, surface.position, frame.tangent, frame.bitangent, frame.normal);

    // The early test: how far the centre is above the horizon, against how far the corners reach.
    float reach = abs(view.half_a.z) + abs(view.half_b.z);
    if (WhollyBelow(view.center.z <= -reach)) return result;
#if EFFECT_HORIZON
    if (WhollyAbove(view.center.z > reach))
#endif
    {
      vec3 f = LambertVector(view).f;
      field = light.axis_x * f.x + light.axis_y * f.y + light.normal * f.z;
    }
#if EFFECT_HORIZON
    else {
      vec3 f = ClippedVector(view.center, view.half_a, view.half_b, view.small);
      field = frame.tangent * f.x + frame.bitangent * f.y + frame.normal * f.z;
    }
#endif
  }
#else
    return result;  // of nothing else
#endif

  float size2 = dot(field, field);
  if (!Lit(size2 >= 1e-36)) return result;  // (1e-9 of the sky)²: no direction is left in float
  vec3 to_light = field * inversesqrt(size2);
#if VECTOR_UNIT
  field = to_light;
#endif
  float form_factor = AsFormFactor(dot(surface.normal, field));
  result.diffuse = DiffuseAlbedo(surface, to_view, to_light) * light.radiance * form_factor;
  result.specular = SpecularBrdf(surface, to_view, to_light) * light.radiance * (kPi * form_factor);
  return result;
}
