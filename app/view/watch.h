// Notices files that change on disk: shader files under a folder, and those that a scene is read from, wherever they lie.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>

namespace arealab {

class Watch {
 public:
  struct Change {
    bool shaders = false;
    std::set<std::filesystem::path> files;  // of the scene's
  };

  // `shader_folder` may be empty.
  explicit Watch(std::filesystem::path shader_folder);

  // What the scene is read from by now. A file that was not among it counts as unchanged as it is, unless it was written after
  // `since`, when the scene was begun to be read.
  void Use(const std::set<std::filesystem::path>& files, std::filesystem::file_time_type since);
  // A file that this program has written itself.
  void Wrote(const std::filesystem::path& file);

  // What has changed since the last call, also by another file that took its place. Looks at the disk now and then, see Rest, and waits
  // until a file has rested for one look, so that half of a save is never read.
  Change Poll();
  // Seconds until the next look is due.
  double Rest() const;

 private:
  // Of a file that is not there: zeros.
  using Mark = std::array<std::int64_t, 4>;  // number, size, time of the last write: s, ns
  using Marks = std::map<std::filesystem::path, Mark>;
  static Mark MarkOf(const std::filesystem::path& file);
  Marks ShaderMarks() const;

  std::filesystem::path shader_folder_;
  Marks shaders_, files_;            // as they were told last
  Marks shaders_seen_, files_seen_;  // as they were seen last
  std::chrono::steady_clock::time_point looked_{};
};

}  // namespace arealab
