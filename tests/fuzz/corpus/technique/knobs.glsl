/*---
summary = "s"
citation = "c"
author_note = "n"
shapes = ["rectangle"]
lobes = ["diffuse"]
brdfs = ["ggx"]
[[knob]]
name = "bias"
label = "Bias"
unit = "m"
initial = 0.0
min = -1.0
max = 1.0
[[departs]]
law = "mirror_limit"
lobe = "diffuse"
when = { shape = ["rectangle"], brdf = "ggx" }
error = 0.35
why = "w"
---*/
