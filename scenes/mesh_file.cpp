#include "scenes/mesh_file.h"

#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/GltfMaterial.h>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>

#include "scenes/error.h"
#include "scenes/image.h"
#include "scenes/in_child.h"

namespace arealab {
namespace {

namespace fs = std::filesystem;

bool IsInside(const fs::path& file, const fs::path& root) {
  std::error_code error;
  const fs::path real_file = fs::weakly_canonical(file, error);
  if (error) return false;
  const fs::path real_root = fs::weakly_canonical(root, error);
  if (error) return false;
  const auto [end, rest] =
      std::mismatch(real_root.begin(), real_root.end(), real_file.begin(), real_file.end());
  return end == real_root.end();
}

// A file's bytes. Some of assimp's readers never notice that a file is cut short, and read on at its end for ever (PLY within its
// header): here that is an exception.
class FileBytes : public Assimp::IOStream {
 public:
  explicit FileBytes(std::string bytes) : bytes_(std::move(bytes)) {}

  std::size_t Read(void* buffer, std::size_t size, std::size_t count) override {
    const std::size_t left = bytes_.size() - at_, wanted = size == 0 ? 0 : std::min(count, left / size + 1) * size;
    const std::size_t taken = std::min(wanted, left);
    if (taken == 0) {
      constexpr int kMostVain = 1000;
      if (++vain_ > kMostVain) throw std::runtime_error("it is cut short");
      return 0;
    }
    vain_ = 0;
    std::memcpy(buffer, bytes_.data() + at_, taken);
    at_ += taken;
    return taken / size;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    const std::size_t from = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? at_ : bytes_.size();
    const std::size_t to = from + offset;  // backwards where the sum wraps around
    if (to > bytes_.size()) return aiReturn_FAILURE;
    at_ = to;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return at_; }
  std::size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  std::string bytes_;
  std::size_t at_ = 0;
  int vain_ = 0;  // reads in a row that found nothing
};

// Opens files inside one folder only, so that a mesh cannot name a buffer or a material library elsewhere.
class FolderFiles : public Assimp::DefaultIOSystem {
 public:
  explicit FolderFiles(fs::path root) : root_(std::move(root)) {}

  bool Exists(const char* file) const override {
    return IsInside(file, root_) && DefaultIOSystem::Exists(file);
  }

  Assimp::IOStream* Open(const char* file, const char* mode) override {
    if (IsInside(file, root_)) {
      asked_.insert(file);
      std::ifstream in(file, std::ios::binary);
      if (!in || mode[0] != 'r') return nullptr;
      return new FileBytes(std::string(std::istreambuf_iterator<char>(in), {}));  // the importer deletes it
    }
    if (!refused_) refused_ = fs::path(file).filename().string();
    return nullptr;
  }

  void Close(Assimp::IOStream* file) override { delete file; }

  const std::optional<std::string>& refused() const { return refused_; }
  const std::set<std::string>& asked() const { return asked_; }  // inside it, there or not

