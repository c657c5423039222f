#include "app/view/watch.h"

#include <sys/stat.h>

#include <algorithm>
#include <system_error>
#include <utility>

namespace arealab {

namespace fs = std::filesystem;

namespace {

constexpr double kLookSeconds = 0.1;
constexpr double kSettleSeconds = 0.05;  // between the look that sees a change and the one that trusts it

}  // namespace

Watch::Watch(fs::path shader_folder)
    : shader_folder_(std::move(shader_folder)), shaders_(ShaderMarks()), shaders_seen_(shaders_) {}

Watch::Mark Watch::MarkOf(const fs::path& file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return {};
  return {static_cast<std::int64_t>(status.st_ino), status.st_size, status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
}

void Watch::Use(const std::set<fs::path>& files, fs::file_time_type since) {
  std::erase_if(files_, [&](const auto& mark) { return !files.contains(mark.first); });
  for (const fs::path& file : files) {
    if (files_.contains(file)) continue;
    std::error_code error;
    const auto written = fs::last_write_time(file, error);
    files_[file] = !error && written > since ? Mark{} : MarkOf(file);
  }
}

void Watch::Wrote(const fs::path& file) {
  if (const auto found = files_.find(file); found != files_.end()) found->second = MarkOf(file);
}

Watch::Marks Watch::ShaderMarks() const {
  Marks marks;
  std::error_code error;
  if (shader_folder_.empty()) return marks;
  for (auto entry = fs::recursive_directory_iterator(shader_folder_, error); !error && entry != fs::recursive_directory_iterator();
       entry.increment(error)) {
    const std::string extension = entry->path().extension().string();
    if (extension == ".glsl" || extension == ".frag" || extension == ".vert" || extension == ".exr") marks[entry->path()] = MarkOf(entry->path());
  }
  return marks;
}

double Watch::Rest() const {
  const bool settled = shaders_seen_ == shaders_ && files_seen_ == files_;
  const std::chrono::duration<double> since = std::chrono::steady_clock::now() - looked_;
  return std::max((settled ? kLookSeconds : kSettleSeconds) - since.count(), 0.0);
}

Watch::Change Watch::Poll() {
  if (Rest() > 0.0) return {};
  looked_ = std::chrono::steady_clock::now();
  const auto rests = [](Marks current, Marks& seen) {
    const bool same = current == seen;
    seen = std::move(current);
    return same;
  };
  Change change;
  if (rests(ShaderMarks(), shaders_seen_)) change.shaders = std::exchange(shaders_, shaders_seen_) != shaders_seen_;
  Marks files;
  for (const auto& [file, mark] : files_) files[file] = MarkOf(file);
  if (rests(std::move(files), files_seen_)) {
    for (auto& [file, told] : files_) {
      if (std::exchange(told, files_seen_.at(file)) != files_seen_.at(file)) change.files.insert(file);
    }
  }
  return change;
}

}  // namespace arealab
