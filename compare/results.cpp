#include "compare/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compare/results_json.h"

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
                   {"split", {{"model", nullptr}, {"approximation", nullptr}, {"rounding", nullptr}}}};
  Json interval = nullptr;
  if (std::isfinite(variant.time.ratio_low) && std::isfinite(variant.time.ratio_high)) {
    interval = Json::array({variant.time.ratio_low, variant.time.ratio_high});
  }
  json["time"] = {{"ns_per_pixel", Number(variant.time.ns_per_pixel)},
                  {"ratio_to_point", Number(variant.time.ratio_to_point)},
                  {"ratio_interval", interval},
                  {"rounds", variant.time.rounds}};
  json["isa"] = Json::object();
  return json;
}

Json ShadowJson(const std::optional<ShadowResult>& shadow) {
  if (!shadow) return nullptr;
  return {{"present", shadow->image != nullptr},
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
  json["lit_pixels"] = scene.lit_pixels;
  json["truth"] = {{"relative_error", Number(scene.truth_relative_error)},
                   {"seconds", Number(scene.truth_seconds)},
                   {"cached", scene.truth_cached},
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

// Characters, not bytes: names and units are UTF-8.
std::size_t Columns(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string Percent(double v) {
  if (!std::isfinite(v)) return "–";
  const double percent = 100.0 * v;
  if (std::abs(percent) < 0.001 && percent != 0.0) return fmt::format("{:.1e}", percent);
  return fmt::format("{:.{}f}", percent, std::abs(percent) < 1.0 ? 3 : std::abs(percent) < 10.0 ? 2 : 1);
}

}  // namespace

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
  json["scenes"] = Json::array();
  for (const SceneResult& scene : results.scenes) json["scenes"].push_back(SceneJson(scene));
  return json;
}

std::string ResultsJson(const Results& results) {
  return ResultsObject(results).dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string ResultsCsv(const Results& results) {
  std::string csv =
      "scene,variant,lobe,supported,rel_rmse,bias,relmse,mae,p99,max,max_x,max_y,flip,nonfinite_pixels,"
      "within_truth_error,truth_relative_error,ns_per_pixel,ratio_to_point,ratio_low,ratio_high,reason\r\n";
  for (const SceneResult& scene : results.scenes) {
    for (const VariantResult& variant : scene.variants) {
      const std::pair<const char*, const ErrorMetrics*> lobes[3] = {
          {"total", &variant.total}, {"diffuse", &variant.diffuse}, {"specular", &variant.specular}};
      for (const auto& [lobe, error] : lobes) {
        const bool located = error->max_x >= 0;
        csv += fmt::format(
            "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\r\n", CsvField(scene.name),
            CsvField(variant.name), lobe, variant.supported ? 1 : 0, CsvNumber(error->rel_rmse),
            CsvNumber(error->bias), CsvNumber(error->relmse), CsvNumber(error->mae), CsvNumber(error->p99),
            CsvNumber(error->max), located ? std::to_string(error->max_x) : "",
            located ? std::to_string(error->max_y) : "", CsvNumber(error->flip), variant.nonfinite_pixels,
            variant.within_truth_error ? 1 : 0, CsvNumber(scene.truth_relative_error),
            CsvNumber(variant.time.ns_per_pixel), CsvNumber(variant.time.ratio_to_point),
            CsvNumber(variant.time.ratio_low), CsvNumber(variant.time.ratio_high), CsvField(variant.reason));
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
  const bool timed = any([](const VariantResult* v) { return std::isfinite(v->time.ratio_to_point); });
  const bool flipped = any([](const VariantResult* v) { return std::isfinite(v->total.flip); });

  std::vector<std::vector<std::string>> rows = {{"variant", "error %", "diffuse", "specular", "bias %"}};
  if (flipped) rows[0].push_back("FLIP");
  if (timed) rows[0].push_back("time");
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
      rows.back().push_back(
          std::isfinite(v->time.ratio_to_point) ? fmt::format("×{:.2f}", v->time.ratio_to_point) : "–");
    }
    std::string remark = v->within_truth_error ? "within truth's error" : "";
    if (v->nonfinite_pixels > 0) {
      remark += fmt::format("{}{} non-finite pixels", remark.empty() ? "" : ", ", v->nonfinite_pixels);
    }
    rows.back().push_back(remark);
  }
  std::vector<std::size_t> widths(rows[0].size(), 0);
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size() && (c == 0 || row.size() > 2); ++c) {
      widths[c] = std::max(widths[c], Columns(row[c]));
    }
  }
  std::string text = fmt::format("{}: {}\n", scene.name, scene.question);
  for (const auto& row : rows) {
    std::string line = "  ";
    for (std::size_t c = 0; c < row.size(); ++c) {
      const bool left = c == 0 || row.size() == 2 || c + 1 == row.size();
      const std::string pad(widths[c] > Columns(row[c]) && row.size() >= c ? widths[c] - Columns(row[c]) : 0,
                            ' ');
      line += (c > 0 ? "  " : "") + (left ? row[c] + pad : pad + row[c]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

}  // namespace arealab
