// What became worse since an earlier results.json: less accurate, slower, more cycles.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/results.h"

namespace arealab {

struct BaselineReport {
  std::vector<std::string> worse;  // a line each, "gloss: ltc: error 7.05 % → 7.31 %"
  std::vector<std::string> notes;  // what could not be compared, and why
  int compared = 0;                // figures
};

// The file of an earlier run, read before this one may replace it. Throws InputError where it is none that `compare` wrote.
struct Baseline {
  explicit Baseline(const std::filesystem::path& path);

  std::filesystem::path file;
  nlohmann::ordered_json results;
};

// Beyond the noise: a relative RMSE that grew by more than both truths' own errors and 0.1 % of itself; a measured ratio whose
// 95 % interval lies above the former one; any more cycles from the same compilers. What the earlier run has and this one has
// not is noted. Throws InputError where a scene has another size, or something is missing.
BaselineReport CompareWithBaseline(const Results& results, const Baseline& baseline);

}  // namespace arealab
