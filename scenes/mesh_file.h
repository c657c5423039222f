// Meshes from files, through assimp: glTF 2.0 with its metal-rough materials, OBJ, PLY, STL and 3DS.
#pragma once

#include <filesystem>
#include <set>
#include <vector>

#include "scenes/scene.h"

namespace arealab {

struct MeshFile {
  std::vector<Mesh> meshes;  // in the file's own units and axes; material is an index into `materials` below
  std::vector<Material> materials;
  bool metal_rough =
      false;  // the format carries metal-rough materials (glTF): `materials` may be shown as they are
  bool has_texture_coordinates = false;  // on every mesh
};

// Reads `file`. It and everything it refers to (buffers, textures, material libraries) must lie inside
// `root`, links followed. Normals are generated (smooth) where the file has none, tangents from texture
// coordinates or, without them, in an arbitrary direction. Triangles without area are dropped; those wound
// against their normals are turned. Throws InputError without a place ("what; expected what"). Adds to `files` what is read,
// also where it throws.
MeshFile LoadMeshFile(const std::filesystem::path& file, const std::filesystem::path& root, std::set<std::filesystem::path>* files = nullptr);

// The file that `path`, as a scene or a mesh gives it, means: relative to `folder`, inside `root`, links
// followed. Throws InputError without a place; `owner` is what the paths are relative to in its words ("the
// scene's folder").
std::filesystem::path ResolveInside(const std::filesystem::path& folder, const std::string& path,
                                    const std::filesystem::path& root, const std::string& owner);

}  // namespace arealab
