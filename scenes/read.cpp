// LoadScene: from TOML to a scene that has been checked. The format is described in the README.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <string_view>

#include "scenes/edit_distance.h"
#include "scenes/error.h"
#include "scenes/image.h"
#include "scenes/light_texture.h"
#include "scenes/mesh_file.h"
#include "scenes/read.h"
#include "scenes/scene.h"
#include "scenes/shapes.h"
#include "scenes/sky.h"

namespace arealab {
namespace {

namespace fs = std::filesystem;

// What a number may be, and how a person is told.
struct Quantity {
  double min;
  double max;
  const char* expected;
};

// Beyond 1e7 m (an Earth's radius) single-precision positions are worse than a metre; below 1e-6 m a light's
// solid angle underflows. 1e12 is a thousand times the Sun's radiance in cd/m² (1.6e9).
constexpr Quantity kCoordinate{-1e7, 1e7, "metres, at most 1e7 either way"};
constexpr Quantity kApertureRays{16.0, 65536.0, "a whole number of rays per vertex, 16 to 65536"};
constexpr Quantity kLength{1e-6, 1e7, "a positive length in metres, 1e-6 to 1e7"};
constexpr Quantity kUnitInterval{0.0, 1.0, "a number from 0 to 1"};
constexpr Quantity kDirection{-1e7, 1e7, "three numbers that are not all zero"};
constexpr Quantity kAngle{-36000.0, 36000.0, "degrees, at most 36000 either way"};
constexpr Quantity kFieldOfView{1e-3, 169.999, "degrees above 0 and below 170"};
constexpr Quantity kExposure{-64.0, 64.0, "stops (EV) from -64 to 64"};
constexpr Quantity kColor{0.0, 1e6, "numbers from 0 to 1e6, not all zero"};
constexpr Quantity kScale{1e-9, 1e9, "a positive factor, 1e-9 to 1e9"};
constexpr Quantity kNormalScale{0.0, 16.0, "a number from 0 to 16"};
constexpr double kMaxRadiance = 1e12;
constexpr Quantity kRadiance{0.0, kMaxRadiance, "a positive number, at most 1e12"};
constexpr Quantity kFlux{0.0, 1e30, "a positive number"};
constexpr int kMaxLights = 256;
constexpr int kMaxCells = 2048;  // a side: 4.2 million quads

// The Debian package whose models a scene may name, and where it installs them.
constexpr std::string_view kPackagePrefix = "glmark2-data:";
constexpr const char* kPackageFolder = "/usr/share/glmark2";

// "'roughness'" where `word` looks like a slip of it, else "one of: …".
std::string Suggest(std::string_view word, const std::vector<std::string>& known) {
  const auto nearest =
      std::min_element(known.begin(), known.end(), [&](const std::string& a, const std::string& b) {
        return EditDistance(word, a) < EditDistance(word, b);
      });
  if (nearest != known.end() &&
      EditDistance(word, *nearest) <= std::max<std::size_t>(1, nearest->size() / 3)) {
    return fmt::format("'{}'", *nearest);
  }
  return fmt::format("one of: {}", fmt::join(known, ", "));
}

std::string_view TypeName(const toml::node& node) {
  if (node.is_string()) return "a string";
  if (node.is_integer()) return "an integer";
  if (node.is_floating_point()) return "a number";
  if (node.is_boolean()) return "a boolean";
  if (node.is_table()) return "a table";
  if (node.is_array()) return "an array";
  return "a date or time";
}

// One line whatever the file's names hold: a control character could break it or reach a terminal.
[[noreturn]] void FailAtLine(const fs::path& file, toml::source_index line, std::string what) {
  std::replace_if(
      what.begin(), what.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  throw InputError(fmt::format("{}:{}: {}", file.string(), std::max<toml::source_index>(line, 1), what));
}

// One table of the file and what may stand in it. Every getter refuses the wrong type and values that are not
// finite or out of range, with the line of the value.
class Fields {
 public:
  Fields(const fs::path& file, const toml::table& table, std::string title)
      : file_(file), table_(table), title_(std::move(title)) {}

  // Refuses keys that are not in `known`.
  void Allow(const std::vector<std::string>& known) const {
    for (const auto& [key, value] : table_) {
      if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
      FailAtLine(
          file_, key.source().begin.line,
          fmt::format("unknown key '{}' in {}; expected {}", key.str(), title_, Suggest(key.str(), known)));
    }
  }

  // The same table under another name in messages.
  Fields Renamed(std::string title) const { return Fields(file_, table_, std::move(title)); }

  const std::string& title() const { return title_; }
  const toml::node* Find(std::string_view key) const { return table_.get(key); }

  const toml::node& Require(std::string_view key, std::string_view expected) const {
    if (const toml::node* node = Find(key)) return *node;
    FailAtLine(file_, table_.source().begin.line,
               fmt::format("{} has no '{}'; expected {}", title_, key, expected));
  }

  [[noreturn]] void Fail(const toml::node& node, const std::string& what) const {
    FailAtLine(file_, node.source().begin.line, what);
  }
  [[noreturn]] void Fail(const std::string& what) const { Fail(table_, what); }

  [[noreturn]] void FailType(const toml::node& node, std::string_view label,
                             std::string_view expected) const {
    Fail(node, fmt::format("'{}' in {} is {}; expected {}", label, title_, TypeName(node), expected));
  }

  double Number(const toml::node& node, std::string_view label, const Quantity& quantity) const {
    if (!node.is_number()) FailType(node, label, quantity.expected);
    const double value = *node.value<double>();
    if (!std::isfinite(value)) {
      Fail(node, fmt::format("'{}' in {} is {}, not a finite number; expected {}", label, title_, value,
                             quantity.expected));
    }
    if (value < quantity.min || value > quantity.max) {
      Fail(node, fmt::format("'{}' in {} is {}; expected {}", label, title_, value, quantity.expected));
    }
    return value;
  }

  double Number(std::string_view key, const Quantity& quantity, double otherwise) const {
    const toml::node* node = Find(key);
    return node ? Number(*node, key, quantity) : otherwise;
  }

  // An array of exactly N numbers.
  template <int N>
  glm::vec<N, double> Numbers(const toml::node& node, std::string_view key, const Quantity& quantity) const {
    const std::string expected = fmt::format("an array of {} numbers", N);
    const toml::array* array = node.as_array();
    if (!array) FailType(node, key, expected);
    if (array->size() != static_cast<std::size_t>(N)) {
      Fail(node,
           fmt::format("'{}' in {} has {} elements; expected {}", key, title_, array->size(), expected));
    }
    glm::vec<N, double> value(0.0);
    for (int i = 0; i < N; ++i) {
      value[i] = Number(*array->get(static_cast<std::size_t>(i)), fmt::format("{}[{}]", key, i), quantity);
    }
    return value;
  }

  template <int N>
  glm::vec<N, double> Numbers(std::string_view key, const Quantity& quantity,
                              const glm::vec<N, double>& otherwise) const {
    const toml::node* node = Find(key);
    return node ? Numbers<N>(*node, key, quantity) : otherwise;
  }

  // One number for all N, or an array of N.
  template <int N>
  glm::vec<N, double> NumberOrNumbers(std::string_view key, const Quantity& quantity,
                                      const glm::vec<N, double>& otherwise) const {
    const toml::node* node = Find(key);
    if (!node) return otherwise;
    if (node->is_array()) return Numbers<N>(*node, key, quantity);
    if (!node->is_number()) FailType(*node, key, fmt::format("one number or an array of {}", N));
    return glm::vec<N, double>(Number(*node, key, quantity));
  }

  std::string String(const toml::node& node, std::string_view key, std::string_view expected) const {
    if (!node.is_string()) FailType(node, key, expected);
    return *node.value<std::string>();
  }

  // One of `words`; required where there is no `otherwise`.
  std::string Word(std::string_view key, const std::vector<std::string>& words,
                   std::optional<std::string> otherwise) const {
    const std::string expected = fmt::format("one of: {}", fmt::join(words, ", "));
    if (!Find(key) && otherwise) return *otherwise;
    const toml::node& node = Require(key, expected);
    const std::string word = String(node, key, expected);
    if (std::find(words.begin(), words.end(), word) == words.end()) {
      Fail(node, fmt::format("'{}' in {} is '{}'; expected {}", key, title_, word, Suggest(word, words)));
    }
    return word;
  }

  bool Bool(std::string_view key, bool otherwise) const {
    const toml::node* node = Find(key);
    if (!node) return otherwise;
    if (!node->is_boolean()) FailType(*node, key, "true or false");
    return *node->value<bool>();
  }

  // Runs what may throw an InputError without a place, and gives it the place of `node`.
  template <typename Function>
  auto At(const toml::node& node, const Function& function) const {
    try {
      return function();
    } catch (const InputError& error) {
      Fail(node, error.what());
    }
  }

 private:
  const fs::path& file_;
  const toml::table& table_;
  std::string title_;
};

// Waves of 7 lengths and directions, each shorter and flatter than the one before: a ground that is
// smooth everywhere and repeats nowhere in sight.
glm::dvec3 Dunes(double x, double y, double wavelength, double amplitude) {
  constexpr double kGoldenAngle = 2.399963229728653;  // rad, π(3 − √5): successive directions never align
  glm::dvec3 result(0.0);
  double frequency = glm::two_pi<double>() / wavelength;
  double height = 0.61803398874989 * amplitude;  // 1 - 1/golden²: the series sums to the amplitude
  for (int i = 0; i < 7; ++i) {
    const double cx = std::cos(kGoldenAngle * i);
    const double cy = std::sin(kGoldenAngle * i);
    const double phase = frequency * (cx * x + cy * y) + i;
    const double slope = height * frequency * std::cos(phase);
    result += glm::dvec3(height * std::sin(phase), slope * cx, slope * cy);
    frequency *= 1.61803398874989;  // golden ratio: incommensurable
    height *= 0.38196601125011;     // its inverse square: slopes fall off too
  }
  return result;
}

// The first line where it is a comment, else nothing.
std::string Question(std::string line) {
  line = line.substr(0, line.find('\n'));
  if (line.empty() || line[0] != '#') return "";
  const auto begin = line.find_first_not_of("# \t");
  const auto end = line.find_last_not_of(" \t\r");
  return begin == std::string::npos ? "" : line.substr(begin, end + 1 - begin);
}

class SceneReader {
 public:
  SceneReader(const fs::path& file, std::set<fs::path>& files)
      : file_(file), folder_(FolderOf(file)), files_(files) {}

  Scene Read(const std::string& text) {
    scene_.name = file_.stem().string();
    scene_.file = file_;
    scene_.question = Question(text);
    toml::table root_table;
    try {
      root_table = toml::parse(text);
    } catch (const toml::parse_error& error) {
      FailAtLine(file_, error.source().begin.line,
                 fmt::format("{}; expected valid TOML", error.description()));
    }
    const Fields root(file_, root_table, "the scene");
    root.Allow({"units", "exposure", "brdf", "diffuse", "aperture", "sky", "camera", "material", "surface", "light"});
    scene_.units = root.Word("units", {"radiometric", "photometric"}, "radiometric") == "photometric"
                       ? Units::kPhotometric
                       : Units::kRadiometric;
    scene_.exposure = root.Number("exposure", kExposure, 0.0);
    scene_.brdf = OneOf(root, "brdf", kBrdfs);
    scene_.diffuse = OneOf(root, "diffuse", kDiffuseBrdfs);
    ReadAperture(root);
    ReadSky(root);
    ReadCamera(root);
    for (const Fields& fields : Tables(root, "material")) ReadMaterial(fields);
    const std::vector<Fields> surfaces = Tables(root, "surface");
    if (surfaces.empty())
      FailAtLine(file_, 1, "the scene has no surfaces; expected at least one [[surface]]");
    for (const Fields& fields : surfaces) ReadSurface(fields);
    const std::vector<Fields> lights = Tables(root, "light");
    if (lights.empty()) FailAtLine(file_, 1, "the scene has no lights; expected at least one [[light]]");
    for (const Fields& fields : lights) {
      if (scene_.lights.size() == kMaxLights) {
        fields.Fail(fmt::format("the scene has {} lights; expected at most {}", lights.size(), kMaxLights));
      }
      ReadLight(fields);
    }
    if (const auto why = WhyNotDiffuse(scene_)) root.Fail(*root.Find("diffuse"), fmt::format("{}; expected \"{}\"", *why, Name(Brdf::kLambert)));
    return std::move(scene_);
  }

 private:
  // One of `brdfs` by its name, the first where the scene names none.
  static Brdf OneOf(const Fields& root, std::string_view key, std::span<const Brdf> brdfs) {
    std::vector<std::string> names;
    for (const Brdf brdf : brdfs) names.emplace_back(Name(brdf));
    const std::string name = root.Word(key, names, names.front());
    return brdfs[static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin())];
  }

  // The tables of an array of tables, each titled "[[key]] 'name'" or "[[key]]".
  std::vector<Fields> Tables(const Fields& root, const std::string& key) const {
    std::vector<Fields> tables;
    const toml::node* node = root.Find(key);
    if (!node) return tables;
    const toml::array* array = node->as_array();
    if (!array) root.FailType(*node, key, fmt::format("tables, each headed [[{}]]", key));
    for (const toml::node& element : *array) {
      const toml::table* table = element.as_table();
      if (!table) root.FailType(element, key, fmt::format("tables, each headed [[{}]]", key));
      std::string title = fmt::format("[[{}]]", key);
      if (const auto name = (*table)["name"].value<std::string>()) title += fmt::format(" '{}'", *name);
      tables.emplace_back(file_, *table, std::move(title));
    }
    return tables;
  }

  void ReadAperture(const Fields& root) {
    const toml::node* node = root.Find("aperture");
    if (!node) return;
    const toml::table* table = node->as_table();
    if (!table) root.FailType(*node, "aperture", "a table [aperture]");
    const Fields fields(file_, *table, "[aperture]");
    fields.Allow({"rays", "cell"});
    ApertureSettings& settings = scene_.aperture.emplace();
    const double rays = fields.Number("rays", kApertureRays, settings.rays);
    settings.rays = static_cast<int>(rays);
    if (settings.rays != rays) fields.Fail(*fields.Find("rays"), fmt::format("'rays' is not whole; expected {}", kApertureRays.expected));
    if (fields.Find("cell")) settings.cell = fields.Number("cell", kLength, 0.0);
  }

  void ReadSky(const Fields& root) {
    const toml::node* node = root.Find("sky");
    if (!node) return;
    const toml::table* table = node->as_table();
    if (!table) root.FailType(*node, "sky", "a table [sky]");
    const Fields fields(file_, *table, "[sky]");
    const char* key = scene_.units == Units::kPhotometric ? "luminance" : "radiance";
    fields.Allow({"radiance", "luminance", "color", "texture", "rotation"});
    RefuseOtherUnits(fields, fmt::format("'{}'", key));
    Sky& sky = scene_.sky.emplace();
    if (const toml::node* texture = fields.Find("texture")) {
      const FileInFolder place = Resolve(fields, *texture, "texture");
      sky.texture = fields.At(*texture, [&] { return LoadSkyTexture(place.file); });
      sky.texture_path = *texture->value<std::string>();
      sky.turn = glm::radians(fields.Number("rotation", kAngle, 0.0));
    } else if (const toml::node* rotation = fields.Find("rotation")) {
      fields.Fail(*rotation, "'rotation' turns a sky without a texture; expected both or neither");
    }
    const toml::node& density = fields.Require(key, kRadiance.expected);
    sky.radiance = ReadDensity(fields, key, density);
    if (!(Luminance(sky.radiance * (sky.texture ? MeanSkyTexel(*sky.texture) : glm::dvec3(1.0))) > 0.0)) {
      fields.Fail(density, fmt::format("[sky] emits nothing; expected {}", kRadiance.expected));
    }
  }

  // The largest side of a plane's or box's cells, m.
  double Cell() const {
    const bool cut = scene_.aperture && scene_.aperture->cell > 0.0;
    return cut ? scene_.aperture->cell : std::numeric_limits<double>::infinity();
  }

  void ReadCamera(const Fields& root) {
    const toml::node* node = root.Find("camera");
    if (!node)
      FailAtLine(file_, 1, "the scene has no camera; expected a table [camera] with position and target");
    const toml::table* table = node->as_table();
    if (!table) root.FailType(*node, "camera", "a table [camera]");
    const Fields fields(file_, *table, "[camera]");
    fields.Allow({"position", "target", "up", "vertical_fov"});
    Camera& camera = scene_.camera;
    const char* expected = "an array of 3 numbers, metres";
    camera.position = fields.Numbers<3>(fields.Require("position", expected), "position", kCoordinate);
    const toml::node& target = fields.Require("target", expected);
    camera.target = fields.Numbers<3>(target, "target", kCoordinate);
    camera.up = fields.Numbers<3>("up", kDirection, {0.0, 0.0, 1.0});
    camera.vertical_fov = glm::radians(fields.Number("vertical_fov", kFieldOfView, 40.0));
    const glm::dvec3 forward = camera.target - camera.position;
    if (!(glm::length(forward) > 0.0)) {
      fields.Fail(target, "the camera's target is its position; expected two different points");
    }
    const toml::node* up = fields.Find("up");
    const toml::node& up_place = up ? *up : target;
    if (!(glm::length(camera.up) > 0.0))
      fields.Fail(up_place, "the camera's up is zero; expected a direction");
    // Below 1e-6 rad single precision leaves nothing of the picture's orientation.
    if (glm::length(glm::cross(glm::normalize(forward), glm::normalize(camera.up))) < 1e-6) {
      fields.Fail(up_place,
                  "the camera looks along its up direction; expected 'up' to lean against the line of sight");
    }
    camera.up = glm::normalize(camera.up);
  }

  // The name of a table, refused where an earlier one has it.
  std::string UniqueName(const Fields& fields, std::set<std::string>& names,
                         const std::string& otherwise) const {
    const toml::node* node = fields.Find("name");
    const std::string name = node ? fields.String(*node, "name", "a string") : otherwise;
    if (node && (name.empty() || name.size() > 100)) {
      fields.Fail(*node, fmt::format("'name' in {} has {} characters; expected 1 to 100", fields.title(),
                                     name.size()));
    }
    if (!names.insert(name).second) {
      const std::string what =
          fmt::format("the name '{}' is taken; expected another name for {}", name, fields.title());
      node ? fields.Fail(*node, what) : fields.Fail(what);
    }
    return name;
  }

  // A file that the scene names, and the folder that it and what it refers to may not leave.
  struct FileInFolder {
    fs::path file;
    fs::path root;
  };

  FileInFolder Resolve(const Fields& fields, const toml::node& node, std::string_view key) const {
    const std::string path = fields.String(node, key, "a path as a string");
    return fields.At(node, [&]() -> FileInFolder {
      if (!path.starts_with(kPackagePrefix)) files_.insert(folder_ / path);
      if (!path.starts_with(kPackagePrefix))
        return {ResolveInside(folder_, path, folder_, "the scene's folder"), folder_};
      std::error_code error;
      if (!fs::is_directory(kPackageFolder, error)) {
        throw InputError(
            fmt::format("no file '{}', since {} does not exist; install the Debian package glmark2-data",
                        path, kPackageFolder));
      }
      return {ResolveInside(kPackageFolder, path.substr(kPackagePrefix.size()), kPackageFolder,
                            "the Debian package glmark2-data"),
              kPackageFolder};
    });
  }

  std::shared_ptr<const Image> Texture(const Fields& fields, const char* key, ImageUse use) {
    const toml::node* node = fields.Find(key);
    if (!node) return nullptr;
    const FileInFolder place = Resolve(fields, *node, key);
    const std::pair id{place.file, use};
    if (const auto found = images_.find(id); found != images_.end()) return found->second;
    return images_[id] = fields.At(*node, [&] { return LoadImage(place.file, use); });
  }

  void ReadMaterial(const Fields& fields) {
    fields.Allow({"name", "base_color", "roughness", "metalness", "specular", "base_color_texture",
                  "metallic_roughness_texture", "normal_texture", "normal_scale"});
    fields.Require("name", "a name that surfaces refer to");
    Material material;
    material.name = UniqueName(fields, material_names_, "");
    material.base_color =
        fields.NumberOrNumbers<3>("base_color", kUnitInterval, glm::dvec3(material.base_color));
    material.roughness =
        fields.NumberOrNumbers<2>("roughness", kUnitInterval, glm::dvec2(material.roughness));
    material.metalness = static_cast<float>(fields.Number("metalness", kUnitInterval, 0.0));
    material.specular = static_cast<float>(fields.Number("specular", kUnitInterval, 1.0));
    material.base_color_texture = Texture(fields, "base_color_texture", ImageUse::kColor);
    material.metallic_roughness_texture = Texture(fields, "metallic_roughness_texture", ImageUse::kData);
    material.normal_texture = Texture(fields, "normal_texture", ImageUse::kData);
    material.normal_scale = static_cast<float>(fields.Number("normal_scale", kNormalScale, 1.0));
    if (material.specular != 1.0f && (material.metalness > 0.0f || material.metallic_roughness_texture)) {
      fields.Fail(*fields.Find("specular"), "specular weighs a non-metal's lobe; expected no metalness beside it");
    }
    scene_.materials.push_back(std::move(material));
  }

  // The index of the material that a surface names.
  int MaterialIndex(const Fields& fields) const {
    std::vector<std::string> names;
    for (const Material& material : scene_.materials) names.push_back(material.name);
    if (names.empty()) {
      const toml::node* node = fields.Find("material");
      const std::string what =
          fmt::format("{} needs a material and the scene has none; expected a [[material]]", fields.title());
      node ? fields.Fail(*node, what) : fields.Fail(what);
    }
    const toml::node& node =
        fields.Require("material", fmt::format("the name of a [[material]]: {}", fmt::join(names, ", ")));
    const std::string name = fields.String(node, "material", "the name of a [[material]]");
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      fields.Fail(node, fmt::format("no material '{}'; expected {}", name, Suggest(name, names)));
    }
    return static_cast<int>(found - names.begin());
  }

