#include "glsl/variant.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>

#include "glsl/effects.h"
#include "glsl/nearest.h"
#include "scenes/error.h"

namespace arealab {

namespace {

constexpr std::string_view kPublished = "published";
constexpr std::string_view kEffectPrefix = "effect_";
constexpr std::pair<std::string_view, PerPixel> kPerPixel[] = {{"no", PerPixel::kNo}, {"branch", PerPixel::kBranch}, {"tiles", PerPixel::kTiles}};

std::vector<std::string> Names(const auto& items) {
  std::vector<std::string> names;
  for (const auto& item : items) names.push_back(item.name);
  return names;
}

template <typename Item>
const Item* FindByName(const std::vector<Item>& items, std::string_view name) {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const Item& item) { return item.name == name; });
  return found == items.end() ? nullptr : &*found;
}

// `text` up to the first of `stops`, which stays at the head of what is left.
std::string_view TakeUntil(std::string_view& text, std::string_view stops) {
  const std::string_view head = text.substr(0, text.find_first_of(stops));
  text.remove_prefix(head.size());
  return head;
}

// Applies one "effect_horizon=1".
void ForceEffect(const std::string& effect, const std::string& choice, std::string_view whole, Variant& variant) {
  const std::vector<std::string> known = EffectNames();
  if (std::find(known.begin(), known.end(), effect) == known.end()) {
    throw InputError(fmt::format("variant \"{}\": unknown effect \"{}\"; expected {}", whole, effect, ExpectedNames(effect, known)));
  }
  if (choice != "0" && choice != "1") {
    throw InputError(fmt::format("variant \"{}\": {}{}={}; expected 0 or 1", whole, kEffectPrefix, effect, choice));
  }
  variant.effects[effect] = choice == "1";
}

// Applies one "clip=switch".
void ParseAssignment(std::string_view assignment, std::string_view whole, Variant& variant,
                     std::map<std::string, std::string>& given) {
  const Technique& technique = *variant.technique;
  const auto equals = assignment.find('=');
  if (equals == std::string_view::npos) {
    throw InputError(
        fmt::format("variant \"{}\": \"+{}\" chooses nothing; expected +OPTION=CHOICE", whole, assignment));
  }
  const std::string name(assignment.substr(0, equals));
  const std::string choice(assignment.substr(equals + 1));
  if (name == "effects") {
    if (choice != "all") throw InputError(fmt::format("variant \"{}\": effects={}; expected effects=all", whole, choice));
    variant = WithAllEffects(std::move(variant));
    return;
  }
  if (name == "per_pixel") {
    const auto found = std::ranges::find(kPerPixel, choice, [](const auto& way) { return way.first; });
    if (found == std::end(kPerPixel)) throw InputError(fmt::format("variant \"{}\": per_pixel={}; expected no, branch or tiles", whole, choice));
    variant.per_pixel = found->second;
    return;
  }
  if (name.starts_with(kEffectPrefix)) {
    ForceEffect(name.substr(kEffectPrefix.size()), choice, whole, variant);
    return;
  }
  const Option* option = FindByName(technique.options, name);
  if (!option && technique.options.empty()) {
    throw InputError(fmt::format("variant \"{}\": unknown option \"{}\"; expected none, {} has no options",
                                 whole, name, technique.name));
  }
  if (!option) {
    throw InputError(fmt::format("variant \"{}\": unknown option \"{}\"; expected {}", whole, name,
                                 ExpectedNames(name, Names(technique.options))));
  }
  if (!FindByName(option->choices, choice)) {
    throw InputError(fmt::format("variant \"{}\": unknown choice \"{}\" of option {}; expected {}", whole,
                                 choice, name, ExpectedNames(choice, Names(option->choices))));
  }
  if (!given.emplace(name, choice).second) {
    throw InputError(fmt::format("variant \"{}\": option {} is given twice; expected once", whole, name));
  }
  variant.options[name] = choice;
}

