// What a scene is, after reading: plain structs, every length in metres, every angle in radians, colours in
// linear sRGB.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace arealab {

enum class Units { kRadiometric, kPhotometric };  // of radiance: W/(m² sr), or cd/m² (nits)

enum class LightShape { kRectangle, kDisk, kSphere, kPolygon, kEllipse, kTube };
constexpr LightShape kLightShapes[] = {LightShape::kRectangle, LightShape::kDisk, LightShape::kSphere, LightShape::kPolygon,
                                       LightShape::kEllipse,   LightShape::kTube};

// "rectangle", "disk", "sphere", "polygon", "ellipse", "tube": as written in scene files, technique headers and results.
const char* Name(LightShape shape);

// Lies in a plane and has a lit side.
constexpr bool IsFlat(LightShape shape) { return shape != LightShape::kSphere && shape != LightShape::kTube; }

constexpr std::size_t kMostCorners = 8;  // of a polygon

// What a scene's surfaces reflect by: a specular BRDF, for Fresnel 1 (formulas and sources: glsl/brdf/), and a diffuse one, for albedo 1
// (glsl/diffuse/).
enum class Brdf { kGgx, kGgxSeparable, kBeckmann, kBlinnPhong, kWard, kPhong, kLambert, kDisney };
constexpr Brdf kBrdfs[] = {Brdf::kGgx,        Brdf::kGgxSeparable, Brdf::kBeckmann,
                           Brdf::kBlinnPhong, Brdf::kWard,         Brdf::kPhong};
constexpr Brdf kDiffuseBrdfs[] = {Brdf::kLambert, Brdf::kDisney};

// "ggx", "ggx_separable", "beckmann", "blinn_phong", "ward", "phong"; "lambert", "disney": as in scene files, technique headers and
// file names.
const char* Name(Brdf brdf);

constexpr bool IsDiffuse(Brdf brdf) { return brdf == Brdf::kLambert || brdf == Brdf::kDisney; }

// The two of a scene.
struct Brdfs {
  Brdfs(Brdf its_specular = Brdf::kGgx, Brdf its_diffuse = Brdf::kLambert) : specular(its_specular), diffuse(its_diffuse) {}  // NOLINT: one is the two with the default
  bool operator==(const Brdfs&) const = default;

  Brdf specular, diffuse;
};

// Relative luminance of linear sRGB: a quantity in W per channel keeps its unit, Rec. 709 weights.
double Luminance(const glm::dvec3& color);

struct Image {
  int width = 0;
  int height = 0;
  std::vector<glm::vec4>
      pixels;  // row 0 is the top; colours already linear, data (normals, roughness) as stored
};

// An emitter of constant radiance, or of radiance × its texture. axis_x, axis_y, normal are unit and right-handed: normal = axis_x ×
// axis_y, and the lit side is the one that normal points to (a sphere emits everywhere and ignores the axes). A tube is the outside of
// a cylinder along axis_x: its ends are open, and its inside is dark.
struct Light {
  std::string name;
  LightShape shape = LightShape::kRectangle;
  glm::dvec3 center{0.0};  // m, world
  glm::dvec3 axis_x{1.0, 0.0, 0.0};
  glm::dvec3 axis_y{0.0, 1.0, 0.0};
  glm::dvec3 normal{0.0, 0.0, 1.0};
  glm::dvec2 half_size{
      0.5};  // m: half width and half height along the axes; disk and sphere: the radius, twice; ellipse: its half axes;
             // polygon: how far its corners reach along the axes; tube: half its length, its radius
  // Polygon: m, from the centre along axis_x and axis_y, counter-clockwise seen from the lit side; the centre is its centroid.
  std::vector<glm::dvec2> corners;
  glm::dvec3 radiance{1.0};  // in the scene's unit, linear sRGB primaries
  bool two_sided = false;
  std::shared_ptr<const Image> texture;  // rectangles only, see scenes/light_texture.h; none: the radiance is everywhere
  std::string texture_path;              // as the scene file has it

  double Area() const;  // m², of the lit side or sides together; sphere: 4πR²; tube: 2πR · length
  double Flux() const;  // mean luminance × π × Area(): W or lm
};

// Lays a tube along a direction of any length above 0, its other axes about it.
void LayAlong(Light& light, const glm::dvec3& direction);

// What keeps corners from being a light: too few, too many, equal ones, three in a line, not convex; nothing where they do.
std::optional<std::string> WhyNoPolygon(const std::vector<glm::dvec2>& corners);

// Makes the light a polygon of these corners (m, along its axes, from `center`), in either order; moves `center` to their centroid.
void SetCorners(Light& light, std::vector<glm::dvec2> corners);

