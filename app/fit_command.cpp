#include <fmt/format.h>

#include "app/commands.h"
#include "app/progress.h"
#include "glsl/fit.h"

namespace arealab {

void AddFit(CLI::App& app, int& /*status*/) {
  struct Arguments {
    FitOptions options;
    std::string out;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("fit", "Fit the LTC tables; `arealab fit --out glsl/tables` makes the built-in ones");
  command->add_option("--out", arguments->out, "folder of the tables")->required();
  command->add_option("--table", arguments->options.tables, "one table only; may be given several times (default: all)")
      ->check(CLI::IsMember(TableNames()));
  command->add_option("--table-size", arguments->options.size, "nodes per axis")->capture_default_str()->check(CLI::Range(2, 512));
  command->callback([arguments] {
    {
      Progress progress;
      FitTables(arguments->out, arguments->options, [&](double fraction) { progress.Show("fit", fraction); });
    }
    fmt::print("tables: {}\n", arguments->out);
  });
}

}  // namespace arealab
