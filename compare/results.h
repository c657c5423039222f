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

struct Estimate {  // a median with its 95 % bootstrap interval
  double value = kNotMeasured, low = kNotMeasured, high = kNotMeasured;
};

struct Timing {  // of the lighting pass alone
  Estimate ns_per_pixel, ratio_to_point;
  // Less a pass that reads the same G-buffer and writes it through; the ratio is not measured where point's own net time
  // is within 3 × its spread, and `refusal` says so.
  Estimate net_ns_per_pixel, net_ratio_to_point;
  std::string refusal;
  int rounds = 0;
};

// What a GPU's compiler makes of a shader; compare/cost.h.
struct ShaderCost {
  int instructions = 0, cycles = 0;  // cycles per wave of 64 on one SIMD, the inverse throughput; divergence discounted
  int vgprs = 0, sgprs = 0, spills = 0, branches = 0, bytes = 0;
  bool operator==(const ShaderCost&) const = default;
};

struct GpuCost {
  // Of a pixel that is lit: guards assumed passed, so that what is behind them counts in full.
  ShaderCost core;  // the technique alone: glsl/core.frag
  ShaderCost full;  // the lighting pass
  std::map<std::string, ShaderCost> paths;  // of a branching core, by where the light lies: "above", "crossing", "below" the horizon
  // and, where that matters, far; "far", "near": no side or some is seen under an obtuse angle
};

// Whose error it is, as relative RMSE of the total: the mathematics' (the ideal form in double against the truth), its shortcuts'
// (the variant in double against the ideal form), rounding's (in float against the same text in double).
struct ErrorSplit {
  double model = kNotMeasured, approximation = kNotMeasured, rounding = kNotMeasured;
  // The same in each pixel: |difference| of luminance over the reference's, at least over 1 % of the truth's mean. Empty where not asked for.
  struct Map {
    const char* name;  // "model"
    std::vector<float> magnitude;
  };
  std::vector<Map> maps = {};
  // Of LTC's variants cause by cause as well (compare/ltc_split.h), in its order, the remainder last.
  struct Cause {
    std::string name;
    double rel_rmse = kNotMeasured, bias = kNotMeasured;  // the part's root of Σ² over the truth's; its sum over the truth's: these add up
    std::vector<float> relative;  // signed, of luminance, over the truth's, at least over 1 % of its mean
  };
  std::vector<Cause> causes = {};
};

// What is saved by simulating only the effects that the scene calls for, and what asking each pixel would save beyond that.
struct Saving {
  Estimate time;  // of the lighting pass over that of the program with every effect
  int rounds = 0;
  std::map<std::string, std::pair<int, int>> cycles;  // of both, whole pass, by the GPU's name
  // One way to ask (glsl/per_pixel.h) over the program that the scene calls for, what it costs to ask included.
  struct PerPixel {
    Estimate time;
    std::map<std::string, double> cycles;  // ratio by the GPU's name, an estimate from the share of tiles of each class
    bool Pays() const { return time.high < 1.0; }
  };
  std::map<std::string, PerPixel> per_pixel = {};  // "tiles" and, where horizons matter, "branch"
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
  ErrorSplit split;                       // where asked for
  bool within_truth_error = false;        // error below 4 × the truth's own: not ranked
  Timing time;
  std::optional<Saving> saving;           // where asked for
  std::map<std::string, GpuCost> isa;     // by the GPU's name; empty where not compiled
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
  std::shared_ptr<const RadianceImage> image;

  // A difference that could not be measured, where all light is lost, matters.
  bool Matters() const { return !(rel_rmse < 1e-3); }
};

struct SceneResult {
  std::string name, question, file, unit;  // unit: "W/(m² sr)" or "cd/m²"
  int width = 0, height = 0;
  double exposure = 0.0;             // EV
  std::vector<std::string> effects;  // those that are on
  // What the picture's tiles need (glsl/per_pixel.h), where asked for: a row of tiles after the other from the top.
  int tile_columns = 0;
  std::vector<int> tile_needs;
  int lit_pixels = 0;                // that truth lights
  double truth_relative_error = kNotMeasured, truth_seconds = kNotMeasured;
  bool truth_cached = false;
  bool truth_shadowed = false;  // truth and variants have visibility; then `shadow` is empty
  std::shared_ptr<const RadianceImage> truth;
  std::optional<ShadowResult> shadow;
  std::shared_ptr<const std::vector<glm::vec3>> emission;  // radiance of emitters seen directly, per pixel
  std::vector<VariantResult> variants;
  std::vector<PairResult> pairs;

  // Leaves the figures: of many scenes the images are what fills the memory.
  void ReleaseImages();
};

// The page of the hard cases; compare/stress_page.h.
struct HardCasesPage {
  int techniques = 0, failures = 0;
  std::int64_t cases = 0;  // of each technique
  std::string html;        // hard-cases.html, a page that stands alone; empty: none was made
};

// What one source's text says, checked; compare/claims.h.
struct ClaimsPage {
  std::string name, citation, title;
  int holds = 0, partly = 0, fails = 0, unknown = 0;  // claims by verdict
  std::string html;                                   // claims-NAME.html, a page that stands alone
};

struct Results {
  std::string command;                         // that made them
  std::string version;                         // AreaLab's
  std::string date;                            // ISO 8601
  std::map<std::string, std::string> machine;  // "cpu", "cores", "os", "compiler", library versions
  std::string platform, renderer, gl_version;  // the context
  bool software = true;                        // a CPU draws
  std::string compilers;                       // that the figures of `isa` come from
  std::string no_isa;                          // why there are none
  std::vector<SceneResult> scenes;
  std::vector<ClaimsPage> claims;
  HardCasesPage hard_cases;
};

// results.json: the schema of design.md, version 1, indented; null where not finite or not measured.
std::string ResultsJson(const Results& results);

// results.csv (RFC 4180): one row per scene, variant and lobe; empty where not finite or not measured.
std::string ResultsCsv(const Results& results);

// The scene's variants as aligned columns for a terminal, sorted by total error, the unsupported ones last
// with their reason.
std::string SummaryTable(const SceneResult& scene);

}  // namespace arealab
