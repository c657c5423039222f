// The one exception for bad input or use: the program prints its message as one line and exits with status 2.
#pragma once

#include <stdexcept>
#include <string>

namespace arealab {

// message: "file:line: what is wrong; expected what" where there is a file and a line, else "what; expected
// what".
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace arealab
