// Mesh import: the first byte chooses the file's suffix, the others are its bytes.
#include <cmath>

#include "scenes/mesh_file.h"
#include "tests/fuzz/targets.h"

namespace arealab::fuzz {

void MeshFileBytes(Bytes bytes) {
  constexpr const char* kSuffixes[] = {"gltf", "glb", "obj", "ply", "stl", "3ds"};
  if (bytes.empty()) return;
  const std::filesystem::path file = File(std::string("mesh.") + kSuffixes[bytes[0] % std::size(kSuffixes)], Text(bytes.subspan(1)));
  MeshFile loaded;
  if (!Reads([&] { loaded = LoadMeshFile(file, Folder()); })) return;
  Require(!loaded.meshes.empty(), "no mesh");
  for (const Mesh& mesh : loaded.meshes) {
    Require(!mesh.indices.empty() && mesh.indices.size() % 3 == 0, "no triangles");
    for (const std::uint32_t index : mesh.indices) Require(index < mesh.vertices.size(), "index");
    if (loaded.metal_rough) Require(static_cast<std::size_t>(mesh.material) < loaded.materials.size(), "material");
    for (const Vertex& v : mesh.vertices) {
      for (int axis = 0; axis < 3; ++axis) {
        Require(std::isfinite(v.position[axis]) && std::isfinite(v.normal[axis]) && std::isfinite(v.tangent[axis]), "vertex");
      }
      Require(std::isfinite(v.uv.x) && std::isfinite(v.uv.y), "uv");
    }
  }
}

}  // namespace arealab::fuzz
