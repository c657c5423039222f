#include "app/view/panels.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "app/view/widgets.h"
#include "compare/cost.h"
#include "glsl/effects.h"
#include "glsl/variant.h"

namespace arealab {
namespace {

using namespace widgets;

const char* const kPaneLetters[] = {"A", "B", "C", "D"};
const char* const kTransforms[] = {"sRGB", "ACES", "Neutral", "AgX"};

constexpr const char* kTruthIs = "The light's own integrals in double, refined while nothing moves; until then the technique `reference` stands in. It says how far it "
                                 "is, and its own error at 99.9 % of the pixels. With shadows where the scene has apertures.";

std::string Radiance(glm::dvec3 v) { return fmt::format("{:.4g}  {:.4g}  {:.4g}", v.x, v.y, v.z); }

const char* RadianceUnit(const Scene& scene) { return scene.units == Units::kPhotometric ? "cd/m²" : "W/(m² sr)"; }
const char* FluxUnit(const Scene& scene) { return scene.units == Units::kPhotometric ? "lm" : "W"; }

// ------------------------------------------------------------------------------------------------ choosing variants

const Technique* TechniqueOf(const ViewState& state, const std::string& variant) {
  if (!state.techniques) return nullptr;
  const std::string name = variant.substr(0, variant.find_first_of("+@"));
  const auto found = std::find_if(state.techniques->begin(), state.techniques->end(),
                                  [&](const Technique& technique) { return technique.name == name; });
  return found == state.techniques->end() ? nullptr : &*found;
}

// Every technique's default and published form, those that cannot shade the scene greyed with the reason.
void VariantCombo(PanelContext& context, int pane, float width) {
  ShownVariant& shown = context.session.panes[static_cast<std::size_t>(pane)];
  ImGui::SetNextItemWidth(width);
  const Snapshot* snapshot = context.session.SnapshotOf(shown);
  const std::string label = snapshot != nullptr ? snapshot->label : shown.name;
  if (ImGui::BeginCombo(fmt::format("##pane{}", pane).c_str(), label.c_str(), ImGuiComboFlags_HeightLargest)) {
    for (const Snapshot& kept : context.session.snapshots) {
      if (ImGui::Selectable(kept.label.c_str(), kept.name == shown.name)) shown = {kept.name, {}};
      Tip("A picture kept earlier (K).");
    }
    if (ImGui::Selectable(kTruth, shown.name == kTruth)) shown = {kTruth, {}};
    Tip(kTruthIs);
    if (context.state.techniques) {
      for (const Variant& variant : DefaultVariants(*context.state.techniques)) {
        const std::string name = variant.ShortName();
        const auto why = WhyUnsupported(variant, context.session.scene);
        if (ImGui::Selectable(name.c_str(), name == shown.name, why ? ImGuiSelectableFlags_Disabled : 0)) shown = {name, {}};
        if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) {
          Tooltip(why ? *why : variant.technique->summary + ". " + variant.technique->citation);
        }
      }
    }
    ImGui::EndCombo();
  }
  if (const Technique* technique = TechniqueOf(context.state, shown.name)) {
    Tip(fmt::format("Pane {}: {}", kPaneLetters[pane], technique->summary));
  }
}

std::string Shortened(std::string text, float width) {
  if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
  while (text.size() > 1 && ImGui::CalcTextSize((text + "…").c_str()).x > width) text.pop_back();
  return text + "…";
}

std::string CanonicalName(const std::vector<Technique>& techniques, const std::string& shown) {
  try {
    return ParseVariant(techniques, shown).Name();
  } catch (const std::exception&) {
    return shown;  // its file has changed
  }
}

// Time for this view, cycles, and how the time went as the view changed.
void VariantCost(const PanelContext& context, int pane) {
  const std::string& shown = context.session.panes[static_cast<std::size_t>(pane)].name;
  if (TechniqueOf(context.state, shown) == nullptr) return;
  const std::string name = CanonicalName(*context.state.techniques, shown);
  ImGui::PushID(pane);
  ImGui::Dummy({1.0f, 0.2f * context.unit});
  Dim(fmt::format("{}   {}", kPaneLetters[pane], shown));
  const auto cost = context.state.costs.find(name);
  if (cost != context.state.costs.end()) {
    Row("Time", "ms", "");
    ImGui::Text("%.3g", cost->second.milliseconds);
    Tip(fmt::format("Of the lighting pass for this view: {:.3g} ns a lit pixel, {:.3g} less a pass that only reads and writes.",
                    cost->second.ns_per_pixel, cost->second.net_ns_per_pixel));
    ImGui::SameLine();
    Dim(fmt::format("{:.2f} × point", cost->second.ratio_to_point));
    Tip("Against the technique `point`, in turns on one clock.");
  }
  const auto cycles = context.cycles.variants.find(shown);
  if (cycles != context.cycles.variants.end()) {
    Row("Cycles", "", "");
    ImGui::Text("%d", cycles->second);
    Tip(fmt::format("On {}, per wave of 64 pixels of the lighting pass with this scene's effects: estimated by its compiler, not measured.", context.cycles.gpu));
    ImGui::SameLine();
    Dim(context.cycles.gpu);
  }
  const auto history = context.history.find(name);
  if (history != context.history.end() && history->second.size() > 1) {
    const std::vector<float>& values = history->second;
    const float most = 1.1f * *std::ranges::max_element(values);
    Row("History", "ns/px", "");
    ImGui::PlotLines("##history", values.data(), static_cast<int>(values.size()), 0, nullptr, 0.0f, most, {0.0f, 2.4f * context.unit});
    Tip(fmt::format("The last {} measurements, the newest at the right, from 0 to {:.3g} ns a lit pixel.", values.size(), most));
  }
  ImGui::PopID();
}

// The options as menus, the knobs as sliders: what the technique's header declares.
void VariantControls(PanelContext& context, int pane) {
  ShownVariant& shown = context.session.panes[static_cast<std::size_t>(pane)];
  const Technique* technique = TechniqueOf(context.state, shown.name);
  if (const Snapshot* snapshot = context.session.SnapshotOf(shown)) {
    Heading(fmt::format("{}   {}", kPaneLetters[pane], snapshot->label));
    Note("A picture kept earlier: it does not change.");
    return;
  }
  Heading(fmt::format("{}   {}", kPaneLetters[pane], shown.name));
  if (shown.name == kTruth) return Note(kTruthIs);
  if (technique == nullptr) {
    Note("Not in the registry: its file has gone or its header is wrong.");
    return;
  }
  ImGui::PushID(pane);
  Variant variant;
  try {
    variant = ParseVariant(*context.state.techniques, shown.name);
  } catch (const std::exception& error) {
    Note(error.what());
    ImGui::PopID();
    return;
  }
  for (const Option& option : technique->options) {
    std::string& chosen = variant.options[option.name];
    Row(option.name, "", option.summary);
    if (ImGui::BeginCombo(("##" + option.name).c_str(), chosen.c_str())) {
      for (const Choice& choice : option.choices) {
        if (ImGui::Selectable(choice.name.c_str(), choice.name == chosen)) {
          chosen = choice.name;
          shown.name = variant.ShortName();
        }
        Tip(choice.summary);
      }
      ImGui::EndCombo();
    }
    Tip(option.summary);
  }
  for (const Knob& knob : technique->knobs) {
    const auto set = shown.knobs.find(knob.name);
    auto value = static_cast<float>(set == shown.knobs.end() ? knob.initial : set->second);
    Row(knob.label, knob.unit, "");
    if (ImGui::SliderFloat(("##" + knob.name).c_str(), &value, static_cast<float>(knob.min), static_cast<float>(knob.max),
                           "%.4g")) {
      shown.knobs[knob.name] = value;
    }
    Tip(fmt::format("{}, {:g} to {:g}{}{}; {:g} unless turned", knob.label, knob.min, knob.max, knob.unit.empty() ? "" : " ",
                    knob.unit, knob.initial));
  }
  if (technique->options.empty() && technique->knobs.empty()) Note("Neither options nor knobs.");
  ImGui::PopID();
}

// ------------------------------------------------------------------------------------------------ lights, materials

bool Vector(const char* id, glm::dvec3& value, float speed) {
  return ImGui::DragScalarN(id, ImGuiDataType_Double, &value.x, 3, speed, nullptr, nullptr, "%.4g");
}

bool Scalar(const char* id, double& value, float speed, double low, double high, const char* format = "%.5g") {
  if (!ImGui::DragScalar(id, ImGuiDataType_Double, &value, speed, &low, &high, format)) return false;
  value = std::clamp(value, low, high);
  return true;
}

// Of the black body whose colour is nearest, to 25 K.
float NearestKelvin(const glm::dvec3& radiance) {
  const glm::dvec3 hue = radiance / Luminance(radiance);
  float nearest = 1700.0f;
  for (float kelvin = 1700.0f; kelvin <= 12000.0f; kelvin += 25.0f) {
    if (glm::distance(PlanckianColor(kelvin), hue) < glm::distance(PlanckianColor(nearest), hue)) nearest = kelvin;
  }
  return nearest;
}

// The light's own axes turned so that its normal is `normal`, its x axis level where that can be.
void Aim(Light& light, const glm::dvec3& normal) {
  light.normal = glm::normalize(normal);
  glm::dvec3 up(0.0, 0.0, 1.0);
  if (glm::length(glm::cross(up, light.normal)) < 1e-6) up = {0.0, 1.0, 0.0};
  light.axis_x = glm::normalize(glm::cross(up, light.normal));
  light.axis_y = glm::cross(light.normal, light.axis_x);
}

// Another shape of about the same size.
void Reshape(Light& light, LightShape shape) {
  light.shape = shape;
  light.corners.clear();
  if (shape != LightShape::kRectangle) light.texture.reset(), light.texture_path.clear();
  if (shape == LightShape::kDisk || shape == LightShape::kSphere) {
    light.half_size = glm::dvec2(std::sqrt(light.half_size.x * light.half_size.y));
  }
  if (!IsFlat(shape)) light.two_sided = false;
  if (shape == LightShape::kTube) light.half_size.y = std::min(light.half_size.y, 0.1 * light.half_size.x);
  if (shape == LightShape::kPolygon) {  // a hexagon
    std::vector<glm::dvec2> corners;
    for (int i = 0; i < 6; ++i) {
      const double angle = i * glm::pi<double>() / 3.0;
      corners.push_back(light.half_size * glm::dvec2(std::cos(angle), std::sin(angle)));
    }
    SetCorners(light, corners);
  }
}

void LightControls(Session& session) {
  Light& light = session.scene.lights[static_cast<std::size_t>(session.light)];
  const LightShape was = light.shape;
  Row("Shape", "", "");
  if (ImGui::BeginCombo("##shape", Name(was))) {
    for (const LightShape shape : kLightShapes) {
      if (ImGui::Selectable(Name(shape), shape == was) && shape != was) Reshape(light, shape);
    }
    ImGui::EndCombo();
  }
  Tip("The light's shape. Its radiance stays when this changes.");
  Row("Position", "m", "");
  Vector("##position", light.center, 0.01f);
  Tip("Centre, metres: x right, y away, z up. Double-click to type.");
  if (IsFlat(light.shape)) {
    glm::dvec3 normal = light.normal;
    Row("Facing", "", "");
    if (Vector("##normal", normal, 0.01f) && glm::length(normal) > 1e-9) Aim(light, normal);
    Tip("The direction of the lit side, a unit vector. R turns the light in the picture.");
  }
  if (light.shape == LightShape::kRectangle) {
    glm::dvec2 size = 2.0 * light.half_size;
    const double low = 1e-3, high = 1e5;
    Row("Size", "m", "");
    if (ImGui::DragScalarN("##size", ImGuiDataType_Double, &size.x, 2, 0.01f, &low, &high, "%.4g")) {
      light.half_size = glm::clamp(0.5 * size, 0.5 * low, 0.5 * high);
    }
    Tip("Width and height, metres.");
  } else if (light.shape == LightShape::kEllipse) {
    const double low = 1e-3, high = 1e5;
    Row("Half axes", "m", "");
    if (ImGui::DragScalarN("##radii", ImGuiDataType_Double, &light.half_size.x, 2, 0.005f, &low, &high, "%.4g")) {
      light.half_size = glm::clamp(light.half_size, low, high);
    }
    Tip("Metres, along the light's own two axes.");
  } else if (light.shape == LightShape::kTube) {
    glm::dvec3 axis = light.axis_x;
    Row("Axis", "", "");
    if (Vector("##axis", axis, 0.01f) && glm::length(axis) > 1e-9) LayAlong(light, axis);
    Tip("Where the tube runs, a unit vector. R turns the light in the picture.");
    double length = 2.0 * light.half_size.x;
    Row("Length", "m", "");
    if (Scalar("##length", length, 0.01f, 1e-3, 1e5)) light.half_size.x = 0.5 * length;
    Tip("Metres. The ends are open: only the wall's outside is lit.");
    Row("Radius", "m", "");
    Scalar("##radius", light.half_size.y, 0.005f, 1e-3, 1e5);
    Tip("Metres.");
  } else if (light.shape == LightShape::kPolygon) {
    glm::dvec2 reach = light.half_size;
    const double low = 1e-3, high = 1e5;
    Row("Reach", "m", "");
    if (ImGui::DragScalarN("##reach", ImGuiDataType_Double, &reach.x, 2, 0.005f, &low, &high, "%.4g")) {
      const glm::dvec2 scale = glm::clamp(reach, low, high) / light.half_size;
      for (glm::dvec2& corner : light.corners) corner *= scale;
      light.half_size *= scale;
    }
    Tip(fmt::format("How far the {} corners reach from their centroid along the light's own two axes, metres. The file says where each lies.",
                    light.corners.size()));
  } else {
    Row("Radius", "m", "");
    if (Scalar("##radius", light.half_size.x, 0.005f, 1e-3, 1e5)) light.half_size.y = light.half_size.x;
    Tip("Metres.");
  }
  const double luminance = std::max(Luminance(light.radiance), 1e-12);
  double radiance = luminance, flux = light.Flux();
  Row(session.scene.units == Units::kPhotometric ? "Luminance" : "Radiance", RadianceUnit(session.scene), "");
  if (Scalar("##radiance", radiance, static_cast<float>(0.01 * luminance), 1e-6, 1e12)) light.radiance *= radiance / luminance;
  Tip(fmt::format("{}: how bright the surface is, the same from every side.", RadianceUnit(session.scene)));
  Row(session.scene.units == Units::kPhotometric ? "Luminous flux" : "Flux", FluxUnit(session.scene), "");
  if (Scalar("##flux", flux, static_cast<float>(0.01 * flux), 1e-9, 1e30)) light.radiance *= flux / light.Flux();
  Tip(fmt::format("{}: all that it emits, π · area · radiance.", FluxUnit(session.scene)));
  const double peak = std::max({light.radiance.x, light.radiance.y, light.radiance.z});
  const double before = Luminance(light.radiance);
  glm::vec3 hue(light.radiance / peak);
  const auto recolor = [&](const glm::dvec3& color) {
    if (Luminance(color) > 1e-6) light.radiance = color * (before / Luminance(color));
  };
  Row("Colour", "linear", "");
  if (ImGui::ColorEdit3("##color", &hue.x, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_NoInputs)) recolor(glm::dvec3(hue));
  Tip("Hue, linear sRGB; the luminance stays.");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1.0f);
  float kelvin = NearestKelvin(light.radiance);
  if (ImGui::SliderFloat("##kelvin", &kelvin, 1700.0f, 12000.0f, "%.0f K")) recolor(PlanckianColor(kelvin));
  Tip("Colour temperature of a black body, kelvin, that comes nearest to the colour: 2700 a bulb, 6500 daylight. Turning it sets the colour.");
  if (light.shape == LightShape::kRectangle) {
    Row("Image", "", "");
    if (light.texture) {
      if (ImGui::Button("×")) light.texture.reset(), light.texture_path.clear();
      Tip("Takes the image away.");
      ImGui::SameLine();
      ImGui::TextUnformatted(light.texture_path.c_str());
    } else {
      Dim("drop one on the light");
    }
    Tip("Each texel × the radiance. The image lies in the scene file's folder.");
  }
  if (IsFlat(light.shape)) {
    Row("Two-sided", "", "");
    ImGui::Checkbox("##two_sided", &light.two_sided);
    Tip("Lights both sides.");
  }
}

