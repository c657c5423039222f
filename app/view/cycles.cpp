#include "app/view/cycles.h"

#include <exception>

#include "compare/cost.h"
#include "glsl/effects.h"
#include "glsl/shader_library.h"

namespace arealab {
namespace {

void Count(const CyclesJob& job, const ShaderLibrary& library, const std::filesystem::path& cache, CycleCounter& counter, Cycles& found) {
  const std::vector<Technique> techniques = LoadTechniques(library);
  const CostMeter meter({job.gpu}, cache);
  const auto whole = [&](Variant variant) -> std::optional<int> {
    for (const std::string& effect : job.effects_off) variant.effects[effect] = false;
    const auto costs = meter.Measure(library, {variant}, *job.scene).front();
    return costs.empty() ? std::nullopt : std::optional(costs.at(job.gpu).full.cycles);
  };
  for (const std::string& name : job.variants) {
    if (counter.Overtaken()) return;
    if (const auto cycles = whole(ParseVariant(techniques, name))) found.variants[name] = *cycles;
    counter.Publish(found);
  }
  const auto first = job.variants.empty() ? found.variants.end() : found.variants.find(job.variants.front());
  if (first == found.variants.end()) return;
  for (const Effect& effect : SceneEffects(*job.scene)) {
    if (counter.Overtaken()) return;
    if (!effect.on || job.effects_off.contains(effect.name)) continue;
    Variant without = ParseVariant(techniques, first->first);
    without.effects[effect.name] = false;
    try {
      if (const auto cycles = whole(without)) found.effects[effect.name] = first->second - *cycles;
    } catch (const std::exception&) {
      continue;  // nothing is left without its only shape
    }
    counter.Publish(found);
  }
}

}  // namespace

CycleCounter::Work MakeCycleCounter(const std::filesystem::path& shader_folder, const std::filesystem::path& cache) {
  return [shader_folder, cache](const CyclesJob& job, CycleCounter& counter) {
    Cycles found;
    found.gpu = job.gpu;
    try {
      Count(job, shader_folder.empty() ? ShaderLibrary() : ShaderLibrary(shader_folder), cache, counter, found);
    } catch (const std::exception& error) {
      found.trouble = error.what();
      counter.Publish(found);
    }
  };
}

}  // namespace arealab
