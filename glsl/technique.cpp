#include "glsl/technique.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <set>
#include <span>
#include <string_view>

#include "glsl/effects.h"
#include "glsl/nearest.h"
#include "glsl/words.h"
#include "scenes/error.h"

namespace arealab {

namespace {

constexpr std::string_view kHeaderBegin = "/*---";
constexpr std::string_view kHeaderEnd = "---*/";
// The header's first TOML line is the file's second: added to every line that the TOML reader reports.
constexpr int kHeaderOffset = 1;

const std::vector<LightShape> kShapes(std::begin(kLightShapes), std::end(kLightShapes));
const std::vector<std::string> kLobes{"diffuse", "specular"};
// "ggx" and the other choices of a scene.
std::vector<std::string> BrdfNames(std::span<const Brdf> brdfs) {
  std::vector<std::string> names;
  for (const Brdf brdf : brdfs) names.emplace_back(Name(brdf));
  return names;
}
constexpr std::string_view kHeldLaws[] = {"scale", "rotation", "radiance"};  // without being claimed
// Names whose defines, folders or includes mean something else.
const std::vector<std::string> kReservedOptions{"arealab",   "effect",   "shape",      "knob",   "table",
                                                "technique", "platform", "techniques", "tables", "published", "ideal", "brdf", "diffuse", "importance_cone", "specular_albedo", "visibility"};

std::vector<std::string> ShapeNames(const std::vector<LightShape>& shapes) {
  std::vector<std::string> names;
  for (const LightShape shape : shapes) names.emplace_back(Name(shape));
  return names;
}

std::string_view NextLine(std::string_view& text) {
  const auto end = std::min(text.find('\n'), text.size());
  std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

bool IsIdentifier(std::string_view name) {
  const auto lower = [](char c) { return c >= 'a' && c <= 'z'; };
  return !name.empty() && lower(name[0]) && name.find("__") == std::string_view::npos &&
         std::all_of(name.begin(), name.end(),
                     [&](char c) { return lower(c) || (c >= '0' && c <= '9') || c == '_'; });
}

// Reads one technique file's header; every complaint carries the file and the line.
class HeaderReader {
 public:
  HeaderReader(const ShaderLibrary& library, const std::string& file_name)
      : library_(library), path_(library.DisplayPath(file_name)) {}

  Technique Read(const std::string& name, std::string_view text) {
    Technique technique;
    technique.name = name;
    if (!IsIdentifier(name)) {
      Fail(1, fmt::format("\"{}\" cannot name a technique", name), "lower-case letters, digits and single _");
    }
    toml::table root = Parse(CutHeader(text));
    CheckKeys(root, {"summary", "citation", "author_note", "shapes", "lobes", "brdfs", "diffuse_brdfs", "effects", "exact",
                     "departs", "yardstick", "option", "knob", "tables", "published", "ideal"});
    technique.summary = Line(root, "summary", 1);
    technique.citation = Line(root, "citation", 1);
    technique.author_note = Line(root, "author_note", 1);
    ReadSupport(root, technique);
    for (const toml::table* table : Tables(root, "option")) ReadOption(*table, technique);
    CheckDefines(root, technique);
    CheckNeeds(root, technique);
    for (const toml::table* table : Tables(root, "knob")) ReadKnob(*table, technique);
    ReadTables(root, technique);
    ReadForms(root, technique);
    for (const toml::table* table : Tables(root, "departs")) ReadDeparture(*table, technique);
    return technique;
  }

 private:
  // One line whatever the header holds.
  [[noreturn]] void Fail(int line, std::string wrong, const std::string& expected) const {
    std::replace_if(wrong.begin(), wrong.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
    throw InputError(fmt::format("{}:{}: {}; expected {}", path_, line, wrong, expected));
  }

  static int LineOf(const toml::source_region& region) {
    return static_cast<int>(region.begin.line) + kHeaderOffset;
  }
  static int LineOf(const toml::node& node) { return LineOf(node.source()); }

  std::string_view CutHeader(std::string_view text) const {
    std::string_view rest = text;
    if (NextLine(rest) != kHeaderBegin) {
      Fail(1, "no header", fmt::format("{} as the first line, then TOML, then {}", kHeaderBegin, kHeaderEnd));
    }
    const std::string_view toml_text = rest;
    for (int line = 2; !rest.empty(); ++line) {
      const std::string_view from_here = rest;
      const std::string_view content = NextLine(rest);
      if (content == kHeaderEnd) return toml_text.substr(0, toml_text.size() - from_here.size());
      if (content.find("*/") != std::string_view::npos) {
        Fail(line, "\"*/\" ends the comment inside the header",
             fmt::format("{} alone on a line", kHeaderEnd));
      }
    }
    Fail(1, "the header has no end", fmt::format("{} alone on a line", kHeaderEnd));
  }

  toml::table Parse(std::string_view header) const {
    try {
      return toml::parse(header);
    } catch (const toml::parse_error& error) {
      Fail(LineOf(error.source()), std::string(error.description()), "TOML");
    }
  }

  void CheckKeys(const toml::table& table, std::initializer_list<const char*> known) const {
    const std::vector<std::string> names(known.begin(), known.end());
    for (const auto& [key, value] : table) {
      if (std::find(names.begin(), names.end(), key.str()) == names.end()) {
        Fail(LineOf(key.source()), fmt::format("unknown key \"{}\"", key.str()),
             ExpectedNames(key.str(), names));
      }
    }
  }

  const toml::node& Get(const toml::table& table, std::string_view key, int line) const {
    const toml::node* node = table.get(key);
    if (!node) Fail(line, fmt::format("no key \"{}\"", key), fmt::format("{} = …", key));
    return *node;
  }

  std::string Text(const toml::node& node, std::string_view what) const {
    const auto* text = node.as_string();
    if (!text) Fail(LineOf(node), fmt::format("{} is not a string", what), fmt::format("{} = \"…\"", what));
    if (text->get().find_first_of("\r\n") != std::string::npos) {
      Fail(LineOf(node), fmt::format("{} has several lines", what), "one line");
    }
    return text->get();
  }

  // A string that is not empty.
  std::string Line(const toml::table& table, std::string_view key, int line) const {
    const toml::node& node = Get(table, key, line);
    std::string text = Text(node, key);
    if (text.empty()) Fail(LineOf(node), fmt::format("{} is empty", key), "one line of text");
    return text;
  }

  std::string Identifier(const toml::node& node, std::string_view what) const {
    std::string text = Text(node, what);
    if (!IsIdentifier(text)) {
      Fail(LineOf(node), fmt::format("{} \"{}\" is no name", what, text),
           "lower-case letters, digits and single _, a letter first");
    }
    return text;
  }

  // Unlike other names it may begin with a digit: it always follows its option's.
  std::string ChoiceName(const toml::node& node, std::string_view what) const {
    std::string text = Text(node, what);
    if (text.empty() || text[0] == '_' || !IsIdentifier("c" + text)) {
      Fail(LineOf(node), fmt::format("{} \"{}\" is no name", what, text),
           "lower-case letters, digits and single _");
    }
    return text;
  }

  double Number(const toml::table& table, std::string_view key, int line) const {
    const toml::node& node = Get(table, key, line);
    const std::optional<double> number = node.value<double>();
    if (!node.is_number() || !number || !std::isfinite(*number)) {
      Fail(LineOf(node), fmt::format("{} is not a finite number", key), fmt::format("{} = 0.5, say", key));
    }
    return *number;
  }

  const toml::array& Array(const toml::node& node, std::string_view what) const {
    const toml::array* array = node.as_array();
    if (!array) Fail(LineOf(node), fmt::format("{} is not an array", what), fmt::format("{} = […]", what));
    return *array;
  }

  // The names under `key`, each one of `known` and none twice; no key: none.
  std::vector<std::string> NameList(const toml::table& root, std::string_view key,
                                    const std::vector<std::string>& known) const {
    std::vector<std::string> names;
    const toml::node* list = root.get(key);
    if (!list) return names;
    for (const toml::node& node : Array(*list, key)) {
      const std::string name = Identifier(node, key);
      if (std::find(known.begin(), known.end(), name) == known.end()) {
        Fail(LineOf(node), fmt::format("unknown name \"{}\" in {}", name, key), ExpectedNames(name, known));
      }
      if (std::find(names.begin(), names.end(), name) != names.end()) {
        Fail(LineOf(node), fmt::format("\"{}\" stands twice in {}", name, key), "each name once");
      }
      names.push_back(name);
    }
    return names;
  }

  std::vector<std::string> NeededList(const toml::table& root, std::string_view key,
                                      const std::vector<std::string>& known) const {
    const toml::node& list = Get(root, key, 1);
    std::vector<std::string> names = NameList(root, key, known);
    if (names.empty()) Fail(LineOf(list), fmt::format("{} is empty", key), ExpectedNames("", known));
    return names;
  }

  void ReadSupport(const toml::table& root, Technique& technique) const {
    const std::vector<std::string> shape_names = ShapeNames(kShapes);
    for (const std::string& name : NeededList(root, "shapes", shape_names)) {
      const auto index = std::find(shape_names.begin(), shape_names.end(), name) - shape_names.begin();
      technique.shapes.push_back(kShapes[static_cast<std::size_t>(index)]);
    }
    const std::vector<std::string> lobes = NeededList(root, "lobes", kLobes);
    technique.diffuse = std::find(lobes.begin(), lobes.end(), "diffuse") != lobes.end();
    technique.specular = std::find(lobes.begin(), lobes.end(), "specular") != lobes.end();
    technique.brdfs = NeededList(root, "brdfs", BrdfNames(kBrdfs));
    if (root.contains("diffuse_brdfs")) technique.diffuse_brdfs = NeededList(root, "diffuse_brdfs", BrdfNames(kDiffuseBrdfs));
    technique.effects = NameList(root, "effects", EffectNames());
    std::vector<std::string> claimable = Laws();
    std::erase_if(claimable, [](const std::string& law) { return std::ranges::count(kHeldLaws, law) > 0; });
    technique.exact = NameList(root, "exact", claimable);
    if (const toml::node* yardstick = root.get("yardstick")) {
      if (!yardstick->is_boolean()) Fail(LineOf(*yardstick), "yardstick is neither true nor false", "one of them");
      technique.yardstick = yardstick->as_boolean()->get();
    }
  }

  // The tables of `[[key]]`.
  std::vector<const toml::table*> Tables(const toml::table& root, std::string_view key) const {
    std::vector<const toml::table*> tables;
    const toml::node* list = root.get(key);
    if (!list) return tables;
    const std::string expected = fmt::format("[[{}]]", key);
    if (!list->is_array()) Fail(LineOf(*list), fmt::format("{} is no array of tables", key), expected);
    for (const toml::node& node : *list->as_array()) {
      if (!node.is_table()) Fail(LineOf(node), fmt::format("{} is no array of tables", key), expected);
      tables.push_back(node.as_table());
    }
    return tables;
  }

  // The `name` of an option or knob, unlike those before it.
  std::string NewName(const toml::table& table, const auto& earlier, std::string_view what) const {
    const toml::node& node = Get(table, "name", LineOf(table));
    std::string name = Identifier(node, "name");
    for (const auto& item : earlier) {
      if (item.name == name)
        Fail(LineOf(node), fmt::format("{} \"{}\" stands twice", what, name), "each name once");
    }
    return name;
  }

  void ReadOption(const toml::table& table, Technique& technique) const {
    CheckKeys(table, {"name", "summary", "choices"});
    Option option;
    option.name = NewName(table, technique.options, "option");
    if (std::find(kReservedOptions.begin(), kReservedOptions.end(), option.name) != kReservedOptions.end()) {
      Fail(LineOf(*table.get("name")), fmt::format("an option cannot be named \"{}\"", option.name),
           "another name");
    }
    option.summary = Line(table, "summary", LineOf(table));
    const toml::node& choices = Get(table, "choices", LineOf(table));
    for (const toml::node& node : Array(choices, "choices"))
      option.choices.push_back(ReadChoice(node, option));
    if (option.choices.size() < 2) {
      Fail(LineOf(choices), fmt::format("option \"{}\" leaves no choice", option.name),
           "two choices or more");
    }
    technique.options.push_back(std::move(option));
  }

  // ["arc", "branchless with the closing arc"], of an option that has its choices so far. A third element
  // names what the choice needs of other options, of the scene's BRDF and of its lights' shapes:
  // { fit = "polygon", brdf = "ggx", shape = "rectangle" }.
  Choice ReadChoice(const toml::node& node, const Option& option) const {
    const toml::array* pair = node.as_array();
    if (!pair || pair->size() < 2 || pair->size() > 3 || (pair->size() == 3 && !(*pair)[2].is_table())) {
      Fail(LineOf(node), "a choice is not a pair",
           "choices = [[\"name\", \"one line\"], …], a third element { option = \"choice\" } where it needs "
           "another");
    }
    Choice choice{ChoiceName((*pair)[0], "choice"), Text((*pair)[1], "the choice's line"), {}};
    if (pair->size() == 3) {
      for (const auto& [key, needed] : *(*pair)[2].as_table())
        choice.needs[std::string(key.str())] = ChoiceName(needed, key.str());
    }
    for (const Choice& earlier : option.choices) {
      if (earlier.name == choice.name) {
        Fail(LineOf(node), fmt::format("choice \"{}\" stands twice", choice.name), "each name once");
      }
    }
    const bool resolved_by_file = !library_.List(option.name).empty();
    const std::string file = fmt::format("{}/{}.glsl", option.name, choice.name);
    if (resolved_by_file && !library_.Find(file)) {
      Fail(LineOf(node), fmt::format("choice \"{}\" has no file {}", choice.name, file),
           fmt::format("a file in glsl/{}/ for each choice", option.name));
    }
    return choice;
  }

  // What a choice needs is another option's choice, and the default needs nothing that is not the default.
  void CheckNeeds(const toml::table& root, const Technique& technique) const {
    const auto tables = Tables(root, "option");
    for (std::size_t i = 0; i < technique.options.size(); ++i) {
      for (const Choice& choice : technique.options[i].choices) {
        const bool is_default = &choice == &technique.options[i].choices.front();
        for (const auto& [name, needed] : choice.needs) {
          const int line = LineOf(*tables[i]->get("choices"));
          if (name == "brdf") {
            CheckNeeded(choice, name, needed, technique.brdfs, line);
            continue;
          }
          if (name == "diffuse") {
            CheckNeeded(choice, name, needed, technique.diffuse_brdfs, line);
            continue;
          }
          if (name == "shape") {
            CheckNeeded(choice, name, needed, ShapeNames(technique.shapes), line);
            continue;
          }
          const Option& other = FindOption(technique, name, line);
          std::vector<std::string> names;
          for (const Choice& known : other.choices) names.push_back(known.name);
          CheckNeeded(choice, name, needed, names, line);
          if (is_default && needed != names.front()) {
            Fail(line, fmt::format("default \"{}\" needs {} \"{}\"", choice.name, name, needed),
                 "what the other options' defaults are");
          }
        }
      }
    }
  }

  void CheckNeeded(const Choice& choice, const std::string& what, const std::string& needed,
                   const std::vector<std::string>& known, int line) const {
    if (std::find(known.begin(), known.end(), needed) != known.end()) return;
    Fail(line, fmt::format("choice \"{}\" needs unknown {} \"{}\"", choice.name, what, needed),
         ExpectedNames(needed, known));
  }

  // No two choices may lead to one define: option "a", choice "b_c" and option "a_b", choice "c".
  void CheckDefines(const toml::table& root, const Technique& technique) const {
    std::set<std::string> defines;
    for (std::size_t i = 0; i < technique.options.size(); ++i) {
      for (const Choice& choice : technique.options[i].choices) {
        const std::string define = Upper(technique.options[i].name + "_" + choice.name);
        if (!defines.insert(define).second) {
          Fail(LineOf((*root.get("option")->as_array())[i]), fmt::format("{} would be defined twice", define),
               "other names of options or choices");
        }
      }
    }
  }

  void ReadDeparture(const toml::table& table, Technique& technique) const {
    const int line = LineOf(table);
    CheckKeys(table, {"law", "lobe", "when", "error", "why"});
    Departure departure;
    departure.law = OneOf(Get(table, "law", line), "law", Laws());
    if (const toml::node* lobe = table.get("lobe")) departure.lobe = OneOf(*lobe, "lobe", kLobes);
    departure.error = Number(table, "error", line);
    if (departure.error <= 0.0) Fail(LineOf(*table.get("error")), "the error is not above 0", "a relative RMSE");
    departure.why = Line(table, "why", line);
    if (const toml::table* when = Section(table, "when")) {
      for (const auto& [key, node] : *when) departure.when[std::string(key.str())] = Covered(key.str(), node, technique);
    }
    technique.departures.push_back(std::move(departure));
  }

  std::string OneOf(const toml::node& node, std::string_view what, const std::vector<std::string>& known) const {
    std::string name = ChoiceName(node, what);
    if (std::ranges::count(known, name) == 0)
      Fail(LineOf(node), fmt::format("unknown {} \"{}\"", what, name), ExpectedNames(name, known));
    return name;
  }

  // "halfway", or ["halfway", "plane"]: of an option, of the technique's shapes or of its BRDFs.
  std::vector<std::string> Covered(std::string_view what, const toml::node& node, const Technique& technique) const {
    std::vector<std::string> known;
    if (what == "shape") {
      known = ShapeNames(technique.shapes);
    } else if (what == "brdf") {
      known = technique.brdfs;
    } else if (what == "diffuse") {
      known = technique.diffuse_brdfs;
    } else {
      for (const Choice& choice : FindOption(technique, what, LineOf(node)).choices) known.push_back(choice.name);
    }
    if (!node.is_array()) return {OneOf(node, what, known)};
    std::vector<std::string> covered;
    for (const toml::node& item : *node.as_array()) covered.push_back(OneOf(item, what, known));
    return covered;
  }

  void ReadKnob(const toml::table& table, Technique& technique) const {
    const int line = LineOf(table);
    CheckKeys(table, {"name", "label", "unit", "initial", "min", "max"});
    Knob knob;
    knob.name = NewName(table, technique.knobs, "knob");
    knob.label = Line(table, "label", line);
    knob.unit = table.contains("unit") ? Text(*table.get("unit"), "unit") : "";
    knob.initial = Number(table, "initial", line);
    knob.min = Number(table, "min", line);
    knob.max = Number(table, "max", line);
    if (!(knob.min < knob.max)) {
      Fail(LineOf(*table.get("max")), fmt::format("max {} is not above min {}", knob.max, knob.min),
           "min < max");
    }
    if (knob.initial < knob.min || knob.initial > knob.max) {
      Fail(LineOf(*table.get("initial")), fmt::format("initial {} is out of range", knob.initial),
           fmt::format("{} to {}", knob.min, knob.max));
    }
    technique.knobs.push_back(std::move(knob));
  }

  const toml::table* Section(const toml::table& root, std::string_view key) const {
    const toml::node* node = root.get(key);
    if (node && !node->is_table()) {
      Fail(LineOf(*node), fmt::format("{} is not a table", key), fmt::format("[{}]", key));
    }
    return node ? node->as_table() : nullptr;
  }

  static std::vector<std::string> OptionNames(const Technique& technique) {
    std::vector<std::string> names;
    for (const Option& option : technique.options) names.push_back(option.name);
    return names;
  }

  const Option& FindOption(const Technique& technique, std::string_view name, int line) const {
    for (const Option& option : technique.options) {
      if (option.name == name) return option;
    }
    Fail(line, fmt::format("unknown option \"{}\"", name), ExpectedNames(name, OptionNames(technique)));
  }

  void ReadTables(const toml::table& root, Technique& technique) const {
    const toml::table* section = Section(root, "tables");
    if (!section) return;
    for (const auto& [key, node] : *section) {
      const int line = LineOf(node);
      if (!IsIdentifier(key.str()))
        Fail(line, fmt::format("table \"{}\" is no name", key.str()), "lower case");
      technique.tables.push_back({std::string(key.str()), Text(node, key.str())});
      CheckPlaceholders(technique.tables.back().file, technique, line);
    }
  }

  // Every "{…}" in a table's file name is an option, or one of the scene's BRDFs.
  void CheckPlaceholders(std::string_view file, const Technique& technique, int line) const {
    if (file.empty() || file.find('/') != std::string_view::npos) {
      Fail(line, fmt::format("\"{}\" is no file in glsl/tables/", file),
           "\"name.exr\" or \"name_{option}.exr\"");
    }
    for (auto open = file.find('{'); open != std::string_view::npos; open = file.find('{', open + 1)) {
      const auto close = file.find('}', open);
      if (close == std::string_view::npos) Fail(line, fmt::format("\"{}\" lacks a }}", file), "{option}");
      const std::string_view name = file.substr(open + 1, close - open - 1);
      if (name != "brdf" && name != "diffuse") FindOption(technique, name, line);
    }
  }

  // Options that [published] leaves out keep their default.
  void ReadForms(const toml::table& root, Technique& technique) const {
    for (const Option& option : technique.options)
      technique.published[option.name] = option.choices.front().name;
    ReadForm(Section(root, "published"), technique, technique.published);
    ReadForm(Section(root, "ideal"), technique, technique.ideal);
  }

  void ReadForm(const toml::table* section, const Technique& technique,
                std::map<std::string, std::string>& form) const {
    if (!section) return;
    for (const auto& [key, node] : *section) {
      const Option& option = FindOption(technique, key.str(), LineOf(key.source()));
      const std::string choice = Text(node, key.str());
      std::vector<std::string> names;
      for (const Choice& known : option.choices) names.push_back(known.name);
      if (std::find(names.begin(), names.end(), choice) == names.end()) {
        Fail(LineOf(node), fmt::format("unknown choice \"{}\" of option {}", choice, option.name),
             ExpectedNames(choice, names));
      }
      form[option.name] = choice;
    }
  }

  const ShaderLibrary& library_;
  std::string path_;
};

}  // namespace

std::vector<std::string> Laws() {
  std::vector<std::string> laws;
  for (const char* lobe : {"lambert", "specular"}) {
    for (const LightShape shape : kShapes) laws.push_back(fmt::format("{}_{}", lobe, Name(shape)));
  }
  laws.insert(laws.end(), {"point_limit", "mirror_limit", "additive"});
  laws.insert(laws.end(), std::begin(kHeldLaws), std::end(kHeldLaws));
  return laws;
}

Technique ReadTechnique(const ShaderLibrary& library, const std::string& name, std::string_view text) {
  return HeaderReader(library, "techniques/" + name + ".glsl").Read(name, text);
}

std::vector<Technique> LoadTechniques(const ShaderLibrary& library) {
  constexpr std::string_view kFolder = "techniques/";
  constexpr std::string_view kSuffix = ".glsl";
  std::vector<Technique> techniques;
  for (const std::string& file : library.List("techniques")) {
    if (!file.ends_with(kSuffix)) continue;
    const std::string name = file.substr(kFolder.size(), file.size() - kFolder.size() - kSuffix.size());
    const std::optional<std::string> text = library.Find(file);
    if (text) techniques.push_back(ReadTechnique(library, name, *text));
  }
  std::sort(techniques.begin(), techniques.end(),
            [](const auto& a, const auto& b) { return a.name < b.name; });
  return techniques;
}

}  // namespace arealab