// What fills the scene from every direction.
void SkyControls(Session& session) {
  Scene& scene = session.scene;
  Heading("Sky");
  bool on = scene.sky.has_value();
  Row("Fill", "", "");
  if (ImGui::Checkbox("##sky", &on)) {
    double brightest = 0.0;  // a hundredth of the brightest light to begin with
    for (const Light& light : scene.lights) brightest = std::max(brightest, Luminance(light.radiance));
    scene.sky = on ? std::optional<Sky>(glm::dvec3(0.01 * brightest)) : std::nullopt;
  }
  Tip("Light from every direction. Drop an image of a whole sky (latitude and longitude) on the background: it shows it.");
  if (!scene.sky) return;
  glm::dvec3& sky = scene.sky->radiance;
  const double luminance = std::max(Luminance(sky), 1e-12);
  double radiance = luminance;
  const char* where = scene.sky->texture ? "what a white texel sends" : "the same from every direction";
  Row(scene.units == Units::kPhotometric ? "Luminance" : "Radiance", RadianceUnit(scene), "");
  if (Scalar("##sky_radiance", radiance, static_cast<float>(0.01 * luminance), 1e-9, 1e12)) sky *= radiance / luminance;
  Tip(fmt::format("{}, {}.", RadianceUnit(scene), where));
  glm::vec3 hue(sky / std::max({sky.x, sky.y, sky.z}));
  Row("Colour", "linear", "");
  if (ImGui::ColorEdit3("##sky_color", &hue.x, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_NoInputs) && Luminance(hue) > 1e-6) {
    sky = glm::dvec3(hue) * (luminance / Luminance(hue));
  }
  Tip("Hue, linear sRGB; the luminance stays.");
  if (!scene.sky->texture) return;
  float degrees = static_cast<float>(glm::degrees(scene.sky->turn));
  Row("Rotation", "°", "");
  if (ImGui::SliderFloat("##sky_turn", &degrees, -180.0f, 180.0f, "%.1f")) scene.sky->turn = glm::radians(static_cast<double>(degrees));
  Tip("Of the sky's image about z, counter-clockwise seen from above; Ctrl + click to type.");
  Row("Image", "", "");
  if (ImGui::Button("Even again", {-1.0f, 0.0f})) {
    scene.sky->texture = nullptr;
    scene.sky->texture_path.clear();
    scene.sky->turn = 0.0;
  }
  Tip(fmt::format("The sky shows {}; click for the same radiance from every direction.", scene.sky->texture_path));
}

