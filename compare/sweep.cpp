#include "compare/sweep.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "compare/page_data.h"
#include "compare/read_results.h"
#include "compare/report.h"
#include "compare/table.h"
#include "scenes/error.h"
#include "scenes/replace_file.h"

namespace arealab {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kCamera = "[camera]\nposition = [0.0, -3.6, 2.2]\ntarget = [0.0, 0.4, 0.0]\nvertical_fov = 40.0\n";
constexpr const char* kFloor = "[[surface]]\ntype = \"plane\"\nsize = [5.0, 5.0]\nmaterial = \"floor\"\n";

std::string MaterialText(double roughness) {
  return fmt::format("[[material]]\nname = \"floor\"\nbase_color = 0.4\nroughness = {}\n", roughness);
}

std::string Panel(glm::dvec3 at, glm::dvec3 normal, glm::dvec2 size) {
  return fmt::format("[[light]]\nshape = \"rectangle\"\nposition = [{}, {}, {}]\nnormal = [{}, {}, {}]\nsize = [{}, {}]\nradiance = 5.0\n",
                     at.x, at.y, at.z, normal.x, normal.y, normal.z, size.x, size.y);
}

// An even grid over the floor, of one area together.
std::string Lights(int count) {
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  std::string text;
  for (int i = 0; i < count; ++i) {
    const auto place = [&](int k) { return 3.2 * ((k + 0.5) / side - 0.5); };
    text += Panel({place(i % side), place(i / side), 1.2}, {0, 0, -1}, glm::dvec2(1.5 / std::sqrt(count)));
  }
  return text;
}

const std::string kUsualPanel = Panel({0.0, 1.6, 0.8}, {0.0, -1.0, -0.3}, {1.8, 0.9});

std::string SceneText(const std::string& axis, double value) {
  const double degree = std::numbers::pi / 180.0;
  if (axis == "lights") return kCamera + MaterialText(0.3) + kFloor + Lights(static_cast<int>(value));
  if (axis == "roughness") return kCamera + MaterialText(value) + kFloor + kUsualPanel;
  if (axis == "angle") {
    return fmt::format("[camera]\nposition = [0.0, {}, {}]\ntarget = [0.0, 0.0, 0.0]\nup = [0.0, 1.0, 1.0]\nvertical_fov = 16.0\n",
                       -4.0 * std::sin(value * degree), 4.0 * std::cos(value * degree)) +
           MaterialText(0.3) + kFloor + kUsualPanel;
  }
  if (axis == "light_size") return kCamera + MaterialText(0.3) + kFloor + Panel({0.0, 1.6, 1.2}, {0.0, -1.0, -0.6}, glm::dvec2(value));
  if (axis == "distance") {
    return kCamera + MaterialText(0.3) + kFloor + Panel({0.0, 0.8 * value, 0.6 * value}, {0.0, -0.8, -0.6}, {0.8, 0.8});
  }
  if (axis == "crossing") {
    // The light reaches below the level strip's horizon, and stands wholly above that of the tilted one.
    std::string text = fmt::format("[camera]\nposition = [0.0, -1.2, 4.0]\ntarget = [0.0, 0.0, 0.0]\nvertical_fov = 24.0\n") + MaterialText(0.3);
    const double left = 4.0 * value, right = 4.0 - left;
    const auto strip = [&](double width, double middle, double tilt) {
      return fmt::format("[[surface]]\ntype = \"plane\"\nsize = [{}, 1.8]\nposition = [{}, 0.0, 0.0]\nrotation = [{}, 0.0, 0.0]\nmaterial = \"floor\"\n",
                         width, middle, tilt);
    };
    if (left > 0.0) text += strip(left, -2.0 + 0.5 * left, 0.0);
    if (right > 0.0) text += strip(right, 2.0 - 0.5 * right, -30.0);
    return text + Panel({0.0, 1.6, 0.3}, {0.0, -1.0, 0.0}, {3.0, 1.0});
  }
  if (axis == "sun") {
    // Hills of plaster with baked apertures, the sun's course leaning to the south, and a sky that fades with it.
    const double rise = std::sin(value * degree);
    return fmt::format(
        "[aperture]\n[sky]\nradiance = {}\n[camera]\nposition = [0.0, -0.46, 0.26]\ntarget = [0.0, 0.02, 0.01]\nvertical_fov = 40.0\n"
        "[[material]]\nname = \"plaster\"\nbase_color = 0.4\nroughness = 0.6\n"
        "[[surface]]\ntype = \"height_field\"\nsize = [0.8, 0.8]\nposition = [0.0, 0.08, 0.0]\nformula = \"waves\"\nheight = 0.06\n"
        "wavelength = 0.4\ncells = [96, 96]\nmaterial = \"plaster\"\n"
        "[[light]]\nname = \"sun\"\nshape = \"sphere\"\nposition = [{}, {}, {}]\nradius = 1.0\nradiance = 1000.0\n",
        0.05 + 0.25 * rise, 40.0 * std::cos(value * degree), -12.0 * rise, 40.0 * rise);
  }
  return kCamera + MaterialText(0.3) + kFloor + kUsualPanel;  // pixels, samples
}

// Seconds of the whole pass: what grows with lights and pixels alike.
double PassSeconds(const Json& scene, const Json& variant) {
  return 1e-9 * NumberOf(variant.at("time").at("ns_per_pixel")) * NumberOf(scene.at("lit_pixels"));
}

// Least squares slope of log y over log x, where at least three points are known.
std::optional<double> Exponent(const std::vector<std::pair<double, double>>& points) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const auto& [value, cost] : points) {
    if (!(value > 0.0) || !(cost > 0.0)) continue;
    const double x = std::log(value), y = std::log(cost);
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  const double spread = n * sxx - sx * sx;
  if (n < 3 || !(spread > 1e-9)) return std::nullopt;
  return (n * sxy - sx * sy) / spread;
}

