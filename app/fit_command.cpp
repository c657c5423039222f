#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "app/commands.h"
#include "app/progress.h"
#include "glsl/fit.h"
#include "scenes/error.h"

namespace arealab {
namespace {

struct FitArguments {
  FitOptions options;
  std::string out;
  std::string quality;
};

void PrintQuality(const std::filesystem::path& folder, const std::vector<std::string>& names) {
  for (const Brdf brdf : kBrdfs) {
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

void RunFit(const FitArguments& arguments) {
  if (arguments.out.empty() == arguments.quality.empty()) {
    throw InputError("arealab fit takes either --out or --quality; expected one of them");
  }
  if (!arguments.quality.empty()) {
    PrintQuality(arguments.quality, arguments.options.tables);
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
  command->add_option("--table", arguments->options.tables, "one table only; may be given several times (default: all)")
      ->check(CLI::IsMember(TableNames()));
  command->add_option("--table-size", arguments->options.size, "nodes per axis")->capture_default_str()->check(CLI::Range(2, 512));
  command->callback([arguments] { RunFit(*arguments); });
}

}  // namespace arealab
