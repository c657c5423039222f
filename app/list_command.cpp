#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "glsl/variant.h"
#include "scenes/scene.h"

namespace arealab {
namespace {

using nlohmann::ordered_json;

std::vector<std::string> ShapeNames(const Technique& technique) {
  std::vector<std::string> names;
  for (const LightShape shape : technique.shapes) names.emplace_back(Name(shape));
  return names;
}

ordered_json AsJson(const Technique& technique) {
  ordered_json options = ordered_json::array();
  for (const Option& option : technique.options) {
    ordered_json choices = ordered_json::array();
    for (const Choice& choice : option.choices) choices.push_back({{"name", choice.name}, {"summary", choice.summary}});
    options.push_back({{"name", option.name}, {"summary", option.summary}, {"choices", choices}});
  }
  ordered_json knobs = ordered_json::array();
  for (const Knob& knob : technique.knobs) {
    knobs.push_back({{"name", knob.name},
                     {"label", knob.label},
                     {"unit", knob.unit},
                     {"initial", knob.initial},
                     {"min", knob.min},
                     {"max", knob.max}});
  }
  return {{"name", technique.name},
          {"summary", technique.summary},
          {"citation", technique.citation},
          {"author_note", technique.author_note},
          {"shapes", ShapeNames(technique)},
          {"diffuse", technique.diffuse},
          {"specular", technique.specular},
          {"brdfs", technique.brdfs},
          {"diffuse_brdfs", technique.diffuse_brdfs},
          {"effects", technique.effects},
          {"exact", technique.exact},
          {"options", options},
          {"knobs", knobs},
          {"published", PublishedVariant(technique).Name()}};
}

void PrintText(const Context& context, const std::vector<Technique>& techniques) {
  fmt::print("context     {}: {}, OpenGL {}{}\n\n", context.platform(), context.renderer(), context.version(),
             context.software() ? " (a CPU rasteriser, not a GPU)" : "");
  fmt::print("techniques\n");
  for (const Technique& technique : techniques) {
    fmt::print("  {:<11} {}\n", technique.name, technique.summary);
    fmt::print("  {:<11} lights: {}; lobes: {}\n", "", fmt::join(ShapeNames(technique), ", "),
               technique.diffuse && technique.specular ? "diffuse, specular"
               : technique.diffuse                     ? "diffuse"
                                                       : "specular");
    for (const Option& option : technique.options) {
      for (std::size_t i = 0; i < option.choices.size(); ++i) {
        fmt::print("  {:<11} +{}={}{}  {}\n", "", option.name, option.choices[i].name, i == 0 ? " (default)" : "",
                   option.choices[i].summary);
      }
    }
    const std::string published = PublishedVariant(technique).Name();
    if (published != technique.name) fmt::print("  {:<11} {}@published = {}\n", "", technique.name, published);
  }
  fmt::print("\nscenes\n");
  for (const auto& file : BuiltInScenes()) fmt::print("  {:<11} {}\n", file.stem().string(), ReadQuestion(file));
}

void PrintJson(const Context& context, const std::vector<Technique>& techniques) {
  ordered_json json;
  json["context"] = {{"platform", context.platform()},
                     {"renderer", context.renderer()},
                     {"version", context.version()},
                     {"software", context.software()}};
  json["techniques"] = ordered_json::array();
  for (const Technique& technique : techniques) json["techniques"].push_back(AsJson(technique));
  json["scenes"] = ordered_json::array();
  for (const auto& file : BuiltInScenes()) {
    json["scenes"].push_back({{"name", file.stem().string()}, {"question", ReadQuestion(file)}});
  }
  fmt::print("{}\n", json.dump(2));
}

}  // namespace

void AddList(CLI::App& app, int& /*status*/) {
  auto common = std::make_shared<CommonOptions>();
  auto as_json = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("list", "The context, the techniques with what each supports, the scenes");
  command->add_flag("--json", *as_json, "as JSON");
  common->AddContext(*command);
  common->AddGlsl(*command);
  command->callback([common, as_json] {
    const std::vector<Technique> techniques = LoadTechniques(common->Library());
    const std::unique_ptr<Context> context = common->MakeContext();
    *as_json ? PrintJson(*context, techniques) : PrintText(*context, techniques);
  });
}

}  // namespace arealab