  static bool NeedsTextureCoordinates(const Material& material) {
    return material.roughness.x != material.roughness.y || material.base_color_texture ||
           material.metallic_roughness_texture || material.normal_texture;
  }

  void ReadSurface(const Fields& fields) {
    static const std::map<std::string, std::vector<std::string>> kKeys = {
        {"plane", {"size"}},
        {"sphere", {"radius"}},
        {"box", {"size"}},
        {"height_field", {"size", "height", "cells", "formula", "wavelength", "image"}},
        {"mesh", {"file", "scale", "height", "up"}}};
    std::vector<std::string> types;
    for (const auto& [type, keys] : kKeys) types.push_back(type);
    const std::string type = fields.Word("type", types, std::nullopt);
    std::vector<std::string> known = {"type", "position", "rotation", "material"};
    known.insert(known.end(), kKeys.at(type).begin(), kKeys.at(type).end());
    const Fields surface(fields.Renamed(fmt::format("[[surface]] of type '{}'", type)));
    surface.Allow(known);
    Placement placement;
    placement.position = surface.Numbers<3>("position", kCoordinate, glm::dvec3(0.0));
    placement.rotation = RotationFromDegrees(surface.Numbers<3>("rotation", kAngle, glm::dvec3(0.0)));
    if (type == "mesh") {
      ReadMesh(surface, placement);
      return;
    }
    Mesh mesh;
    const auto size = [&]<int N>(std::integral_constant<int, N>) {
      return surface.Numbers<N>(surface.Require("size", fmt::format("an array of {} lengths in metres", N)),
                                "size", kLength);
    };
    if (type == "plane") mesh = MakePlane(size(std::integral_constant<int, 2>{}), placement, Cell());
    if (type == "box") mesh = MakeBox(size(std::integral_constant<int, 3>{}), placement, Cell());
    if (type == "sphere") {
      mesh = MakeSphere(surface.Number(surface.Require("radius", kLength.expected), "radius", kLength),
                        placement);
    }
    if (type == "height_field")
      mesh = HeightField(surface, size(std::integral_constant<int, 2>{}), placement);
    mesh.material = MaterialIndex(surface);
    scene_.meshes.push_back(std::move(mesh));
  }

