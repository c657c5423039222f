// Meshes and textures from files.
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <sstream>

#include "scenes/image.h"
#include "scenes/mesh_file.h"
#include "tests/scenes/mesh_checks.h"
#include "tests/scenes/scene_folder.h"

namespace arealab::mesh_test {
namespace {

using ::testing::HasSubstr;

std::string Base64(const std::string& bytes) {
  static const char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63u] : '=';
    }
  }
  return text;
}

std::string FileBytes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  return bytes.str();
}

class MeshTest : public SceneFolder {
 protected:
  // Writes an image of 8-bit pixels, row 0 at the top.
  void WriteImage(const std::string& name, int width, int height, int channels,
                  const std::vector<unsigned char>& pixels) const {
    const std::string file = (folder_ / name).string();
    auto output = OIIO::ImageOutput::create(file);
    ASSERT_TRUE(output);
    OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    ASSERT_TRUE(output->open(file, spec));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, pixels.data()));
    output->close();
  }

  // A glTF square in its x-y plane, which faces +z, with texture coordinates; u along x, v (down) against y.
  // `textures` are three URIs: base colour, metallic-roughness, normal.
  std::string Gltf(const std::string& buffer_uri, const std::array<std::string, 3>& textures,
                   const std::string& node = "") const {
    return fmt::format(
        R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0{}}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_0":1}},"indices":2,"material":0}}]}}],
"materials":[{{"name":"tile","normalTexture":{{"index":2,"scale":0.5}},"pbrMetallicRoughness":{{
"baseColorFactor":[0.5,0.25,1.0,1.0],"metallicFactor":0.75,"roughnessFactor":0.5,
"baseColorTexture":{{"index":0}},"metallicRoughnessTexture":{{"index":1}}}}}}],
"textures":[{{"source":0}},{{"source":1}},{{"source":2}}],
"images":[{{"uri":"{}"}},{{"uri":"{}"}},{{"uri":"{}"}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[-1,-1,0],"max":[1,1,0]}},
{{"bufferView":1,"componentType":5126,"count":4,"type":"VEC2"}},
{{"bufferView":2,"componentType":5123,"count":6,"type":"SCALAR"}}],
"bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":32}},
{{"buffer":0,"byteOffset":80,"byteLength":12}}],"buffers":[{{"byteLength":92,"uri":"{}"}}]}})",
        node, textures[0], textures[1], textures[2], buffer_uri);
  }

  static std::string SquareBytes() {
    const float floats[20] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0, 0, 1, 1, 1, 1, 0, 0, 0};
    const std::uint16_t indices[6] = {0, 1, 2, 0, 2, 3};
    std::string bytes(sizeof floats + sizeof indices, '\0');
    std::memcpy(bytes.data(), floats, sizeof floats);
    std::memcpy(bytes.data() + sizeof floats, indices, sizeof indices);
    return bytes;
  }

  void WriteTextures() const {
    WriteImage("color.png", 2, 1, 3, {255, 0, 0, 188, 188, 188});
    WriteImage("rough.png", 1, 1, 3, {0, 128, 64});
    WriteImage("normal.png", 1, 1, 3, {128, 128, 255});
  }

  Scene LoadSurface(const std::string& lines) const {
    return Load(kCamera + kMaterial + kLight + "[[surface]]\ntype = \"mesh\"\n" + lines);
  }
};

void ExpectTile(const Scene& scene) {
  ASSERT_EQ(scene.meshes.size(), 1u);
  const Mesh& mesh = scene.meshes[0];
  ExpectSound(mesh);
  ExpectTangentsFollowTexture(mesh);
  EXPECT_EQ(TriangleCount(mesh), 2u);
  for (const Vertex& vertex : mesh.vertices) {
    // glTF's y is up, so its z-facing square stands upright and faces the scene's -y.
    EXPECT_LT(glm::length(vertex.normal - glm::vec3(0, -1, 0)), 1e-6f);
    EXPECT_LT(
        glm::length(vertex.position - glm::vec3(2.0f * vertex.uv.x - 1.0f, 0.0f, 1.0f - 2.0f * vertex.uv.y)),
        1e-6f);
    EXPECT_EQ(vertex.tangent.w, 1.0f);
  }
  const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
  EXPECT_EQ(material.name, "tile.gltf: tile");
  EXPECT_EQ(material.base_color, glm::vec3(0.5f, 0.25f, 1.0f));
  EXPECT_EQ(material.roughness, glm::vec2(0.5f));
  EXPECT_EQ(material.metalness, 0.75f);
  EXPECT_EQ(material.normal_scale, 0.5f);
  ASSERT_TRUE(material.base_color_texture && material.metallic_roughness_texture && material.normal_texture);
  EXPECT_EQ(material.base_color_texture->width, 2);
  EXPECT_EQ(material.base_color_texture->height, 1);
  EXPECT_EQ(material.base_color_texture->pixels[0], glm::vec4(1, 0, 0, 1));
  // sRGB 188/255 is 0.5029 in linear light: ((0.73725 + 0.055) / 1.055)^2.4.
  EXPECT_NEAR(material.base_color_texture->pixels[1].g, 0.5029f, 1e-4f);
  EXPECT_NEAR(material.metallic_roughness_texture->pixels[0].g, 128.0f / 255.0f,
              1e-6f);  // data stay as stored
  EXPECT_NEAR(material.metallic_roughness_texture->pixels[0].b, 64.0f / 255.0f, 1e-6f);
  EXPECT_NEAR(material.normal_texture->pixels[0].r, 128.0f / 255.0f, 1e-6f);
}