const char* PluralName(LightShape shape) {
  switch (shape) {
    case LightShape::kRectangle:
      return "rectangles";
    case LightShape::kDisk:
      return "disks";
    case LightShape::kSphere:
      return "spheres";
    case LightShape::kPolygon:
      return "polygons";
    case LightShape::kEllipse:
      return "ellipses";
    case LightShape::kTube:
      return "tubes";
  }
  return "";
}

// "rectangles", "rectangles and disks", "rectangles, disks and spheres".
std::string ShapeList(const std::vector<LightShape>& shapes) {
  std::string list;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    list += i == 0 ? "" : i + 1 == shapes.size() ? " and " : ", ";
    list += PluralName(shapes[i]);
  }
  return list;
}

// What the variant's choices need of a scene under `key`: "horizon=true" → "rectangle".
std::vector<std::pair<std::string, std::string>> NeedsOf(const Variant& variant, const std::string& key) {
  std::vector<std::pair<std::string, std::string>> needs;
  for (const Option& option : variant.technique->options) {
    const Choice* choice = FindByName(option.choices, variant.options.at(option.name));
    if (const auto needed = choice->needs.find(key); needed != choice->needs.end()) {
      needs.emplace_back(option.name + "=" + choice->name, needed->second);
    }
  }
  return needs;
}

// What a scene may call for of a technique beside shapes and lobes, and how to say that it lacks it. (The loop over many
// lights is the lighting pass's own.)
struct Need {
  const char* effect;
  const char* what;
};
constexpr Need kNeeds[] = {
    {"two_sided", "two-sided lights; the scene has one"},
    {"fresnel", "a Fresnel term; the scene's materials reflect less than all light"},
    {"textured", "textured lights; the scene has one"},
};

// The only BRDF of which the reflection of a whole sky is known to the shading text: glsl/specular_albedo.glsl.
constexpr Brdf kSkyBrdf = Brdf::kGgx;

}  // namespace

std::string Variant::Name() const {
  std::string name = technique->name;
  for (const Option& option : technique->options) {
    const std::string& choice = options.at(option.name);
    if (choice != option.choices.front().name) name += fmt::format("+{}={}", option.name, choice);
  }
  if (!effects.empty() && effects == WithAllEffects(*this).effects) {
    name += "+effects=all";
  } else {
    for (const auto& [effect, on] : effects) name += fmt::format("+{}{}={}", kEffectPrefix, effect, on ? 1 : 0);
  }
  if (per_pixel != PerPixel::kNo) name += fmt::format("+per_pixel={}", std::ranges::find(kPerPixel, per_pixel, [](const auto& way) { return way.second; })->first);
  return name;
}

std::string Variant::ShortName() const {
  if (*this == PublishedVariant(*technique) && *this != DefaultVariant(*technique)) {
    return fmt::format("{}@{}", technique->name, kPublished);
  }
  return Name();
}

bool Variant::operator==(const Variant& other) const {
  return technique->name == other.technique->name && options == other.options && effects == other.effects && per_pixel == other.per_pixel;
}

Variant DefaultVariant(const Technique& technique) {
  Variant variant{&technique, {}};
  for (const Option& option : technique.options) variant.options[option.name] = option.choices.front().name;
  return variant;
}

Variant WithAllEffects(Variant variant) {
  const Technique& technique = *variant.technique;
  for (const std::string& effect : EffectNames()) variant.effects[effect] = true;
  variant.effects.erase("aperture");
  variant.effects.erase("textured");
  variant.effects.erase("sky");
  variant.effects.erase("sky_texture");
  for (const LightShape shape : kLightShapes) {
    if (std::ranges::find(technique.shapes, shape) == technique.shapes.end()) variant.effects.erase(Name(shape));
  }
  for (const Need& need : kNeeds) {
    if (std::ranges::find(technique.effects, need.effect) == technique.effects.end()) variant.effects.erase(need.effect);
  }
  return variant;
}

Variant PublishedVariant(const Technique& technique) {
  Variant variant = DefaultVariant(technique);
  for (const auto& [option, choice] : technique.published) variant.options[option] = choice;
  return variant;
}