 private:
  fs::path root_;
  std::set<std::string> asked_;
  std::optional<std::string> refused_;  // the first file name that was not opened since it lies outside
};

glm::dvec3 ToGlm(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}

bool IsFinite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

glm::dmat4 ToGlm(const aiMatrix4x4& m) {
  glm::dmat4 result;
  for (unsigned row = 0; row < 4; ++row) {
    for (unsigned column = 0; column < 4; ++column) {
      result[static_cast<int>(column)][static_cast<int>(row)] = static_cast<double>(m[row][column]);
    }
  }
  return result;
}

// Any unit vector across `normal`, steady under small changes [Duff et al. 2017, listing 3].
glm::dvec3 AnyTangent(const glm::dvec3& normal) {
  const double sign = std::copysign(1.0, normal.z);
  const double a = -1.0 / (sign + normal.z);
  return {1.0 + sign * normal.x * normal.x * a, sign * normal.x * normal.y * a, -sign * normal.x};
}

// Appends `source`, moved by world_from_mesh, to `file`.
void AddMesh(MeshFile& file, const aiMesh& source, const glm::dmat4& world_from_mesh) {
  Mesh mesh;
  mesh.material = static_cast<int>(source.mMaterialIndex);
  const glm::dmat3 linear(world_from_mesh);
  const double determinant = glm::determinant(linear);
  // The cofactor matrix carries normals also where the inverse does not exist.
  const glm::dmat3 normals(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                           glm::cross(linear[0], linear[1]));
  const double mirrored = determinant < 0.0 ? -1.0 : 1.0;

  std::vector<glm::dvec3> face_normal(source.mNumVertices, glm::dvec3(0.0));
  for (unsigned f = 0; f < source.mNumFaces; ++f) {
    const aiFace& face = source.mFaces[f];
    if (face.mNumIndices != 3) continue;
    std::uint32_t index[3] = {face.mIndices[0], face.mIndices[1], face.mIndices[2]};
    if (mirrored < 0.0) std::swap(index[1], index[2]);
    glm::dvec3 corner[3];
    glm::dvec3 normal_sum(0.0);
    for (int k = 0; k < 3; ++k) {
      corner[k] = glm::dvec3(world_from_mesh * glm::dvec4(ToGlm(source.mVertices[index[k]]), 1.0));
      const glm::dvec3 normal = mirrored * (normals * ToGlm(source.mNormals[index[k]]));
      if (IsFinite(normal)) normal_sum += normal;
    }
    glm::dvec3 facing = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    if (!(glm::length(facing) > 0.0)) continue;
    if (glm::dot(facing, normal_sum) < 0.0) {
      std::swap(index[1], index[2]);
      facing = -facing;
    }
    for (const std::uint32_t k : index) {
      face_normal[k] += facing;
      mesh.indices.push_back(k);
    }
  }
  if (mesh.indices.empty()) return;

  mesh.vertices.reserve(source.mNumVertices);
  for (unsigned i = 0; i < source.mNumVertices; ++i) {
    Vertex vertex{};
    vertex.position = glm::vec3(world_from_mesh * glm::dvec4(ToGlm(source.mVertices[i]), 1.0));
    glm::dvec3 normal = mirrored * (normals * ToGlm(source.mNormals[i]));
    // Generated normals are not finite where only triangles without area meet, and may cancel to zero.
    if (!IsFinite(normal) || !(glm::length(normal) > 0.0)) normal = face_normal[i];
    normal = glm::length(normal) > 0.0 ? glm::normalize(normal) : glm::dvec3(0.0, 0.0, 1.0);
    vertex.normal = glm::vec3(normal);
    if (source.HasTextureCoords(0)) {
      const glm::dvec3 uv = ToGlm(source.mTextureCoords[0][i]);
      if (!IsFinite(uv)) throw InputError("a texture coordinate is not finite; expected finite numbers");
      vertex.uv = {uv.x, 1.0 - uv.y};  // assimp's v runs up from the image's foot
    }
    glm::dvec3 tangent(0.0);
    double sign = 1.0;
    if (source.HasTangentsAndBitangents()) {
      tangent = linear * ToGlm(source.mTangents[i]);
      const glm::dvec3 bitangent = linear * ToGlm(source.mBitangents[i]);
      tangent -= glm::dot(tangent, normal) * normal;
      if (glm::dot(glm::cross(normal, tangent), bitangent) < 0.0) sign = -1.0;
    }
    if (!IsFinite(tangent) || !(glm::length(tangent) > 0.0)) tangent = AnyTangent(normal);
    vertex.tangent = glm::vec4(glm::vec3(glm::normalize(tangent)), static_cast<float>(sign));
    mesh.vertices.push_back(vertex);
  }
  file.has_texture_coordinates = file.has_texture_coordinates && source.HasTextureCoords(0);
  file.meshes.push_back(std::move(mesh));
}

void AddNode(MeshFile& file, const aiScene& scene, const aiNode& node, const glm::dmat4& world_from_parent) {
  const glm::dmat4 world_from_node = world_from_parent * ToGlm(node.mTransformation);
  for (unsigned i = 0; i < node.mNumMeshes; ++i)
    AddMesh(file, *scene.mMeshes[node.mMeshes[i]], world_from_node);
  for (unsigned i = 0; i < node.mNumChildren; ++i) AddNode(file, scene, *node.mChildren[i], world_from_node);
}

// Reads textures of one mesh file, each once per use.
class Textures {
 public:
  Textures(const aiScene& scene, fs::path folder, fs::path root, std::set<fs::path>* files)
      : scene_(scene), folder_(std::move(folder)), root_(std::move(root)), files_(files) {}

  // Null where the material has no such texture.
  std::shared_ptr<const Image> Find(const aiMaterial& material, aiTextureType type, ImageUse use) {
    aiString path;
    if (material.GetTexture(type, 0, &path) != AI_SUCCESS) return nullptr;
    const std::pair key{std::string(path.C_Str()), use};
    if (const auto found = known_.find(key); found != known_.end()) return found->second;
    return known_[key] = Load(key.first, use);
  }

