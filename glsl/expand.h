// The include expander: one GLSL text from the files of a ShaderLibrary, and the map back to the author's lines.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "glsl/shader_library.h"
#include "glsl/variant.h"

namespace arealab {

// kDouble: the same text in fp64 (glsl/fp64_rewrite.h). kHalf: with every result rounded to a half float (glsl/fp16_rewrite.h).
enum class Precision { kFloat, kDouble, kHalf };

// The file of lines that the host writes: they have no author.
inline constexpr std::string_view kHostFile = "the host's prologue";

struct ExpandedSource {
  struct Origin {
    std::string file;  // as ShaderLibrary::DisplayPath gives it
    int line = 0;      // 1-based
  };
  std::string text;             // begins with #version
  std::vector<Origin> origins;  // origins[i]: where line i + 1 of text comes from

  // The driver's log with each "0:LINE" or "0(LINE)" or "0:LINE(COL)" replaced by the author's file:line.
  std::string RewriteLog(const std::string& log) const;
};

// Expands `main` ("lighting.frag"): `#include "technique"` is the variant's file, `#include "OPTION"` the chosen file
// of that option, `#include "platform"` glsl/platform_float.glsl, platform_double or platform_half, `#include "brdf"`, "importance_cone" and "specular_albedo" the scene's BRDF in the folder of that name, "diffuse" its diffuse one, any other a name in the
// library.
// Each file is included once; a cycle or an unknown include throws InputError with file and line.
// `effects` are all EFFECT_* names with 0 or 1; they and the option defines head the text.
ExpandedSource Expand(const ShaderLibrary& library, const std::string& main, const Variant& variant,
                      const std::vector<std::pair<std::string, int>>& effects, Precision precision,
                      Brdfs brdfs = {});

}  // namespace arealab