void LightsTab(PanelContext& context) {
  Session& session = context.session;
  auto& lights = session.scene.lights;
  const float rows = std::clamp(static_cast<float>(lights.size()), 2.0f, 6.0f);
  if (ImGui::BeginListBox("##lights", {-1.0f, (rows + 0.4f) * ImGui::GetTextLineHeightWithSpacing()})) {
    for (std::size_t i = 0; i < lights.size(); ++i) {
      ImGui::PushID(static_cast<int>(i));
      if (ImGui::Selectable(lights[i].name.c_str(), static_cast<int>(i) == session.light)) session.light = static_cast<int>(i);
      Tip(fmt::format("{}, a {}: click to select it, here or in the picture.", lights[i].name, Name(lights[i].shape)));
      ImGui::PopID();
    }
    ImGui::EndListBox();
  }
  const float half = 0.5f * (ImGui::GetWindowContentRegionWidth() - ImGui::GetStyle().ItemSpacing.x);
  if (ImGui::Button("Add", {half, 0.0f})) session.AddLight();
  Tip("A copy of the selected light beside it.");
  ImGui::SameLine();
  if (ImGui::Button("Remove", {half, 0.0f})) session.RemoveLight();
  Tip("The selected light; a scene keeps at least one.");
  if (session.light < 0) {
    Note("Click a light, in the list or in the picture, to edit it.");
    return SkyControls(session);
  }
  const char* const modes[] = {"Move", "Turn", "Scale"};
  int mode = static_cast<int>(session.gizmo);
  Segments("gizmo", modes, 3, mode,
           "What the handles in the picture do: G, R, S. Hold Ctrl to snap to 0.1 m and 15°.");
  session.gizmo = static_cast<GizmoMode>(mode);
  ImGui::Spacing();
  LightControls(session);
  SkyControls(session);
}

