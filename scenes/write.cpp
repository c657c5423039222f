#include "scenes/write.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "scenes/error.h"
#include "scenes/replace_file.h"

namespace arealab {
namespace {

namespace fs = std::filesystem;

// What a file's seven digits may leave of a value that was edited.
constexpr double kDigits = 1e-6;

bool Close(double a, double b) { return std::abs(a - b) <= kDigits * std::max({std::abs(a), std::abs(b), 1e-6}); }
bool Close(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::distance(a, b) <= kDigits * std::max({glm::length(a), glm::length(b), 1.0});
}
bool CloseColor(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::distance(a, b) <= kDigits * std::max(glm::length(a), glm::length(b));
}

std::string Number(double value) {
  std::string text = fmt::format("{:.7g}", value == 0.0 ? 0.0 : value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}
std::string Numbers(std::initializer_list<double> values) {
  std::vector<std::string> texts;
  for (const double value : values) texts.push_back(Number(value));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}
std::string Numbers(const glm::dvec3& v) { return Numbers({v.x, v.y, v.z}); }
std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
  return quoted + '"';
}
// Of a value that is floats in memory: the shortest text that reads as the same.
std::string Float(float value) {
  std::string text = fmt::format("{}", value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

// A text and replacements of parts of it, which are all made at the end, so that places stay what they are.
class Text {
 public:
  explicit Text(std::string text) : text_(std::move(text)) {
    lines_.push_back(0);
    for (std::size_t i = 0; i < text_.size(); ++i) {
      if (text_[i] == '\n') lines_.push_back(i + 1);
    }
  }

  std::size_t Offset(const toml::source_position& position) const {
    std::size_t offset = lines_.at(position.line - 1);
    for (toml::source_index column = 1; column < position.column && offset < text_.size(); ++column) {
      do ++offset;
      while (offset < text_.size() && (static_cast<unsigned char>(text_[offset]) & 0xc0) == 0x80);  // within a code point
    }
    return offset;
  }
  std::size_t LineBegin(std::size_t offset) const { return offset == 0 ? 0 : text_.rfind('\n', offset - 1) + 1; }
  std::size_t LineEnd(std::size_t offset) const { return std::min(text_.find('\n', offset), text_.size() - 1) + 1; }

  void Replace(std::size_t begin, std::size_t end, std::string by) { edits_.push_back({begin, end, std::move(by)}); }
  void Replace(const toml::source_region& where, std::string by) { Replace(Offset(where.begin), Offset(where.end), std::move(by)); }

  std::string Result() const {
    std::vector<Edit> edits = edits_;
    std::stable_sort(edits.begin(), edits.end(), [](const Edit& a, const Edit& b) { return a.begin < b.begin; });
    std::string result;
    std::size_t at = 0;
    for (const Edit& edit : edits) {
      result.append(text_, at, edit.begin - at);
      result += edit.by;
      at = edit.end;
    }
    return result.append(text_, at);
  }

 private:
  struct Edit {
    std::size_t begin, end;
    std::string by;
  };
  std::string text_;
  std::vector<std::size_t> lines_;
  std::vector<Edit> edits_;
};

// One table of the file: [camera], a [[light]] …
class TableText {
 public:
  TableText(Text& text, const toml::table& table) : text_(text), table_(table) {}

  const toml::node* Find(std::string_view key) const { return table_.get(key); }

  // Writes a value where it stands, else as the table's last line.
  void Set(const std::string& key, const std::string& value) {
    if (const toml::node* node = Find(key)) {
      text_.Replace(node->source(), value);
    } else {
      const std::size_t end = text_.LineEnd(LastOffset());
      text_.Replace(end, end, fmt::format("{} = {}\n", key, value));
    }
  }
  // Another key with another value in its place.
  void Rename(const std::string& key, const std::string& other, const std::string& value) {
    for (const auto& [name, node] : table_) {
      if (name.str() != key) continue;
      text_.Replace(name.source(), other);
      text_.Replace(node.source(), value);
    }
  }
  void Remove(const std::string& key) {
    for (const auto& [name, node] : table_) {
      if (name.str() != key) continue;
      text_.Replace(text_.LineBegin(text_.Offset(name.source().begin)), text_.LineEnd(text_.Offset(node.source().end) - 1), "");
    }
  }
  // The table, its header and the blank line behind it.
  void Erase() {
    std::size_t end = text_.LineEnd(LastOffset());
    text_.Replace(text_.LineBegin(text_.Offset(table_.source().begin)), end, "");
  }

 private:
  // Of the last character of its last value, or of its header.
  std::size_t LastOffset() const {
    std::size_t last = text_.Offset(table_.source().begin);
    for (const auto& [key, node] : table_) last = std::max(last, text_.Offset(node.source().end) - 1);
    return last;
  }

  Text& text_;
  const toml::table& table_;
};

glm::dvec3 Hue(const Light& light) { return light.radiance / Luminance(light.radiance); }

// As the reader derives it from a normal and an up.
glm::dvec3 AxisX(const glm::dvec3& normal, const std::optional<glm::dvec3>& given_up) {
  glm::dvec3 up = glm::normalize(given_up.value_or(glm::dvec3(0.0, 0.0, 1.0)));
  if (glm::length(glm::cross(up, normal)) < 1e-6) up = {0.0, 1.0, 0.0};
  return glm::normalize(glm::cross(up, normal));
}

// Degrees about the world's x, then y, then z that turn +z to the light's normal and +x to its x axis.
glm::dvec3 RotationDegrees(const Light& light) {
  return glm::degrees(glm::dvec3(std::atan2(light.axis_y.z, light.normal.z), std::asin(std::clamp(-light.axis_x.z, -1.0, 1.0)),
                                 std::atan2(light.axis_x.y, light.axis_x.x)));
}

std::optional<glm::dvec3> UpOf(const TableText& table) {
  const toml::node* node = table.Find("up");
  const toml::array* array = node == nullptr ? nullptr : node->as_array();
  if (array == nullptr || array->size() != 3) return std::nullopt;
  return glm::dvec3(array->get(0)->value_or(0.0), array->get(1)->value_or(0.0), array->get(2)->value_or(0.0));
}

void WriteAxes(TableText& table, const Light& light) {
  if (table.Find("rotation") != nullptr) {
    table.Set("rotation", Numbers(RotationDegrees(light)));
    return;
  }
  table.Find("target") != nullptr ? table.Rename("target", "normal", Numbers(light.normal)) : table.Set("normal", Numbers(light.normal));
  if (!Close(AxisX(light.normal, UpOf(table)), light.axis_x)) table.Set("up", Numbers(light.axis_y));
}

void WriteEmission(TableText& table, const Light& before, const Light& after, Units units) {
  const bool photometric = units == Units::kPhotometric;
  const std::string density = photometric ? "luminance" : "radiance", total = photometric ? "luminous_flux" : "flux";
  const toml::node* node = table.Find(density);
  const bool recolored = !CloseColor(Hue(before), Hue(after));
  if (node != nullptr && node->is_array()) {
    if (!CloseColor(before.radiance, after.radiance)) table.Set(density, Numbers(after.radiance));
    return;
  }
  const double then = node != nullptr ? Luminance(before.radiance) : before.Flux();
  const double now = node != nullptr ? Luminance(after.radiance) : after.Flux();
  if (!Close(then, now)) table.Set(node != nullptr ? density : total, Number(now));
  const glm::dvec3 hue = Hue(after);
  if (recolored) table.Set("color", Numbers(hue / std::max({hue.x, hue.y, hue.z})));
}

// What says a shape's size, and how.
struct SizeEntry {
  std::string key, text;
};

SizeEntry SizeOf(const Light& light) {
  switch (light.shape) {
    case LightShape::kRectangle:
      return {"size", Numbers({2.0 * light.half_size.x, 2.0 * light.half_size.y})};
    case LightShape::kDisk:
    case LightShape::kSphere:
      return {"radius", Number(light.half_size.x)};
    case LightShape::kTube:
      return {"radius", Number(light.half_size.y)};
    case LightShape::kEllipse:
      return {"radii", Numbers({light.half_size.x, light.half_size.y})};
    case LightShape::kPolygon:
      break;
  }
  std::string text;
  for (const glm::dvec2& corner : light.corners) text += (text.empty() ? "[" : ", ") + Numbers({corner.x, corner.y});
  return {"corners", text + "]"};
}

bool SameSize(const Light& a, const Light& b) {
  return Close(a.half_size.x, b.half_size.x) && Close(a.half_size.y, b.half_size.y) &&
         std::ranges::equal(a.corners, b.corners, [](const glm::dvec2& p, const glm::dvec2& q) {
           return glm::distance(p, q) <= 10.0 * kDigits * (glm::length(p) + glm::length(q));
         });
}

void WriteTexture(TableText& table, const Light& before, const Light& after) {
  if (before.texture_path == after.texture_path) return;
  after.texture_path.empty() ? table.Remove("texture") : table.Set("texture", Quoted(after.texture_path));
}

// What only a tube says.
void WriteTube(TableText& table, const Light& before, const Light& after) {
  const bool was_tube = before.shape == LightShape::kTube;
  if (after.shape != LightShape::kTube) {
    for (const char* key : {"length", "axis", "rotation"}) {
      if (was_tube) table.Remove(key);
    }
    return;
  }
  if (!was_tube || !Close(before.half_size.x, after.half_size.x)) table.Set("length", Number(2.0 * after.half_size.x));
  if (was_tube && Close(before.axis_x, after.axis_x)) return;
  if (was_tube) table.Remove("rotation");
  table.Set("axis", Numbers(after.axis_x));
}

void WriteLight(TableText& table, const Light& before, const Light& after, Units units) {
  const SizeEntry was = SizeOf(before), is = SizeOf(after);
  // A file's corners need not lie about their centroid, from which the light's do: place and corners are written together.
  const bool polygon = after.shape == LightShape::kPolygon;
  if (before.shape != after.shape) table.Set("shape", Quoted(Name(after.shape)));
  const bool reoriented = !Close(before.normal, after.normal) || !Close(before.axis_x, after.axis_x);
  const bool placed = !Close(before.center, after.center) ||
                      (before.shape == LightShape::kPolygon && (!polygon || reoriented || !SameSize(before, after)));
  if (placed) table.Set("position", Numbers(after.center));
  if (was.key != is.key) {
    table.Rename(was.key, is.key, is.text);
  } else if (!SameSize(before, after) || (polygon && placed)) {
    table.Set(is.key, is.text);
  }
  const bool flat = IsFlat(after.shape);
  if (!flat && IsFlat(before.shape)) {
    for (const char* key : {"target", "normal", "rotation", "up", "two_sided"}) table.Remove(key);
  }
  WriteTube(table, before, after);
  // A light that is moved keeps its axes, so what it faced as a target is a direction from then on.
  const bool turned = reoriented || !IsFlat(before.shape) || (table.Find("target") != nullptr && placed);
  if (flat && turned) WriteAxes(table, after);
  if (flat && before.two_sided != after.two_sided) table.Set("two_sided", after.two_sided ? "true" : "false");
  WriteTexture(table, before, after);
  WriteEmission(table, before, after, units);
}

std::string NewLight(const Light& light, Units units) {
  std::string text = fmt::format("\n[[light]]\nname = {}\nshape = {}\nposition = {}\n", Quoted(light.name),
                                 Quoted(Name(light.shape)), Numbers(light.center));
  if (IsFlat(light.shape)) {
    text += fmt::format("normal = {}\n", Numbers(light.normal));
    if (!Close(AxisX(light.normal, std::nullopt), light.axis_x)) text += fmt::format("up = {}\n", Numbers(light.axis_y));
    if (light.two_sided) text += "two_sided = true\n";
  }
  if (light.shape == LightShape::kTube) text += fmt::format("axis = {}\nlength = {}\n", Numbers(light.axis_x), Number(2.0 * light.half_size.x));
  const SizeEntry size = SizeOf(light);
  text += fmt::format("{} = {}\n", size.key, size.text);
  if (light.texture) text += fmt::format("texture = {}\n", Quoted(light.texture_path));
  const glm::dvec3 hue = Hue(light);
  if (!CloseColor(hue, glm::dvec3(1.0))) text += fmt::format("color = {}\n", Numbers(hue / std::max({hue.x, hue.y, hue.z})));
  return text + fmt::format("{} = {}\n", units == Units::kPhotometric ? "luminance" : "radiance", Number(Luminance(light.radiance)));
}

void WriteMaterial(TableText& table, const Material& before, const Material& after) {
  const glm::vec3& c = after.base_color;
  if (before.base_color != c) {
    table.Set("base_color", c.x == c.y && c.y == c.z ? Float(c.x) : fmt::format("[{}, {}, {}]", Float(c.x), Float(c.y), Float(c.z)));
  }
  const glm::vec2& r = after.roughness;
  if (before.roughness != r) table.Set("roughness", r.x == r.y ? Float(r.x) : fmt::format("[{}, {}]", Float(r.x), Float(r.y)));
  if (before.metalness != after.metalness) table.Set("metalness", Float(after.metalness));
  if (before.specular != after.specular) table.Set("specular", Float(after.specular));
  if (before.normal_scale != after.normal_scale) table.Set("normal_scale", Float(after.normal_scale));
}

double SkyRotation(const Sky& sky) { return glm::degrees(sky.turn); }

void WriteSky(TableText& table, const Sky& sky_before, const Sky& sky_after, Units units) {
  if (sky_before.texture_path != sky_after.texture_path) {
    sky_after.texture ? table.Set("texture", Quoted(sky_after.texture_path)) : table.Remove("texture");
    if (!sky_after.texture) table.Remove("rotation");
  }
  if (sky_after.texture && !Close(sky_before.turn, sky_after.turn)) table.Set("rotation", Number(SkyRotation(sky_after)));
  const glm::dvec3 &before = sky_before.radiance, &after = sky_after.radiance;
  if (before == after) return;
  const std::string density = units == Units::kPhotometric ? "luminance" : "radiance";
  if (table.Find(density)->is_array()) return table.Set(density, Numbers(after));
  const auto hue = [](const glm::dvec3& sky) { return sky / std::max({sky.x, sky.y, sky.z}); };
  table.Set(density, Number(Luminance(after)));
  if (!CloseColor(hue(before), hue(after))) table.Set("color", Numbers(hue(after)));
}

std::string NewSky(const Sky& sky, Units units) {
  std::string text = fmt::format("\n[sky]\n{} = {}\n", units == Units::kPhotometric ? "luminance" : "radiance", Numbers(sky.radiance));
  if (sky.texture) text += fmt::format("texture = {}\n", Quoted(sky.texture_path));
  if (sky.texture && sky.turn != 0.0) text += fmt::format("rotation = {}\n", Number(SkyRotation(sky)));
  return text;
}

bool SameSky(const Sky& a, const Sky& b) {
  return a.texture_path == b.texture_path && Close(a.turn, b.turn) && glm::distance(a.radiance, b.radiance) <= 10.0 * kDigits * glm::length(b.radiance);
}

void WriteCamera(TableText& table, const Camera& before, const Camera& after) {
  if (!Close(before.position, after.position)) table.Set("position", Numbers(after.position));
  if (!Close(before.target, after.target)) table.Set("target", Numbers(after.target));
  if (!Close(before.up, after.up)) table.Set("up", Numbers(after.up));
  if (!Close(before.vertical_fov, after.vertical_fov)) table.Set("vertical_fov", Number(glm::degrees(after.vertical_fov)));
}

// The tables of [[key]].
std::vector<const toml::table*> Tables(const toml::table& root, std::string_view key) {
  std::vector<const toml::table*> tables;
  if (const toml::array* array = root[key].as_array()) {
    for (const toml::node& node : *array) {
      const toml::table* table = node.as_table();
      if (table == nullptr || table->is_inline()) {
        throw InputError(fmt::format("'{}' is written in one line; expected tables, each headed [[{}]]", key, key));
      }
      tables.push_back(table);
    }
  }
  return tables;
}

template <typename Thing>
const Thing* Named(const std::vector<Thing>& things, const std::string& name) {
  const auto found = std::find_if(things.begin(), things.end(), [&](const Thing& thing) { return thing.name == name; });
  return found == things.end() ? nullptr : &*found;
}

bool SameLight(const Light& a, const Light& b) {
  const bool flat = IsFlat(a.shape);
  return a.name == b.name && a.shape == b.shape && a.texture_path == b.texture_path && Close(a.center, b.center) && SameSize(a, b) && glm::distance(a.radiance, b.radiance) <= 10.0 * kDigits * glm::length(b.radiance) &&
         (a.shape != LightShape::kTube || Close(a.axis_x, b.axis_x)) &&
         (!flat || (a.two_sided == b.two_sided && Close(a.normal, b.normal) && Close(a.axis_x, b.axis_x)));
}

bool SameMaterial(const Material& a, const Material& b) {
  return a.name == b.name && a.base_color == b.base_color && a.roughness == b.roughness && a.metalness == b.metalness && a.specular == b.specular &&
         a.normal_scale == b.normal_scale;
}

// What of `after` the file's new text does not say; nothing where it says all.
std::optional<std::string> Lost(const Scene& read, const Scene& after) {
  if (read.lights.size() != after.lights.size()) return "the number of lights";
  for (const Light& light : after.lights) {
    const Light* found = Named(read.lights, light.name);
    if (found == nullptr || !SameLight(*found, light)) return fmt::format("the light '{}'", light.name);
  }
  for (const Material& material : after.materials) {
    const Material* found = Named(read.materials, material.name);
    if (found == nullptr || !SameMaterial(*found, material)) return fmt::format("the material '{}'", material.name);
  }
  if (!Close(read.exposure, after.exposure)) return "the exposure";
  if (read.sky.has_value() != after.sky.has_value() || (read.sky && !SameSky(*read.sky, *after.sky))) return "the sky";
  return std::nullopt;
}

}  // namespace

std::string EditedText(const std::string& original, const Scene& before, const Scene& after) {
  // A last line without its end would swallow what is added behind it.
  Text text(original.empty() || original.back() == '\n' ? original : original + '\n');
  const toml::table root = toml::parse(original);

  const std::vector<const toml::table*> lights = Tables(root, "light");
  const bool removed = std::any_of(before.lights.begin(), before.lights.end(),
                                   [&](const Light& light) { return Named(after.lights, light.name) == nullptr; });
  for (std::size_t i = 0; i < lights.size() && i < before.lights.size(); ++i) {
    TableText table(text, *lights[i]);
    const Light& then = before.lights[i];
    const Light* now = Named(after.lights, then.name);
    if (now == nullptr) {
      table.Erase();
      continue;
    }
    // A light without a name is called by its place, which one that goes away changes.
    if (removed && table.Find("name") == nullptr) table.Set("name", Quoted(then.name));
    WriteLight(table, then, *now, after.units);
  }
  std::string added;
  for (const Light& light : after.lights) {
    if (Named(before.lights, light.name) == nullptr) added += NewLight(light, after.units);
  }
  if (const toml::table* sky = root["sky"].as_table()) {
    TableText table(text, *sky);
    after.sky ? WriteSky(table, *before.sky, *after.sky, after.units) : table.Erase();
  } else if (after.sky) {
    added += NewSky(*after.sky, after.units);
  }
  if (!added.empty()) text.Replace(original.size() + (original.ends_with('\n') || original.empty() ? 0 : 1),
                                   original.size() + (original.ends_with('\n') || original.empty() ? 0 : 1), added);

  const std::vector<const toml::table*> materials = Tables(root, "material");
  for (std::size_t i = 0; i < before.materials.size(); ++i) {
    const Material* now = Named(after.materials, before.materials[i].name);
    if (now == nullptr || SameMaterial(before.materials[i], *now)) continue;
    if (i >= materials.size()) {
      throw InputError(fmt::format("the material '{}' comes from a mesh file; expected an edit of a [[material]] of the scene",
                                   before.materials[i].name));
    }
    TableText table(text, *materials[i]);
    WriteMaterial(table, before.materials[i], *now);
  }
  if (const toml::table* camera = root["camera"].as_table()) {
    TableText table(text, *camera);
    WriteCamera(table, before.camera, after.camera);
  }
  if (!Close(before.exposure, after.exposure)) {
    if (const toml::node* stated = root.get("exposure")) {
      text.Replace(stated->source(), Number(after.exposure));
    } else {  // above the first table: below it, it would be that table's
      std::size_t first = original.size();
      for (const auto& [key, node] : root) {
        const toml::node* begin = node.is_array_of_tables() ? node.as_array()->get(0) : &node;
        if (node.is_table() || node.is_array_of_tables()) first = std::min(first, text.LineBegin(text.Offset(begin->source().begin)));
      }
      text.Replace(first, first, fmt::format("exposure = {}\n\n", Number(after.exposure)));
    }
  }
  return text.Result();
}

void SaveScene(const Scene& before, const Scene& after) {
  const fs::path& file = after.file;
  std::string text;
  try {
    text = EditedText(ReadSceneText(file), before, after);
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}:{}: {}; expected valid TOML", file.string(), error.source().begin.line, error.description()));
  }
  if (const auto lost = Lost(ParseScene(file, text), after)) {
    throw InputError(fmt::format("{}: not saved, since {} would not read back as it is; expected the file as it was when it was opened",
                                 file.string(), *lost));
  }
  ReplaceFile(file, text);
}

}  // namespace arealab
