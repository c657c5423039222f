/*---
summary = "s"
citation = "c"
author_note = "n"
shapes = ["rectangle"]
lobes = ["diffuse", "specular"]
brdfs = ["ggx"]
effects = ["two_sided", "fresnel"]
exact = ["lambert_rectangle", "point_limit"]
yardstick = true
[[option]]
name = "norm"
summary = "x"
choices = [["exact", "slow"], ["fast", "quick", { fit = "l3" }]]
[[option]]
name = "fit"
summary = "y"
choices = [["polygon", "a"], ["l3", "b", { brdf = "ggx", shape = "rectangle" }]]
[published]
norm = "fast"
fit = "l3"
[ideal]
norm = "exact"
[tables]
matrix = "ltc_{brdf}_{fit}.exr"
---*/
float f;