  Mesh HeightField(const Fields& fields, const glm::dvec2& size, const Placement& placement) {
    const double height =
        fields.Number(fields.Require("height", "a height in metres"), "height", kCoordinate);
    const toml::node* formula = fields.Find("formula");
    const toml::node* image_node = fields.Find("image");
    if (!formula == !image_node)
      fields.Fail("a height field has one of 'formula' and 'image'; expected exactly one");
    glm::ivec2 cells(256);
    HeightFunction function;
    std::shared_ptr<const Image> image;
    if (image_node) {
      if (const toml::node* node = fields.Find("wavelength")) {
        fields.Fail(*node,
                    "'wavelength' belongs to a formula and this height field has an image; expected none");
      }
      image = Texture(fields, "image", ImageUse::kData);
      if (image->width < 2 || image->height < 2) {
        fields.Fail(*image_node,
                    "the height image is a single row or column; expected at least 2 × 2 pixels");
      }
      cells = glm::clamp(glm::ivec2(image->width - 1, image->height - 1), 1, kMaxCells);
      function = [&](double x, double y) { return HeightInImage(*image, size, height, x, y); };
    } else {
      const std::string name = fields.Word("formula", {"waves", "ripples", "dunes"}, std::nullopt);
      const double wavelength =
          fields.Number(fields.Require("wavelength", kLength.expected), "wavelength", kLength);
      const double k = glm::two_pi<double>() / wavelength;
      if (name == "waves") {
        function = [=](double x, double y) {
          return height * glm::dvec3(std::sin(k * x) * std::sin(k * y), k * std::cos(k * x) * std::sin(k * y),
                                     k * std::sin(k * x) * std::cos(k * y));
        };
      } else if (name == "ripples") {
        function = [=](double x, double y) {
          const double r = std::hypot(x, y);
          const double slope = r > 0.0 ? -k * std::sin(k * r) / r : 0.0;
          return height * glm::dvec3(std::cos(k * r), slope * x, slope * y);
        };
      } else {
        function = [=](double x, double y) { return Dunes(x, y, wavelength, height); };
      }
    }
    if (const toml::node* node = fields.Find("cells")) {
      const Quantity count{1.0, kMaxCells, "whole numbers of cells along x and y, 1 to 2048"};
      const glm::dvec2 value = fields.Numbers<2>(*node, "cells", count);
      cells = glm::ivec2(value);
      if (glm::dvec2(cells) != value)
        fields.Fail(*node, fmt::format("'cells' is not whole; expected {}", count.expected));
    }
    return MakeHeightField(size, cells, function, placement);
  }

