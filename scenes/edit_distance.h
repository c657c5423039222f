// How unlike two words are: error messages suggest the name that was probably meant.
#pragma once

#include <cstddef>
#include <string_view>

namespace arealab {

// Letters to insert, delete or replace to turn a into b [Levenshtein 1966].
std::size_t EditDistance(std::string_view a, std::string_view b);

}  // namespace arealab
