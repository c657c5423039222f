// Names that exist, for an error message about one that does not.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace arealab {

// "arc, switch, none", and where one of them is at most a few letters away from `wrong`: "arc, switch, none
// (did you mean "switch"?)". Empty `names`: "nothing".
std::string ExpectedNames(std::string_view wrong, const std::vector<std::string>& names);

}  // namespace arealab
