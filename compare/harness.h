// The harness: identical scenes through every variant, each measured against the truth and against the others.
#pragma once

#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compare/context.h"
#include "compare/cost.h"
#include "compare/results.h"
#include "compare/shadowed_truth.h"
#include "compare/timing.h"
#include "compare/truth.h"
#include "glsl/renderer.h"
#include "glsl/shader_library.h"
#include "glsl/variant.h"

namespace arealab {

struct CompareOptions {
  std::vector<std::filesystem::path> scenes;
  std::vector<Variant> variants;
  glm::ivec2 size{512, 512};
  TruthOptions truth;
  ShadowOptions shadow;
  std::filesystem::path cache;                               // folder of truths that are already known
  bool split = false;  // say whose error it is: two more pictures of each variant, in double
  std::optional<Variant> timed_against;                      // `point`, where the passes are to be timed
  TimingOptions timing;
  double saving_seconds = 0.0;                               // of the clock, per variant, to time it against its program with every effect; 0: not
  std::shared_ptr<const CostMeter> cost;                     // what compiles for GPUs that are not here; may be null
  std::function<void(const std::string&, double)> progress;  // what is being done, fraction of the whole
  // Gets each scene, in their order, once all is known of it, while the next is being shaded; it may take its images away.
  std::function<void(SceneResult&)> done;
};

// Renders, integrates and measures. Everything in the result is filled but `command`, `version` and `date`.
Results Compare(Context& context, const ShaderLibrary& library, const CompareOptions& options);

// The radiance of the emitters and of the sky that the camera sees directly, per pixel.
std::vector<glm::vec3> EmissionImage(const Scene& scene, const SurfacePixels& pixels);

// One figure of a variant's total error by its name in results.json ("rel_rmse", "bias" without its sign, …).
// Throws InputError that lists the names.
double MetricByName(const ErrorMetrics& metrics, const std::string& name);

}  // namespace arealab
