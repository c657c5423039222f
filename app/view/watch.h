// Notices files that change on disk: shader files under a folder, a scene file and what lies beside it.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>

namespace arealab {

class Watch {
 public:
  struct Change {
    bool shaders = false, scene = false;
  };

  // `shader_folder` may be empty.
  explicit Watch(std::filesystem::path shader_folder);
  void SetScene(const std::filesystem::path& file);  // as it is now is what counts as unchanged

  // What has changed since the last call; looks at the disk every 100 ms at most, and waits until a file has rested for
  // one look, so that half of a save is never read.
  Change Poll();

 private:
  using Marks = std::map<std::filesystem::path, std::pair<std::filesystem::file_time_type, std::uintmax_t>>;
  static void Mark(const std::filesystem::path& file, Marks& marks);
  Marks ShaderMarks() const;
  Marks SceneMarks() const;

  std::filesystem::path shader_folder_, scene_file_;
  Marks shaders_, scene_;                // as they were told last
  Marks shaders_seen_, scene_seen_;      // as they were seen last
  std::chrono::steady_clock::time_point looked_{};
};

}  // namespace arealab
