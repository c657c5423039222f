// What `compare` found: the one structure behind results.json, results.csv and the report.
#pragma once

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "glsl/pixels.h"

namespace arealab {

// NaN where a figure was not measured or is not finite; written as null.
constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

// Of image a against reference b, over the pixels that either lights; definitions in compare/metrics.h.
struct ErrorMetrics {
  double rel_rmse = kNotMeasured, bias = kNotMeasured, relmse = kNotMeasured, mae = kNotMeasured;
  double p99 = kNotMeasured, max = kNotMeasured, flip = kNotMeasured;
  int max_x = -1, max_y = -1;  // the pixel of max
};

struct Timing {  // of the lighting pass alone
  double ns_per_pixel = kNotMeasured, ratio_to_point = kNotMeasured;
  double ratio_low = kNotMeasured, ratio_high = kNotMeasured;  // 95 % interval
  int rounds = 0;
};

struct VariantResult {
  std::string name;        // canonical: "ltc+clip=switch"
  std::string short_name;  // "ltc@published"
  std::string summary;     // the technique's line
  std::string note;        // author's form and ours
  std::string citation;
  bool supported = true;
  std::string reason;  // why not
  int nonfinite_pixels = 0;
  ErrorMetrics total, diffuse, specular;  // against truth
  bool within_truth_error = false;        // error below 4 × the truth's own: not ranked
  Timing time;
  std::shared_ptr<const RadianceImage> image;  // null where not supported
};

struct PairResult {  // of variant b as reference
  std::string a, b;  // canonical names
  double rel_rmse = kNotMeasured;
};

// Truth with visibility beside the unshadowed truth; compare/shadowed_truth.h.
struct ShadowResult {
  // Σ(u−s)/Σu, the share of all light that shadows take; of the unshadowed truth u against the shadowed s.
  double light_lost = kNotMeasured, bias = kNotMeasured, rel_rmse = kNotMeasured;
  // Standard error of a pixel that needed rays, relative to its unshadowed radiance.
  double mean_error = kNotMeasured, p99_error = kNotMeasured;
  double seconds = kNotMeasured;
  bool cached = false;
  std::shared_ptr<const RadianceImage> image;  // null where no shadow matters: rel_rmse below kLeastShadow
};
constexpr double kLeastShadow = 1e-3;

struct SceneResult {
  std::string name, question, file, unit;  // unit: "W/(m² sr)" or "cd/m²"
  int width = 0, height = 0;
  double exposure = 0.0;             // EV
  std::vector<std::string> effects;  // those that are on
  int lit_pixels = 0;                // that truth lights
  double truth_relative_error = kNotMeasured, truth_seconds = kNotMeasured;
  bool truth_cached = false;
  std::shared_ptr<const RadianceImage> truth;
  std::optional<ShadowResult> shadow;
  std::shared_ptr<const std::vector<glm::vec3>> emission;  // radiance of emitters seen directly, per pixel
  std::vector<VariantResult> variants;
  std::vector<PairResult> pairs;
};

struct Results {
  std::string command;                         // that made them
  std::string version;                         // AreaLab's
  std::string date;                            // ISO 8601
  std::map<std::string, std::string> machine;  // "cpu", "cores", "os", "compiler", library versions
  std::string platform, renderer, gl_version;  // the context
  bool software = true;                        // a CPU draws
  std::vector<SceneResult> scenes;
};

// results.json: the schema of design.md, version 1, indented; null where not finite or not measured.
std::string ResultsJson(const Results& results);

// results.csv (RFC 4180): one row per scene, variant and lobe; empty where not finite or not measured.
std::string ResultsCsv(const Results& results);

// The scene's variants as aligned columns for a terminal, sorted by total error, the unsupported ones last
// with their reason.
std::string SummaryTable(const SceneResult& scene);

}  // namespace arealab
