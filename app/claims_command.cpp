#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "app/commands.h"
#include "app/progress.h"
#include "compare/claims.h"
#include "scenes/error.h"
#include "scenes/replace_file.h"

namespace arealab {
namespace {

struct ClaimsArguments {
  CommonOptions common;
  std::string source, out;
  bool no_cost = false;
};

void RunClaims(const ClaimsArguments& arguments) {
  const std::vector<ClaimSource> sources = ClaimSources(arguments.source);
  const ShaderLibrary library = arguments.common.Library();
  std::optional<CostMeter> meter;
  std::string no_cost = arguments.no_cost ? "--no-cost" : "";
  if (!arguments.no_cost) {
    try {
      meter.emplace(std::vector<std::string>{"bonaire"}, arguments.common.CacheFolder());
    } catch (const InputError& error) {
      no_cost = error.what();
    }
  }
  const std::unique_ptr<Context> context = arguments.common.MakeContext();
  ClaimBench bench(*context, library, meter ? &*meter : nullptr);
  std::vector<ClaimsPage> pages;
  for (const ClaimSource& source : sources) {
    const std::vector<CheckedClaim> checked = CheckClaims(source, bench);
    fmt::print("{}: {}\n", source.citation, source.title);
    for (const auto& [claim, finding] : checked) fmt::print("  {}: {}\n{}", claim.where, claim.sentence, FindingText(finding));
    pages.push_back(MakeClaimsPage(source, checked));
  }
  if (!no_cost.empty()) fmt::print("without cycles: {}\n", no_cost);
  LinkClaimsPages(pages);
  if (!arguments.out.empty()) {
    for (const ClaimsPage& page : pages) {
      ReplaceFile(std::filesystem::path(arguments.out) / fmt::format("claims-{}.html", page.name), page.html);
    }
    fmt::print("pages: {}\n", (std::filesystem::absolute(arguments.out) / fmt::format("claims-{}.html", sources[0].name)).lexically_normal().string());
  }
}

}  // namespace

void AddClaims(CLI::App& app, int& /*status*/) {
  auto arguments = std::make_shared<ClaimsArguments>();
  CLI::App* command = app.add_subcommand("claims", "Check what the sources claim: each claim with our figure and whether it holds");
  command->add_option("--source", arguments->source, "hill, mayaux, light_field, drobot or oat (default: all)");
  command->add_option("--out", arguments->out, "folder for the pages claims-NAME.html");
  command->add_flag("--no-cost", arguments->no_cost, "leave out what needs a GPU's compiler");
  command->add_option("--cache", arguments->common.cache, "folder of cycles already counted (default: the user's cache)");
  arguments->common.AddContext(*command);
  arguments->common.AddGlsl(*command);
  command->callback([arguments] { RunClaims(*arguments); });
}

}  // namespace arealab
