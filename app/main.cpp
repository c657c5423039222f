#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <string>

#include "app/commands.h"
#include "scenes/error.h"

namespace {

std::string CommandLine(int argc, char** argv) {
  std::string line = "arealab";
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    line += word.find_first_of(" \t'\"") == std::string::npos ? " " + word : " '" + word + "'";
  }
  return line;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("AreaLab compares area-light shading techniques: error maps against ground truth, and what accuracy costs.",
               "arealab");
  app.require_subcommand(1);
  app.set_version_flag("--version", "arealab " AREALAB_VERSION);
  int status = 0;
  arealab::AddCompare(app, status, CommandLine(argc, argv));
  arealab::AddRender(app, status);
  arealab::AddList(app, status);
  arealab::AddFit(app, status);
  arealab::AddCheck(app, status);
  arealab::AddBake(app, status);
  arealab::AddCost(app, status);
  arealab::AddSweep(app, status, CommandLine(argc, argv));
  arealab::AddView(app, status);
  arealab::AddStress(app, status);
  arealab::AddExplain(app, status);
  arealab::AddExport(app, status);
  arealab::AddClaims(app, status);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const CLI::CallForAllHelp& help) {
    return app.exit(help);
  } catch (const CLI::CallForVersion& version) {
    return app.exit(version);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "arealab: {}; `arealab --help` lists what exists\n", error.what());
    return arealab::kExitBadInput;
  } catch (const arealab::InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return arealab::kExitBadInput;
  } catch (const std::exception& error) {
    fmt::print(stderr, "arealab: {}\n", error.what());
    return arealab::kExitBadInput;
  }
  return status;
}