struct Material {
  std::string name;
  glm::vec3 base_color{0.8f};
  glm::vec2 roughness{
      0.5f};  // artist's roughness in [0, 1] at texture coordinate u = 0 and u = 1, linear between
  float metalness = 0.0f;
  float specular = 1.0f;  // weight of a non-metal's specular lobe, [0, 1]; 1 where metalness > 0 [KHR_materials_specular]
  float normal_scale = 1.0f;
  std::shared_ptr<const Image> base_color_texture;          // multiplies base_color
  std::shared_ptr<const Image> metallic_roughness_texture;  // glTF: green × roughness, blue × metalness
  std::shared_ptr<const Image> normal_texture;              // glTF tangent space, y up
};

struct Vertex {
  glm::vec3 position;  // m, world
  glm::vec3 normal;    // unit, world
  glm::vec4 tangent;   // xyz unit, w = ±1 the bitangent's sign (glTF)
  glm::vec2 uv;        // glTF: (0, 0) is the top left corner of a texture; textures repeat
};

// What a vertex sees of its hemisphere, as spherical caps, each a unit axis and the versine 1 − cos of its radius; how they are
// found: scenes/bake.h. The first is the ambient aperture [Oat 2006], the others what he suggests to go further with.
struct Aperture {
  glm::vec4 open;                   // all that is open
  std::array<glm::vec4, 2> region;  // the two largest contiguous regions of it; the second may be empty
  glm::vec4 blocked;                // what is not: an "anti-aperture"
  bool operator==(const Aperture&) const = default;
};

struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;  // triangles, counter-clockwise seen from outside
  std::vector<Aperture> apertures;     // one per vertex once baked, else none
  int material = 0;                    // index into Scene::materials
};

struct Camera {
  glm::dvec3 position{0.0, -4.0, 1.5};
  glm::dvec3 target{0.0};
  glm::dvec3 up{0.0, 0.0, 1.0};
  double vertical_fov = 0.7;  // radians
};

// What of the hemisphere each vertex sees is to be baked into a spherical cap [Oat 2006].
struct ApertureSettings {
  int rays = 512;     // directions per vertex
  double cell = 0.0;  // m: planes and boxes are cut into cells of at most this size; 0: not at all
};

// Light from every direction, behind all lights: of one radiance, or × a texture of the whole sky, see scenes/sky.h.
struct Sky {
  Sky(const glm::dvec3& everywhere = glm::dvec3(0.0)) : radiance(everywhere) {}  // NOLINT: a radiance is a sky
  bool operator==(const Sky&) const = default;

  glm::dvec3 radiance;                   // in the scene's unit, linear sRGB primaries
  std::shared_ptr<const Image> texture;  // none: the radiance is everywhere
  std::string texture_path;              // as the scene file has it
  double turn = 0.0;                     // radians: of the texture about the world's z, counter-clockwise seen from above
};

struct Scene {
  std::string name;      // the file's stem
  std::string question;  // the file's first line, without the comment mark: what this scene asks
  std::filesystem::path file;
  Units units = Units::kRadiometric;
  Brdf brdf = Brdf::kGgx;
  Brdf diffuse = Brdf::kLambert;
  double exposure = 0.0;  // EV: pictures show radiance × 2^exposure
  Camera camera;
  std::vector<Material> materials;
  std::vector<Mesh> meshes;
  std::vector<Light> lights;
  std::optional<ApertureSettings> aperture;  // where the scene calls for visibility
  std::optional<Sky> sky;

  Brdfs brdfs() const { return {brdf, diffuse}; }
};

// What of the scene its diffuse BRDF has no truth for, in a sentence; nothing where it has.
std::optional<std::string> WhyNotDiffuse(const Scene& scene);

// Reads and checks a scene file. Throws InputError ("file:line: what; expected what").
Scene LoadScene(const std::filesystem::path& file);
// The same of `text`, as if `file` held it: what the text names lies in the file's folder.
Scene ParseScene(const std::filesystem::path& file, const std::string& text);
// The bytes of a scene file. Throws InputError where it cannot be read.
std::string ReadSceneText(const std::filesystem::path& file);

// A scene file's question alone, without reading the rest; empty where the file has no first line.
std::string ReadQuestion(const std::filesystem::path& file);

// The scene files that come with AreaLab, in the order of the report. The environment variable AREALAB_SCENES
// names another folder of scenes.
std::vector<std::filesystem::path> BuiltInScenes();

// A built-in scene's name ("gloss") or a path, to a path. Throws InputError naming the built-in scenes.
std::filesystem::path FindScene(const std::string& name_or_path);

}  // namespace arealab
