// The commands of `arealab`. Each adds its subcommand to the parser and runs when it is chosen; an InputError thrown by
// one is printed as a line by main, with exit status 2.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>

#include "compare/context.h"
#include "glsl/shader_library.h"
#include "scenes/scene.h"

namespace arealab {

// What several commands take.
struct CommonOptions {
  std::string context;          // "egl", "osmesa" or empty: the best there is
  std::string size = "512x512";
  std::string glsl;             // folder whose shader files win over the embedded ones
  std::string cache;            // folder of truths

  void AddContext(CLI::App& command);
  void AddSize(CLI::App& command);
  void AddGlsl(CLI::App& command);

  std::unique_ptr<Context> MakeContext() const;
  ShaderLibrary Library() const;
  glm::ivec2 Size() const;  // throws InputError
  std::filesystem::path CacheFolder() const;
};

// Where no scene says it: the BRDFs.
struct BrdfOptions {
  std::string specular = "ggx", diffuse = "lambert";

  void Add(CLI::App& command);
  Brdfs Chosen() const;
  Scene On(Scene scene) const;  // the scene with these
};

// CLI::Range lets NaN pass.
CLI::Validator Within(double low, double high);

constexpr int kExitLimitExceeded = 1;
constexpr int kExitBadInput = 2;

// Each returns nothing; `status` is the program's exit status, set by the command that ran.
void AddCompare(CLI::App& app, int& status, const std::string& command_line);
void AddRender(CLI::App& app, int& status);
void AddList(CLI::App& app, int& status);
void AddFit(CLI::App& app, int& status);
void AddCheck(CLI::App& app, int& status);
void AddBake(CLI::App& app, int& status);
void AddCost(CLI::App& app, int& status);
void AddSweep(CLI::App& app, int& status, const std::string& command_line);
void AddView(CLI::App& app, int& status);
void AddStress(CLI::App& app, int& status);
void AddExplain(CLI::App& app, int& status);
void AddExport(CLI::App& app, int& status);
void AddClaims(CLI::App& app, int& status);

}  // namespace arealab
