#include "glsl/shading_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <thread>

namespace arealab {

struct ShadingWatch::Watched {
  std::string file;
  double seconds;
  std::chrono::steady_clock::time_point end;
};

namespace {

double AllowedSeconds() {
  const char* text = std::getenv("AREALAB_SHADER_SECONDS");
  const double seconds = text != nullptr ? std::strtod(text, nullptr) : 0.0;
  return seconds > 0.0 && seconds < 1e6 ? seconds : 600.0;
}

// The shaders that run, and the thread that looks at the clock.
class Watcher {
 public:
  ~Watcher() {
    {
      const std::lock_guard lock(mutex_);
      over_ = true;
    }
    wake_.notify_all();
    if (thread_.joinable()) thread_.join();
  }

  std::list<ShadingWatch::Watched>::iterator Add(std::string file, double seconds) {
    const std::lock_guard lock(mutex_);
    if (!thread_.joinable()) thread_ = std::thread([this] { Watch(); });
    const auto span = std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(seconds));
    return running_.insert(running_.end(), {std::move(file), seconds, std::chrono::steady_clock::now() + span});
  }

  void Remove(std::list<ShadingWatch::Watched>::iterator watched) {
    const std::lock_guard lock(mutex_);
    running_.erase(watched);
  }

 private:
  void Watch() {
    constexpr std::chrono::milliseconds kTick(250);
    std::unique_lock lock(mutex_);
    while (!wake_.wait_for(lock, kTick, [this] { return over_; })) {
      const auto now = std::chrono::steady_clock::now();
      const auto late = std::find_if(running_.begin(), running_.end(), [&](const auto& watched) { return watched.end < now; });
      if (late == running_.end()) continue;
      fmt::print(stderr, "{}:1: the shader has not ended after {:.0f} s; expected one that does (AREALAB_SHADER_SECONDS allows more)\n",
                 late->file, late->seconds);
      std::quick_exit(2);
    }
  }

  std::mutex mutex_;
  std::condition_variable wake_;
  std::list<ShadingWatch::Watched> running_;
  bool over_ = false;
  std::thread thread_;
};

Watcher& TheWatcher() {
  static Watcher watcher;
  return watcher;
}

}  // namespace

ShadingWatch::ShadingWatch(std::string file, std::size_t pixels) {
  constexpr double kPixels = 512.0 * 512.0;
  static const double allowed = AllowedSeconds();
  watched_ = TheWatcher().Add(std::move(file), allowed * std::max(1.0, static_cast<double>(pixels) / kPixels));
}

ShadingWatch::~ShadingWatch() { TheWatcher().Remove(watched_); }

}  // namespace arealab