void MaterialsTab(PanelContext& context) {
  Session& session = context.session;
  auto& materials = session.scene.materials;
  const float rows = std::clamp(static_cast<float>(materials.size()), 2.0f, 6.0f);
  if (ImGui::BeginListBox("##materials", {-1.0f, (rows + 0.4f) * ImGui::GetTextLineHeightWithSpacing()})) {
    for (std::size_t i = 0; i < materials.size(); ++i) {
      ImGui::PushID(static_cast<int>(i));
      if (ImGui::Selectable(materials[i].name.c_str(), static_cast<int>(i) == session.material)) {
        session.material = static_cast<int>(i);
      }
      Tip(fmt::format("{}: click to edit it.", materials[i].name));
      ImGui::PopID();
    }
    ImGui::EndListBox();
  }
  if (materials.empty()) return;
  Material& material = materials[static_cast<std::size_t>(std::clamp(session.material, 0, static_cast<int>(materials.size()) - 1))];
  Row("Base colour", "linear", "");
  ImGui::ColorEdit3("##base", &material.base_color.x, ImGuiColorEditFlags_Float);
  Tip("Reflectance, linear sRGB, 0 to 1; times the texture where there is one.");
  const bool ramp = material.roughness.x != material.roughness.y;
  float roughness = material.roughness.x;
  Row(ramp ? "Roughness, u 0" : "Roughness", "0 … 1", "");
  if (ImGui::SliderFloat("##roughness", &roughness, 0.0f, 1.0f, "%.4g", ImGuiSliderFlags_AlwaysClamp)) {
    material.roughness = ramp ? glm::vec2(roughness, material.roughness.y) : glm::vec2(roughness);
  }
  Tip("The artist's roughness, 0 a mirror to 1 matte; alpha is its square. Ctrl+click to type.");
  if (ramp) {
    Row("Roughness, u 1", "0 … 1", "");
    ImGui::SliderFloat("##roughness1", &material.roughness.y, 0.0f, 1.0f, "%.4g", ImGuiSliderFlags_AlwaysClamp);
    Tip("Roughness at the other end of the texture coordinate u.");
  }
  Row("Metalness", "0 … 1", "");
  if (ImGui::SliderFloat("##metalness", &material.metalness, 0.0f, 1.0f, "%.4g", ImGuiSliderFlags_AlwaysClamp) && material.metalness > 0.0f) {
    material.specular = 1.0f;  // a metal has the whole lobe
  }
  Tip("0 a dielectric with 4 % reflectance at normal incidence, 1 a metal of the base colour.");
  if (material.metalness == 0.0f && !material.metallic_roughness_texture) {
    Row("Specular", "0 … 1", "");
    ImGui::SliderFloat("##specular", &material.specular, 0.0f, 1.0f, "%.4g", ImGuiSliderFlags_AlwaysClamp);
    Tip("Weight of a non-metal's specular lobe; 0 is matte.");
  }
  if (material.normal_texture) {
    Row("Normal map", "×", "");
    ImGui::SliderFloat("##normal_scale", &material.normal_scale, 0.0f, 4.0f, "%.4g", ImGuiSliderFlags_AlwaysClamp);
    Tip("How far the normal map bends the normal; 1 as stored.");
  }
  std::string textures;
  for (const auto& [texture, name] : {std::pair(&material.base_color_texture, "base colour"),
                                      std::pair(&material.metallic_roughness_texture, "metalness and roughness"),
                                      std::pair(&material.normal_texture, "normals")}) {
    if (*texture) textures += fmt::format("{}{} {}×{}", textures.empty() ? "Textures: " : ", ", name, (*texture)->width, (*texture)->height);
  }
  if (!textures.empty()) Note(textures);
}

// ------------------------------------------------------------------------------------------------ pixel, view

// A line of two columns that is no control.
void Fact(const char* label, const char* unit, const std::string& value, const std::string& tip) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(label);
  Tip(tip);
  if (*unit != '\0') {
    ImGui::SameLine(0.0f, 0.4f * ImGui::GetFontSize());
    Dim(unit);
  }
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(value.c_str());
}

void PixelLights(PanelContext& context, PanelRequests& requests) {
  const std::vector<LightAtPixel>& lights = context.inspection.lights;
  const LightAtPixel* chosen = CaseLight(context.session, context.inspection);
  const std::size_t shown = std::min<std::size_t>(lights.size(), 4);
  if (ImGui::BeginTable("##lights", 3, ImGuiTableFlags_SizingStretchProp)) {
    ImGui::TableSetupColumn("name", 0, 1.0f);
    ImGui::TableSetupColumn("form factor", 0, 0.8f);
    ImGui::TableSetupColumn("horizon", 0, 1.4f);
    for (std::size_t i = 0; i < shown; ++i) {
      const LightAtPixel& light = lights[i];
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::PushID(static_cast<int>(i));
      if (ImGui::Selectable(light.name.c_str(), lights.size() > 1 && &light == chosen, ImGuiSelectableFlags_SpanAllColumns)) context.session.case_light = light.name;
      ImGui::PopID();
      Tip(fmt::format("{}: its form factor, and what of it lies above the surface's plane.", light.name));
      ImGui::TableNextColumn();
      ImGui::Text("%.4g", light.form_factor);
      ImGui::TableNextColumn();
      Dim(light.clipping);
    }
    ImGui::EndTable();
  }
  if (lights.size() > shown) Note(fmt::format("and {} that fill less of the hemisphere", lights.size() - shown));
  if (ImGui::Button("Copy as test case", {-1.0f, 0.0f})) requests.copy = true;
  Tip(fmt::format("Ctrl + C. The line that `arealab stress --case` takes: this point under '{}' alone, with white albedo (diffuse is the picture's over "
                  "the albedo), F0 and radiance by their luminance, GGX, without texture, apertures and sky.", chosen->name));
}

