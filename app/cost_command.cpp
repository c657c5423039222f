#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/progress.h"
#include "compare/cost.h"
#include "compare/results_json.h"
#include "compare/table.h"
#include "scenes/error.h"

namespace arealab {
namespace {

struct CostArguments {
  CommonOptions common;
  std::vector<std::string> gpus{"bonaire", "navi21"};
  std::vector<std::string> techniques;
  std::string scene;
  std::vector<std::string> effects{"rectangle", "diffuse", "specular", "fresnel"};
  bool json = false;
};

// One row per variant and per path of a branching one.
std::string CostTable(const std::string& gpu, const std::vector<Variant>& variants, const Scene& scene,
                      const std::vector<std::map<std::string, GpuCost>>& costs) {
  const bool timed = std::isfinite(MillisecondsAt1080p(gpu, 1.0));
  std::vector<std::vector<std::string>> rows = {{"variant", "core: instr", "cycles", "VGPR", "SGPR", "spills"}};
  if (timed) rows[0].push_back("ms");
  for (const char* title : {"full: instr", "cycles", "VGPR", "spills"}) rows[0].emplace_back(title);
  if (timed) rows[0].push_back("ms");
  rows[0].push_back("");
  const auto add = [&](const std::string& name, const ShaderCost& core, const ShaderCost* full) {
    std::vector<std::string> row = {name};
    for (const int n : {core.instructions, core.cycles, core.vgprs, core.sgprs, core.spills}) row.push_back(std::to_string(n));
    if (timed) row.push_back(fmt::format("{:.2f}", MillisecondsAt1080p(gpu, core.cycles)));
    if (full != nullptr) {
      for (const int n : {full->instructions, full->cycles, full->vgprs, full->spills}) row.push_back(std::to_string(n));
      if (timed) row.push_back(fmt::format("{:.2f}", MillisecondsAt1080p(gpu, full->cycles)));
    }
    row.push_back("");
    rows.push_back(std::move(row));
  };
  for (std::size_t v = 0; v < variants.size(); ++v) {
    const auto found = costs[v].find(gpu);
    if (found == costs[v].end()) continue;
    add(variants[v].ShortName(), found->second.core, &found->second.full);
    for (const char* path : {"above", "crossing", "below"}) {
      const auto at = found->second.paths.find(path);
      if (at != found->second.paths.end()) add(fmt::format("  {}", path), at->second, nullptr);
    }
  }
  std::string text = AlignedTable(rows);
  for (std::size_t v = 0; v < variants.size(); ++v) {
    if (const auto reason = WhyUnsupported(variants[v], scene)) text += fmt::format("  {}: {}\n", variants[v].ShortName(), *reason);
  }
  return text;
}

void RunCost(const CostArguments& arguments) {
  const ShaderLibrary library = arguments.common.Library();
  const std::vector<Technique> techniques = LoadTechniques(library);
  std::vector<Variant> variants;
  for (const std::string& name : arguments.techniques) variants.push_back(ParseVariant(techniques, name));
  if (variants.empty()) variants = DefaultVariants(techniques);
  const Scene scene = arguments.scene.empty() ? SceneOfEffects(arguments.effects) : LoadScene(FindScene(arguments.scene));
  const CostMeter meter(arguments.gpus, arguments.common.CacheFolder());
  std::vector<std::map<std::string, GpuCost>> costs;
  {
    Progress progress;
    costs = meter.Measure(library, variants, scene, [&](double fraction) { progress.Show("compiling", fraction); });
  }
  if (arguments.json) {
    nlohmann::ordered_json json = {{"compilers", meter.compilers()}, {"variants", nlohmann::ordered_json::array()}};
    for (std::size_t v = 0; v < variants.size(); ++v) {
      const auto reason = WhyUnsupported(variants[v], scene);
      json["variants"].push_back({{"name", variants[v].Name()},
                                  {"short_name", variants[v].ShortName()},
                                  {"supported", !reason},
                                  {"reason", reason ? nlohmann::ordered_json(*reason) : nlohmann::ordered_json(nullptr)},
                                  {"isa", IsaObject(costs[v])}});
    }
    fmt::print("{}\n", json.dump(1));
    return;
  }
  fmt::print("{}; nothing is run: cycles per wave of 64 on one SIMD, as the compiler counts them\n", meter.compilers());
  for (const std::string& gpu : meter.gpus()) {
    fmt::print("\n{}{}\n{}", gpu,
               std::isfinite(MillisecondsAt1080p(gpu, 1.0))
                   ? ": ms at 1920x1080 estimated from bonaire ISA (PlayStation 4: 18 compute units at 0.8 GHz)"
                   : "",
               CostTable(gpu, variants, scene, costs));
  }
}

}  // namespace

void AddCost(CLI::App& app, int& /*status*/) {
  auto arguments = std::make_shared<CostArguments>();
  CLI::App* command = app.add_subcommand("cost", "Instructions and cycles of the techniques on GPUs that are not here");
  command->add_option("--gpu", arguments->gpus, "AMD families as Mesa names them")->capture_default_str()->delimiter(',');
  command->add_option("--technique", arguments->techniques,
                      "a variant; may be given several times (default: each technique's default and published form)");
  command->add_option("--scene", arguments->scene, "compiled for this scene's effects and BRDF");
  command->add_option("--effects", arguments->effects, "compiled for these effects where no scene is given")
      ->capture_default_str()
      ->delimiter(',');
  command->add_flag("--json", arguments->json, "as JSON");
  command->add_option("--cache", arguments->common.cache, "folder of figures already known (default: the user's cache)");
  arguments->common.AddGlsl(*command);
  command->callback([arguments] { RunCost(*arguments); });
}

}  // namespace arealab
