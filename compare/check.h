// Image tests: every variant against its own stored image (has it changed?) and against the truth, within a
// band (is it still as right, and as wrong, as it was?). And every default form through the hard families (compare/stress.h).
#pragma once

#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compare/context.h"
#include "compare/results.h"
#include "compare/stress.h"
#include "glsl/shader_library.h"
#include "glsl/variant.h"

namespace arealab {

// How far an image may be from its golden, in OpenImageIO's terms (idiff's fail, failpercent and hardfail). A
// channel of a lobe differs by |a − b| / max(|b|, floor × the mean of the golden's lit values in that lobe).
struct GoldenTolerance {
  // Ten times the rounding of the stored halves, 2⁻¹¹, to leave room for a Mesa or a CPU that rounds
  // otherwise. The worst that rounding may do is what the same text in double shows: over all scenes and
  // variants it moves 21 of 2272 pixels by more than this (the published rational edge under the strip
  // light), elsewhere at most 13. llvmpipe with vectors of 128 instead of 256 bits moves none at all.
  double threshold = 5e-3;
  double floor = 0.01;  // below a hundredth of the mean nobody sees a difference
  // Of the lit pixels: the 21 above, and on another rasteriser pixels on a silhouette, or where a technique
  // is not continuous, that fall on the other side.
  double fraction = 0.01;
  // × the lobe's peak. A pixel that changed sides takes a neighbour's value, which is seldom near the peak; a
  // firefly is above it.
  double hard = 0.5;
};

// The relative RMSE that a lobe may have. Nothing is within a band that was not measurable but another such
// figure.
struct Band {
  double low = kNotMeasured, measured = kNotMeasured, high = kNotMeasured;

  bool Holds(double rel_rmse) const;
};

// [0.8 × measured − 1e-4, 1.25 × measured + 1e-4], not below 0. 1e-4 is the tolerance asked of the truth: a
// figure below it is the truth's error as much as the technique's.
Band BandAround(double rel_rmse);

enum class CheckKind {
  kShader,            // the variant does not compile or does not run
  kNonfinite,         // NaN or Inf in the image or the golden
  kMissingGolden,     // no stored image
  kUnreadableGolden,  // a stored image that cannot be read
  kSize,              // a stored image of another size
  kGolden,            // differs from the stored image
  kStaleGolden,       // a stored image that no variant asks for
  kMissingBand,
  kBand,       // the error against the truth left its band
  kStaleBand,  // a band that no variant asks for
  kHardCase,   // a hard family or path exceeds its bounds
};

// "golden", "missing golden", …: as printed.
const char* Name(CheckKind kind);

struct CheckFailure {
  CheckKind kind;
  std::string message;  // one line
};

// Of `image` against `golden`: nothing where it passes. Sizes and non-finite pixels fail before any
// difference is taken.
std::optional<CheckFailure> TestGolden(const RadianceImage& image, const RadianceImage& golden,
                                       const GoldenTolerance& tolerance = {});

// One variant on one scene or through one hard family or path, or a stored file that belongs to none.
struct CheckCase {
  std::string scene, variant;  // variant: canonical; scene "hard cases": with a family or path
  std::string hard;            // the family or path, "contact", "path sinking"; empty of an image
  std::string rerun;           // the command that runs this case alone; empty for a stale file
  double exposure = 0.0;  // EV
  std::vector<CheckFailure> failures;
  std::vector<std::string> changes;                           // what an update rewrote, one line each
  std::shared_ptr<const RadianceImage> image, golden, truth;  // null where there is none
  std::shared_ptr<const std::vector<glm::vec3>> emission;
  std::shared_ptr<const FamilyResult> family;  // of a hard family that failed, with its pictures

  std::string Title() const;  // "gloss: ltc", "hard cases: ltc: contact"
};

struct CheckResult {
  std::string renderer, golden_renderer;  // GL_RENDERER now, and when the goldens were made
  std::vector<CheckCase> cases;
  int checked = 0;      // images
  int hard = 0;         // hard families and paths
  int unsupported = 0;  // pairs of scene and variant that the technique refuses

  int failures() const;
};

// The size of every golden: large enough for each scene's question to show, small enough for the whole set to
// stay below 3 MB and its check below a minute.
constexpr glm::ivec2 kCheckSize{64, 64};

struct CheckOptions {
  std::vector<std::filesystem::path> scenes;
  std::vector<Variant> variants;
  std::filesystem::path golden;  // SCENE/VARIANT.exr and bands.json
  bool all_scenes = false;    // nothing was left out: a golden of a scene that is not among `scenes` is stale
  bool all_variants = false;  // the same for variants
  bool update = false;        // rewrite goldens and bands, and remove stale ones; no hard cases then
  std::int64_t hard_cases = 0;  // of each technique's default form among `variants`; 0: none
  // What the commands that rerun a case repeat: " --glsl mine"; of images alone " --golden kept".
  std::string repeated, repeated_of_images;
  glm::ivec2 size = kCheckSize;
  std::function<void(const std::string&, double)> progress;  // what is being done, fraction of the whole
};

// Renders and tests. The truth is computed anew, at the goldens' size: no cache can be stale here. With
// `update` each file is replaced in one step, and only non-finite images and shaders that do not run are
// failures; what these had before stays. Throws InputError where the golden folder is missing, is not one
// (update) or its bands.json is no JSON of ours, where two scenes have one name, and where no variant
// supports any scene.
CheckResult Check(Context& context, const ShaderLibrary& library, const CheckOptions& options);

}  // namespace arealab