  // Bilinear in the image's red, whose corner pixels lie on the field's corners: 0 is 0 m, 1 is `height`. The
  // slopes are central differences over a pixel either way.
  static glm::dvec3 HeightInImage(const Image& image, const glm::dvec2& size, double height, double x,
                                  double y) {
    const glm::dvec2 last(image.width - 1, image.height - 1);
    const auto at = [&](glm::dvec2 p) {
      p = glm::clamp(p, glm::dvec2(0.0), last);
      const glm::ivec2 i = glm::min(glm::ivec2(p), glm::ivec2(last) - 1);
      const glm::dvec2 f = p - glm::dvec2(i);
      const auto pixel = [&](int dx, int dy) {
        const auto index = static_cast<std::size_t>(i.y + dy) * static_cast<std::size_t>(image.width) +
                           static_cast<std::size_t>(i.x + dx);
        return static_cast<double>(image.pixels[index].r);
      };
      return height *
             glm::mix(glm::mix(pixel(0, 0), pixel(1, 0), f.x), glm::mix(pixel(0, 1), pixel(1, 1), f.x), f.y);
    };
    const glm::dvec2 p(last.x * (x / size.x + 0.5), last.y * (0.5 - y / size.y));
    const auto slope = [&](int axis, double sign) {
      glm::dvec2 low = p;
      glm::dvec2 high = p;
      low[axis] = std::max(p[axis] - 1.0, 0.0);
      high[axis] = std::min(p[axis] + 1.0, last[axis]);
      return sign * (at(high) - at(low)) / (high[axis] - low[axis]) * last[axis] / size[axis];
    };
    return {at(p), slope(0, 1.0), slope(1, -1.0)};
  }

