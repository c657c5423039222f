#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/progress.h"
#include "compare/explain.h"
#include "compare/table.h"
#include "scenes/error.h"

namespace arealab {
namespace {

struct ExplainArguments {
  CommonOptions common;
  std::string scene;
  std::vector<std::string> techniques{"ltc"};
  std::vector<std::string> effects;
  std::vector<std::string> gpus{"bonaire", "navi21"};
  double seconds = 20.0;
  bool total = false;
  bool no_cycles = false;
  bool json = false;
};

std::string RatioText(const Estimate& ratio) {
  return std::isfinite(ratio.value) ? fmt::format("{:.2f} [{:.2f}, {:.2f}]", ratio.value, ratio.low, ratio.high) : "–";
}

nlohmann::ordered_json RatioJson(const Estimate& ratio) {
  if (!std::isfinite(ratio.value)) return nullptr;
  return {{"value", ratio.value}, {"interval", {ratio.low, ratio.high}}};
}

nlohmann::ordered_json AsJson(const Explanation& explanation) {
  const Saving& saving = explanation.saving;
  nlohmann::ordered_json json = {{"variant", explanation.variant},
                                 {"pruned_over_all", RatioJson(saving.time)},
                                 {"rounds", saving.rounds},
                                 {"cycles", nlohmann::ordered_json::object()},
                                 {"per_pixel", nlohmann::ordered_json::object()},
                                 {"effects", nlohmann::ordered_json::array()}};
  for (const auto& [gpu, cycles] : saving.cycles) json["cycles"][gpu] = {{"pruned", cycles.first}, {"all", cycles.second}};
  for (const auto& [way, cost] : saving.per_pixel) json["per_pixel"][way] = {{"over_pruned", RatioJson(cost.time)}, {"cycles_over_pruned", cost.cycles}};
  for (const EffectPrice& price : explanation.effects) {
    json["effects"].push_back({{"name", price.effect.name},
                               {"on", price.effect.on},
                               {"forced", price.forced},
                               {"asked", price.asked},
                               {"reason", price.effect.reason},
                               {"time_ratio", RatioJson(price.time_ratio)},
                               {"cycles", price.cycles}});
  }
  return json;
}

// Which way to ask pixels for what they need pays, by renderer.
std::string WhatPays(const Saving& saving) {
  if (saving.per_pixel.empty()) return "";
  std::map<std::string, std::pair<std::string, double>> best;  // by renderer, the cheapest way and its ratio
  const auto offer = [&](const std::string& renderer, const std::string& way, double ratio, bool pays) {
    auto& known = best.try_emplace(renderer, "", 1.0).first->second;
    if (pays && ratio < known.second) known = {way, ratio};
  };
  for (const auto& [way, cost] : saving.per_pixel) {
    offer("here", way, cost.time.value, cost.Pays());
    for (const auto& [gpu, ratio] : cost.cycles) offer("on " + gpu, way, ratio, ratio < 1.0);
  }
  std::string text;
  for (const auto& [renderer, way] : best) text += fmt::format("{}{} {}", text.empty() ? "  " : ", ", renderer, way.first.empty() ? "neither pays" : way.first + (way.first == "tiles" ? " pay" : " pays"));
  return text + "\n";
}

std::string AsText(const Explanation& explanation, const std::vector<std::string>& gpus, bool prices) {
  std::vector<std::vector<std::string>> rows{{"effect", ""}};
  if (prices) {
    rows[0].emplace_back("time with/without");
    for (const std::string& gpu : gpus) rows[0].push_back(gpu + " cycles");
  }
  rows[0].emplace_back("why");
  for (const EffectPrice& price : explanation.effects) {
    std::vector<std::string> row{price.effect.name, price.effect.on ? "on" : "off"};
    if (prices) {
      row.push_back(price.asked ? RatioText(price.time_ratio) : "not asked");
      for (const std::string& gpu : gpus) {
        const auto cycles = price.cycles.find(gpu);
        row.push_back(cycles == price.cycles.end() ? "–" : fmt::format("{:+}", cycles->second));
      }
    }
    row.push_back((price.forced ? "forced; else " : "") + price.effect.reason);
    rows.push_back(std::move(row));
  }
  std::string text = AlignedTable(rows);
  const Saving& saving = explanation.saving;
  text += fmt::format("  time over that of every effect: {}, {} rounds", RatioText(saving.time), saving.rounds);
  for (const auto& [gpu, cycles] : saving.cycles) text += fmt::format("; {} {} of {} cycles", gpu, cycles.first, cycles.second);
  for (const auto& [way, cost] : saving.per_pixel) {
    text += fmt::format("\n  per pixel, {} over one program: time {}", way, RatioText(cost.time));
    for (const auto& [gpu, ratio] : cost.cycles) text += fmt::format("; {} {:.2f} of its cycles", gpu, ratio);
  }
  return text + "\n" + WhatPays(saving);
}

void RunExplain(const ExplainArguments& arguments) {
  const ShaderLibrary library = arguments.common.Library();
  const std::vector<Technique> techniques = LoadTechniques(library);
  std::vector<Variant> variants;
  for (std::string name : arguments.techniques) {
    for (const std::string& effect : arguments.effects) name += "+effect_" + effect;
    variants.push_back(ParseVariant(techniques, name));
  }
  const Scene scene = LoadScene(FindScene(arguments.scene));
  std::optional<CostMeter> meter;
  if (!arguments.no_cycles) meter.emplace(arguments.gpus, arguments.common.CacheFolder());
  const std::unique_ptr<Context> context = arguments.common.MakeContext();
  Renderer renderer(context->gl(), library);
  renderer.DrawScene(scene, arguments.common.Size());
  nlohmann::ordered_json json = {{"scene", scene.name}, {"renderer", context->renderer()}, {"software", context->software()},
                                 {"variants", nlohmann::ordered_json::array()}};
  if (!arguments.json) {
    fmt::print("{}: {}\nlighting pass at {} on {}{}{}\n", scene.name, scene.question, arguments.common.size, context->renderer(),
               context->software() ? ", a CPU rasteriser, not a GPU" : "", meter ? "; cycles are estimates by " + meter->compilers() : "");
  }
  for (const Variant& variant : variants) {
    Explanation explanation;
    {
      Progress progress;
      ExplainOptions options;
      options.prices = !arguments.total;
      options.meter = meter ? &*meter : nullptr;
      options.seconds = arguments.seconds;
      options.progress = [&](double fraction) { progress.Show(variant.ShortName(), fraction); };
      explanation = Explain(*context, renderer, library, scene, variant, options);
    }
    if (arguments.json) {
      json["variants"].push_back(AsJson(explanation));
    } else {
      fmt::print("\n{}\n{}", variant.ShortName(), AsText(explanation, meter ? meter->gpus() : std::vector<std::string>(), !arguments.total));
    }
  }
  if (arguments.json) fmt::print("{}\n", json.dump(1));
}

}  // namespace

void AddExplain(CLI::App& app, int& /*status*/) {
  auto arguments = std::make_shared<ExplainArguments>();
  CLI::App* command = app.add_subcommand("explain", "Which effects a scene calls for, why, and what each costs");
  command->add_option("scene", arguments->scene, "a built-in name or a scene file")->required();
  command->add_option("--technique", arguments->techniques, "a variant; may be given several times")->capture_default_str();
  command->add_option("--effect", arguments->effects, "NAME=0 or NAME=1: forced off or on; may be given several times");
  command->add_option("--gpu", arguments->gpus, "AMD families whose cycles are estimated")->capture_default_str()->delimiter(',');
  command->add_option("--seconds", arguments->seconds, "of the clock per variant, at most")
      ->capture_default_str()
      ->check(Within(0.1, 3600.0));
  command->add_flag("--total", arguments->total, "only all effects together, not the price of each");
  command->add_flag("--no-cycles", arguments->no_cycles, "no estimates for GPUs");
  command->add_flag("--json", arguments->json, "as JSON");
  command->add_option("--cache", arguments->common.cache, "folder of what compilers said already (default: the user's cache)");
  arguments->common.AddContext(*command);
  arguments->common.AddSize(*command);
  arguments->common.AddGlsl(*command);
  command->callback([arguments] { RunExplain(*arguments); });
}

}  // namespace arealab