Variant IdealVariant(const Variant& variant, Brdfs brdfs) {
  const auto goes_with = [](const Variant& changed, const char* kind, Brdf brdf) {
    return std::ranges::all_of(NeedsOf(changed, kind), [&](const auto& need) { return need.second == Name(brdf); });
  };
  Variant ideal = variant;
  for (const auto& [option, choice] : variant.technique->ideal) {
    Variant changed = ideal;
    changed.options[option] = choice;
    if (!WhyInconsistent(changed) && goes_with(changed, "brdf", brdfs.specular) && goes_with(changed, "diffuse", brdfs.diffuse)) ideal = std::move(changed);
  }
  return ideal;
}

Variant ParseVariant(const std::vector<Technique>& techniques, std::string_view name) {
  std::string_view rest = name;
  const std::string technique_name(TakeUntil(rest, "@+"));
  const Technique* technique = FindByName(techniques, technique_name);
  if (!technique) {
    throw InputError(fmt::format("variant \"{}\": unknown technique \"{}\"; expected {}", name,
                                 technique_name, ExpectedNames(technique_name, Names(techniques))));
  }
  Variant variant = DefaultVariant(*technique);
  if (rest.starts_with('@')) {
    rest.remove_prefix(1);
    const std::string_view form = TakeUntil(rest, "@+");
    if (form != kPublished) {
      throw InputError(
          fmt::format("variant \"{}\": unknown form \"@{}\"; expected @{}", name, form, kPublished));
    }
    variant = PublishedVariant(*technique);
  }
  std::map<std::string, std::string> given;
  while (rest.starts_with('+')) {
    rest.remove_prefix(1);
    ParseAssignment(TakeUntil(rest, "@+"), name, variant, given);
  }
  if (!rest.empty()) {
    throw InputError(
        fmt::format("variant \"{}\": \"{}\" is out of place; expected TECHNIQUE[@{}][+OPTION=CHOICE]…", name,
                    rest, kPublished));
  }
  if (const std::optional<std::string> why = WhyInconsistent(variant))
    throw InputError(fmt::format("variant \"{}\": {}", name, *why));
  return variant;
}

std::vector<Variant> DefaultVariants(const std::vector<Technique>& techniques) {
  std::vector<Variant> variants;
  for (const Technique& technique : techniques) {
    variants.push_back(DefaultVariant(technique));
    if (Variant published = PublishedVariant(technique); published != variants.back()) {
      variants.push_back(std::move(published));
    }
  }
  return variants;
}

std::vector<Variant> AllVariants(const std::vector<Technique>& techniques) {
  std::vector<Variant> variants;
  const auto add = [&](Variant variant) {
    if (WhyInconsistent(variant)) return;
    if (std::find(variants.begin(), variants.end(), variant) == variants.end())
      variants.push_back(std::move(variant));
  };
  for (const Variant& base : DefaultVariants(techniques)) {
    add(base);
    for (const Option& option : base.technique->options) {
      for (const Choice& choice : option.choices) {
        Variant changed = base;
        changed.options[option.name] = choice.name;
        add(std::move(changed));
      }
    }
  }
  return variants;
}

std::string TableFile(const Variant& variant, const Table& table, Brdfs brdfs) {
  std::string file = "tables/" + table.file;
  std::map<std::string, std::string> chosen = variant.options;
  chosen["brdf"] = Name(brdfs.specular);
  chosen["diffuse"] = Name(brdfs.diffuse);
  for (const auto& [option, choice] : chosen) {
    const std::string placeholder = "{" + option + "}";
    for (auto at = file.find(placeholder); at != std::string::npos; at = file.find(placeholder)) {
      file.replace(at, placeholder.size(), choice);
    }
  }
  return file;
}

std::vector<Table> TablesOf(const Variant& variant, Brdfs brdfs) {
  std::vector<Table> tables = variant.technique->tables;
  if (brdfs.diffuse == Brdf::kLambert) std::erase_if(tables, [](const Table& table) { return table.file.find("{diffuse}") != std::string::npos; });
  return tables;
}