 private:
  std::shared_ptr<const Image> Load(const std::string& path, ImageUse use) const {
    const aiTexture* embedded = scene_.GetEmbeddedTexture(path.c_str());
    if (!embedded && files_) files_->insert(folder_ / path);
    if (!embedded) return LoadImage(ResolveInside(folder_, path, root_, "the mesh's folder"), use);
    if (embedded->mHeight != 0)
      throw InputError("an embedded texture is not encoded; expected PNG or JPEG bytes");
    std::string format = embedded->achFormatHint;
    if (format.empty()) format = "png";
    return DecodeImage({reinterpret_cast<const std::byte*>(embedded->pcData), embedded->mWidth},
                       fmt::format("embedded texture {}.{}", path, format), use);
  }

  const aiScene& scene_;
  fs::path folder_;
  fs::path root_;
  std::set<fs::path>* files_;
  std::map<std::pair<std::string, ImageUse>, std::shared_ptr<const Image>> known_;
};

float UnitFactor(const aiMaterial& material, const char* key, const char* label) {
  ai_real value = 1.0f;
  material.Get(key, 0, 0, value);
  if (!(value >= 0.0f && value <= 1.0f)) {
    throw InputError(fmt::format("the mesh's {} is {}; expected a number from 0 to 1", label, value));
  }
  return value;
}

// A glTF 2.0 metal-rough material [glTF 2.0 specification, § 3.9.2].
Material MetalRough(const aiMaterial& source, Textures& textures) {
  Material material;
  material.name = source.GetName().C_Str();
  aiColor4D color(1.0f, 1.0f, 1.0f, 1.0f);
  if (source.Get(AI_MATKEY_BASE_COLOR, color) != AI_SUCCESS) source.Get(AI_MATKEY_COLOR_DIFFUSE, color);
  material.base_color = {color.r, color.g, color.b};
  for (int c = 0; c < 3; ++c) {
    if (!(material.base_color[c] >= 0.0f && material.base_color[c] <= 1.0f)) {
      throw InputError(
          fmt::format("the mesh's base colour is {}; expected numbers from 0 to 1", material.base_color[c]));
    }
  }
  material.roughness = glm::vec2(UnitFactor(source, "$mat.roughnessFactor", "roughness"));
  material.metalness = UnitFactor(source, "$mat.metallicFactor", "metalness");
  material.base_color_texture = textures.Find(source, aiTextureType_BASE_COLOR, ImageUse::kColor);
  if (!material.base_color_texture) {
    material.base_color_texture = textures.Find(source, aiTextureType_DIFFUSE, ImageUse::kColor);
  }
  material.metallic_roughness_texture = textures.Find(source, aiTextureType_UNKNOWN, ImageUse::kData);
  material.normal_texture = textures.Find(source, aiTextureType_NORMALS, ImageUse::kData);
  ai_real scale = 1.0f;
  source.Get(AI_MATKEY_GLTF_TEXTURE_SCALE(aiTextureType_NORMALS, 0), scale);
  material.normal_scale = scale;
  return material;
}

template <typename Refusal>
void CheckNode(const aiNode& node, unsigned meshes, const Refusal& refuse) {
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    if (node.mMeshes[i] >= meshes) throw refuse("mesh");
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) CheckNode(*node.mChildren[i], meshes, refuse);
}

std::string Extension(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

// The file as assimp reads it, checked, smoothed and in assimp's own form, of no bytes where it has no triangles; before it the files
// that assimp asked for, each ended by a NUL, and another NUL.
std::string ReadInChild(const fs::path& file, const fs::path& root) {
  const std::string name = file.filename().string(), extension = Extension(file);
  Assimp::Importer importer;
  // A damaged file would be offered to the readers of every other format.
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    Assimp::BaseImporter* reader = importer.GetImporter(i);
    std::set<std::string> extensions;
    reader->GetExtensionList(extensions);
    if (extensions.contains(extension.substr(1))) continue;
    importer.UnregisterLoader(reader);
    delete reader;
  }
  auto* files = new FolderFiles(root);
  importer.SetIOHandler(files);  // the importer deletes it
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = importer.ReadFile(file.string(), 0);
  if (files->refused()) {
    throw InputError(
        fmt::format("'{}' refers to '{}', which leaves the scene's folder; expected files inside it", name,
                    *files->refused()));
  }
  if (!scene || !scene->mRootNode) {
    std::string why = importer.GetErrorString();
    if (const auto at = why.find(file.string()); at != std::string::npos)
      why.replace(at, file.string().size(), name);
    std::replace_if(why.begin(), why.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
    throw InputError(
        fmt::format("'{}' cannot be read as a mesh ({}); expected a valid {} file", name, why, extension));
  }
  // Before anything is derived from them: smoothing sorts positions, and assimp looks up what indices name without a look at them.
  const auto refuse_index = [&](const char* what) -> InputError {
    return InputError(fmt::format("'{}' refers to a {} that it does not hold; expected indices below their count", name, what));
  };
  CheckNode(*scene->mRootNode, scene->mNumMeshes, refuse_index);
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    if (mesh.mMaterialIndex >= scene->mNumMaterials) throw refuse_index("material");
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      for (unsigned k = 0; k < mesh.mFaces[f].mNumIndices; ++k) {
        if (mesh.mFaces[f].mIndices[k] >= mesh.mNumVertices) throw refuse_index("vertex");
      }
    }
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      if (IsFinite(ToGlm(mesh.mVertices[i]))) continue;
      throw InputError(
          fmt::format("vertex {} of '{}' is not finite; expected finite positions", i + 1, name));
    }
  }
  if (scene->mNumMeshes > 0) {
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_SortByPType |
                                         aiProcess_GenSmoothNormals | aiProcess_CalcTangentSpace |
                                         aiProcess_JoinIdenticalVertices);
  }
  std::string asked;
  for (const std::string& each : files->asked()) asked += each + '\0';
  asked += '\0';
  if (!scene || scene->mNumMeshes == 0) return asked;
  Assimp::Exporter exporter;
  const aiExportDataBlob* blob = exporter.ExportToBlob(scene, "assbin");
  if (!blob) throw InputError(fmt::format("'{}' cannot be handed on ({}); expected a valid {} file", name, exporter.GetErrorString(), extension));
  return asked.append(static_cast<const char*>(blob->data), blob->size);
}

}  // namespace

