#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <span>

#include "app/commands.h"
#include "compare/program_cache.h"
#include "scenes/error.h"

namespace arealab {

void CommonOptions::AddContext(CLI::App& command) {
  command.add_option("--context", context, "OpenGL from egl or osmesa (default: EGL on a GPU if there is one, else OSMesa)")
      ->check(CLI::IsMember({"egl", "osmesa"}));
}

void CommonOptions::AddSize(CLI::App& command) {
  command.add_option("--size", size, "of the picture, WxH in pixels")->capture_default_str();
}

void BrdfOptions::Add(CLI::App& command) {
  const auto names = [](std::span<const Brdf> brdfs) {
    std::vector<std::string> all;
    for (const Brdf brdf : brdfs) all.emplace_back(Name(brdf));
    return all;
  };
  command.add_option("--brdf", specular, "where no scene says it")->capture_default_str()->check(CLI::IsMember(names(kBrdfs)));
  command.add_option("--diffuse", diffuse, "the diffuse BRDF, where no scene says it")->capture_default_str()->check(CLI::IsMember(names(kDiffuseBrdfs)));
}

Brdfs BrdfOptions::Chosen() const {
  const auto named = [](std::span<const Brdf> known, const std::string& wanted) {
    return *std::ranges::find(known, wanted, [](Brdf brdf) { return std::string(Name(brdf)); });
  };
  return {named(kBrdfs, specular), named(kDiffuseBrdfs, diffuse)};
}

Scene BrdfOptions::On(Scene scene) const {
  scene.brdf = Chosen().specular;
  scene.diffuse = Chosen().diffuse;
  return scene;
}

void CommonOptions::AddGlsl(CLI::App& command) {
  command.add_option("--glsl", glsl, "folder whose shader files win over the built-in ones (techniques/NAME.glsl, …)");
}

std::unique_ptr<Context> CommonOptions::MakeContext() const {
  KeepProgramsIn(ProgramsInFolder(CacheFolder()));
  if (context.empty()) return CreateContext();
  return CreateContext(context == "egl" ? ContextKind::kEgl : ContextKind::kOsmesa);
}

ShaderLibrary CommonOptions::Library() const {
  if (glsl.empty()) return ShaderLibrary();
  if (!std::filesystem::is_directory(glsl)) {
    throw InputError(fmt::format("{}: no such folder; expected one with shader files for --glsl", glsl));
  }
  return ShaderLibrary(glsl);
}

glm::ivec2 CommonOptions::Size() const {
  constexpr int kMaxSize = 8192;  // what every OpenGL 4.5 driver seen can draw to
  glm::ivec2 parsed(0);
  int used = 0;
  if (std::sscanf(size.c_str(), "%dx%d%n", &parsed.x, &parsed.y, &used) != 2 ||
      static_cast<std::size_t>(used) != size.size() || parsed.x < 1 || parsed.y < 1 || parsed.x > kMaxSize ||
      parsed.y > kMaxSize) {
    throw InputError(fmt::format("--size {}: not a size; expected WxH with each from 1 to {}", size, kMaxSize));
  }
  return parsed;
}

std::filesystem::path CommonOptions::CacheFolder() const {
  if (!cache.empty()) return cache;
  if (const char* folder = std::getenv("XDG_CACHE_HOME"); folder != nullptr && *folder != '\0') {
    return std::filesystem::path(folder) / "arealab";
  }
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0') {
    return std::filesystem::path(home) / ".cache" / "arealab";
  }
  return std::filesystem::temp_directory_path() / "arealab";
}

CLI::Validator Within(double low, double high) {
  return CLI::Validator(
      [low, high](std::string& text) {
        double value = 0.0;
        const bool within = CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
        return within ? std::string() : fmt::format("{} is not from {:g} to {:g}", text, low, high);
      },
      fmt::format("FLOAT in [{:g} - {:g}]", low, high));
}

}  // namespace arealab
