// The scene reader; what it takes is finite, and its writer finds its way through the text.
#include "scenes/scene.h"

#include <cmath>

#include "scenes/write.h"
#include "tests/fuzz/targets.h"

namespace arealab::fuzz {
namespace {

template <int N>
bool IsFinite(const glm::vec<N, double>& v) {
  for (int i = 0; i < N; ++i) {
    if (!std::isfinite(v[i])) return false;
  }
  return true;
}

void RequireSound(const Scene& scene) {
  Require(IsFinite(scene.camera.position) && IsFinite(scene.camera.target) && IsFinite(scene.camera.up), "camera");
  for (const Light& light : scene.lights) {
    Require(IsFinite(light.center) && IsFinite(light.axis_x) && IsFinite(light.axis_y) && IsFinite(light.normal), "light's place");
    Require(IsFinite(light.radiance) && light.Area() > 0.0 && std::isfinite(light.Flux()), "light's emission");
  }
  for (const Mesh& mesh : scene.meshes) {
    Require(mesh.material >= 0 && static_cast<std::size_t>(mesh.material) < scene.materials.size(), "material");
    for (const std::uint32_t index : mesh.indices) Require(index < mesh.vertices.size(), "index");
    for (const Vertex& v : mesh.vertices) {
      Require(IsFinite(glm::dvec3(v.position)) && IsFinite(glm::dvec3(v.normal)) && IsFinite(glm::dvec4(v.tangent)) &&
                  IsFinite(glm::dvec2(v.uv)), "vertex");
    }
  }
}

}  // namespace

void SceneFile(Bytes bytes) {
  static const bool beside = File("image.ppm", "P3 2 2 255 255 0 0 0 255 0 0 0 255 9 9 9\n").string() +
                                 File("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n").string() != "";
  Require(beside, "no folder");
  const std::filesystem::path file = Folder() / "scene.toml";
  const std::string text = Text(bytes);
  Scene scene;
  if (!Reads([&] { scene = ParseScene(file, text); })) return;
  RequireSound(scene);
  const std::string ended = text.ends_with('\n') ? text : text + '\n';  // it ends a last line
  Require(EditedText(text, scene, scene) == ended, "nothing edited, yet something written");
  Scene edited = scene;
  edited.lights[0].center.x += edited.lights[0].center.x < 0.0 ? 1.0 : -1.0;
  std::string written;
  if (!Reads([&] { written = EditedText(text, scene, edited); })) return;
  RequireSound(ParseScene(file, written));
}

}  // namespace arealab::fuzz
