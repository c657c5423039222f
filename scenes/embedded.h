// Files that the build puts into the program, unmodified (see arealab_embed in the top CMakeLists.txt).
#pragma once

#include <string_view>

namespace arealab {

struct EmbeddedFile {
  const char* name;  // relative to the folder that was embedded, e.g. "techniques/ltc.glsl"
  const char* begin;
  const char* end;

  std::string_view bytes() const { return {begin, static_cast<std::size_t>(end - begin)}; }
};

}  // namespace arealab
