// Columns for a terminal.
#pragma once

#include <string>
#include <vector>

namespace arealab {

// Two blanks, then the cells: the first and last column to the left, the others to the right, as wide as the widest cell
// (characters, not bytes). A row of two cells is a name and a remark that may be any length.
std::string AlignedTable(const std::vector<std::vector<std::string>>& rows);

}  // namespace arealab