void PixelTab(PanelContext& context, PanelRequests& requests) {
  Session& session = context.session;
  const Inspection& pixel = context.inspection;
  if (!session.inspected) {
    Note("Shift+click the picture to see what every technique has at a pixel, the truth there, and the lobe.");
    return;
  }
  if (!pixel.surface) {
    Note(!pixel.what.empty() ? pixel.what : context.inspecting ? "Looking …" : "No surface there.");
    return;
  }
  if (ImGui::BeginTable("##point", 2, ImGuiTableFlags_SizingStretchSame)) {
    Fact("Pixel", "", fmt::format("{}, {}", pixel.pixel.x, pixel.pixel.y), "From the picture's top left corner.");
    Fact("Position", "m", fmt::format("{:.4g}  {:.4g}  {:.4g}", pixel.position.x, pixel.position.y, pixel.position.z), "World: x right, y away, z up.");
    Fact("Roughness", "", fmt::format("{:.4g}   α {:.4g}", pixel.roughness, std::max(pixel.roughness * pixel.roughness, 1e-4)),
         "The artist's roughness and alpha, its square.");
    Fact("View angle", "°", fmt::format("{:.2f}", glm::degrees(std::acos(std::clamp(pixel.n_dot_v, -1.0, 1.0)))), "Between the normal and the viewer.");
    Fact("Form factor", "", fmt::format("{:.5g}", pixel.form_factor), "The share of the cosine-weighted hemisphere that the lights fill, summed.");
    ImGui::EndTable();
  }
  Heading(pixel.lights.size() == 1 ? "Light, form factor, corners over the horizon" : "Lights, form factor, corners over the horizon");
  PixelLights(context, requests);
  Heading(fmt::format("{}, luminance   {}", session.lobe == Lobe::kTotal ? "Total" : session.lobe == Lobe::kDiffuse ? "Diffuse" : "Specular",
                      RadianceUnit(session.scene)));
  if (ImGui::BeginTable("##values", 4, ImGuiTableFlags_SizingStretchProp)) {
    ImGui::TableSetupColumn("name", 0, 1.3f);
    ImGui::TableSetupColumn("value", 0, 1.0f);
    ImGui::TableSetupColumn("error", 0, 0.95f);
    ImGui::TableSetupColumn("rounding", 0, 0.9f);
    const double reference = Luminance(pixel.truth.Of(session.lobe));
    const auto cell = [&](const std::string& text, const std::string& tip, bool dim = false) {
      ImGui::TableNextColumn();
      dim ? Dim(text) : ImGui::TextUnformatted(text.c_str());
      Tip(tip);
    };
    const auto head = [&](const char* text, const char* tip) { cell(text, tip, true); };
    ImGui::TableNextRow();
    head("", "");
    head("value", "Luminance of the picture there; of the RGB values in its tooltip.");
    head("error", "(value − truth) / truth.");
    head("rounding", "|float − double| / double of the same shader text.");
    const std::string exact = fmt::format("Diffuse {}, specular {}; linear sRGB.", Radiance(pixel.truth.diffuse), Radiance(pixel.truth.specular));
    ImGui::TableNextRow();
    cell("truth", "The light's own integrals in double; with shadows where the scene has apertures.");
    cell(fmt::format("{:.4g}", reference), exact);
    cell(fmt::format("±{:.1g} %", 100.0 * pixel.truth_error), "What the truth says of its own error, of the total.", true);
    cell("", "");
    for (const PixelValue& value : pixel.values) {
      const auto last = session.panes.begin() + session.PaneCount();
      const bool shown = std::find_if(session.panes.begin(), last, [&](const ShownVariant& pane) { return pane.name == value.name; }) != last;
      const double luminance = Luminance(value.in_float.Of(session.lobe));
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      shown ? ImGui::TextUnformatted(value.name.c_str()) : Dim(value.name);
      Tip(value.name);
      cell(fmt::format("{:.4g}", luminance),
           fmt::format("Diffuse {}, specular {}; linear sRGB.", Radiance(value.in_float.diffuse), Radiance(value.in_float.specular)));
      const double error = reference > 0.0 ? 100.0 * (luminance - reference) / reference : 0.0;
      cell(!(reference > 0.0) ? "–" : std::abs(error) < 0.01 ? fmt::format("{:+.0e} %", error) : fmt::format("{:+.3g} %", error), "(value − truth) / truth.");
      const double exactly = value.in_double ? Luminance(value.in_double->Of(session.lobe)) : 0.0;
      cell(!value.in_double ? "…" : exactly != 0.0 ? fmt::format("{:.1e}", std::abs(luminance - exactly) / std::abs(exactly)) : "–",
           "|float − double| / double of the same shader text.", true);
    }
    ImGui::EndTable();
  }
  if (context.inspecting) Note("more to come …");
  ImGui::Checkbox("Lobe on the picture", &session.show_lobe);
  Tip("The specular lobe at this point: the BRDF, the fitted LTC, the lights, the horizon.");
}

void ViewTab(PanelContext& context, PanelRequests& requests) {
  Session& session = context.session;
  Heading("Camera");
  const char* const navigations[] = {"Blender", "Maya"};
  int navigation = static_cast<int>(session.navigation);
  Row("Navigation", "", "");
  Segments("navigation", navigations, 2, navigation,
           "Blender: middle drag orbits, Shift pans, wheel dollies. Maya: Alt + left, middle, right drag.");
  session.navigation = static_cast<Navigation>(navigation);
  double fov = glm::degrees(session.scene.camera.vertical_fov);
  Row("Field of view", "°", "");
  if (Scalar("##fov", fov, 0.1f, 1.0, 150.0, "%.1f")) session.scene.camera.vertical_fov = glm::radians(fov);
  Tip("Vertical, degrees.");
  Row("Saved", "", "");
  for (std::size_t i = 0; i < session.cameras.size(); ++i) {
    if (ImGui::Button(std::to_string(i + 1).c_str())) session.scene.camera = session.cameras[i];
    Tip("Go to this camera.");
    ImGui::SameLine();
  }
  if (session.cameras.size() < 9 && ImGui::Button("+")) session.cameras.push_back(session.scene.camera);
  if (session.cameras.size() < 9) Tip("Remember where the camera stands.");

  if (ImGui::Button("Make this the scene's camera", {-1.0f, 0.0f})) session.KeepCamera();
  Tip("The next save writes the camera as it stands; otherwise the file keeps its own.");

  Heading("Maps");
  Row("Kind", "", "");
  const char* const kinds[] = {"Signed", "Magnitude"};
  int kind = session.display.kind == PictureKind::kMagnitude ? 1 : 0;
  Segments("kind", kinds, 2, kind, "Signed: (A − B) / B of the luminance. Magnitude: the largest channel's, without its sign.");
  session.display.kind = kind == 1 ? PictureKind::kMagnitude : PictureKind::kSigned;
  Row("Scale", "", "");
  const char* const scales[] = {"Log", "Linear"};
  int scale = session.display.logarithmic ? 0 : 1;
  Segments("scale", scales, 2, scale, "Log: two decades below the end of the scale.");
  session.display.logarithmic = scale == 0;
  Row("Ends at", "±%", "");
  double range = 100.0 * session.display.range;
  if (Scalar("##range", range, 0.5f, 0.1, 1000.0, "%.3g")) session.display.range = 0.01 * range;
  Tip("The relative difference at the end of the map's colours, percent.");

  Heading("Effects");
  Note("What the scene calls for. Switch one off to see the picture and the cost without it.");
  for (const Effect& effect : session.Effects()) {
    const std::string& name = effect.name;
    const bool shape = std::ranges::any_of(kLightShapes, [&](LightShape light) { return name == Name(light); });
    if (!effect.on || shape) continue;
    bool on = !session.effects_off.contains(name);
    if (ImGui::Checkbox(EffectLabel(name).c_str(), &on)) {
      on ? void(session.effects_off.erase(name)) : void(session.effects_off.insert(name));
    }
    Tip(effect.reason + ".");
    const auto price = context.cycles.effects.find(name);
    if (price == context.cycles.effects.end()) continue;
    const std::string text = fmt::format("{:+} cycles", price->second);
    ImGui::SameLine(ImGui::GetWindowContentRegionWidth() - ImGui::CalcTextSize(text.c_str()).x);
    ImGui::AlignTextToFramePadding();
    Dim(text);
    Tip(fmt::format("What it adds to {} on {}, per wave of 64 pixels of the lighting pass.", session.panes[0].name, context.cycles.gpu));
  }
  if (!session.measure) Note("Shading, Measure: what each costs.");

  Heading("Files");
  if (ImGui::Button("Save scene", {-1.0f, 0.0f})) requests.save = true;
  Tip("Ctrl+S: writes what was edited into the scene file; comments and order stay.");
  if (ImGui::Button("Screenshot PNG", {-1.0f, 0.0f})) requests.screenshot = true;
  Tip("F12: the window as it is seen, into the current folder.");
  if (ImGui::Button("Keep a snapshot", {-1.0f, 0.0f})) requests.snapshot = true;
  Tip("K: keeps pane A's picture in the strip at the picture's foot, to compare it with what comes after.");
  if (ImGui::Button("Turntable", {-1.0f, 0.0f})) requests.turntable = true;
  Tip("72 numbered PNGs once round the target, into a folder beside the screenshots.");
  if (ImGui::Button("Linear EXR", {-1.0f, 0.0f})) requests.exr = true;
  Tip("F11: pane A's radiance with its lobes as layers, unexposed.");
}

