#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <optional>

#include "app/commands.h"
#include "app/progress.h"
#include "compare/baseline.h"
#include "compare/claims.h"
#include "compare/harness.h"
#include "compare/report.h"
#include "compare/stress_page.h"
#include "compare/sweep.h"
#include "scenes/error.h"

namespace arealab {
namespace {

struct CompareArguments {
  CommonOptions common;
  std::vector<std::string> scenes;
  std::vector<std::string> techniques;
  std::vector<std::string> limits;
  std::string out = "out";
  std::vector<std::string> gpus;
  std::string baseline;
  std::vector<std::string> merge;
  double tolerance = 1e-4;
  bool all_variants = false;
  bool timing = false;
  bool saving = false;
  bool split = false;
  bool hard_cases = false;
  std::vector<std::string> sources;
};

constexpr double kSavingSeconds = 2.0;  // a variant and scene
constexpr int kHardCases = 24000;       // a technique, over all families

struct Limit {
  std::string metric;
  double most;
};

Limit ParseLimit(const std::string& text) {
  const std::size_t equals = text.find('=');
  Limit limit{text.substr(0, equals), 0.0};
  std::size_t used = 0;
  try {
    if (equals != std::string::npos) limit.most = std::stod(text.substr(equals + 1), &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (equals == std::string::npos || used == 0 || used != text.size() - equals - 1 || !(limit.most >= 0.0)) {
    throw InputError(fmt::format("--limit {}: not a limit; expected METRIC=NUMBER, for example rel_rmse=0.05", text));
  }
  MetricByName({}, limit.metric);  // names the metrics if this is none of them
  return limit;
}

std::vector<ClaimSource> ChosenSources(const CompareArguments& arguments) {
  if (arguments.sources.empty()) return ClaimSources();
  std::vector<ClaimSource> sources;
  for (const std::string& name : arguments.sources) sources.push_back(ClaimSources(name).at(0));
  return sources;
}

std::vector<Variant> ChosenVariants(const CompareArguments& arguments, const std::vector<Technique>& techniques) {
  if (arguments.all_variants && !arguments.techniques.empty()) {
    throw InputError("--all-variants and --technique exclude each other; expected one of them");
  }
  if (!arguments.sources.empty() && !arguments.techniques.empty()) {
    throw InputError("--source and --technique exclude each other; expected one of them");
  }
  std::vector<Variant> variants;
  if (arguments.techniques.empty()) {
    const std::vector<ClaimSource> sources = ChosenSources(arguments);
    variants = arguments.all_variants ? AllVariants(techniques) : DefaultVariants(techniques);
    std::erase_if(variants, [&](const Variant& variant) {
      if (arguments.sources.empty()) return variant.technique->yardstick && !arguments.all_variants;
      return std::none_of(sources.begin(), sources.end(), [&](const ClaimSource& source) { return IsFrom(*variant.technique, source); });
    });
    return variants;
  }
  for (const std::string& name : arguments.techniques) {
    const Variant variant = ParseVariant(techniques, name);
    if (std::find(variants.begin(), variants.end(), variant) == variants.end()) variants.push_back(variant);
  }
  return variants;
}

// Prints each excess; a figure that could not be measured (non-finite pixels) exceeds every limit.
bool ExceedsLimits(const Results& results, const std::vector<Limit>& limits) {
  bool exceeded = false;
  for (const SceneResult& scene : results.scenes) {
    for (const VariantResult& variant : scene.variants) {
      if (!variant.supported) continue;
      for (const Limit& limit : limits) {
        const double value = MetricByName(variant.total, limit.metric);
        if (value <= limit.most) continue;
        fmt::print(stderr, "{}: {}: {} {:.4g} exceeds {:.4g}\n", scene.name, variant.short_name, limit.metric, value,
                   limit.most);
        exceeded = true;
      }
    }
  }
  return exceeded;
}

// Prints what is worse than in the earlier run.
bool IsWorse(const Results& results, const Baseline& baseline) {
  const BaselineReport report = CompareWithBaseline(results, baseline);
  for (const std::string& note : report.notes) fmt::print("{}\n", note);
  for (const std::string& line : report.worse) fmt::print(stderr, "{}\n", line);
  fmt::print("{}: {} figures compared, {} worse\n", baseline.file.string(), report.compared, report.worse.size());
  return !report.worse.empty();
}

// Cycles where GPUs are asked for, or by default where the compilers are installed; else why there are none.
std::string PrepareCost(const CompareArguments& arguments, CompareOptions& options) {
  if (arguments.gpus == std::vector<std::string>{"none"}) return "--gpu none";
  const bool asked = !arguments.gpus.empty();
  try {
    options.cost = std::make_shared<CostMeter>(asked ? arguments.gpus : std::vector<std::string>{"bonaire", "navi21"},
                                               options.cache);
  } catch (const InputError& error) {
    if (asked) throw;
    return error.what();
  }
  return "";
}

// Joins the parts of a sweep: folders or their results.json.
int Merge(const CompareArguments& arguments) {
  std::vector<std::string> parts;
  for (const std::string& part : arguments.merge) {
    const std::filesystem::path file = std::filesystem::is_directory(part) ? std::filesystem::path(part) / "results.json" : std::filesystem::path(part);
    std::ifstream in(file);
    if (!in) throw InputError(fmt::format("{}: cannot be read; expected results of `arealab sweep`", file.string()));
    parts.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  fmt::print("{}", WriteSweep(parts, arguments.out));
  fmt::print("sweep: {}\n", (std::filesystem::absolute(arguments.out) / "index.html").lexically_normal().string());
  return 0;
}

int RunCompare(const CompareArguments& arguments, const std::string& command_line) {
  if (!arguments.merge.empty()) return Merge(arguments);
  std::vector<Limit> limits;
  for (const std::string& text : arguments.limits) limits.push_back(ParseLimit(text));
  std::optional<Baseline> baseline;
  if (!arguments.baseline.empty()) baseline.emplace(arguments.baseline);

  const ShaderLibrary library = arguments.common.Library();
  const std::vector<Technique> techniques = LoadTechniques(library);
  CompareOptions options;
  options.variants = ChosenVariants(arguments, techniques);
  options.size = arguments.common.Size();
  options.truth.tolerance = arguments.tolerance;
  options.cache = arguments.common.CacheFolder();
  options.split = arguments.split;
  if (arguments.timing) options.timed_against = ParseVariant(techniques, "point");
  if (arguments.saving) options.saving_seconds = kSavingSeconds;
  const std::string no_isa = PrepareCost(arguments, options);
  if (arguments.scenes.empty()) options.scenes = BuiltInScenes();
  for (const std::string& scene : arguments.scenes) options.scenes.push_back(FindScene(scene));

  Results results;
  {
    Progress progress;
    options.progress = [&](const std::string& what, double fraction) { progress.Show(what, fraction); };
    ReportWriter report(arguments.out);
    options.done = [&](SceneResult& scene) {
      report.Add(scene);
      scene.ReleaseImages();
    };
    const std::unique_ptr<Context> context = arguments.common.MakeContext();
    results = Compare(*context, library, options);
    if (results.no_isa.empty()) results.no_isa = no_isa;
    if (arguments.techniques.empty() && arguments.common.glsl.empty()) {
      progress.Show("claims", 1.0);
      const std::string compilers = options.cost ? options.cost->compilers() : "";
      results.claims = CachedClaimsPages(ChosenSources(arguments), context->renderer() + context->version() + compilers, options.cache,
                                         [&] { return std::make_unique<ClaimBench>(*context, library, options.cost.get()); });
      LinkClaimsPages(results.claims, "index.html");
    }
    if (arguments.hard_cases) {
      StressOptions stress;
      for (const Technique& technique : techniques) {
        if (technique.yardstick) continue;
        stress.variants.push_back(DefaultVariant(technique));
        stress.judged.push_back(true);
      }
      stress.cases = kHardCases;
      stress.pictures = true;
      stress.progress = [&](const std::string& what, double) { progress.Show("hard cases: " + what, 1.0); };
      results.hard_cases = CachedStressPage(*context, library, stress, "index.html", options.cache);
    }
    results.command = command_line;
    results.version = AREALAB_VERSION;
    results.date = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                               fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
    report.Finish(results);
  }
  for (const SceneResult& scene : results.scenes) fmt::print("{}\n", SummaryTable(scene));
  if (arguments.timing && results.software) fmt::print("× point, net: a CPU rasteriser's times, not a GPU's\n");
  if (!results.no_isa.empty()) fmt::print("without cycles: {}\n", results.no_isa);
  fmt::print("report: {}\n", (std::filesystem::absolute(arguments.out) / "index.html").lexically_normal().string());
  const bool exceeded = ExceedsLimits(results, limits), worse = baseline && IsWorse(results, *baseline);
  return exceeded || worse ? kExitLimitExceeded : 0;
}

}  // namespace

void AddCompare(CLI::App& app, int& status, const std::string& command_line) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command =
      app.add_subcommand("compare", "Render scenes through every technique and the truth, and write the report");
  command->add_option("scenes", arguments->scenes, "built-in names or scene files (default: all built-in scenes)");
  command->add_option("--out", arguments->out, "folder of the report")->capture_default_str();
  command->add_option("--technique", arguments->techniques,
                      "a variant, e.g. ltc, ltc@published or ltc+clip=switch; may be given several times "
                      "(default: each technique's default and published form)");
  command->add_option("--source", arguments->sources,
                      "the techniques and claims of one source: hill, mayaux, light_field, drobot or oat; may be given several times");
  command->add_flag("--all-variants", arguments->all_variants, "every combination of every technique's options");
  command->add_option("--limit", arguments->limits,
                      "METRIC=X: exit with status 1 where a variant's total error exceeds X, e.g. rel_rmse=0.05");
  command->add_flag("--split", arguments->split,
                    "say whose error it is: the mathematics', its shortcuts' or rounding's; of LTC cause by cause");
  command->add_flag("--hard-cases", arguments->hard_cases,
                    "add the page of the hard cases: each technique's default form by families (a minute or two, then cached)");
  command->add_flag("--timing", arguments->timing,
                    "time the lighting pass of every variant as a ratio to point, in interleaved rounds");
  command->add_flag("--saving", arguments->saving,
                    "time every variant, and count its cycles, against its program with every effect: what the scene does not call for");
  command->add_option("--gpu", arguments->gpus,
                      "AMD families whose cycles are counted without them, or none (default: bonaire,navi21 where the "
                      "compilers are installed)")
      ->delimiter(',');
  command->add_option("--baseline", arguments->baseline,
                      "results.json of an earlier run: exit with status 1 where something is slower or less accurate beyond the noise")
      ->check(CLI::ExistingFile);
  command->add_option("--merge", arguments->merge, "folders of `arealab sweep --shard`: joins them into --out, and does nothing else");
  command->add_option("--tolerance", arguments->tolerance, "of the truth, relative, per pixel and light")
      ->capture_default_str()
      ->check(Within(1e-8, 1e-1));
  command->add_option("--cache", arguments->common.cache, "folder of truths already computed (default: the user's cache)");
  arguments->common.AddContext(*command);
  arguments->common.AddSize(*command);
  arguments->common.AddGlsl(*command);
  command->callback([arguments, command_line, &status] { status = RunCompare(*arguments, command_line); });
}

}  // namespace arealab
