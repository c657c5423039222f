#include "glsl/nearest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

namespace arealab {

namespace {

// Letters to insert, delete or replace to turn a into b [Levenshtein 1966].
std::size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

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