  void ReadMesh(const Fields& fields, const Placement& placement) {
    const toml::node& file_node = fields.Require("file", "the path of a mesh");
    const FileInFolder place = Resolve(fields, file_node, "file");
    MeshFile loaded = fields.At(file_node, [&] { return LoadMeshFile(place.file, place.root, &files_); });
    // glTF stands on y by its specification; the other formats leave it open.
    const bool y_up = fields.Word("up", {"y", "z"}, loaded.metal_rough ? "y" : "z") == "y";
    const toml::node* height = fields.Find("height");
    if (height && fields.Find("scale")) {
      fields.Fail(*height, "both 'height' and 'scale' are given; expected one of them");
    }
    glm::dvec3 scale = fields.NumberOrNumbers<3>("scale", kScale, glm::dvec3(1.0));
    const glm::dmat3 z_up = y_up ? RotationFromDegrees({90.0, 0.0, 0.0}) : glm::dmat3(1.0);
    glm::dvec3 offset(0.0);
    if (height) {
      const double meters = fields.Number(*height, "height", kLength);
      glm::dvec3 low(std::numeric_limits<double>::infinity());
      glm::dvec3 high = -low;
      const glm::dmat3 turned = placement.rotation * z_up;
      for (const Mesh& mesh : loaded.meshes) {
        for (const std::uint32_t index : mesh.indices) {
          const glm::dvec3 p = turned * glm::dvec3(mesh.vertices[index].position);
          low = glm::min(low, p);
          high = glm::max(high, p);
        }
      }
      if (!(high.z > low.z))
        fields.Fail(*height, "the mesh is flat and level; expected 'scale' instead of 'height'");
      scale = glm::dvec3(meters / (high.z - low.z));
      offset = -scale * glm::dvec3(0.5 * (low.x + high.x), 0.5 * (low.y + high.y), low.z);
    }
    const bool own_materials = !fields.Find("material") && loaded.metal_rough;
    const int first = own_materials ? static_cast<int>(scene_.materials.size()) : MaterialIndex(fields);
    for (Mesh& mesh : loaded.meshes) {
      for (Vertex& vertex : mesh.vertices) {
        // Scaling acts along the mesh's axes after they were turned to z up, before the rotation.
        const glm::dvec3 local = scale * (z_up * glm::dvec3(vertex.position));
        vertex.position = glm::vec3(placement.position + offset + placement.rotation * local);
        const glm::dvec3 normal =
            placement.rotation * glm::normalize((z_up * glm::dvec3(vertex.normal)) / scale);
        const glm::dvec3 tangent = placement.rotation * (scale * (z_up * glm::dvec3(vertex.tangent)));
        vertex.normal = glm::vec3(glm::normalize(normal));
        vertex.tangent = glm::vec4(glm::vec3(glm::normalize(tangent - glm::dot(tangent, normal) * normal)),
                                   vertex.tangent.w);
        for (int axis = 0; axis < 3; ++axis) {
          if (std::abs(vertex.position[axis]) > 1e7f) {
            fields.Fail(file_node, fmt::format("the mesh reaches {} m; expected {}", vertex.position[axis],
                                               kCoordinate.expected));
          }
        }
      }
      mesh.material = own_materials ? first + mesh.material : first;
    }
    if (own_materials) {
      for (Material& material : loaded.materials) {
        material.name = fmt::format("{}: {}", place.file.filename().string(), material.name);
        scene_.materials.push_back(std::move(material));
      }
    }
    for (Mesh& mesh : loaded.meshes) {
      const Material& material = scene_.materials[static_cast<std::size_t>(mesh.material)];
      if (!loaded.has_texture_coordinates && NeedsTextureCoordinates(material)) {
        fields.Fail(
            file_node,
            fmt::format("'{}' has no texture coordinates and its material '{}' has a texture or a roughness "
                        "ramp; expected a mesh with them or a plain material",
                        place.file.filename().string(), material.name));
      }
      scene_.meshes.push_back(std::move(mesh));
    }
  }