std::optional<std::string> WhyInconsistent(const Variant& variant) {
  for (const Option& option : variant.technique->options) {
    const Choice* choice = FindByName(option.choices, variant.options.at(option.name));
    for (const auto& [other, needed] : choice->needs) {
      if (other == "brdf" || other == "diffuse" || other == "shape") continue;  // a scene's matter
      if (const std::string& chosen = variant.options.at(other); chosen != needed) {
        return fmt::format("{}={} does not go with {}={}; expected +{}={}", option.name, choice->name, other,
                           chosen, other, needed);
      }
    }
  }
  return std::nullopt;
}

namespace {

std::optional<std::string> WhyUnsupported(const Variant& variant, const Scene& scene,
                                          const std::function<bool(const char*)>& calls_for) {
  const std::string brdf = Name(scene.brdf);
  const auto lacks = [&](const char* kind, const char* called, const std::string& name, const std::vector<std::string>& known) -> std::optional<std::string> {
    if (std::ranges::find(known, name) == known.end()) {
      return fmt::format("{} does not know the {} {}, which is the scene's; it knows {}", variant.technique->name, called, name, fmt::join(known, ", "));
    }
    for (const auto& [choice, needed] : NeedsOf(variant, kind)) {
      if (needed != name) return fmt::format("{} with {} goes with the {} {} alone; the scene's is {}", variant.technique->name, choice, called, needed, name);
    }
    return std::nullopt;
  };
  if (const auto why = lacks("brdf", "BRDF", brdf, variant.technique->brdfs)) return why;
  if (const auto why = lacks("diffuse", "diffuse BRDF", Name(scene.diffuse), variant.technique->diffuse_brdfs)) return why;
  if (const auto why = WhyNotDiffuse(scene)) return why;
  const std::vector<LightShape>& shapes = variant.technique->shapes;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (std::find(shapes.begin(), shapes.end(), light.shape) != shapes.end()) continue;
    const std::string who =
        light.name.empty() ? fmt::format("light {}", i + 1) : fmt::format("light \"{}\"", light.name);
    return fmt::format("{} shades {}; {} is {} {}", variant.technique->name, ShapeList(shapes), who,
                       light.shape == LightShape::kEllipse ? "an" : "a", Name(light.shape));
  }
  for (const auto& [choice, needed] : NeedsOf(variant, "shape")) {
    for (const Light& light : scene.lights) {
      if (needed == Name(light.shape)) continue;
      return fmt::format("{} with {} goes with {}s alone; the scene has a {}", variant.technique->name, choice, needed,
                         Name(light.shape));
    }
  }
  const Technique& technique = *variant.technique;
  if (scene.brdf != kSkyBrdf && calls_for("sky") && calls_for("specular")) {
    return fmt::format("{} reflects a sky by the BRDF {} alone; the scene's is {}", technique.name, Name(kSkyBrdf), brdf);
  }
  const auto takes = [&](const char* effect) { return std::ranges::find(technique.effects, effect) != technique.effects.end(); };
  if (takes("sky") && !takes("sky_texture") && calls_for("sky_texture")) {
    return fmt::format("{} fills from a sky that is the same everywhere; the scene's shows a texture", technique.name);
  }
  for (const Need& need : kNeeds) {
    if (takes(need.effect)) continue;
    const auto forced = variant.effects.find(need.effect);
    if ((forced != variant.effects.end() && forced->second) || calls_for(need.effect)) {
      return fmt::format("{} does not take {}", technique.name, need.what);
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> WhyUnsupported(const Variant& variant, const Scene& scene) {
  return WhyUnsupported(variant, scene, [&](const char* effect) { return SceneEffect(scene, effect).on; });
}

std::optional<std::string> WhyUnsupported(const Variant& variant, const Scene& scene, const std::vector<Effect>& effects) {
  return WhyUnsupported(variant, scene, [&](const char* effect) { return std::ranges::find(effects, effect, &Effect::name)->on; });
}

}  // namespace arealab
