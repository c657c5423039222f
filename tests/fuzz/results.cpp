// results.json as an earlier run's (compare --baseline) and as a part of a sweep (compare --merge).
#include "compare/baseline.h"
#include "compare/sweep.h"
#include "tests/fuzz/targets.h"

namespace arealab::fuzz {
namespace {

Results Sample() {
  Results results;
  results.compilers = "radv";
  SceneResult& scene = results.scenes.emplace_back();
  scene.name = "gloss";
  scene.width = scene.height = 8;
  scene.truth_relative_error = 1e-4;
  for (const char* name : {"ltc", "point"}) {
    VariantResult& variant = scene.variants.emplace_back();
    variant.name = variant.short_name = name;
    variant.total.rel_rmse = variant.diffuse.rel_rmse = variant.specular.rel_rmse = 0.07;
    variant.time.ratio_to_point = {3.0, 2.9, 3.1};
    variant.isa["bonaire"].core.cycles = 2058;
    variant.isa["bonaire"].full.cycles = 2500;
  }
  return results;
}

}  // namespace

void ResultsFile(Bytes bytes) {
  static const Results now = Sample();
  const std::string text = Text(bytes);
  const std::filesystem::path file = File("results.json", text);
  Reads([&] { CompareWithBaseline(now, Baseline(file)); });
  Reads([&] { WriteSweep({text, text}, Folder() / "sweep"); });
}

}  // namespace arealab::fuzz
