#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/progress.h"
#include "glsl/fit.h"
#include "scenes/error.h"
#include "scenes/replace_file.h"

namespace arealab {
namespace {

struct FitArguments {
  FitOptions options;
  std::string out;
  std::string quality, map;
};

void PrintQuality(const std::filesystem::path& folder, const std::vector<std::string>& names) {
  for (const Brdf brdf : kFittedBrdfs) {
    for (const FitKind kind : KindsOf(brdf)) {
      const std::string name = TableName(brdf, kind);
      if (!names.empty() && std::find(names.begin(), names.end(), name) == names.end()) continue;
      FitQuality quality;
      {
        Progress progress;
        quality = MeasureFit(ReadLtcTables(folder, brdf, kind), {}, [&](double fraction) { progress.Show(name, fraction); });
      }
      fmt::print("{}\n\n{}\n", name, QualityTable(quality));
    }
  }
}

// What the report's panel shows, as a file: figures rounded to four digits, so that another libm writes the same.
void WriteMaps(const std::filesystem::path& folder, const std::vector<std::string>& names, const std::string& file) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  const auto rounded = [](const std::vector<double>& values) {
    std::vector<double> result;
    for (const double v : values) result.push_back(std::stod(fmt::format("{:.3e}", v)));
    return result;
  };
  for (const Brdf brdf : kFittedBrdfs) {
    for (const FitKind kind : KindsOf(brdf)) {
      const std::string name = TableName(brdf, kind);
      if (!names.empty() && std::find(names.begin(), names.end(), name) == names.end()) continue;
      Progress progress;
      const FitMap map = MapFit(ReadLtcTables(folder, brdf, kind), {}, [&](double fraction) { progress.Show(name, fraction); });
      json.push_back({{"table", map.table},
                      {"brdf", map.brdf},
                      {"rectangles", map.options.rectangles},
                      {"seed", map.options.seed},
                      {"roughness", map.roughness},
                      {"degrees", map.degrees},
                      {"polygon", rounded(map.polygon)},
                      {"lobe", rounded(map.lobe)},
                      {"below", rounded(map.below)}});
    }
  }
  std::string text = "[";  // a line for each table
  for (const auto& map : json) text += (text.size() > 1 ? ",\n" : "\n") + map.dump();
  ReplaceFile(file, text + "\n]\n");
}

void RunFit(const FitArguments& arguments) {
  if (arguments.out.empty() == arguments.quality.empty()) {
    throw InputError("arealab fit takes either --out or --quality; expected one of them");
  }
  if (!arguments.map.empty() && arguments.quality.empty()) throw InputError("--map goes with --quality; expected both");
  if (!arguments.quality.empty()) {
    if (arguments.map.empty()) {
      PrintQuality(arguments.quality, arguments.options.tables);
    } else {
      WriteMaps(arguments.quality, arguments.options.tables, arguments.map);
    }
    return;
  }
  {
    Progress progress;
    FitTables(arguments.out, arguments.options, [&](double fraction) { progress.Show("fit", fraction); });
  }
  fmt::print("tables: {}\n", arguments.out);
}

}  // namespace

void AddFit(CLI::App& app, int& /*status*/) {
  auto arguments = std::make_shared<FitArguments>();
  CLI::App* command = app.add_subcommand("fit", "Fit the LTC tables; `arealab fit --out glsl/tables` makes the built-in ones");
  command->add_option("--out", arguments->out, "folder to write the tables to");
  command->add_option("--quality", arguments->quality, "folder of tables to measure, on random rectangles, instead");
  command->add_option("--map", arguments->map,
                      "file for --quality over roughness and angle, the report's panel; `arealab fit --quality glsl/tables --map glsl/tables/quality.json` makes the built-in one");
  command->add_option("--table", arguments->options.tables, "one table only; may be given several times (default: all)")
      ->check(CLI::IsMember(TableNames()));
  command->add_option("--table-size", arguments->options.size, "nodes per axis")->capture_default_str()->check(CLI::Range(2, 512));
  command->callback([arguments] { RunFit(*arguments); });
}

}  // namespace arealab
