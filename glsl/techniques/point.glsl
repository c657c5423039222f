/*---
summary = "A point at the light's centre with the light's intensity towards the surface: the baseline"
citation = "far-field limit of an area light; intensity and its cosine as in Drobot 2014, eq. 1.16"
author_note = "published and default form are the same: there is one. Of a textured light its mean"
shapes = ["rectangle", "disk", "sphere", "polygon", "ellipse", "tube"]
lobes = ["diffuse", "specular"]
brdfs = ["ggx", "ggx_separable", "beckmann", "blinn_phong", "ward", "phong"]
diffuse_brdfs = ["lambert", "disney"]
effects = ["two_sided", "fresnel", "many_lights", "textured"]
exact = ["point_limit"]

[[departs]]
law = "mirror_limit"
error = 1.0
why = "a point has no outline: dark but where the mirror ray meets it, brighter there without bound"

[[departs]]
law = "additive"
when = { shape = ["rectangle", "tube"] }
error = 0.56
why = "each half is taken at its own centre"

[[departs]]
law = "additive"
when = { shape = "polygon" }
error = 27.0
why = "each half is taken at its own centre, which may be where the mirror ray meets it"
---*/
#include "far_field.glsl"

Radiance ShadeLight(Surface surface, Light light, vec3 to_view) { return FarField(surface, light, to_view); }
