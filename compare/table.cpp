#include "compare/table.h"

#include <algorithm>
#include <cstddef>

namespace arealab {
namespace {

// Characters: names and units are UTF-8.
std::size_t Columns(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

}  // namespace

std::string AlignedTable(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows[0].size(), 0);
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size() && (c == 0 || row.size() > 2); ++c) {
      widths[c] = std::max(widths[c], Columns(row[c]));
    }
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line = "  ";
    for (std::size_t c = 0; c < row.size(); ++c) {
      const bool left = c == 0 || row.size() == 2 || c + 1 == row.size();
      const std::string pad(widths[c] > Columns(row[c]) && row.size() >= c ? widths[c] - Columns(row[c]) : 0,
                            ' ');
      line += (c > 0 ? "  " : "") + (left ? row[c] + pad : pad + row[c]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

}  // namespace arealab