TEST_F(MeshTest, GltfBringsItsMaterialAndEmbeddedTextures) {
  WriteTextures();
  const auto embedded = [&](const char* name) {
    return "data:image/png;base64," + Base64(FileBytes(folder_ / name));
  };
  Write("tile.gltf", Gltf("data:application/octet-stream;base64," + Base64(SquareBytes()),
                          {embedded("color.png"), embedded("rough.png"), embedded("normal.png")}));
  for (const char* name : {"color.png", "rough.png", "normal.png"}) std::filesystem::remove(folder_ / name);
  ExpectTile(LoadSurface("file = \"tile.gltf\"\n"));
}

TEST_F(MeshTest, GltfBringsTexturesAndBuffersBesideIt) {
  std::filesystem::create_directory(folder_ / "parts");
  WriteTextures();
  std::filesystem::rename(folder_ / "color.png", folder_ / "parts/color.png");
  Write("parts/square.bin", SquareBytes());
  Write("tile.gltf", Gltf("parts/square.bin", {"parts/color.png", "rough.png", "normal.png"}));
  ExpectTile(LoadSurface("file = \"tile.gltf\"\n"));
}

TEST_F(MeshTest, GltfTextureThatLeavesTheFolderIsRefused) {
  WriteTextures();
  std::filesystem::rename(folder_ / "color.png", outside_ / "color.png");
  Write("square.bin", SquareBytes());
  Write("tile.gltf", Gltf("square.bin", {"../color.png", "rough.png", "normal.png"}));
  EXPECT_THAT(Error(kCamera + kMaterial + kLight + "[[surface]]\ntype = \"mesh\"\nfile = \"tile.gltf\"\n"),
              HasSubstr("test.toml:15: '../color.png' leaves the mesh's folder; expected a path inside it"));
}

TEST_F(MeshTest, GltfUnderAMaterialOfTheSceneTakesIt) {
  WriteTextures();
  Write("square.bin", SquareBytes());
  Write("tile.gltf", Gltf("square.bin", {"color.png", "rough.png", "normal.png"}));
  const Scene scene = LoadSurface("file = \"tile.gltf\"\nmaterial = \"grey\"\n");
  EXPECT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.meshes.at(0).material, 0);
}

TEST_F(MeshTest, GltfNodesMoveTurnAndMirror) {
  WriteTextures();
  Write("square.bin", SquareBytes());
  // Mirrored in x, twice as high in y, moved along glTF's z, which is the scene's -y.
  Write("tile.gltf", Gltf("square.bin", {"color.png", "rough.png", "normal.png"},
                          ",\"scale\":[-1,2,1],\"translation\":[0,0,3]"));
  const Scene scene = LoadSurface("file = \"tile.gltf\"\n");
  const Mesh& mesh = scene.meshes.at(0);
  ExpectSound(mesh);
  ExpectTangentsFollowTexture(mesh);
  for (const Vertex& vertex : mesh.vertices) {
    EXPECT_LT(glm::length(vertex.normal - glm::vec3(0, -1, 0)), 1e-6f);
    EXPECT_LT(
        glm::length(vertex.position - glm::vec3(1.0f - 2.0f * vertex.uv.x, -3.0f, 2.0f - 4.0f * vertex.uv.y)),
        1e-6f);
    EXPECT_EQ(vertex.tangent.w, -1.0f);
  }
}

// An octahedron without normals, its faces outward.
const char* const kOctahedron =
    "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
    "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";

