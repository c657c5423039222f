#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/progress.h"
#include "compare/cost.h"
#include "compare/results_json.h"
#include "compare/table.h"
#include "scenes/error.h"
#include "scenes/replace_file.h"

namespace arealab {
namespace {

struct CostArguments {
  CommonOptions common;
  std::vector<std::string> gpus{"bonaire", "navi21"};
  std::vector<std::string> techniques;
  std::string scene;
  std::vector<std::string> effects{"rectangle", "diffuse", "specular", "fresnel"};
  BrdfOptions brdfs;
  bool json = false;
  bool claims = false;
  bool update = false;
  std::string baseline;
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
    for (const char* path : {"above", "crossing", "below", "far", "near"}) {
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

// Sources' own figures beside ours.
void PrintClaims(const ShaderLibrary& library, const std::vector<Technique>& techniques, const CostMeter& meter) {
  const auto cost = [&](const char* variant, const char* shape, bool textured = false) {
    std::vector<std::string> effects = {shape, "diffuse", "specular", "fresnel"};
    if (textured) effects.push_back("textured");
    const Scene scene = SceneOfEffects(effects);
    return meter.Measure(library, {ParseVariant(techniques, variant)}, scene).at(0).at("bonaire");
  };
  struct Claim {
    const char *light, *variant, *shape;
    int operations;  // scalar ALU [Drobot 2014, Table 1.1]
    bool textured = false;
  };
  const std::vector<Claim> claims = {{"point", "point", "rectangle", 222},
                                     {"sphere", "drobot@published", "sphere", 252},
                                     {"disk", "drobot@published", "disk", 361},
                                     {"rectangle", "drobot@published", "rectangle", 382},
                                     {"textured rectangle", "drobot@published", "rectangle", 405, true}};
  const auto growth = [](double value, double base) { return fmt::format("{:+.0f} %", 100.0 * (value / base - 1.0)); };
  const ShaderCost base = cost("point", "rectangle").full;
  std::vector<std::vector<std::string>> rows = {
      {"light", "his scalar ALU", "", "our variant", "instructions", "", "cycles", "", "ms at 1080p", ""}};
  for (const Claim& claim : claims) {
    const ShaderCost full = cost(claim.variant, claim.shape, claim.textured).full;
    rows.push_back({claim.light, std::to_string(claim.operations), growth(claim.operations, claims[0].operations), claim.variant,
                    std::to_string(full.instructions), growth(full.instructions, base.instructions), std::to_string(full.cycles),
                    growth(full.cycles, base.cycles), fmt::format("{:.2f}", MillisecondsAt1080p("bonaire", full.cycles)), ""});
  }
  fmt::print("{}\n\nDrobot 2014, Table 1.1, beside our full lighting pass on bonaire\n{}", meter.compilers(), AlignedTable(rows));
  fmt::print("  What differs: his counts are of a shadowed deferred shader with Blinn-Phong by the PlayStation 4's compiler, ours of one light\n"
             "  with GGX and Fresnel and without shadows by Mesa, all instructions and not only scalar ALU; his point light carries the shadow\n"
             "  and G-buffer work that makes his percentages small, ours next to nothing, so compare the differences: his rectangle adds 160.\n\n");

  rows = {{"variant", "instructions", "cycles", "ms at 1080p", ""}};
  rows.push_back({"theirs", "–", "–", "0.90", ""});
  for (const char* variant : {"hill@published", "hill", "ltc@published", "ltc"}) {
    const GpuCost found = cost(variant, "rectangle");
    const auto add = [&](const std::string& name, const ShaderCost& shader) {
      rows.push_back({name, std::to_string(shader.instructions), std::to_string(shader.cycles),
                      fmt::format("{:.2f}", MillisecondsAt1080p("bonaire", shader.cycles)), ""});
    };
    add(variant, found.core);
    for (const auto& [path, shader] : found.paths) add(fmt::format("  {}", path), shader);
  }
  fmt::print("Hill & Heitz 2016: 0.9 ms on a PlayStation 4 at 1080p, diffuse and specular, beside our technique core, estimated from bonaire ISA\n{}",
             AlignedTable(rows));
  fmt::print("  What differs: theirs was measured, with the vendor's compiler; the talk does not say how much of the picture the light reached. Ours is\n"
             "  a count for every pixel of the picture, with memory free and a Fresnel term, which the talk names as still to come.\n");
}

// Cycles as they were stored: {"compilers": "…", "cycles": {"rectangle": {"ltc": {"bonaire": 2545, …}, …}, …}}.
int CompareCycles(const ShaderLibrary& library, const std::vector<Technique>& techniques, const CostMeter& meter,
                  const std::string& file, bool update) {
  using Json = nlohmann::ordered_json;
  Json stored;
  {
    std::ifstream in(file);
    stored = in ? Json::parse(in, nullptr, false) : Json();
  }
  if (stored.is_discarded() || !stored.is_object() || !stored.contains("cycles") || !stored.contains("compilers")) {
    throw InputError(fmt::format("{}: no stored cycles; expected {{\"compilers\": …, \"cycles\": {{SHAPE: {{VARIANT: {{GPU: n}}}}}}}}", file));
  }
  if (stored["compilers"] != meter.compilers() && !update) {
    fmt::print("not compared: stored are the cycles of {}, here is {}; `arealab cost --baseline {} --update` stores these\n",
               stored["compilers"].get<std::string>(), meter.compilers(), file);
    return 0;
  }
  int figures = 0, more = 0, fewer = 0;
  for (auto& [shape, variants] : stored["cycles"].items()) {
    std::vector<Variant> chosen;
    for (const auto& [name, cycles] : variants.items()) chosen.push_back(ParseVariant(techniques, name));
    const auto costs = meter.Measure(library, chosen, SceneOfEffects({shape, "diffuse", "specular", "fresnel"}));
    std::size_t v = 0;
    for (auto& [name, cycles] : variants.items()) {
      const auto& found = costs[v++];
      for (auto& [gpu, before] : cycles.items()) {
        if (!found.contains(gpu)) throw InputError(fmt::format("{}: {} on {}; expected a GPU of --gpu and a variant that shades it", file, name, gpu));
        const int now = found.at(gpu).core.cycles, old = before.get<int>();
        ++figures;
        more += now > old;
        fewer += now < old;
        if (now != old) fmt::print(now > old ? stderr : stdout, "{}, {}, {}: {} → {} cycles\n", shape, name, gpu, old, now);
        before = now;
      }
    }
  }
  fmt::print("{}: {} figures compared, {} more, {} fewer\n", file, figures, more, fewer);
  if (update) {
    stored["compilers"] = meter.compilers();
    ReplaceFile(file, stored.dump(1) + "\n");
    return 0;
  }
  if (more > 0) fmt::print(stderr, "if that is meant: arealab cost --baseline {} --update\n", file);
  return more > 0 ? kExitLimitExceeded : 0;
}

int RunCost(const CostArguments& arguments) {
  const ShaderLibrary library = arguments.common.Library();
  const std::vector<Technique> techniques = LoadTechniques(library);
  if (arguments.claims) {
    PrintClaims(library, techniques, CostMeter({"bonaire"}, arguments.common.CacheFolder()));
    return 0;
  }
  if (!arguments.baseline.empty()) {
    return CompareCycles(library, techniques, CostMeter(arguments.gpus, arguments.common.CacheFolder()), arguments.baseline,
                         arguments.update);
  }
  std::vector<Variant> variants;
  for (const std::string& name : arguments.techniques) variants.push_back(ParseVariant(techniques, name));
  if (variants.empty()) variants = DefaultVariants(techniques);
  const Scene scene = arguments.scene.empty() ? arguments.brdfs.On(SceneOfEffects(arguments.effects)) : LoadScene(FindScene(arguments.scene));
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
    return 0;
  }
  fmt::print("{}; nothing is run: cycles per wave of 64 on one SIMD, as the compiler counts them\n", meter.compilers());
  for (const std::string& gpu : meter.gpus()) {
    fmt::print("\n{}{}\n{}", gpu,
               std::isfinite(MillisecondsAt1080p(gpu, 1.0))
                   ? ": ms at 1920x1080 estimated from bonaire ISA (PlayStation 4: 18 compute units at 0.8 GHz)"
                   : "",
               CostTable(gpu, variants, scene, costs));
  }
  return 0;
}

}  // namespace

void AddCost(CLI::App& app, int& status) {
  auto arguments = std::make_shared<CostArguments>();
  CLI::App* command = app.add_subcommand("cost", "Instructions and cycles of the techniques on GPUs that are not here");
  command->add_option("--gpu", arguments->gpus, "AMD families as Mesa names them")->capture_default_str()->delimiter(',');
  command->add_option("--technique", arguments->techniques,
                      "a variant; may be given several times (default: each technique's default and published form)");
  command->add_option("--scene", arguments->scene, "compiled for this scene's effects and BRDF");
  command->add_option("--effects", arguments->effects, "compiled for these effects where no scene is given")
      ->capture_default_str()
      ->delimiter(',');
  arguments->brdfs.Add(*command);
  command->add_flag("--json", arguments->json, "as JSON");
  command->add_flag("--claims", arguments->claims, "the sources' own counts and times beside ours");
  command->add_option("--baseline", arguments->baseline, "file of stored core cycles: exit with status 1 where there are more now")
      ->check(CLI::ExistingFile);
  command->add_flag("--update", arguments->update, "store the cycles in the baseline's file");
  command->add_option("--cache", arguments->common.cache, "folder of figures already known (default: the user's cache)");
  arguments->common.AddGlsl(*command);
  command->callback([arguments, &status] { status = RunCost(*arguments); });
}

}  // namespace arealab
