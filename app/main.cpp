#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <string>

#include "app/commands.h"
#include "compare/cache_file.h"
#include "scenes/error.h"

namespace {

// What a file or an argument holds may break the line or reach the terminal.
std::string OneLine(std::string text) {
  for (char& c : text) c = static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
  return text;
}

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
    fmt::print(stderr, "arealab: {}; `arealab --help` lists what exists\n", OneLine(error.what()));
    return arealab::kExitBadInput;
  } catch (const arealab::InputError& error) {
    fmt::print(stderr, "{}\n", OneLine(error.what()));
    return arealab::kExitBadInput;
  } catch (const std::exception& error) {
    fmt::print(stderr, "arealab: {}\n", OneLine(error.what()));
    return arealab::kExitBadInput;
  }
  if (const int damaged = arealab::DamagedCacheEntries(); damaged > 0) {
    fmt::print(stderr, "cache: {} damaged {} made anew\n", damaged, damaged == 1 ? "entry was" : "entries were");
  }
  if (std::fflush(stdout) != 0) {
    fmt::print(stderr, "standard output cannot be written; expected room\n");
    return arealab::kExitBadInput;
  }
  return status;
}