TEST_F(MeshTest, MissingNormalsAreSmooth) {
  Write("octahedron.obj", kOctahedron);
  const Scene scene = LoadSurface("file = \"octahedron.obj\"\nmaterial = \"grey\"\n");
  const Mesh& mesh = scene.meshes.at(0);
  ExpectSound(mesh);
  EXPECT_EQ(TriangleCount(mesh), 8u);
  EXPECT_EQ(mesh.vertices.size(), 6u);  // corners are shared
  for (const Vertex& vertex : mesh.vertices) EXPECT_LT(glm::length(vertex.normal - vertex.position), 1e-6f);
}

TEST_F(MeshTest, PlacementScaleAndHeight) {
  Write("octahedron.obj", kOctahedron);
  const auto extent = [&](const std::string& lines) {
    const Scene scene = LoadSurface("file = \"octahedron.obj\"\nmaterial = \"grey\"\n" + lines);
    ExpectSound(scene.meshes.at(0));
    glm::vec3 low(1e9f), high(-1e9f);
    for (const Vertex& vertex : scene.meshes.at(0).vertices) {
      low = glm::min(low, vertex.position);
      high = glm::max(high, vertex.position);
    }
    return std::pair(low, high);
  };
  const auto expect = [](const auto& pair, const glm::vec3& low, const glm::vec3& high) {
    EXPECT_LT(glm::length(pair.first - low), 1e-5f);
    EXPECT_LT(glm::length(pair.second - high), 1e-5f);
  };
  expect(extent(""), glm::vec3(-1), glm::vec3(1));
  expect(extent("scale = 2\nposition = [1, 2, 3]\n"), {-1, 0, 1}, {3, 4, 5});
  expect(extent("scale = [1, 2, 3]\nrotation = [0, 0, 90]\n"), {-2, -1, -3}, {2, 1, 3});
  expect(extent("scale = [1, 2, 3]\nup = \"y\"\n"), {-1, -2, -3}, {1, 2, 3});
  expect(extent("height = 0.5\nposition = [1, 2, 3]\n"), {0.75, 1.75, 3}, {1.25, 2.25, 3.5});
}

TEST_F(MeshTest, PlyIsRead) {
  Write("triangle.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const Scene scene = LoadSurface("file = \"triangle.ply\"\nmaterial = \"grey\"\n");
  ExpectSound(scene.meshes.at(0));
  EXPECT_EQ(scene.meshes.at(0).vertices.at(0).normal, glm::vec3(0, 0, 1));
}

