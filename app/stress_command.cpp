#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/progress.h"
#include "compare/stress.h"
#include "compare/stress_mutants.h"
#include "compare/stress_page.h"
#include "scenes/error.h"

namespace arealab {
namespace {

struct StressArguments {
  CommonOptions common;
  std::vector<std::string> techniques;
  std::int64_t cases = StressOptions{}.cases;
  std::uint64_t seed = StressOptions{}.seed;
  std::string one_case, out;
  BrdfOptions brdfs;
  bool json = false;
  bool mutants = false;
};

// The finite value itself, else null.
nlohmann::ordered_json Figure(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

void PrintStressJson(const StressResult& result) {
  nlohmann::ordered_json json{
      {"schema", 1},         {"renderer", result.renderer},   {"cases", result.cases},
      {"seed", result.seed}, {"failures", result.failures()}, {"variants", nlohmann::ordered_json::array()}};
  for (const VariantStress& variant : result.variants) {
    nlohmann::ordered_json row{{"name", variant.name},
                               {"ideal", variant.ideal},
                               {"judged", variant.judged},
                               {"seconds", variant.seconds},
                               {"families", nlohmann::ordered_json::array()}};
    for (const FamilyResult& family : variant.families) {
      row["families"].push_back({{"name", family.family->name},
                                 {"cases", family.cases},
                                 {"nonfinite", family.nonfinite},
                                 {"nonfinite_strict", family.hidden},
                                 {"negative", family.negative},
                                 {"p999", family.p999},
                                 {"worst", Figure(family.worst)},
                                 {"backward_ulps", Figure(family.backward)},
                                 {"approximation", Figure(family.approximation)},
                                 {"approximation_case", CaseLine(family.approximation_case)},
                                 {"half_tables", Figure(family.half_tables)},
                                 {"fp16", {{"cases", family.fp16_cases},
                                           {"nonfinite", family.fp16_nonfinite},
                                           {"median", Figure(family.fp16_median)},
                                           {"p999", Figure(family.fp16_p999)}}},
                                 {"cause", family.cause},
                                 {"failures", family.failures},
                                 {"case", CaseLine(family.worst_case)}});
    }
    row["paths"] = nlohmann::ordered_json::array();
    for (const PathResult& path : variant.paths) {
      row["paths"].push_back({{"name", path.path->name},
                              {"shape", Name(path.shape)},
                              {"lobe", path.lobe},
                              {"step", Figure(path.step)},
                              {"bend", Figure(path.bend)},
                              {"failures", path.failures}});
    }
    json["variants"].push_back(std::move(row));
  }
  fmt::print("{}\n", json.dump(2));
}

std::string Percent(std::int64_t part, std::int64_t whole) {
  if (part == 0) return "0";
  return fmt::format("{:.2g} %", 100.0 * static_cast<double>(part) / static_cast<double>(std::max<std::int64_t>(whole, 1)));
}

// Which technique bears half floats: those that are finite most often first, then by their ordinary error.
void PrintLowerPrecision(const StressResult& result) {
  struct Row {
    const VariantStress* variant;
    const FamilyResult* ordinary;
  };
  std::vector<Row> rows;
  for (const VariantStress& variant : result.variants) {
    const auto ordinary = std::ranges::find_if(
        variant.families, [](const FamilyResult& f) { return f.family == &StressFamilies()[0]; });
    if (ordinary != variant.families.end()) rows.push_back({&variant, &*ordinary});
  }
  std::ranges::stable_sort(rows, {}, [](const Row& row) {
    return std::pair(row.ordinary->fp16_nonfinite, row.ordinary->fp16_p999);
  });
  fmt::print(
      "\nlower precision, not judged: tables of half floats; fp16, the same text with every input and result a "
      "half float (nearest, infinity above 65504, 0 below 6.1e-5)\n"
      "  {:<24}{:>10}  {:>10}{:>10}{:>10}  {:>20}\n",
      "", "half tab.", "fp16 nf.", "median", "p99.9", "nf. in all families");
  for (const auto& [variant, ordinary] : rows) {
    fmt::print("  {:<24}{:>10.2g}  {:>10}{:>10.2g}{:>10.2g}  {:>20}\n", variant->name, ordinary->half_tables,
               Percent(ordinary->fp16_nonfinite, ordinary->fp16_cases), ordinary->fp16_median,
               ordinary->fp16_p999, Percent(variant->fp16_nonfinite(), variant->fp16_cases()));
  }
}

void PrintStress(const StressResult& result) {
  fmt::print(
      "{}; seed {}; rounding error relative to the larger of the value and the light's maximal "
      "contribution\n",
      result.renderer, result.seed);
  for (const VariantStress& variant : result.variants) {
    const std::int64_t cases = variant.cases();
    fmt::print("\n{}: {} cases, {:.1f} s, {:.0f} per second{}{}\n", variant.name, cases, variant.seconds,
               static_cast<double>(cases) / variant.seconds,
               variant.ideal.empty() ? "" : "; ideal: " + variant.ideal,
               variant.judged ? "" : "; shown, not judged");
    fmt::print("  {:<14}{:>10}{:>7}{:>9}{:>10}{:>10}{:>10}{:>10}{:>10}{:>9}{:>10}\n", "family", "nonfinite",
               "strict", "negative", "p99.9", "worst", "ulps", "approx.", "half tab.", "fp16 nf.", "p99.9");
    for (const FamilyResult& family : variant.families) {
      fmt::print("  {:<14}{:>10}{:>7}{:>9}{:>10.2g}{:>10.2g}{:>10.2g}{:>10.2g}{:>10.2g}{:>9}{:>10}{}\n",
                 family.family->name, family.nonfinite, family.hidden, family.negative, family.p999,
                 family.worst, family.backward, family.approximation, family.half_tables,
                 family.fp16_cases == 0 ? "–" : Percent(family.fp16_nonfinite, family.fp16_cases),
                 family.fp16_cases == 0 ? "–" : fmt::format("{:.2g}", family.fp16_p999),
                 family.family->ill_conditioned ? "  *" : "");
      for (const std::string& failure : family.failures) fmt::print("    FAILS: {}\n", failure);
      if (!family.failures.empty()) fmt::print("    --case '{}'\n", CaseLine(family.worst_case));
      if (!family.cause.empty())
        fmt::print("    bounds {:g}, {:g}, {:g} ulps: {}\n", family.bounds.worst, family.bounds.p999,
                   family.bounds.backward, family.cause);
    }
    for (const PathResult& path : variant.paths) {
      fmt::print("  {:<14}{:<10} {:<9} step {:>8.1e}  bend {:>8.1e}\n", path.path->name, Name(path.shape),
                 path.lobe, path.step, path.bend);
      for (const std::string& failure : path.failures) fmt::print("    FAILS: {}\n", failure);
    }
  }
  PrintLowerPrecision(result);
  fmt::print(
      "\n* an input's last bit moves the answer: the error is judged by the ulps of the inputs that explain "
      "it (backward error)\n"
      "{} failures\n",
      result.failures());
}

void PrintCase(const PointCase& c, const std::vector<CaseValues>& rows, Brdfs brdfs) {
  const LightIntegrals truth = c.Truth(1e-4, brdfs);
  const double specular =
      c.radiance * (c.f0 * (truth.specular - truth.specular_grazing) + truth.specular_grazing);
  const MaximalContribution most = MaximalContributionOf(c);
  const glm::dvec3 to_center = c.center - c.position;
  fmt::print("{}\n\n", CaseLine(c));
  fmt::print("a {} of half size {:.4g} x {:.4g} m, centre {:.4g} m away, {:.4g} m before its plane\n",
             Name(c.shape), c.half_size.x, c.half_size.y, glm::length(to_center),
             -glm::dot(to_center, c.light_normal));
  fmt::print("n.v {:.6g}, centre {:.4g} m over the horizon, roughness {:.4g}, F0 {:.4g}, |n| {:.6g}\n",
             glm::dot(c.normal, c.to_view), glm::dot(to_center, c.normal), c.roughness, c.f0,
             glm::length(c.normal));
  fmt::print("the light's maximal contribution: diffuse {:.6g}, specular {:.6g}\n", most.diffuse,
             most.specular);
  fmt::print("truth: diffuse {:.9g}, specular {:.9g}\n\n", c.radiance * truth.form_factor, specular);
  fmt::print("{:<18}{:>16}{:>16}{:>16}{:>16}{:>16}{:>16}{:>11}{:>9}\n", "", "diffuse float", "double",
             "ideal", "specular float", "double", "ideal", "rounding", "ulps");
  for (const CaseValues& row : rows) {
    fmt::print("{:<18}{:>16.9g}{:>16.9g}{:>16.9g}{:>16.9g}{:>16.9g}{:>16.9g}{:>11.3g}{:>9.3g}\n", row.variant,
               row.in_float.diffuse, row.in_double.diffuse, row.ideal.diffuse, row.in_float.specular,
               row.in_double.specular, row.ideal.specular, row.rounding, row.backward);
  }
}

// At least 19 of 20 are to be caught.
int RunMutantTest(const CommonOptions& common) {
  MutantOptions options;
  options.golden = AREALAB_GOLDEN_DIR;
  std::vector<MutantResult> results;
  {
    Progress progress;
    options.progress = [&](const std::string& what, double fraction) { progress.Show(what, fraction); };
    results = RunMutants(*common.MakeContext(), options);
  }
  std::ptrdiff_t caught = 0, survived = 0;
  for (const MutantResult& result : results) {
    const bool equivalent = result.caught.empty() && result.mutant->equivalent != nullptr;
    caught += !result.caught.empty();
    survived += result.caught.empty() && !equivalent;
    fmt::print("{:<10} {:<12} {:<32} {}\n           {}\n",
               !result.caught.empty() ? "caught"
               : equivalent           ? "equivalent"
                                      : "SURVIVED",
               result.mutant->technique, result.mutant->file, result.mutant->what,
               equivalent ? result.mutant->equivalent : result.caught);
  }
  fmt::print("{} caught, {} survived, {} equivalent\n", caught, survived,
             static_cast<std::ptrdiff_t>(results.size()) - caught - survived);
  return 20 * survived <= caught + survived ? 0 : kExitLimitExceeded;
}

int RunStress(const StressArguments& arguments) {
  const ShaderLibrary library = arguments.common.Library();
  const std::vector<Technique> techniques = LoadTechniques(library);
  StressOptions options;
  options.cases = arguments.cases;
  options.seed = arguments.seed;
  options.pictures = !arguments.out.empty();
  options.fp16 = true;
  options.brdfs = arguments.brdfs.Chosen();
  // A variant that is asked for is judged; of all, the default forms are.
  for (const std::string& name : arguments.techniques)
    options.variants.push_back(ParseVariant(techniques, name));
  if (options.variants.empty()) options.variants = DefaultVariants(techniques);
  const Scene surfaces = arguments.brdfs.On({});
  std::erase_if(options.variants, [&](const Variant& variant) {
    const auto why = WhyUnsupported(variant, surfaces);
    if (why && !arguments.techniques.empty()) throw InputError(fmt::format("stress: {}; expected a technique that knows both BRDFs", *why));
    return why.has_value();
  });
  for (const Variant& variant : options.variants) {
    options.judged.push_back(!arguments.techniques.empty() || variant == DefaultVariant(*variant.technique));
  }
  CommonOptions common = arguments.common;
  if (common.context.empty()) common.context = "osmesa";
  if (arguments.mutants) return RunMutantTest(common);
  const std::unique_ptr<Context> context = common.MakeContext();
  if (!arguments.one_case.empty()) {
    const PointCase c = ParseCase(arguments.one_case);
    PrintCase(c, ShadeCase(*context, library, options.variants, c, options.brdfs), options.brdfs);
    return 0;
  }
  StressResult result;
  {
    Progress progress;
    options.progress = [&](const std::string& what, double fraction) { progress.Show(what, fraction); };
    result = Stress(*context, library, options);
  }
  if (!arguments.out.empty()) WriteStressPage(result, arguments.out);
  if (arguments.json) {
    PrintStressJson(result);
  } else {
    PrintStress(result);
  }
  return result.failures() == 0 ? 0 : kExitLimitExceeded;
}

}  // namespace

void AddStress(CLI::App& app, int& status) {
  auto arguments = std::make_shared<StressArguments>();
  CLI::App* command = app.add_subcommand("stress",
                                         "Hard cases through every technique, in float and as the same text "
                                         "in double: NaN, negatives, rounding");
  command->add_option("--technique", arguments->techniques,
                      "a variant, judged; may be given several times (default: each technique's default "
                      "form, judged, and published form, shown)");
  command->add_option("--cases", arguments->cases, "of each variant, over all families")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->add_option("--seed", arguments->seed, "of the generators")->capture_default_str()->check(Within(0.0, 4294967295.0));
  command->add_option(
      "--case", arguments->one_case,
      "a case as the command prints it: what it is, and each variant's value in float, double, ideal form");
  command->add_flag("--mutants", arguments->mutants,
                    "test the checks instead: wrong shader text, one slip at a time, and what catches it");
  command->add_option("--out", arguments->out, "folder for stress.html and the worst cases as scenes");
  command->add_flag("--json", arguments->json, "print the figures as JSON");
  arguments->brdfs.Add(*command);
  arguments->common.AddContext(*command);
  arguments->common.AddGlsl(*command);
  command->callback([arguments, &status] { status = RunStress(*arguments); });
}

}  // namespace arealab