void CostControls(PanelContext& context) {
  Session& session = context.session;
  ImGui::Checkbox("Measure what it costs", &session.measure);
  Tip("Times the lighting pass of each pane against `point`, in turns, whenever the picture is whole and nothing moves, without waiting "
      "for the screen; counts cycles on a GPU of your choice.");
  if (!session.measure) return;
  Row("Cycles on", "", "");
  if (ImGui::BeginCombo("##gpu", session.gpu.c_str(), ImGuiComboFlags_HeightLarge)) {
    for (const char* gpu : GpuNames()) {
      if (ImGui::Selectable(gpu, session.gpu == gpu)) session.gpu = gpu;
    }
    ImGui::EndCombo();
  }
  Tip("An AMD family, by the name that Mesa's compiler has for it; it need not be here. bonaire is like a PlayStation 4's.");
  for (int i = 0; i < session.PaneCount(); ++i) VariantCost(context, i);
  if (!context.cycles.trouble.empty()) Note(context.cycles.trouble);
  if (context.state.software) Note("Times are of a CPU rasteriser, not a GPU.");
}

void TransformCombo(PanelContext& context) {
  Session& session = context.session;
  const auto transform = session.display.transform;
  const std::string now = session.false_color ? "False colour" : transform == ViewTransform::kOcio ? session.ocio_view : kTransforms[static_cast<int>(transform)];
  if (ImGui::BeginCombo("##transform", now.c_str(), ImGuiComboFlags_HeightLargest)) {
    const auto choose = [&](const std::string& name, ViewTransform chosen, const std::string& tip) {
      if (ImGui::Selectable(name.c_str(), name == now)) {
        session.false_color = false;
        session.display.transform = chosen;
        if (chosen == ViewTransform::kOcio) session.ocio_view = name;
      }
      Tip(tip);
    };
    choose(kTransforms[0], ViewTransform::kSrgb, "The sRGB curve, clipped at white.");
    choose(kTransforms[1], ViewTransform::kAces, "ACES reference rendering and sRGB output, fitted.");
    choose(kTransforms[2], ViewTransform::kPbrNeutral, "Khronos PBR Neutral: colours of materials stay, highlights are compressed.");
    choose(kTransforms[3], ViewTransform::kAgx, "AgX, its base look.");
    if (context.ocio_views != nullptr) {
      for (const std::string& view : *context.ocio_views) {
        choose(view, ViewTransform::kOcio, fmt::format("A view of your OpenColorIO configuration; the picture's linear sRGB is taken for its {}.", context.ocio_input));
      }
    }
    if (ImGui::Selectable("False colour", session.false_color)) session.false_color = true;
    Tip("Stops of luminance about middle grey.");
    ImGui::EndCombo();
  }
  Tip("View transform: from linear light to the display's codes.");
}

void TechniqueTab(PanelContext& context) {
  Session& session = context.session;
  CostControls(context);
  if (session.layout == Layout::kGrid) {
    Row("Panes", "", "");
    ImGui::SliderInt("##panes", &session.grid_panes, 2, 4);
    Tip("How many variants the grid shows.");
    for (int i = 2; i < session.grid_panes; ++i) {
      Row(kPaneLetters[i], "", "");
      VariantCombo(context, i, -1.0f);
    }
  }
  for (int i = 0; i < session.PaneCount(); ++i) VariantControls(context, i);
}

}  // namespace

const LightAtPixel* CaseLight(const Session& session, const Inspection& inspection) {
  if (inspection.lights.empty()) return nullptr;
  const auto found = std::ranges::find(inspection.lights, session.case_light, &LightAtPixel::name);
  return found == inspection.lights.end() ? &inspection.lights.front() : &*found;
}

glm::vec4 GridCell(int i, int count, glm::vec2 size) {
  const float columns = 2.0f, rows = count > 2 ? 2.0f : 1.0f, gap = 2.0f;
  const glm::vec2 cell = glm::floor((size - gap * glm::vec2(columns - 1.0f, rows - 1.0f)) / glm::vec2(columns, rows));
  return {static_cast<float>(i % 2) * (cell.x + gap), static_cast<float>(i / 2) * (cell.y + gap), cell.x, cell.y};
}

glm::vec4 StripCell(std::size_t i, glm::vec2 size, float unit) {
  const float width = std::min(8.0f * unit, (size.x - 2.0f * unit) / static_cast<float>(kMostSnapshots) - 0.5f * unit), height = std::round(width * size.y / size.x);
  return {std::round(unit + static_cast<float>(i) * (width + 0.5f * unit)), std::round(size.y - unit - height), std::round(width), height};
}

float StripHeight(const PanelContext& context, glm::vec2 size) {
  return context.session.snapshots.empty() ? 0.0f : StripCell(0, size, context.unit).w + 2.2f * context.unit;
}

