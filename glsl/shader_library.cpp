#include "glsl/shader_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <span>
#include <system_error>
#include <utility>

#include "scenes/embedded.h"
#include "scenes/error.h"

namespace arealab {

namespace glsl_files {
extern const EmbeddedFile kFiles[];
extern const int kFileCount;
}  // namespace glsl_files

namespace {

std::span<const EmbeddedFile> EmbeddedFiles() {
  return {glsl_files::kFiles, static_cast<std::size_t>(glsl_files::kFileCount)};
}

// A name that stays inside the library: relative, no "..", no empty part.
bool IsPlainName(std::string_view name) {
  const std::filesystem::path path{name};
  if (name.empty() || path.is_absolute()) return false;
  return std::none_of(path.begin(), path.end(),
                      [](const auto& part) { return part == ".." || part.empty(); });
}

bool IsDirectlyIn(std::string_view folder, std::string_view name) {
  return name.size() > folder.size() + 1 && name.starts_with(folder) && name[folder.size()] == '/' &&
         name.find('/', folder.size() + 1) == std::string_view::npos;
}

}  // namespace

ShaderLibrary::ShaderLibrary(std::filesystem::path overrides) : overrides_(std::move(overrides)) {
  std::error_code error;
  if (!overrides_.empty() && !std::filesystem::is_directory(overrides_, error)) {
    throw InputError(fmt::format("{}: no such folder; expected one with shader text, laid out as glsl/",
                                 overrides_.generic_string()));
  }
}

std::optional<std::string> ShaderLibrary::Find(std::string_view name) const {
  if (!IsPlainName(name)) return std::nullopt;
  std::error_code error;
  if (const auto path = overrides_ / name;
      !overrides_.empty() && std::filesystem::is_regular_file(path, error)) {
    std::ifstream stream(path, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    if (!stream)
      throw InputError(fmt::format("{}: cannot be read; expected shader text", path.generic_string()));
    return bytes;
  }
  for (const EmbeddedFile& file : EmbeddedFiles()) {
    if (file.name == name) return std::string(file.bytes());
  }
  return std::nullopt;
}

std::vector<std::string> ShaderLibrary::List(std::string_view folder) const {
  std::vector<std::string> names;
  for (const EmbeddedFile& file : EmbeddedFiles()) {
    if (IsDirectlyIn(folder, file.name)) names.emplace_back(file.name);
  }
  std::error_code error;
  if (!overrides_.empty() && IsPlainName(folder) &&
      std::filesystem::is_directory(overrides_ / folder, error)) {
    for (const auto& entry : std::filesystem::directory_iterator(overrides_ / folder)) {
      if (entry.is_regular_file(error)) {
        names.push_back(fmt::format("{}/{}", folder, entry.path().filename().generic_string()));
      }
    }
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

std::string ShaderLibrary::DisplayPath(std::string_view name) const {
  std::error_code error;
  if (const auto path = overrides_ / name;
      !overrides_.empty() && std::filesystem::is_regular_file(path, error)) {
    return path.generic_string();
  }
  return fmt::format("glsl/{}", name);
}

}  // namespace arealab
