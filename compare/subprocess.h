// Runs another program to its end, with bytes in and bytes out.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace arealab {

struct ProcessResult {
  bool started = false;  // false: there is no such program
  int status = -1;       // exit status where it ended by itself
  int signal = 0;        // what ended it otherwise
  std::string messages;  // its standard output and error
  std::string data;      // what it wrote to descriptor 3
};

// `command`: the program (searched in PATH where it has no '/') and its arguments. `environment` is set on top of ours;
// an empty value removes the name. The program reads `input` as its standard input; nothing else of ours is open in it.
ProcessResult RunProcess(const std::vector<std::string>& command,
                         const std::vector<std::pair<std::string, std::string>>& environment, std::span<const char> input);

}  // namespace arealab
