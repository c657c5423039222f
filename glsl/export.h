// A variant's lighting pass as text that stands alone: for a renderer that is not ours.
#pragma once

#include <string>
#include <vector>

#include "glsl/effects.h"
#include "glsl/variant.h"

namespace arealab {

enum class GlslDialect { kCore330, kEs300 };

struct ExportedShader {
  std::string text;                 // begins with #version; ends with main()
  std::vector<std::string> tables;  // that it samples, by their names in the technique's header
  std::vector<std::string> knobs;   // that it reads
  std::vector<std::string> light_textures;  // forms of the lights' textures that it samples (glsl/light_textures.h)
};

// The lighting pass (glsl/lighting.frag) of the variant as one text: no include, no condition that the effects or the options decide,
// only functions, constants and uniforms that are used; comments and citations stay. Its forced effects have the last word. An array
// of lights holds at most `lights`. Throws InputError as Expand does.
ExportedShader ExportShader(const ShaderLibrary& library, const Variant& variant, const std::vector<Effect>& effects, Brdfs brdfs,
                            GlslDialect dialect, int lights);

}  // namespace arealab