void DrawStrip(PanelContext& context, glm::vec2 origin, glm::vec2 size) {
  Session& session = context.session;
  const float u = context.unit;
  const std::size_t pane = session.layout == Layout::kSingle ? 0 : 1;
  std::string gone;
  for (std::size_t i = 0; i < session.snapshots.size(); ++i) {
    const Snapshot& kept = session.snapshots[i];
    const glm::vec4 cell = StripCell(i, size, u) + glm::vec4(origin, 0.0f, 0.0f);
    ImGui::SetNextWindowPos({cell.x, cell.y});
    ImGui::SetNextWindowSize({cell.z, cell.w});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0f, 0.0f});
    ImGui::Begin(kept.name.c_str(), nullptr, kFixedWindow | ImGuiWindowFlags_NoBackground);
    ImGui::PopStyleVar();
    if (ImGui::InvisibleButton("##show", {cell.z, cell.w})) {
      // Again: back to what it was of.
      session.panes[pane] = session.panes[pane].name == kept.name ? kept.picture.variant : ShownVariant{kept.name, {}};
    }
    if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) gone = kept.name;
    const bool shown = session.panes[pane].name == kept.name, hovered = ImGui::IsItemHovered();
    Tip(fmt::format("{}: click to show it in pane {}, right click to throw it away.", kept.label, kPaneLetters[pane]));
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddRect({cell.x, cell.y}, {cell.x + cell.z, cell.y + cell.w}, shown ? IM_COL32(240, 176, 92, 255) : hovered ? IM_COL32(255, 255, 255, 230) : IM_COL32(255, 255, 255, 90),
                 0.0f, 0, shown ? 2.0f : 1.0f);
    const std::string label = Shortened(kept.label, cell.z - 0.6f * u);
    const ImVec2 extent = ImGui::CalcTextSize(label.c_str());
    draw.AddRectFilled({cell.x, cell.y}, {cell.x + extent.x + 0.6f * u, cell.y + extent.y + 0.2f * u}, IM_COL32(18, 19, 22, 190));
    draw.AddText({cell.x + 0.3f * u, cell.y + 0.1f * u}, IM_COL32(240, 240, 242, 255), label.c_str());
    ImGui::End();
  }
  if (!gone.empty()) session.Drop(gone);
}

float BarHeight(const PanelContext& context) { return std::round(2.9f * context.unit); }
float ColumnWidth(const PanelContext& context) { return std::round(21.5f * context.unit); }

void DrawBar(PanelContext& context, float width, PanelRequests& requests) {
  Session& session = context.session;
  const float u = context.unit;
  ImGui::SetNextWindowPos({0.0f, 0.0f});
  ImGui::SetNextWindowSize({width, BarHeight(context)});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.8f * u, 0.5f * (BarHeight(context) - ImGui::GetFrameHeight())});
  ImGui::Begin("##bar", nullptr, kFixedWindow);
  ImGui::PopStyleVar();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(Shortened(session.scene.name, 7.0f * u).c_str());
  Tip(session.scene.question.empty() ? session.scene.file.string() : session.scene.question);
  ImGui::SameLine(0.0f, 0.2f * u);
  ImGui::TextUnformatted(session.Dirty() ? "•" : " ");
  Tip("Edited since it was saved: Ctrl+S");

  Gap(0.8f * u);
  VariantCombo(context, 0, 8.5f * u);
  if (session.layout != Layout::kSingle) {
    ImGui::SameLine(0.0f, 0.3f * u);
    if (ImGui::Button("⇄")) std::swap(session.panes[0], session.panes[1]);
    Tip("Swap A and B (X).");
    ImGui::SameLine(0.0f, 0.3f * u);
    VariantCombo(context, 1, 8.5f * u);
  }
  Gap(1.0f * u);
  const char* const layouts[] = {"Single", "Wipe", "Difference", "Flicker", "Grid"};
  int layout = static_cast<int>(session.layout);
  Segments("layout", layouts, 5, layout, "How the panes are compared: 1 to 5.");
  session.layout = static_cast<Layout>(layout);

  Gap(1.0f * u);
  ImGui::SetNextItemWidth(5.6f * u);
  int lobe = static_cast<int>(session.lobe);
  const char* const lobes[] = {"Total", "Diffuse", "Specular"};
  if (ImGui::Combo("##lobe", &lobe, lobes, 3)) session.lobe = static_cast<Lobe>(lobe);
  Tip("Which lobe is shown.");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(5.0f * u);
  double exposure = session.exposure;
  if (Scalar("##exposure", exposure, 0.02f, -32.0, 32.0, "%+.2f EV")) session.exposure = exposure;
  Tip("Exposure on top of the scene's, stops. Home: 0. A: automatic.");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(7.2f * u);
  TransformCombo(context);
  ImGui::SameLine(ImGui::GetWindowWidth() - 2.6f * u);
  if (ImGui::Button("?", {1.8f * u, 0.0f})) requests.toggle_help = true;
  Tip("Keys: ?");
  ImGui::End();
}

void DrawColumn(PanelContext& context, glm::vec2 position, glm::vec2 size, PanelRequests& requests) {
  const float u = context.unit;
  ImGui::SetNextWindowPos({position.x, position.y});
  ImGui::SetNextWindowSize({size.x, size.y});
  ImGui::Begin("##column", nullptr, kFixedWindow);
  const float foot = 3.4f * u;
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0.3f * u, 0.3f * u});
  const bool tabs = ImGui::BeginTabBar("##tabs");
  ImGui::PopStyleVar();
  if (tabs) {
    const auto tab = [&](const char* name, const char* tip, const auto& content) {
      const bool open = ImGui::BeginTabItem(name);
      Tip(tip);
      if (!open) return;
      ImGui::BeginChild(name, {0.0f, -foot});
      ImGui::Spacing();
      content();
      ImGui::EndChild();
      ImGui::EndTabItem();
    };
    tab("Lights", "The scene's lights", [&] { LightsTab(context); });
    tab("Materials", "The scene's materials", [&] { MaterialsTab(context); });
    tab("Shading", "Options, knobs and cost of what is shown", [&] { TechniqueTab(context); });
    tab("Pixel", "What every technique has at one pixel", [&] { PixelTab(context, requests); });
    tab("View", "Camera, maps, effects, files", [&] { ViewTab(context, requests); });
    ImGui::EndTabBar();
  }
  ImGui::SetCursorPosY(size.y - foot + 0.1f * u);
  ImGui::Separator();
  std::string status;
  for (const ShadedVariant& variant : context.state.variants) {
    if (!variant.image || variant.variant.name == kTruth) continue;
    status += fmt::format("{}{} {:.0f} ms", status.empty() ? "" : "   ", variant.variant.name, 1e3 * variant.seconds);
  }
  if (context.progress < 1.0) {
    ImGui::ProgressBar(static_cast<float>(context.progress), {-1.0f, 0.25f * u}, "");
  } else {
    ImGui::Dummy({1.0f, 0.25f * u});
  }
  Dim(status.empty() ? "starting" : status);
  Tip(fmt::format("Wall time of the last picture, per pane. Shaded by {} on {}.", context.state.platform, context.state.renderer));
  ImGui::End();
}

