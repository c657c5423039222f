#include "app/view/watch.h"

#include <system_error>
#include <utility>

namespace arealab {

namespace fs = std::filesystem;

Watch::Watch(fs::path shader_folder)
    : shader_folder_(std::move(shader_folder)), shaders_(ShaderMarks()), shaders_seen_(shaders_) {}

void Watch::SetScene(const fs::path& file) {
  scene_file_ = file;
  scene_ = scene_seen_ = SceneMarks();
}

void Watch::Mark(const fs::path& file, Marks& marks) {
  std::error_code error;
  const auto time = fs::last_write_time(file, error);
  if (error) return;
  const auto size = fs::is_regular_file(file, error) ? fs::file_size(file, error) : 0;
  if (!error) marks[file] = {time, size};
}

Watch::Marks Watch::ShaderMarks() const {
  Marks marks;
  std::error_code error;
  if (shader_folder_.empty()) return marks;
  for (auto entry = fs::recursive_directory_iterator(shader_folder_, error); !error && entry != fs::recursive_directory_iterator();
       entry.increment(error)) {
    const std::string extension = entry->path().extension().string();
    if (extension == ".glsl" || extension == ".frag" || extension == ".vert" || extension == ".exr") Mark(entry->path(), marks);
  }
  return marks;
}

Watch::Marks Watch::SceneMarks() const {
  Marks marks;
  if (scene_file_.empty()) return marks;
  Mark(scene_file_, marks);
  // Its textures and meshes lie in its folder or below; other scenes' files beside it do not count.
  std::error_code error;
  const fs::path folder = scene_file_.has_parent_path() ? scene_file_.parent_path() : fs::path(".");
  for (auto entry = fs::directory_iterator(folder, error); !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const std::string extension = entry->path().extension().string();
    for (const char* used : {".png", ".ppm", ".jpg", ".jpeg", ".exr", ".hdr", ".tif", ".gltf", ".glb", ".obj", ".ply", ".stl", ".3ds"}) {
      if (extension == used) Mark(entry->path(), marks);
    }
  }
  return marks;
}

Watch::Change Watch::Poll() {
  const auto now = std::chrono::steady_clock::now();
  if (now - looked_ < std::chrono::milliseconds(100)) return {};
  looked_ = now;
  const auto look = [](Marks current, Marks& seen, Marks& told, bool new_ones_count) {
    if (!new_ones_count) std::erase_if(current, [&](const auto& mark) { return !told.contains(mark.first); });
    const bool rests = current == seen;
    seen = std::move(current);
    if (!rests || seen == told) return false;
    told = seen;
    return true;
  };
  Change change;
  change.shaders = look(ShaderMarks(), shaders_seen_, shaders_, true);
  change.scene = look(SceneMarks(), scene_seen_, scene_, false);  // what a scene refers to was there when it was read
  return change;
}

}  // namespace arealab
