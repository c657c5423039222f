/*---
summary = "s"
citation = "c"
author_note = "n"
shapes = ["rectangle"]
lobes = ["diffuse"]
brdfs = ["ggx"]
---*/
