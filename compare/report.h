// Writes results.json, results.csv, the images and the page that shows them, as one folder that moves into
// place whole.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "compare/results.h"

namespace arealab {

// Throws InputError where `directory` cannot become a report: it is a file, or a folder that holds anything
// but an earlier report, or nothing can be written beside it. Creates its parents. Call it before long work.
void CheckReportDirectory(const std::filesystem::path& directory);

// Writes to a temporary folder beside `directory`, which is renamed at the end; an earlier report there is replaced only
// then, in one step.
//   index.html               the page; opens from disk, offline
//   results.json, results.csv
//   images/SCENE/VARIANT.exr layers diffuse and specular (compare/image_files.h); VARIANT "truth" is the
//   ground truth images/SCENE/VARIANT.png the picture at the scene's exposure, emitters included
//   plots/SCENE.svg, plots/all scenes.svg  accuracy against cost, where a cost is known (compare/pareto.h)
//   images/SCENE/VARIANT-model.png, -approximation.png, -rounding.png  where the error was split
//   images/SCENE/VARIANT-cause-fit.png, …  the same of LTC's variants by cause
//   claims-SOURCE.html       what each source says and whether it holds (compare/claims.h)
//   hard-cases.html          techniques by hard families (compare/stress_page.h)
//   data/SCENE/VARIANT.js    what the page loads: the same values as the EXR's
// VARIANT "truth-shadowed" is the truth with visibility, where a shadow matters; its values are within 0.8 % of
// the computed ones, a fraction of their own error.
// Names are the scene's and the variant's, with '_' for what a file name should not hold.
class ReportWriter {
 public:
  // Both throw InputError where the folder cannot be written.
  explicit ReportWriter(const std::filesystem::path& directory);
  ~ReportWriter();  // of a report that was not finished nothing stays
  // The pictures of the next scene of the results; they need not be kept after it. One call at a time, from any thread.
  void Add(const SceneResult& scene);
  // The scenes are those that were added, in that order.
  void Finish(const Results& results);

 private:
  struct Pictures;
  struct State;
  std::unique_ptr<State> state_;
};

// All of it at once.
void WriteReport(const Results& results, const std::filesystem::path& directory);

// The page of `arealab sweep`; `results`: its results.json, safe within a script element.
std::string SweepPage(const std::string& results);

}  // namespace arealab
