// The look-dev window: a scene under two to four variants at once, edited live.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compare/context.h"

namespace arealab {

struct ViewOptions {
  std::string scene;                   // a built-in name, a scene file, or a mesh file alone; empty: the last one
  std::optional<ContextKind> context;  // that shades; the window's own is the display's
  std::filesystem::path shader_folder;
  std::filesystem::path cache;          // folder of apertures already baked
  std::optional<glm::ivec2> size;       // px of the window; else as it was last, else 1280×720
  std::vector<std::string> techniques;  // A, B, C, D
  std::string layout;                   // "single", "wipe", "difference", "flicker", "grid"; empty: by the techniques
  std::string transform;                // "srgb", "aces", "neutral", "agx", "false", "ocio" (its first view); empty: sRGB
  bool bare = false;                    // the picture alone
  bool captions = false;                // with its captions
  int frames = 0;                       // draws this many once the picture is whole, then leaves; 0: until closed
  std::filesystem::path screenshot;     // written before it leaves: .png as seen, .exr pane A's radiance
  std::filesystem::path turntable;      // with frames: a folder for so many pictures once round the target, 0001.png …
  bool json = false;                    // figures of this session on standard output at the end
};

// Returns when the window closes. Throws InputError where there is no display, no such scene, no such variant.
void RunView(const ViewOptions& options);

}  // namespace arealab
