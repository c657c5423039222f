// results.json as it comes back: from an earlier run, another machine, or someone's editor.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace arealab {

// `text` as an object with "schema": 1 and an array of scenes; `name`, a file's or a part's, begins each complaint. Throws
// InputError with the line where it is no JSON, else with what is missing.
nlohmann::ordered_json ParseResults(const std::string& name, const std::string& text);

// NaN where it is no number.
double NumberOf(const nlohmann::ordered_json& value);

// Whether it is an array of two numbers.
bool IsInterval(const nlohmann::ordered_json& value);

}  // namespace arealab
