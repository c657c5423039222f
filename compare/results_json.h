// results.json as an object, for those who add to it.
#pragma once

#include <nlohmann/json.hpp>

#include "compare/results.h"

namespace arealab {

nlohmann::ordered_json ResultsObject(const Results& results);

// The field `isa` of a variant.
nlohmann::ordered_json IsaObject(const std::map<std::string, GpuCost>& costs);

}  // namespace arealab
