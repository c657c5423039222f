#include "compare/results.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "compare/cost.h"
#include "compare/results_json.h"
#include "compare/table.h"
#include "glsl/per_pixel.h"

namespace arealab {
namespace {

using Json = nlohmann::ordered_json;

Json Number(double v) {
  return std::isfinite(v) ? Json(v) : Json(nullptr);
}

Json ErrorJson(const ErrorMetrics& error) {
  Json json = {{"rel_rmse", Number(error.rel_rmse)}, {"bias", Number(error.bias)},
               {"relmse", Number(error.relmse)},     {"mae", Number(error.mae)},
               {"p99", Number(error.p99)},           {"max", Number(error.max)},
               {"flip", Number(error.flip)}};
  json["max_pixel"] = error.max_x < 0 ? Json(nullptr) : Json::array({error.max_x, error.max_y});
  return json;
}

Json EstimateJson(const Estimate& estimate, const char* interval, const char* name, Json json) {
  json[name] = Number(estimate.value);
  const bool known = std::isfinite(estimate.low) && std::isfinite(estimate.high);
  json[interval] = known ? Json::array({estimate.low, estimate.high}) : Json(nullptr);
  return json;
}

Json CostJson(const ShaderCost& cost, const std::string& gpu) {
  return {{"instructions", cost.instructions}, {"cycles", cost.cycles},     {"registers", cost.vgprs},
          {"scalar_registers", cost.sgprs},    {"spills", cost.spills},     {"branches", cost.branches},
          {"bytes", cost.bytes},               {"estimated_ms_1080p", Number(MillisecondsAt1080p(gpu, cost.cycles))}};
}

Json TimeJson(const Timing& time) {
  Json json = Json::object();
  json = EstimateJson(time.ns_per_pixel, "ns_interval", "ns_per_pixel", json);
  json = EstimateJson(time.ratio_to_point, "ratio_interval", "ratio_to_point", json);
  json = EstimateJson(time.net_ns_per_pixel, "net_ns_interval", "net_ns_per_pixel", json);
  json = EstimateJson(time.net_ratio_to_point, "net_ratio_interval", "net_ratio_to_point", json);
  json["net_refusal"] = time.refusal.empty() ? Json(nullptr) : Json(time.refusal);
  json["rounds"] = time.rounds;
  return json;
}

// A letter a tile, from A: the sum of the bits of what it needs.
Json TilesJson(const SceneResult& scene) {
  Json json = {{"size", kTileSize}, {"columns", scene.tile_columns}, {"bits", {{"light", kNeedsLight}}}};
  for (const PixelNeed& need : kPixelNeeds) json["bits"][need.effect] = need.bit;
  std::string letters;
  for (const int needs : scene.tile_needs) letters += static_cast<char>('A' + needs);
  json["needs"] = letters;
  return json;
}

Json SavingJson(const std::optional<Saving>& saving) {
  if (!saving) return nullptr;
  Json json = EstimateJson(saving->time, "interval", "time_ratio", Json::object());
  json["rounds"] = saving->rounds;
  json["cycles"] = Json::object();
  for (const auto& [gpu, cycles] : saving->cycles) json["cycles"][gpu] = {{"pruned", cycles.first}, {"every_effect", cycles.second}};
  json["per_pixel"] = Json::object();
  for (const auto& [way, cost] : saving->per_pixel) {
    json["per_pixel"][way] = EstimateJson(cost.time, "interval", "time_ratio", Json::object());
    json["per_pixel"][way]["cycles_ratio"] = cost.cycles;
  }
  return json;
}

Json CausesJson(const ErrorSplit& split) {
  Json json = Json::array();
  for (const ErrorSplit::Cause& cause : split.causes) json.push_back({{"name", cause.name}, {"rel_rmse", Number(cause.rel_rmse)}, {"bias", Number(cause.bias)}});
  return json;
}

Json VariantJson(const VariantResult& variant) {
  Json json;
  json["name"] = variant.name;
  json["short_name"] = variant.short_name;
  json["summary"] = variant.summary;
  json["note"] = variant.note;
  json["citation"] = variant.citation;
  json["supported"] = variant.supported;
  json["reason"] = variant.supported ? Json(nullptr) : Json(variant.reason);
  json["nonfinite_pixels"] = variant.nonfinite_pixels;
  json["within_truth_error"] = variant.within_truth_error;
  json["error"] = {{"total", ErrorJson(variant.total)},
                   {"diffuse", ErrorJson(variant.diffuse)},
                   {"specular", ErrorJson(variant.specular)},
                   {"split",
                    {{"model", Number(variant.split.model)},
                     {"approximation", Number(variant.split.approximation)},
                     {"rounding", Number(variant.split.rounding)},
                     {"causes", CausesJson(variant.split)}}}};
  json["time"] = TimeJson(variant.time);
  json["saving"] = SavingJson(variant.saving);
  json["isa"] = IsaObject(variant.isa);
  return json;
}

Json ShadowJson(const std::optional<ShadowResult>& shadow) {
  if (!shadow) return nullptr;
  return {{"present", shadow->Matters()},
          {"light_lost", Number(shadow->light_lost)},
          {"bias", Number(shadow->bias)},
          {"rel_rmse", Number(shadow->rel_rmse)},
          {"error", {{"mean", Number(shadow->mean_error)}, {"p99", Number(shadow->p99_error)}}},
          {"seconds", Number(shadow->seconds)},
          {"cached", shadow->cached}};
}

Json SceneJson(const SceneResult& scene) {
  Json json;
  json["name"] = scene.name;
  json["question"] = scene.question;
  json["file"] = scene.file;
  json["unit"] = scene.unit;
  json["width"] = scene.width;
  json["height"] = scene.height;
  json["exposure"] = Number(scene.exposure);
  json["effects"] = scene.effects;
  if (!scene.tile_needs.empty()) json["tiles"] = TilesJson(scene);
  json["lit_pixels"] = scene.lit_pixels;
  json["truth"] = {{"relative_error", Number(scene.truth_relative_error)},
                   {"seconds", Number(scene.truth_seconds)},
                   {"cached", scene.truth_cached},
                   {"visibility", scene.truth_shadowed},
                   {"shadow", ShadowJson(scene.shadow)}};
  json["variants"] = Json::array();
  for (const VariantResult& variant : scene.variants) json["variants"].push_back(VariantJson(variant));
  json["pairs"] = Json::array();
  for (const PairResult& pair : scene.pairs) {
    json["pairs"].push_back({{"a", pair.a}, {"b", pair.b}, {"rel_rmse", Number(pair.rel_rmse)}});
  }
  return json;
}

std::string CsvField(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string CsvNumber(double v) {
  return std::isfinite(v) ? fmt::format("{:.9g}", v) : std::string();
}

std::string Percent(double v) {
  if (!std::isfinite(v)) return "–";
  const double percent = 100.0 * v;
  if (std::abs(percent) < 0.001 && percent != 0.0) return fmt::format("{:.1e}", percent);
  return fmt::format("{:.{}f}", percent, std::abs(percent) < 1.0 ? 3 : std::abs(percent) < 10.0 ? 2 : 1);
}

// The median and half the width of its interval: "2.31 ± 0.02".
std::string WithSpread(const Estimate& ratio) {
  if (!std::isfinite(ratio.value)) return "–";
  return fmt::format("{:.2f} ± {:.2f}", ratio.value, 0.5 * (ratio.high - ratio.low));
}

}  // namespace

void SceneResult::ReleaseImages() {
  truth.reset();
  emission.reset();
  if (shadow) shadow->image.reset();
  for (VariantResult& variant : variants) {
    variant.image.reset();
    variant.split.maps.clear();
    for (ErrorSplit::Cause& cause : variant.split.causes) cause.relative.clear();
  }
}

nlohmann::ordered_json IsaObject(const std::map<std::string, GpuCost>& costs) {
  Json json = Json::object();
  for (const auto& [gpu, cost] : costs) {
    Json core = CostJson(cost.core, gpu);
    core["paths"] = Json::object();
    for (const auto& [path, shader] : cost.paths) core["paths"][path] = CostJson(shader, gpu);
    json[gpu] = {{"core", core}, {"full", CostJson(cost.full, gpu)}};
  }
  return json;
}

nlohmann::ordered_json ResultsObject(const Results& results) {
  Json json;
  json["schema"] = 1;
  json["command"] = results.command;
  json["version"] = results.version;
  json["date"] = results.date;
  json["machine"] = Json::object();
  for (const auto& [key, value] : results.machine) json["machine"][key] = value;
  json["platform"] = results.platform;
  json["renderer"] = results.renderer;
  json["gl_version"] = results.gl_version;
  json["software"] = results.software;
  json["isa_compilers"] = results.compilers.empty() ? Json(nullptr) : Json(results.compilers);
  json["no_isa"] = results.no_isa.empty() ? Json(nullptr) : Json(results.no_isa);
  json["scenes"] = Json::array();
  for (const SceneResult& scene : results.scenes) json["scenes"].push_back(SceneJson(scene));
  json["claims"] = Json::array();
  for (const ClaimsPage& page : results.claims) {
    json["claims"].push_back({{"source", page.name},
                              {"citation", page.citation},
                              {"title", page.title},
                              {"holds", page.holds},
                              {"partly", page.partly},
                              {"fails", page.fails},
                              {"unknown", page.unknown}});
  }
  const HardCasesPage& hard = results.hard_cases;
  json["hard_cases"] = hard.html.empty() ? Json(nullptr)
                                         : Json{{"techniques", hard.techniques}, {"cases", hard.cases}, {"failures", hard.failures}};
  return json;
}

std::string ResultsJson(const Results& results) {
  return ResultsObject(results).dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string ResultsCsv(const Results& results) {
  std::set<std::string> gpus;
  for (const SceneResult& scene : results.scenes) {
    for (const VariantResult& variant : scene.variants) {
      for (const auto& [gpu, cost] : variant.isa) gpus.insert(gpu);
    }
  }
  std::string csv =
      "scene,variant,lobe,supported,rel_rmse,bias,relmse,mae,p99,max,max_x,max_y,flip,nonfinite_pixels,"
      "within_truth_error,truth_relative_error,ns_per_pixel,ns_low,ns_high,ratio_to_point,ratio_low,ratio_high,"
      "net_ns_per_pixel,net_ns_low,net_ns_high,net_ratio_to_point,net_ratio_low,net_ratio_high";
  for (const std::string& gpu : gpus) {
    csv += fmt::format(",{0}_core_instructions,{0}_core_cycles,{0}_full_instructions,{0}_full_cycles", gpu);
  }
  csv += ",reason\r\n";
  for (const SceneResult& scene : results.scenes) {
    for (const VariantResult& variant : scene.variants) {
      const std::pair<const char*, const ErrorMetrics*> lobes[3] = {
          {"total", &variant.total}, {"diffuse", &variant.diffuse}, {"specular", &variant.specular}};
      for (const auto& [lobe, error] : lobes) {
        const bool located = error->max_x >= 0;
        std::vector<std::string> fields = {CsvField(scene.name), CsvField(variant.name), lobe, variant.supported ? "1" : "0"};
        for (const double v : {error->rel_rmse, error->bias, error->relmse, error->mae, error->p99, error->max}) {
          fields.push_back(CsvNumber(v));
        }
        fields.push_back(located ? std::to_string(error->max_x) : "");
        fields.push_back(located ? std::to_string(error->max_y) : "");
        fields.push_back(CsvNumber(error->flip));
        fields.push_back(std::to_string(variant.nonfinite_pixels));
        fields.push_back(variant.within_truth_error ? "1" : "0");
        fields.push_back(CsvNumber(scene.truth_relative_error));
        const Timing& time = variant.time;
        for (const Estimate& estimate :
             {time.ns_per_pixel, time.ratio_to_point, time.net_ns_per_pixel, time.net_ratio_to_point}) {
          for (const double v : {estimate.value, estimate.low, estimate.high}) fields.push_back(CsvNumber(v));
        }
        for (const std::string& gpu : gpus) {
          const auto found = variant.isa.find(gpu);
          const bool known = found != variant.isa.end();
          for (const ShaderCost* cost : {known ? &found->second.core : nullptr, known ? &found->second.full : nullptr}) {
            fields.push_back(cost != nullptr ? std::to_string(cost->instructions) : "");
            fields.push_back(cost != nullptr ? std::to_string(cost->cycles) : "");
          }
        }
        fields.push_back(CsvField(variant.reason));
        csv += fmt::format("{}\r\n", fmt::join(fields, ","));
      }
    }
  }
  return csv;
}

std::string SummaryTable(const SceneResult& scene) {
  std::vector<const VariantResult*> order;
  for (const VariantResult& variant : scene.variants) order.push_back(&variant);
  const auto key = [](const VariantResult* v) {  // unsupported last, then what has no figure
    const double error = v->total.rel_rmse;
    return std::tuple(!v->supported, !std::isfinite(error), std::isfinite(error) ? error : 0.0);
  };
  std::stable_sort(order.begin(), order.end(), [&](auto* a, auto* b) { return key(a) < key(b); });
  const auto any = [&](auto predicate) { return std::any_of(order.begin(), order.end(), predicate); };
  const bool timed = any([](const VariantResult* v) { return std::isfinite(v->time.ratio_to_point.value); });
  const bool flipped = any([](const VariantResult* v) { return std::isfinite(v->total.flip); });
  std::set<std::string> gpus;
  for (const VariantResult* v : order) {
    for (const auto& [gpu, cost] : v->isa) gpus.insert(gpu);
  }

  std::vector<std::vector<std::string>> rows = {{"variant", "error %", "diffuse", "specular", "bias %"}};
  if (flipped) rows[0].push_back("FLIP");
  if (timed) rows[0].push_back("× point");
  if (timed) rows[0].push_back("net");
  for (const std::string& gpu : gpus) rows[0].push_back(gpu);
  rows[0].push_back("");
  for (const VariantResult* v : order) {
    if (!v->supported) {
      rows.push_back({v->short_name, "not supported: " + v->reason});
      continue;
    }
    rows.push_back({v->short_name, Percent(v->total.rel_rmse), Percent(v->diffuse.rel_rmse),
                    Percent(v->specular.rel_rmse), Percent(v->total.bias)});
    if (flipped)
      rows.back().push_back(std::isfinite(v->total.flip) ? fmt::format("{:.4f}", v->total.flip) : "–");
    if (timed) {
      rows.back().push_back(WithSpread(v->time.ratio_to_point));
      rows.back().push_back(WithSpread(v->time.net_ratio_to_point));
    }
    for (const std::string& gpu : gpus) {
      const auto found = v->isa.find(gpu);
      rows.back().push_back(found == v->isa.end() ? "–" : std::to_string(found->second.core.cycles));
    }
    std::string remark = v->within_truth_error ? "within truth's error" : "";
    if (v->nonfinite_pixels > 0) {
      remark += fmt::format("{}{} non-finite pixels", remark.empty() ? "" : ", ", v->nonfinite_pixels);
    }
    rows.back().push_back(remark);
  }
  std::string text = fmt::format("{}: {}\n{}", scene.name, scene.question, AlignedTable(rows));
  std::vector<std::vector<std::string>> causes;
  for (const VariantResult* v : order) {
    if (v->split.causes.empty()) continue;
    if (causes.empty()) {
      causes.push_back({"by cause, %"});
      for (const ErrorSplit::Cause& cause : v->split.causes) causes[0].push_back(cause.name);
    }
    causes.push_back({v->short_name});
    for (const ErrorSplit::Cause& cause : v->split.causes) causes.back().push_back(fmt::format("{:.2g}", 100.0 * cause.rel_rmse));
  }
  if (!causes.empty()) text += AlignedTable(causes);
  for (const VariantResult* v : order) {  // one reason holds for all
    if (v->time.refusal.empty()) continue;
    text += fmt::format("  net of the pass-through refused: {}\n", v->time.refusal);
    break;
  }
  return text;
}

}  // namespace arealab