  static std::vector<std::string> ShapeNames() {
    std::vector<std::string> names;
    for (const LightShape shape : kLightShapes) names.emplace_back(Name(shape));
    return names;
  }

  static const char* SizeKey(LightShape shape) {
    switch (shape) {
      case LightShape::kRectangle:
        return "size";
      case LightShape::kDisk:
      case LightShape::kSphere:
      case LightShape::kTube:
        return "radius";
      case LightShape::kPolygon:
        return "corners";
      case LightShape::kEllipse:
        return "radii";
    }
    return "";
  }

  void ReadLight(const Fields& fields) {
    const std::string shape = fields.Word("shape", ShapeNames(), std::nullopt);
    std::vector<std::string> known = {"name",     "shape", "position",  "color",
                                      "radiance", "flux",  "luminance", "luminous_flux", "texture"};
    Light light;
    light.shape = *std::find_if(std::begin(kLightShapes), std::end(kLightShapes), [&](LightShape s) { return shape == Name(s); });
    known.emplace_back(SizeKey(light.shape));
    if (light.shape == LightShape::kTube) known.insert(known.end(), {"length", "axis", "rotation"});
    if (IsFlat(light.shape)) known.insert(known.end(), {"target", "normal", "rotation", "up", "two_sided"});
    fields.Allow(known);
    light.name = UniqueName(fields, light_names_, fmt::format("light {}", scene_.lights.size() + 1));
    light.center = fields.Numbers<3>(fields.Require("position", "an array of 3 numbers, metres"), "position",
                                     kCoordinate);
    light.two_sided = fields.Bool("two_sided", false);
    if (light.shape != LightShape::kPolygon) ReadLightSize(fields, light);
    if (IsFlat(light.shape)) ReadLightAxes(fields, light);
    if (light.shape == LightShape::kTube) ReadTube(fields, light);
    if (light.shape == LightShape::kPolygon) ReadCorners(fields, light);
    ReadLightTexture(fields, light);
    ReadEmission(fields, light);
    scene_.lights.push_back(std::move(light));
  }