void DrawOverlay(PanelContext& context, glm::vec2 origin, glm::vec2 size) {
  Session& session = context.session;
  const float u = context.unit;
  ImDrawList& draw = *ImGui::GetBackgroundDrawList();
  draw.PushClipRect({origin.x, origin.y}, {origin.x + size.x, origin.y + size.y}, true);
  const float wrap = size.x - 2.0f * u;
  const auto label = [&](float x, float y, float align, const std::string& text, ImU32 color = IM_COL32(240, 240, 242, 255)) {
    const ImVec2 extent = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap);
    const ImVec2 at(std::round(x - align * extent.x), y);
    draw.AddRectFilled({at.x - 0.5f * u, at.y - 0.2f * u}, {at.x + extent.x + 0.5f * u, at.y + extent.y + 0.2f * u},
                       IM_COL32(18, 19, 22, 190), 0.35f * u);
    draw.AddText(ImGui::GetFont(), ImGui::GetFontSize(), at, color, text.c_str(), nullptr, wrap);
  };
  const float left = origin.x + u, top = origin.y + 0.8f * u;
  const auto name = [&](int pane) {
    const ShownVariant& shown = session.panes[static_cast<std::size_t>(pane)];
    const Snapshot* snapshot = session.SnapshotOf(shown);
    if (snapshot != nullptr) return snapshot->label;
    const auto shaded = std::ranges::find(context.state.variants, shown.name, [](const ShadedVariant& variant) { return variant.variant.name; });
    return shaded == context.state.variants.end() || shaded->note.empty() ? shown.name : fmt::format("{}   {}", shown.name, shaded->note);
  };
  switch (session.layout) {
    case Layout::kSingle:
      label(left, top, 0.0f, name(0));
      break;
    case Layout::kFlicker:
      label(left, top, 0.0f, name(context.flicker_pane));
      break;
    case Layout::kDifference:
      label(left, top, 0.0f, fmt::format("({} − {}) / {}", name(0), name(1), name(1)));
      DrawLegend(draw, session, {origin.x + size.x - u, origin.y + size.y - u}, u);
      break;
    case Layout::kWipe: {
      const float x = std::round(origin.x + session.wipe * size.x);
      draw.AddRectFilled({x - 1.5f, origin.y}, {x + 1.5f, origin.y + size.y}, IM_COL32(0, 0, 0, 90));
      draw.AddLine({x, origin.y}, {x, origin.y + size.y}, IM_COL32(255, 255, 255, 200), 1.0f);
      const ImVec2 knob(x, origin.y + 0.5f * size.y);
      draw.AddCircleFilled(knob, 0.7f * u, IM_COL32(28, 29, 33, 230));
      draw.AddCircle(knob, 0.7f * u, context.over_wipe ? IM_COL32(240, 176, 92, 255) : IM_COL32(255, 255, 255, 200), 0, 1.5f);
      for (const float side : {-1.0f, 1.0f}) {
        const float a = x + side * 0.38f * u, b = x + side * 0.18f * u;
        draw.AddTriangleFilled({a, knob.y}, {b, knob.y - 0.2f * u}, {b, knob.y + 0.2f * u}, IM_COL32(235, 235, 235, 255));
      }
      label(left, top, 0.0f, name(0));
      label(origin.x + size.x - u, top, 1.0f, name(1));
      break;
    }
    case Layout::kGrid:
      for (int i = 0; i < session.grid_panes; ++i) {
        const glm::vec4 cell = GridCell(i, session.grid_panes, size);
        label(origin.x + cell.x + u, origin.y + cell.y + 0.8f * u, 0.0f, name(i));
      }
      break;
  }
  if (session.false_color && session.layout != Layout::kDifference) {
    DrawLegend(draw, session, {origin.x + size.x - u, origin.y + size.y - u}, u);
  }
  const int rings = !session.inspected ? 0 : session.layout == Layout::kGrid ? session.grid_panes : 1;  // one in each pane
  for (int i = 0; i < rings; ++i) {
    const glm::vec4 cell = session.layout == Layout::kGrid ? GridCell(i, session.grid_panes, size) : glm::vec4(0.0f, 0.0f, size);
    const ImVec2 at(origin.x + cell.x + static_cast<float>(session.inspected->x) * cell.z, origin.y + cell.y + static_cast<float>(session.inspected->y) * cell.w);
    draw.AddCircle(at, 0.45f * u, IM_COL32(0, 0, 0, 160), 0, 3.0f);
    draw.AddCircle(at, 0.45f * u, IM_COL32(255, 255, 255, 230), 0, 1.5f);
  }
  // What went wrong stays until it is mended, at the picture's foot.
  float y = origin.y + size.y - 0.7f * u - StripHeight(context, size);
  const auto lines = [&](const std::string& text, ImU32 color) {
    if (text.empty()) return;
    y -= ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap).y;
    label(left, y, 0.0f, text, color);
    y -= 0.8f * u;
  };
  if (!context.message.empty()) lines(context.message, context.trouble ? IM_COL32(255, 150, 120, 255) : IM_COL32(240, 240, 242, 255));
  if (!context.reading.empty()) lines("reading " + context.reading, IM_COL32(240, 240, 242, 255));
  lines(context.state.error, IM_COL32(255, 150, 120, 255));
  std::string last;
  for (const ShadedVariant& variant : context.state.variants) {
    if (variant.error != last) lines(variant.error, IM_COL32(255, 150, 120, 255));
    last = variant.error;
  }
  draw.PopClipRect();
}

void DrawHelp(PanelContext& context, glm::vec2 window) {
  struct Key {
    const char* key;
    const char* what;
  };
  const bool maya = context.session.navigation == Navigation::kMaya;
  const Key keys[] = {{maya ? "Alt + left drag" : "Middle drag, left drag", "orbit"},
                      {maya ? "Alt + middle drag" : "Shift + middle drag", "pan"},
                      {maya ? "Alt + right drag, wheel" : "Wheel, Ctrl + middle drag", "dolly"},
                      {"F", "look at the point under the pointer"},
                      {"Click", "select a light"},
                      {"Shift + click, Ctrl + C", "inspect a pixel, copy it as a test case"},
                      {"G  R  S", "move, turn, scale the light; Ctrl snaps"},
                      {"1 … 5", "single, wipe, difference, flicker, grid"},
                      {"X", "swap A and B"},
                      {"A", "automatic exposure; Home: none"},
                      {"[  ]", "exposure by a third of a stop"},
                      {"Ctrl + Z, Ctrl + Shift + Z", "undo, redo"},
                      {"Ctrl + S", "save the scene"},
                      {"K", "keep a snapshot of A"},
                      {"Ctrl + R", "bring back what a crash left unsaved"},
                      {"F11  F12", "linear EXR, screenshot PNG"},
                      {"Ctrl + Q", "leave"},
                      {"Tab", "controls, captions alone, the picture alone"},
                      {"Ctrl + plus, minus", "larger, smaller type"},
                      {"Drop an image", "on a light: it shows it; on the background: a sky"},
                      {"?", "this list"}};
  ImGui::SetNextWindowPos({0.5f * window.x, 0.5f * window.y}, 0, {0.5f, 0.5f});
  ImGui::SetNextWindowFocus();
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {1.6f * context.unit, 1.2f * context.unit});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.5f * context.unit);
  ImGui::Begin("##help", nullptr, (kFixedWindow & ~ImGuiWindowFlags_NoBringToFrontOnFocus) | ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::PopStyleVar(2);
  if (ImGui::BeginTable("##keys", 2)) {
    for (const Key& key : keys) {
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(key.key);
      ImGui::SameLine();
      ImGui::Dummy({context.unit, 1.0f});
      ImGui::TableNextColumn();
      Dim(key.what);
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace arealab
