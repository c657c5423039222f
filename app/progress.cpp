#include "app/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace arealab {
namespace {

constexpr int kBarWidth = 24;
constexpr std::chrono::milliseconds kInterval(100);  // between redraws: smooth to the eye, free of cost

std::string TimeLeft(double seconds) {
  const int whole = static_cast<int>(seconds + 0.5);
  return whole >= 60 ? fmt::format("{}:{:02} min left", whole / 60, whole % 60) : fmt::format("{} s left", whole);
}

}  // namespace

Progress::Progress() : terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void Progress::Show(const std::string& what, double fraction) {
  const Clock::time_point now = Clock::now();
  if (!terminal_ || (shown_ && now - last_ < kInterval)) return;
  shown_ = true;
  last_ = now;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const int filled = static_cast<int>(fraction * kBarWidth);
  const std::string left = fraction > 0.02 ? TimeLeft(elapsed * (1.0 - fraction) / fraction) : "";
  fmt::print(stderr, "\r\033[K{:3.0f} % [{:<{}}] {}  {}", fraction * 100.0, std::string(static_cast<std::size_t>(filled), '='),
             kBarWidth, left, what);
  std::fflush(stderr);
}

}  // namespace arealab