  static void ReadLightSize(const Fields& fields, Light& light) {
    const char* key = SizeKey(light.shape);
    const bool two = light.shape == LightShape::kRectangle || light.shape == LightShape::kEllipse;
    const double scale = light.shape == LightShape::kRectangle ? 0.5 : 1.0;
    const toml::node& node = fields.Require(key, light.shape == LightShape::kRectangle ? "[width, height] in metres"
                                                 : two                                 ? "[a, b], half axes in metres"
                                                                                       : kLength.expected);
    // Zero gets a sentence of its own: it is what people try for a point light.
    const Quantity from_zero{0.0, kLength.max, kLength.expected};
    const glm::dvec2 size = two ? scale * fields.Numbers<2>(node, key, from_zero) : glm::dvec2(fields.Number(node, key, from_zero));
    if (size.x == 0.0 || size.y == 0.0) FailForArea(fields, node);
    light.half_size = two ? scale * fields.Numbers<2>(node, key, kLength) : glm::dvec2(fields.Number(node, key, kLength));
  }

  [[noreturn]] static void FailForArea(const Fields& fields, const toml::node& node) {
    fields.Fail(node, fmt::format("{} has no area; expected {}", fields.title(), kLength.expected));
  }

  // A tube's length, and where it runs.
  static void ReadTube(const Fields& fields, Light& light) {
    const toml::node& node = fields.Require("length", kLength.expected);
    if (fields.Number(node, "length", {0.0, kLength.max, kLength.expected}) == 0.0) FailForArea(fields, node);
    light.half_size.x = 0.5 * fields.Number(node, "length", kLength);
    const toml::node* axis = fields.Find("axis");
    const toml::node* rotation = fields.Find("rotation");
    if (!axis == !rotation) {
      const std::string what =
          fmt::format("{} has {} 'axis' and 'rotation'; expected exactly one", fields.title(), axis ? "both" : "neither of");
      axis ? fields.Fail(*axis, what) : fields.Fail(what);
    }
    if (rotation) {
      const glm::dmat3 turned = RotationFromDegrees(fields.Numbers<3>(*rotation, "rotation", kAngle));
      light.axis_x = turned[0];
      light.axis_y = turned[1];
      light.normal = turned[2];
      return;
    }
    const glm::dvec3 along = fields.Numbers<3>(*axis, "axis", kDirection);
    if (!(glm::length(along) > 0.0)) fields.Fail(*axis, "the tube's axis is zero; expected a direction");
    LayAlong(light, along);
  }

  // After the axes: the corners lie along them.
  static void ReadCorners(const Fields& fields, Light& light) {
    const std::string expected =
        fmt::format("[[x, y], …], the 3 to {} corners of a convex outline in metres, no three in a line", kMostCorners);
    const toml::node& node = fields.Require("corners", expected);
    const toml::array* array = node.as_array();
    if (!array) fields.FailType(node, "corners", expected);
    std::vector<glm::dvec2> corners;
    for (std::size_t i = 0; i < array->size(); ++i) {
      corners.push_back(fields.Numbers<2>(*array->get(i), fmt::format("corners[{}]", i), kCoordinate));
    }
    const auto fail = [&](const std::string& what) { fields.Fail(node, fmt::format("{}: {}; expected {}", fields.title(), what, expected)); };
    if (const std::optional<std::string> why = WhyNoPolygon(corners)) fail(*why);
    SetCorners(light, std::move(corners));
    if (light.half_size.x < kLength.min || light.half_size.y < kLength.min || light.Area() < kLength.min * kLength.min) {
      fail("it has no area");
    }
  }

  static void ReadLightAxes(const Fields& fields, Light& light) {
    const toml::node* target = fields.Find("target");
    const toml::node* normal = fields.Find("normal");
    const toml::node* rotation = fields.Find("rotation");
    if (!target + !normal + !rotation != 2) {
      const toml::node* second = rotation ? rotation : normal;
      const std::string what =
          fmt::format("{} has {} of 'target', 'normal' and 'rotation'; expected exactly one", fields.title(),
                      (target || normal || rotation) ? "more than one" : "none");
      second ? fields.Fail(*second, what) : fields.Fail(what);
    }
    const toml::node* up_node = fields.Find("up");
    if (rotation) {
      if (up_node) fields.Fail(*up_node, "'up' has no meaning beside 'rotation'; expected one of the two");
      const glm::dmat3 turned = RotationFromDegrees(fields.Numbers<3>(*rotation, "rotation", kAngle));
      light.axis_x = turned[0];
      light.axis_y = turned[1];
      light.normal = turned[2];
      return;
    }
    const glm::dvec3 facing = target ? fields.Numbers<3>(*target, "target", kCoordinate) - light.center
                                     : fields.Numbers<3>(*normal, "normal", kDirection);
    if (!(glm::length(facing) > 0.0)) {
      fields.Fail(target ? *target : *normal,
                  target ? "the light's target is its position; expected two different points"
                         : "the light's normal is zero; expected a direction");
    }
    light.normal = glm::normalize(facing);
    glm::dvec3 up = fields.Numbers<3>("up", kDirection, {0.0, 0.0, 1.0});
    if (!(glm::length(up) > 0.0)) fields.Fail(*up_node, "the light's up is zero; expected a direction");
    up = glm::normalize(up);
    // 1e-6 rad: closer to parallel, rounding in the file's digits would turn the light about its normal.
    if (glm::length(glm::cross(up, light.normal)) < 1e-6) {
      if (up_node)
        fields.Fail(*up_node, "the light's up is parallel to its normal; expected it to lean against it");
      up = {0.0, 1.0, 0.0};  // a light that faces straight up or down, without a word on its turn
    }
    light.axis_x = glm::normalize(glm::cross(up, light.normal));
    light.axis_y = glm::cross(light.normal, light.axis_x);
  }