// A variant's name on the curves: a family along the axis "samples" is one.
std::string CurveName(const std::string& axis, const Json& variant) {
  const std::string name = variant.at("short_name");
  return axis == "samples" ? name.substr(0, name.find("+samples=")) : name;
}

}  // namespace

const std::vector<SweepAxis>& SweepAxes() {
  static const std::vector<SweepAxis> axes = {
      {"lights", "lights", true, {1, 2, 4, 8, 16, 32, 64, 128, 256}},
      {"pixels", "pixels, millions", true, {0.1, 0.25, 0.5, 1, 2, 4, 8}},
      {"samples", "samples per light and pixel", true, {1, 4, 16, 64}},
      {"roughness", "roughness", false, {0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1}},
      {"angle", "view angle from the normal, degrees", false, {5, 15, 25, 35, 45, 55, 65, 75, 80, 85}},
      {"light_size", "side of the square light, m", true, {0.02, 0.05, 0.1, 0.2, 0.5, 1, 2}},
      {"distance", "distance of the light from the floor's middle, m", true, {0.5, 0.7, 1, 1.5, 2, 3, 5, 8}},
      {"crossing", "share of the floor whose horizon the light crosses", false, {0, 0.25, 0.5, 0.75, 1}},
      {"sun", "the sun's angle from its rise in the east, degrees", false, {10, 25, 40, 60, 90, 120, 140, 155, 170}}};
  return axes;
}

const SweepAxis& FindSweepAxis(const std::string& name) {
  std::vector<std::string> names;
  for (const SweepAxis& axis : SweepAxes()) {
    if (axis.name == name) return axis;
    names.push_back(axis.name);
  }
  throw InputError(fmt::format("no axis \"{}\"; expected one of {}", name, fmt::join(names, ", ")));
}

SweepPoint MakeSweepPoint(const SweepAxis& axis, double value, glm::ivec2 size) {
  const std::map<std::string, std::pair<double, double>> reach = {
      {"lights", {1, 256}},     {"pixels", {1e-4, 60}},     {"samples", {1, 64}},   {"roughness", {0, 1}},
      {"angle", {0, 89}},       {"light_size", {1e-3, 4}},  {"distance", {0.1, 100}}, {"crossing", {0, 1}}, {"sun", {1, 179}}};
  const auto [low, high] = reach.at(axis.name);
  const bool whole = axis.name != "lights" || value == std::floor(value);
  if (!(value >= low && value <= high) || !whole) {
    throw InputError(fmt::format("{} {}; expected {} from {} to {}", axis.name, value, whole ? "a number" : "a whole number", low, high));
  }
  if (axis.name == "pixels") {
    const double height = std::sqrt(1e6 * value * 9.0 / 16.0);
    size = {static_cast<int>(std::lround(height * 16.0 / 9.0)), static_cast<int>(std::lround(height))};
  }
  return {fmt::format("# {}: {}\n{}", axis.title, value, SceneText(axis.name, value)), size};
}

