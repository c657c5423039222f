// Whose error the picture of a linearly transformed cosine is, cause by cause: signed pictures, each against a reference computed for it.
//
// In this order. T is the truth and P the variant's picture; E is the lobes' own integral over the lights, on the CPU in double, from a
// table as it is looked up: outlines clipped side by side, arc tangents, nothing of the shading text.
//   fit            E of a table kLtcRefinement times as fine, clipped at the surface's horizon and where the lobe ends, less T;
//                  with it the choice of the Fresnel term, whose average is part of the table
//   interpolation  E of the variant's own table less that
//   horizon        E as the variant treats the horizon (the lobe's end alone, none, a proxy sphere by Snyder's closed form, and in the
//                  variant's form of it less the exact one's, both by the text in double) less E clipped at both
//   edge           the variant's text in double less the same text with edge=arctangent
//   texture        the text in double under its textures less the same without them × the truth's ratio of both, per lobe
//   rounding       P less its text in double
//   remainder      P − T less all of these: what E does not know of the text, and the references' own errors
// Where lights show textures the first four are taken without them and multiplied by that ratio, so that the parts still add up.
#pragma once

#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compare/truth.h"
#include "glsl/fit.h"
#include "glsl/renderer.h"
#include "glsl/shader_library.h"
#include "glsl/variant.h"

namespace arealab {

constexpr int kLtcRefinement = 3;  // what interpolation is left in the reference is a ninth of the variant's

enum class LtcHorizon { kBoth, kLobe, kNone, kProxy };

// What E needs to know of a variant.
struct LtcForm {
  LtcTables tables;
  bool fresnel_direction = true;
  // Of rectangles and polygons, and of round lights.
  LtcHorizon straight = LtcHorizon::kBoth, round = LtcHorizon::kBoth;
};

struct LobePictures {
  std::vector<glm::dvec3> diffuse, specular;
};

// E. Lights are taken without their textures; a tube or a sphere around the point gives nothing.
LobePictures LtcPicture(const Scene& scene, const SurfacePixels& pixels, const LtcForm& form);

// The variant's table from the library, and the same lobes fitted kLtcRefinement times as densely, at the roughnesses of the picture
// alone (two lobes at all rougher ones too, on which theirs hang); kept in the cache.
LtcTables OwnTables(const Variant& variant, const ShaderLibrary& library, Brdf brdf);
LtcTables FineTables(const LtcTables& own, const SurfacePixels& pixels, const std::filesystem::path& cache);

// A sentence that says why the picture is not split, or nothing: only LTC's variants are, under lights that E knows.
std::optional<std::string> WhyNoCauses(const Variant& variant, const Scene& scene);

struct CausePicture {
  std::string name;
  std::vector<glm::dvec3> error;  // signed, of both lobes together
};

// `image` is P, `truth` T. The renderer has drawn the scene, and has again afterwards.
std::vector<CausePicture> SplitByCause(Renderer& renderer, const ShaderLibrary& library, const Variant& variant, const Scene& scene,
                                       glm::ivec2 size, const RadianceImage& image, const RadianceImage& truth,
                                       const TruthOptions& truth_options, const std::filesystem::path& cache);

}  // namespace arealab