  void ReadLightTexture(const Fields& fields, Light& light) {
    const toml::node* node = fields.Find("texture");
    if (!node) return;
    if (light.shape != LightShape::kRectangle) {
      fields.Fail(*node, fmt::format("'texture' in {} stands on a {}; expected a rectangle", fields.title(), Name(light.shape)));
    }
    const FileInFolder place = Resolve(fields, *node, "texture");
    std::shared_ptr<const Image>& texture = light_textures_[place.file];
    if (!texture) texture = fields.At(*node, [&] { return LoadLightTexture(place.file); });
    light.texture = texture;
    light.texture_path = *node->value<std::string>();
  }

  // Quantities of the units that the scene has not.
  void RefuseOtherUnits(const Fields& fields, const std::string& expected) const {
    const bool photometric = scene_.units == Units::kPhotometric;
    const char* own = photometric ? "photometric" : "radiometric";
    const char* other = photometric ? "radiometric" : "photometric";
    for (const char* wrong :
         {photometric ? "radiance" : "luminance", photometric ? "flux" : "luminous_flux"}) {
      if (const toml::node* node = fields.Find(wrong)) {
        fields.Fail(*node, fmt::format("'{}' is a {} quantity and this scene's units are {}; expected {}", wrong,
                                       other, own, expected));
      }
    }
  }

  // The colour gives the hue alone: the luminance-weighted value is what the file states.
  static glm::dvec3 Colored(const Fields& fields, double value) {
    const glm::dvec3 color = fields.Numbers<3>("color", kColor, glm::dvec3(1.0));
    if (!(Luminance(color) > 0.0)) {
      fields.Fail(*fields.Find("color"),
                  fmt::format("{}'s color is black; expected {}", fields.title() == "[sky]" ? "the sky" : "the light", kColor.expected));
    }
    return color / Luminance(color) * value;
  }

  // Radiance or luminance: three numbers, or one and a color.
  static glm::dvec3 ReadDensity(const Fields& fields, const char* key, const toml::node& density) {
    if (!density.is_array()) return Colored(fields, fields.Number(density, key, kRadiance));
    if (const toml::node* color = fields.Find("color")) {
      fields.Fail(*color, fmt::format("'color' stands beside three numbers of '{}'; expected one or the other", key));
    }
    return fields.Numbers<3>(density, key, kRadiance);
  }

  void ReadEmission(const Fields& fields, Light& light) const {
    const bool photometric = scene_.units == Units::kPhotometric;
    const char* per_area = photometric ? "luminance" : "radiance";
    const char* total = photometric ? "luminous_flux" : "flux";
    RefuseOtherUnits(fields, fmt::format("'{}' or '{}'", per_area, total));
    const toml::node* density = fields.Find(per_area);
    const toml::node* flux = fields.Find(total);
    if (!density == !flux) {
      const std::string what = fmt::format("{} has {} '{}' and '{}'; expected exactly one", fields.title(),
                                           density ? "both" : "neither of", per_area, total);
      flux ? fields.Fail(*flux, what) : fields.Fail(what);
    }
    const toml::node& node = density ? *density : *flux;
    if (density) {
      light.radiance = ReadDensity(fields, per_area, *density);
    } else {
      light.radiance = Colored(fields, fields.Number(*flux, total, kFlux) / (glm::pi<double>() * light.Area()));
    }
    if (light.texture && Luminance(light.radiance) > 0.0) {
      const double mean = Luminance(light.radiance * MeanTexel(*light.texture)) / Luminance(light.radiance);
      if (mean == 0.0) {
        const toml::node* color = fields.Find("color");
        fields.Fail(color ? *color : node,
                    fmt::format("the light's color and its texture have no channel in common; expected {}", kColor.expected));
      }
      if (flux) light.radiance /= mean;
    }
    if (!(Luminance(light.radiance) > 0.0)) {
      fields.Fail(node, fmt::format("{} emits nothing; expected {}", fields.title(), kRadiance.expected));
    }
    if (Luminance(light.radiance) > kMaxRadiance) {
      fields.Fail(node, fmt::format("{} makes a {} of {:.3g} over {:.3g} m²; expected at most 1e12", total,
                                    per_area, Luminance(light.radiance), light.Area()));
    }
  }

  const fs::path& file_;
  fs::path folder_;
  std::set<fs::path>& files_;  // that the scene calls for
  Scene scene_;
  std::set<std::string> material_names_;
  std::set<std::string> light_names_;
  std::map<std::pair<fs::path, ImageUse>, std::shared_ptr<const Image>> images_;
  std::map<fs::path, std::shared_ptr<const Image>> light_textures_;
};

}  // namespace

std::string ReadQuestion(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return Question(std::move(line));
}

fs::path FolderOf(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

std::string ReadSceneText(const fs::path& file) {
  std::error_code error;
  std::ifstream stream;
  if (fs::is_regular_file(file, error)) stream.open(file, std::ios::binary);
  if (!stream.is_open()) {
    throw InputError(fmt::format("{}: cannot be read; expected a scene file (TOML)", file.string()));
  }
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

Scene ParseScene(const fs::path& file, const std::string& text) {
  std::set<fs::path> files;
  return ParseScene(file, text, files);
}

Scene ParseScene(const fs::path& file, const std::string& text, std::set<fs::path>& files) {
  return SceneReader(file, files).Read(text);
}

Scene LoadScene(const fs::path& file) {
  return ParseScene(file, ReadSceneText(file));
}

}  // namespace arealab
