/*---
summary = "s"
citation = t
author_note = "n"
---*/
