// Work that a library may not survive, in a process of its own.
#pragma once

#include <functional>
#include <string>

namespace arealab {

// What `work` returns, run in a fork of this process; its InputError is thrown here too. Where the child crashes, or takes
// more than `seconds` of a processor, an InputError says so: "`what` (its reader ends with signal 11); expected `expected`".
// `work` starts no threads and touches nothing that another thread of this process may hold.
std::string InChild(const std::function<std::string()>& work, int seconds, const std::string& what, const std::string& expected);

}  // namespace arealab
