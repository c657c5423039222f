// What the fuzzers (clang's libFuzzer, README) and the replay of their corpus call. Each target takes any bytes: an
// InputError of one line that says what was expected is a right answer, a sound result is one, all else is a defect.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>

#include "scenes/error.h"

namespace arealab::fuzz {

using Bytes = std::span<const std::uint8_t>;

void SceneFile(Bytes bytes);
void TechniqueHeader(Bytes bytes);
void TextureFile(Bytes bytes);
void MeshFileBytes(Bytes bytes);
void CacheEntry(Bytes bytes);
void ResultsFile(Bytes bytes);

struct Target {
  const char* name;  // of its corpus' folder too
  void (*run)(Bytes);
};
constexpr Target kTargets[] = {{"scene", SceneFile},     {"technique", TechniqueHeader}, {"texture", TextureFile},
                               {"mesh", MeshFileBytes}, {"cache", CacheEntry},          {"results", ResultsFile}};

inline void Require(bool sound, const std::string& what) {
  if (!sound) throw std::logic_error(what);
}

// Runs what reads; false where it refuses, in one line.
inline bool Reads(const std::function<void()>& read) {
  try {
    read();
    return true;
  } catch (const InputError& error) {
    const std::string line = error.what();
    for (const char c : line) Require(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f, "not one line: " + line);
    Require(line.find("expected") != std::string::npos || line.find("install") != std::string::npos, "what was expected? " + line);
    return false;
  }
}

inline std::string Text(Bytes bytes) { return {bytes.begin(), bytes.end()}; }

// A folder of this process, gone with it.
inline const std::filesystem::path& Folder() {
  struct Owned {
    Owned() : path(std::filesystem::temp_directory_path() / ("arealab_fuzz_" + std::to_string(getpid()))) {
      std::filesystem::create_directories(path);
    }
    ~Owned() {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }
    std::filesystem::path path;
  };
  static const Owned owned;
  return owned.path;
}

inline std::filesystem::path File(const std::string& name, const std::string& bytes) {
  std::ofstream(Folder() / name, std::ios::binary | std::ios::trunc) << bytes;
  return Folder() / name;
}

}  // namespace arealab::fuzz