fs::path ResolveInside(const fs::path& folder, const std::string& path, const fs::path& root,
                       const std::string& owner) {
  const auto is_control = [](unsigned char c) { return c < 0x20; };
  if (path.empty() || std::any_of(path.begin(), path.end(), is_control)) {
    throw InputError(
        fmt::format("the file's name is empty or has control characters; expected a path in {}", owner));
  }
  if (fs::path(path).is_absolute()) {
    throw InputError(fmt::format("'{}' is an absolute path; expected a path relative to {}", path, owner));
  }
  const fs::path file = folder / path;
  if (!IsInside(file, root)) {
    throw InputError(fmt::format("'{}' leaves {}; expected a path inside it, links followed", path, owner));
  }
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    throw InputError(fmt::format("no file '{}'; expected a file in {}", path, owner));
  }
  return file;
}

MeshFile LoadMeshFile(const fs::path& file, const fs::path& root, std::set<fs::path>* files) {
  if (files) files->insert(file);
  const std::string name = file.filename().string();
  const std::string extension = Extension(file);
  const std::initializer_list<const char*> known = {".gltf", ".glb", ".obj", ".ply", ".stl", ".3ds"};
  if (std::find(known.begin(), known.end(), extension) == known.end()) {
    throw InputError(
        fmt::format("'{}' is not a mesh format that is read; expected .gltf, .glb, .obj, .ply, .stl or "
                    ".3ds",
                    name));
  }
  // assimp's readers crash on many a damaged file: one that does takes its own process with it.
  const std::string checked = InChild([&] { return ReadInChild(file, root); }, 60, fmt::format("'{}' cannot be read as a mesh", name),
                                      fmt::format("a valid {} file", extension));
  std::size_t at = 0;
  for (std::size_t end; (end = checked.find('\0', at)) > at; at = end + 1) {
    if (files) files->insert(checked.substr(at, end - at));
  }
  ++at;
  Assimp::Importer importer;
  const aiScene* scene = at == checked.size() ? nullptr : importer.ReadFileFromMemory(checked.data() + at, checked.size() - at, 0, "assbin");
  MeshFile result;
  result.metal_rough = extension == ".gltf" || extension == ".glb";
  result.has_texture_coordinates = true;
  if (scene && scene->mRootNode) AddNode(result, *scene, *scene->mRootNode, glm::dmat4(1.0));
  if (result.meshes.empty()) {
    throw InputError(fmt::format("'{}' has no triangles; expected at least one with an area", name));
  }
  if (result.metal_rough) {
    Textures textures(*scene, file.parent_path(), root, files);
    for (unsigned i = 0; i < scene->mNumMaterials; ++i) {
      result.materials.push_back(MetalRough(*scene->mMaterials[i], textures));
    }
  }
  return result;
}

}  // namespace arealab
