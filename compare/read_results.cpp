#include "compare/read_results.h"

#include <fmt/format.h>

#include <algorithm>

#include "compare/results.h"
#include "scenes/error.h"

namespace arealab {

using Json = nlohmann::ordered_json;

Json ParseResults(const std::string& name, const std::string& text) {
  constexpr int kDeepest = 32;  // what is written needs 9; copying and writing recurse
  const char* const expected = "expected a results.json of `arealab compare` or `arealab sweep`";
  Json results;
  try {
    results = Json::parse(text, [&](int depth, Json::parse_event_t, const Json&) {
      if (depth > kDeepest) throw InputError(fmt::format("{}: nested more than {} deep; {}", name, kDeepest, expected));
      return true;
    });
  } catch (const Json::parse_error& error) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    throw InputError(fmt::format("{}:{}: not JSON; {}", name, 1 + std::count(text.begin(), end, '\n'), expected));
  } catch (const Json::exception&) {  // a number that no double holds
    throw InputError(fmt::format("{}: a number out of range; {}", name, expected));
  }
  const bool ours = results.is_object() && results.contains("schema") && results["schema"] == 1 && results.contains("scenes") &&
                    results["scenes"].is_array();
  if (!ours) throw InputError(fmt::format("{}: no results of schema 1 with scenes; {}", name, expected));
  return results;
}

double NumberOf(const Json& value) { return value.is_number() ? value.get<double>() : kNotMeasured; }

bool IsInterval(const Json& value) {
  return value.is_array() && value.size() == 2 && value[0].is_number() && value[1].is_number();
}

}  // namespace arealab
