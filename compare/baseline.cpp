#include "compare/baseline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "compare/read_results.h"
#include "scenes/error.h"

namespace arealab {
namespace {

using json = nlohmann::ordered_json;

json ReadResults(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(fmt::format("{}: cannot be read; expected a results.json of an earlier run", file.string()));
  return ParseResults(file.string(), std::string(std::istreambuf_iterator<char>(in), {}));
}

// The element of that name, or null.
const json* Named(const json& list, const std::string& name) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const json& entry) { return entry.at("name") == name; });
  return found == list.end() ? nullptr : &*found;
}

void CompareError(const std::string& who, const VariantResult& now, double now_noise, const json& before, double before_noise,
                  BaselineReport& report) {
  const std::pair<const char*, const ErrorMetrics*> lobes[] = {
      {"total", &now.total}, {"diffuse", &now.diffuse}, {"specular", &now.specular}};
  for (const auto& [lobe, error] : lobes) {
    const double old = NumberOf(before.at("error").at(lobe).at("rel_rmse")), value = error->rel_rmse;
    if (!std::isfinite(old)) continue;
    ++report.compared;
    constexpr double kGrowth = 1e-3;  // another CPU's or driver's rounding changes less
    if (value <= old * (1.0 + kGrowth) + now_noise + before_noise) continue;  // false for NaN too
    report.worse.push_back(fmt::format("{}: {} error {:.4g} % → {:.4g} %", who, lobe, 100.0 * old, 100.0 * value));
  }
}

void CompareTime(const std::string& who, const Timing& now, const json& before, BaselineReport& report) {
  const json& interval = before.at("time").at("ratio_interval");
  if (!IsInterval(interval) || !std::isfinite(now.ratio_to_point.value)) return;
  ++report.compared;
  if (now.ratio_to_point.low <= NumberOf(interval[1])) return;
  report.worse.push_back(fmt::format("{}: {:.2f} × point ({:.2f} to {:.2f}) → {:.2f} ({:.2f} to {:.2f})", who,
                                     NumberOf(before.at("time").at("ratio_to_point")), NumberOf(interval[0]), NumberOf(interval[1]),
                                     now.ratio_to_point.value, now.ratio_to_point.low, now.ratio_to_point.high));
}

void CompareCycles(const std::string& who, const VariantResult& now, const json& before, BaselineReport& report) {
  for (const auto& [gpu, cost] : now.isa) {
    if (!before.at("isa").contains(gpu)) continue;
    for (const auto& [part, shader] : {std::pair("core", &cost.core), std::pair("full", &cost.full)}) {
      const double old = NumberOf(before.at("isa").at(gpu).at(part).at("cycles"));
      if (!std::isfinite(old)) continue;
      ++report.compared;
      if (shader->cycles > old) report.worse.push_back(fmt::format("{}: {} {} {} → {} cycles", who, gpu, part, old, shader->cycles));
    }
  }
}

void CompareScene(const Results& results, const SceneResult& now, const json& baseline, const json& before, BaselineReport& report) {
  if (before.at("width") != now.width || before.at("height") != now.height) {
    const std::string size = fmt::format("{}x{}", NumberOf(before["width"]), NumberOf(before["height"]));
    throw InputError(fmt::format("{}: the baseline has {} pixels; expected --size {}", now.name, size, size));
  }
  const double before_noise = NumberOf(before.at("truth").at("relative_error"));
  const bool same_compilers = baseline.value("isa_compilers", json()) == json(results.compilers);
  for (const json& old : before.at("variants")) {
    const std::string name = old.at("name");
    const auto variant = std::find_if(now.variants.begin(), now.variants.end(), [&](const VariantResult& v) { return v.name == name; });
    const std::string who = fmt::format("{}: {}", now.name, old.at("short_name").get<std::string>());
    if (variant == now.variants.end()) {
      report.notes.push_back(fmt::format("{}: only in the baseline", who));
    } else if (old.at("supported").get<bool>() && !variant->supported) {
      report.worse.push_back(fmt::format("{}: no longer supported: {}", who, variant->reason));
    } else if (variant->supported && old.at("supported").get<bool>()) {
      CompareError(who, *variant, now.truth_relative_error, old, before_noise, report);
      CompareTime(who, variant->time, old, report);
      if (same_compilers) CompareCycles(who, *variant, old, report);
    }
  }
}

}  // namespace

Baseline::Baseline(const std::filesystem::path& path) : file(path), results(ReadResults(path)) {}

BaselineReport CompareWithBaseline(const Results& results, const Baseline& earlier) {
  const json& baseline = earlier.results;
  BaselineReport report;
  try {
    for (const SceneResult& scene : results.scenes) {
      const json* before = Named(baseline.at("scenes"), scene.name);
      if (before == nullptr) {
        report.notes.push_back(fmt::format("{}: not in the baseline", scene.name));
      } else {
        CompareScene(results, scene, baseline, *before, report);
      }
    }
  } catch (const json::exception& error) {
    throw InputError(fmt::format("{}: {}; expected a results.json of this version", earlier.file.string(), error.what()));
  }
  const json compilers = baseline.value("isa_compilers", json());
  if (compilers.is_string() && !results.compilers.empty() && compilers != results.compilers) {
    report.notes.push_back(fmt::format("cycles are not compared: the baseline's are of {}, these of {}", compilers.get<std::string>(),
                                       results.compilers));
  }
  return report;
}

}  // namespace arealab