std::string SweepResults(const std::string& results, const SweepAxis& axis, const std::vector<double>& values) {
  Json json = Json::parse(results);
  for (std::size_t s = 0; s < values.size(); ++s) {
    json["scenes"][s]["sweep"] = {{"axis", axis.name}, {"title", axis.title}, {"logarithmic", axis.logarithmic}, {"value", values[s]}};
    json["scenes"][s].erase("pairs");
  }
  return json.dump(1) + "\n";
}

std::string WriteSweep(const std::vector<std::string>& parts, const std::filesystem::path& directory) {
  Json joined;
  try {
    std::map<double, Json> scenes;
    std::string axis;
    for (const std::string& part : parts) {
      const Json json = ParseResults(fmt::format("part {}", 1 + (&part - parts.data())), part);
      if (joined.is_null()) joined = json;
      if (json.at("isa_compilers") != joined.at("isa_compilers") || json.at("version") != joined.at("version")) {
        throw InputError("parts of different versions of AreaLab or of the compilers; expected one of each");
      }
      for (const Json& scene : json.at("scenes")) {
        const std::string name = scene.at("sweep").at("axis");
        if (!axis.empty() && name != axis) throw InputError(fmt::format("parts along {} and {}; expected one axis", axis, name));
        axis = name;
        scenes.emplace(scene.at("sweep").at("value").get<double>(), scene);
      }
    }
    joined["scenes"] = Json::array();
    std::map<std::string, std::vector<std::pair<double, double>>> costs;  // value, seconds of the pass
    std::vector<std::string> order;
    std::string csv = "axis,value,variant,rel_rmse,ns_per_pixel,ns_low,ns_high,pass_seconds,ratio_to_point,bonaire_core_cycles\r\n";
    for (const auto& [value, scene] : scenes) {
      joined["scenes"].push_back(scene);
      for (const Json& variant : scene.at("variants")) {
        if (!variant.at("supported").get<bool>()) continue;
        const std::string name = CurveName(axis, variant);
        if (!costs.contains(name)) order.push_back(name);
        const Json& time = variant.at("time");
        const double pass = PassSeconds(scene, variant);
        const double cycles = variant.at("isa").contains("bonaire") ? NumberOf(variant.at("isa").at("bonaire").at("core").at("cycles"))
                                                                    : std::numeric_limits<double>::quiet_NaN();
        costs[name].emplace_back(value, pass);
        const Json interval = IsInterval(time.at("ns_interval")) ? time["ns_interval"] : Json::array({nullptr, nullptr});
        std::vector<std::string> fields = {axis, fmt::format("{}", value), name};
        for (const double v : {NumberOf(variant.at("error").at("total").at("rel_rmse")), NumberOf(time.at("ns_per_pixel")), NumberOf(interval[0]),
                               NumberOf(interval[1]), pass, NumberOf(time.at("ratio_to_point")), cycles}) {
          fields.push_back(std::isfinite(v) ? fmt::format("{:.9g}", v) : "");
        }
        csv += fmt::format("{}\r\n", fmt::join(fields, ","));
      }
    }
    joined["exponents"] = Json::object();
    std::vector<std::vector<std::string>> rows = {{"variant", "exponent", ""}};
    for (const std::string& name : order) {
      const auto time = Exponent(costs[name]);
      joined["exponents"][name] = time ? Json(*time) : Json(nullptr);
      rows.push_back({name, time ? fmt::format("{:.2f}", *time) : "–", ""});
    }
    ReplaceFiles({{directory / "results.json", joined.dump(1) + "\n"},
                  {directory / "curves.csv", csv},
                  {directory / "index.html", SweepPage(ScriptSafe(joined.dump()))}});
    return fmt::format("time of the whole pass, fitted as {}^exponent over {} values:\n{}", axis, scenes.size(), AlignedTable(rows));
  } catch (const Json::exception& wrong) {
    throw InputError(fmt::format("{}; expected results.json of `arealab sweep`", wrong.what()));
  }
}

}  // namespace arealab
