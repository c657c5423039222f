// Where shader text and fitted tables come from: the files embedded in the program, or a folder that overrides them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace arealab {

// Names are relative to glsl/, with '/': "lighting.frag", "techniques/ltc.glsl", "tables/ltc_ggx_polygon.exr".
class ShaderLibrary {
 public:
  ShaderLibrary() = default;  // embedded files only
  // A file in `overrides` wins over the embedded file of the same name; it is read again at every call (live editing).
  explicit ShaderLibrary(std::filesystem::path overrides);

  std::optional<std::string> Find(std::string_view name) const;  // the bytes
  std::vector<std::string> List(std::string_view folder) const;  // sorted names of the files directly in a folder
  // What a person would open to edit `name`: the path under the override folder, else "glsl/NAME".
  std::string DisplayPath(std::string_view name) const;

 private:
  std::filesystem::path overrides_;
};

}  // namespace arealab
