// What became worse since an earlier results.json: less accurate, slower, more cycles.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "compare/results.h"

namespace arealab {

struct BaselineReport {
  std::vector<std::string> worse;  // a line each, "gloss: ltc: error 7.05 % → 7.31 %"
  std::vector<std::string> notes;  // what could not be compared, and why
  int compared = 0;                // figures
};

// Beyond the noise: a relative RMSE that grew by more than both truths' own errors and 0.1 % of itself; a measured ratio whose
// 95 % interval lies above the former one; any more cycles from the same compilers. What the earlier run has and this one has
// not is noted. Throws InputError where the file is none that `compare` wrote, or a scene has another size.
BaselineReport CompareWithBaseline(const Results& results, const std::filesystem::path& baseline);

}  // namespace arealab
