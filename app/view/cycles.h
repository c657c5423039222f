// Cycles of what is shown on a GPU that need not be here, and what each of the scene's effects adds to them: compiled in the
// background, kept in the cache by content.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "app/view/background.h"
#include "scenes/scene.h"

namespace arealab {

struct CyclesJob {
  std::shared_ptr<const Scene> scene;
  std::vector<std::string> variants;  // of the first the effects' prices too
  std::set<std::string> effects_off;
  std::string gpu;
};

struct Cycles {
  std::string gpu;
  std::map<std::string, int> variants;  // per wave of 64, whole pass, by the name asked for
  std::map<std::string, int> effects;   // that each adds to the first variant's
  std::string trouble;                  // why there are none: one line
};

using CycleCounter = Background<CyclesJob, Cycles>;
CycleCounter::Work MakeCycleCounter(const std::filesystem::path& shader_folder, const std::filesystem::path& cache);

}  // namespace arealab