// Each once hung or crashed the reader: found by tests/fuzz/.
TEST_F(MeshTest, DamagedFilesAreRefused) {
  const std::string header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                             "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const auto error = [&](const std::string& bytes) {
    Write("bad.ply", bytes);
    return Error(kCamera + kMaterial + kLight + "[[surface]]\ntype = \"mesh\"\nfile = \"bad.ply\"\nmaterial = \"grey\"\n");
  };
  EXPECT_THAT(error(header.substr(0, 40)), testing::HasSubstr("'bad.ply' cannot be read as a mesh"));
  EXPECT_THAT(error(header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 999999\n"), testing::HasSubstr("'bad.ply' refers to a vertex that it does not hold"));
  EXPECT_THAT(error("ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                    "element face 1\nproperty list uchar int vertex_indicsnee\n_dheader\n" + std::string(49, '\1')),
              testing::HasSubstr("'bad.ply' cannot be read as a mesh"));
}

TEST_F(MeshTest, ThreeDsOfTheDebianPackageIsRead) {
  const Scene scene =
      LoadSurface("file = \"glmark2-data:models/horse.3ds\"\nheight = 1\nmaterial = \"grey\"\n");
  std::size_t triangles = 0;
  for (const Mesh& mesh : scene.meshes) {
    ExpectSound(mesh);
    triangles += TriangleCount(mesh);
  }
  EXPECT_GT(triangles, 1000u);
}

TEST_F(MeshTest, NormalsWinOverWinding) {
  Write("turned.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 -1\nf 1//1 2//1 3//1\n");
  const Scene scene = LoadSurface("file = \"turned.obj\"\nmaterial = \"grey\"\n");
  ExpectSound(scene.meshes.at(0));
  EXPECT_EQ(scene.meshes.at(0).vertices.at(0).normal, glm::vec3(0, 0, -1));
}

TEST_F(MeshTest, TrianglesWithoutAreaAreDropped) {
  Write("sliver.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\nf 1 1 3\n");
  const Scene scene = LoadSurface("file = \"sliver.obj\"\nmaterial = \"grey\"\n");
  ExpectSound(scene.meshes.at(0));
  EXPECT_EQ(TriangleCount(scene.meshes.at(0)), 1u);
}

TEST_F(MeshTest, HeightImageIsAHeightField) {
  WriteImage("steps.png", 3, 2, 1, {0, 51, 102, 0, 51, 102});
  const Scene scene =
      Load(kCamera + kMaterial + kLight +
           "[[surface]]\ntype = \"height_field\"\nsize = [4, 1]\nheight = 10\nimage = \"steps.png\"\n"
           "material = \"grey\"\n");
  const Mesh& mesh = scene.meshes.at(0);
  ExpectSound(mesh);
  EXPECT_EQ(mesh.vertices.size(), 6u);
  for (const Vertex& vertex : mesh.vertices) {  // 0 … 0.4 of 10 m along x from -2 m to 2 m: a slope of 1
    EXPECT_NEAR(vertex.position.z, vertex.position.x + 2.0f, 1e-5f);
    EXPECT_LT(glm::length(vertex.normal - glm::normalize(glm::vec3(-1, 0, 1))), 1e-5f);
  }
}

TEST_F(MeshTest, MaterialsShareATextureFile) {
  WriteTextures();
  const std::string material = "base_color_texture = \"color.png\"\n";
  const Scene scene = Load(kCamera + kLight + kSurface + kMaterial + material +
                           "[[material]]\nname = \"b\"\n" + material + "normal_texture = \"normal.png\"\n");
  ASSERT_TRUE(scene.materials[0].base_color_texture);
  EXPECT_EQ(scene.materials[0].base_color_texture, scene.materials[1].base_color_texture);
  EXPECT_NE(scene.materials[1].normal_texture, nullptr);
}

TEST_F(MeshTest, ImagesOfOneTwoAndFourChannels) {
  WriteImage("grey.png", 1, 1, 1, {51});
  WriteImage("grey_alpha.png", 1, 1, 2, {51, 102});
  WriteImage("all.png", 1, 1, 4, {51, 102, 153, 0});
  EXPECT_LT(glm::length(LoadImage(folder_ / "grey.png", ImageUse::kData)->pixels[0] -
                        glm::vec4(0.2f, 0.2f, 0.2f, 1)),
            1e-6f);
  EXPECT_LT(glm::length(LoadImage(folder_ / "grey_alpha.png", ImageUse::kData)->pixels[0] -
                        glm::vec4(0.2f, 0.2f, 0.2f, 0.4f)),
            1e-6f);
  // Colour survives under alpha 0: it is not multiplied in.
  EXPECT_LT(glm::length(LoadImage(folder_ / "all.png", ImageUse::kData)->pixels[0] -
                        glm::vec4(0.2f, 0.4f, 0.6f, 0)),
            1e-6f);
}

TEST_F(MeshTest, FloatImagesAreLinearAndMustBeFinite) {
  const auto write = [&](const std::string& name, float value) {
    const std::string file = (folder_ / name).string();
    auto output = OIIO::ImageOutput::create(file);
    const float pixel[3] = {value, 0.5f, 0.25f};
    output->open(file, OIIO::ImageSpec(1, 1, 3, OIIO::TypeDesc::FLOAT));
    output->write_image(OIIO::TypeDesc::FLOAT, pixel);
    output->close();
  };
  write("linear.exr", 7.5f);
  write("nan.exr", std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(LoadImage(folder_ / "linear.exr", ImageUse::kColor)->pixels[0],
            glm::vec4(7.5f, 0.5f, 0.25f, 1.0f));
  try {
    LoadImage(folder_ / "nan.exr", ImageUse::kColor);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "'nan.exr' has a pixel that is not finite at (0, 0); expected finite values");
  }
}

// An EXR: where a PNG is cut short, libpng jumps out of OpenImageIO's reader, which then leaks a string.
TEST_F(MeshTest, DamagedImageIsRefused) {
  WriteImage("whole.exr", 64, 64, 3, std::vector<unsigned char>(64 * 64 * 3, 77));
  EXPECT_EQ(LoadImage(folder_ / "whole.exr", ImageUse::kColor)->width, 64);
  const std::string bytes = FileBytes(folder_ / "whole.exr");
  Write("cut.exr", bytes.substr(0, bytes.size() / 2));
  try {
    LoadImage(folder_ / "cut.exr", ImageUse::kColor);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "'cut.exr' is not an image that can be read; expected a whole PNG, JPEG, EXR, HDR, TGA or TIFF file");
  }
}

}  // namespace
}  // namespace arealab::mesh_test
