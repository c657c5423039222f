// A progress line with the time left, on standard error; nothing where that is not a terminal.
#pragma once

#include <chrono>
#include <string>

namespace arealab {

class Progress {
 public:
  Progress();
  ~Progress();  // clears the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void Show(const std::string& what, double fraction);  // fraction of the whole work, in [0, 1]

 private:
  using Clock = std::chrono::steady_clock;
  bool terminal_;
  bool shown_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_{};
};

}  // namespace arealab
