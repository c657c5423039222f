// Finds out all about one pixel in a thread and a context of its own: programs of every technique in float and in double take
// their time to compile, and the picture need not wait for them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/view/background.h"
#include "app/view/inspect.h"
#include "app/view/worker.h"
#include "compare/context.h"

namespace arealab {

struct InspectJob {
  std::shared_ptr<const Scene> scene;
  glm::ivec2 size{0}, pixel{0};
  std::vector<ShownVariant> variants;  // that come first; every technique's default follows
  std::set<std::string> effects_off;
  std::uint64_t library = 0;
};

using Inspector = Background<InspectJob, Inspection>;
Inspector::Work MakeInspector(std::optional<ContextKind> kind, const std::filesystem::path& shader_folder);

}  // namespace arealab
