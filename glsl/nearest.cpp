#include "glsl/nearest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "scenes/edit_distance.h"

namespace arealab {

std::string ExpectedNames(std::string_view wrong, const std::vector<std::string>& names) {
  if (names.empty()) return "nothing";
  const auto nearest = std::min_element(names.begin(), names.end(), [&](const auto& a, const auto& b) {
    return EditDistance(wrong, a) < EditDistance(wrong, b);
  });
  // Half of the letters wrong is no longer a slip of the finger.
  const bool likely = 2 * EditDistance(wrong, *nearest) <= std::max(wrong.size(), nearest->size());
  return fmt::format("{}{}", fmt::join(names, ", "),
                     likely ? fmt::format(" (did you mean \"{}\"?)", *nearest) : "");
}

}  // namespace arealab
