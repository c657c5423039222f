#include <fmt/format.h>

#include <chrono>

#include "app/commands.h"
#include "app/progress.h"
#include "compare/aperture_cache.h"
#include "scenes/error.h"

namespace arealab {
namespace {

struct BakeArguments {
  CommonOptions common;
  std::string scene;
};

void RunBake(const BakeArguments& arguments) {
  Scene scene = LoadScene(FindScene(arguments.scene));
  if (!scene.aperture) {
    throw InputError(fmt::format("{}:1: the scene asks for no visibility; expected a table [aperture]", scene.file.string()));
  }
  const auto start = std::chrono::steady_clock::now();
  bool cached = false;
  {
    Progress progress;
    cached = CachedApertures(scene, arguments.common.CacheFolder(),
                             [&](double fraction) { progress.Show("apertures", fraction); });
  }
  std::size_t vertices = 0, closed = 0;
  double open = 0.0;
  for (const Mesh& mesh : scene.meshes) {
    vertices += mesh.apertures.size();
    for (const Aperture& aperture : mesh.apertures) {
      open += static_cast<double>(aperture.open.w);
      closed += aperture.open.w == 0.0f;
    }
  }
  fmt::print("{}: {} vertices, {} rays each, {:.1f} % of their hemispheres open, {} closed; {} in {:.2f} s, in {}\n", scene.name,
             vertices, scene.aperture->rays, 100.0 * open / static_cast<double>(vertices), closed, cached ? "read" : "baked",
             std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
             arguments.common.CacheFolder().string());
}

}  // namespace

void AddBake(CLI::App& app, int& /*status*/) {
  auto arguments = std::make_shared<BakeArguments>();
  CLI::App* command = app.add_subcommand(
      "bake", "Bake what each vertex of a scene with a table [aperture] sees into a spherical cap (others do it on need)");
  command->add_option("scene", arguments->scene, "a built-in name or a scene file")->required();
  command->add_option("--cache", arguments->common.cache, "folder of what was baked already (default: the user's cache)");
  command->callback([arguments] { RunBake(*arguments); });
}

}  // namespace arealab
