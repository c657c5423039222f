#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "app/commands.h"
#include "app/progress.h"
#include "compare/check.h"
#include "compare/check_page.h"
#include "scenes/error.h"

namespace arealab {
namespace {

struct CheckArguments {
  CommonOptions common;
  std::vector<std::string> scenes;
  std::vector<std::string> techniques;
  std::string golden = AREALAB_GOLDEN_DIR;
  std::string out = AREALAB_CHECK_DIR;
  std::int64_t hard_cases = 12000;
  bool update = false;
};

std::string ShellArgument(const char* name, const std::string& value) {
  return fmt::format(" {} '{}'", name, value);
}

int RunCheck(const CheckArguments& arguments) {
  const ShaderLibrary library = arguments.common.Library();
  const std::vector<Technique> techniques = LoadTechniques(library);
  CheckOptions options;
  options.golden = arguments.golden;
  options.update = arguments.update;
  options.all_scenes = arguments.scenes.empty();
  options.all_variants = arguments.techniques.empty();
  if (options.all_scenes) options.hard_cases = arguments.hard_cases;
  if (arguments.golden != AREALAB_GOLDEN_DIR) options.repeated_of_images = ShellArgument("--golden", arguments.golden);
  if (!arguments.common.glsl.empty()) options.repeated += ShellArgument("--glsl", arguments.common.glsl);
  if (!arguments.common.context.empty()) options.repeated += " --context " + arguments.common.context;
  if (options.all_variants) options.variants = DefaultVariants(techniques);
  for (const std::string& name : arguments.techniques) {
    const Variant variant = ParseVariant(techniques, name);
    if (std::find(options.variants.begin(), options.variants.end(), variant) == options.variants.end()) {
      options.variants.push_back(variant);
    }
  }
  if (options.all_scenes) options.scenes = BuiltInScenes();
  for (const std::string& scene : arguments.scenes) options.scenes.push_back(FindScene(scene));

  // OSMesa unless told otherwise: it is the same on a desk and on a build server.
  CommonOptions common = arguments.common;
  if (common.context.empty()) common.context = "osmesa";
  CheckResult result;
  {
    Progress progress;
    options.progress = [&](const std::string& what, double fraction) { progress.Show(what, fraction); };
    const std::unique_ptr<Context> context = common.MakeContext();
    result = Check(*context, library, options);
  }

  for (const CheckCase& row : result.cases) {
    for (const std::string& change : row.changes) fmt::print("{}: {}\n", row.Title(), change);
  }
  for (const CheckCase& row : result.cases) {
    for (const CheckFailure& failure : row.failures) {
      fmt::print(stderr, "{}: {}: {}\n", row.Title(), Name(failure.kind), failure.message);
    }
  }
  const std::filesystem::path out = std::filesystem::absolute(arguments.out).lexically_normal();
  WriteCheckReport(result, out);
  if (result.failures() == 0) {
    fmt::print("{} images {} {}; {} not supported{}\n", result.checked,
               arguments.update ? "stored in" : "pass against", arguments.golden, result.unsupported,
               result.hard == 0 ? "" : fmt::format("; {} hard families and paths pass", result.hard));
    return 0;
  }
  const auto failed = std::count_if(result.cases.begin(), result.cases.end(),
                                    [](const CheckCase& row) { return !row.failures.empty(); });
  fmt::print("{} failures in {} of {} images, hard families and paths: {}\n", result.failures(), failed,
             result.checked + result.hard, (out / "check.html").string());
  return kExitLimitExceeded;
}

}  // namespace

void AddCheck(CLI::App& app, int& status) {
  auto arguments = std::make_shared<CheckArguments>();
  CLI::App* command = app.add_subcommand(
      "check", "Test every technique's image against its stored one, its error against the truth's band, and its hard cases");
  command->add_option("scenes", arguments->scenes,
                      "built-in names or scene files (default: all built-in scenes)");
  command->add_option("--golden", arguments->golden, "folder of the stored images and bands.json")
      ->capture_default_str();
  command->add_flag("--update", arguments->update,
                    "store what is drawn now, and print old and new error of what changed");
  command->add_option("--hard-cases", arguments->hard_cases,
                      "how many of each technique's default form, where no scene is named; 0: none (see stress)")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command->add_option("--out", arguments->out,
                      "folder for junit.xml, and for check.html and pictures/ of what failed")
      ->capture_default_str();
  command->add_option(
      "--technique", arguments->techniques,
      "a variant; may be given several times (default: each technique's default and published form)");
  arguments->common.AddContext(*command);
  arguments->common.AddGlsl(*command);
  command->callback([arguments, &status] { status = RunCheck(*arguments); });
}

}  // namespace arealab
