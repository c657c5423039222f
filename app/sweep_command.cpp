#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>

#include "app/commands.h"
#include "app/progress.h"
#include "compare/harness.h"
#include "compare/sweep.h"
#include "scenes/error.h"
#include "scenes/replace_file.h"

namespace arealab {
namespace {

struct SweepArguments {
  CommonOptions common;
  std::string axis;
  std::vector<double> values;
  std::vector<std::string> techniques;
  std::string shard = "1/1";
  std::string out = "sweep";
  double seconds = 3.0;
};

// "2/4": every fourth value, from the second on.
std::vector<double> Share(const std::vector<double>& values, const std::string& shard) {
  int index = 0, count = 0, used = 0;
  if (std::sscanf(shard.c_str(), "%d/%d%n", &index, &count, &used) != 2 || static_cast<std::size_t>(used) != shard.size() ||
      count < 1 || index < 1 || index > count) {
    throw InputError(fmt::format("--shard {}: not a share; expected i/n with i from 1 to n", shard));
  }
  std::vector<double> share;
  for (std::size_t v = static_cast<std::size_t>(index) - 1; v < values.size(); v += static_cast<std::size_t>(count)) {
    share.push_back(values[v]);
  }
  if (share.empty()) throw InputError(fmt::format("--shard {}: nothing is left of {} values; expected fewer parts", shard, values.size()));
  return share;
}

std::vector<std::string> Names(const SweepAxis& axis, const SweepArguments& arguments, double value) {
  std::vector<std::string> names = arguments.techniques;
  if (names.empty()) names = {"point", "ltc", "ltc@published", "hill", "hill@published", "drobot"};
  if (axis.name == "samples") names.push_back(fmt::format("monte_carlo+samples={}", value));
  return names;
}

void RunSweep(const SweepArguments& arguments, const std::string& command_line) {
  const SweepAxis& axis = FindSweepAxis(arguments.axis);
  const std::vector<double> values = Share(arguments.values.empty() ? axis.values : arguments.values, arguments.shard);
  const ShaderLibrary library = arguments.common.Library();
  const std::vector<Technique> techniques = LoadTechniques(library);
  const std::filesystem::path folder = arguments.out;
  std::error_code error;
  std::filesystem::create_directories(folder / "scenes", error);
  if (error) throw InputError(fmt::format("{}: cannot be created; expected a folder that may be written to", arguments.out));
  const std::unique_ptr<Context> context = arguments.common.MakeContext();
  CompareOptions options;
  options.cache = arguments.common.CacheFolder();
  if (arguments.seconds > 0.0) options.timed_against = ParseVariant(techniques, "point");
  options.timing.seconds = arguments.seconds;
  std::string no_isa;
  try {
    options.cost = std::make_shared<CostMeter>(std::vector<std::string>{"bonaire", "navi21"}, options.cache);
  } catch (const InputError& missing) {
    no_isa = missing.what();
  }
  Results results;
  {
    Progress progress;
    for (std::size_t v = 0; v < values.size(); ++v) {
      const SweepPoint point = MakeSweepPoint(axis, values[v], arguments.common.Size());
      const std::filesystem::path file = folder / "scenes" / fmt::format("{}-{}.toml", axis.name, values[v]);
      ReplaceFile(file, point.scene);
      options.scenes = {file};
      options.size = point.size;
      options.variants.clear();
      for (const std::string& name : Names(axis, arguments, values[v])) options.variants.push_back(ParseVariant(techniques, name));
      options.progress = [&](const std::string& what, double fraction) {
        progress.Show(what, (static_cast<double>(v) + fraction) / static_cast<double>(values.size()));
      };
      Results one = Compare(*context, library, options);
      for (VariantResult& variant : one.scenes[0].variants) variant.image.reset();  // figures are what is kept
      one.scenes[0].truth.reset();
      if (v == 0) results = one;
      else results.scenes.push_back(one.scenes[0]);
    }
  }
  if (results.no_isa.empty()) results.no_isa = no_isa;
  results.command = command_line;
  results.version = AREALAB_VERSION;
  results.date = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                             fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
  fmt::print("{}", WriteSweep({SweepResults(ResultsJson(results), axis, values)}, folder));
  fmt::print("sweep: {}\n", (std::filesystem::absolute(folder) / "index.html").lexically_normal().string());
}

}  // namespace

void AddSweep(CLI::App& app, int& /*status*/, const std::string& command_line) {
  auto arguments = std::make_shared<SweepArguments>();
  arguments->common.size = "256x256";
  CLI::App* command = app.add_subcommand("sweep", "How error and cost grow along an axis: curves, the cost's exponent");
  std::string axes;
  for (const SweepAxis& axis : SweepAxes()) axes += (axes.empty() ? "" : ", ") + axis.name;
  command->add_option("axis", arguments->axis, axes)->required();
  command->add_option("--values", arguments->values, "along the axis, in its unit (default: those of the axis)")->delimiter(',');
  command->add_option("--technique", arguments->techniques,
                      "a variant; may be given several times (default: point, ltc, hill and their published forms, drobot)");
  command->add_option("--shard", arguments->shard, "i/n: every n-th value from the i-th on; `compare --merge` joins the parts")
      ->capture_default_str();
  command->add_option("--out", arguments->out, "folder of the curves")->capture_default_str();
  command->add_option("--seconds", arguments->seconds, "of clock for the times at each value; 0: no times")->capture_default_str()->check(Within(0.0, 600.0));
  command->add_option("--cache", arguments->common.cache, "folder of truths already computed (default: the user's cache)");
  arguments->common.AddContext(*command);
  arguments->common.AddSize(*command);
  arguments->common.AddGlsl(*command);
  command->callback([arguments, command_line] { RunSweep(*arguments, command_line); });
}

}  // namespace arealab
