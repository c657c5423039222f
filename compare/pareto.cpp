#include "compare/pareto.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>

namespace arealab {
namespace {

constexpr double kWidth = 900.0, kHeight = 560.0, kLeft = 78.0, kRight = 880.0, kTop = 52.0, kBottom = 500.0;
constexpr double kLetter = 7.2;  // width of a character of 13 units, about

struct Box {
  double x, y, width, height;
  bool Meets(const Box& b) const {
    return x < b.x + b.width && b.x < x + width && y < b.y + b.height && b.y < y + height;
  }
};

// A logarithmic axis from `low` to `high`, mapped to [begin, end].
struct Axis {
  double low, high, begin, end;

  double operator()(double v) const { return begin + (end - begin) * std::log(v / low) / std::log(high / low); }

  // 1-2-5 steps, or decades where those are too many.
  std::vector<double> Ticks() const {
    std::vector<double> all, decades;
    for (int e = static_cast<int>(std::floor(std::log10(low))); e <= static_cast<int>(std::ceil(std::log10(high))); ++e) {
      for (const double step : {1.0, 2.0, 5.0}) {
        const double v = step * std::pow(10.0, e);
        if (v < low || v > high) continue;
        all.push_back(v);
        if (step == 1.0) decades.push_back(v);
      }
    }
    return all.size() > 12 ? decades : all;
  }
};

Axis MakeAxis(const std::vector<double>& values, double begin, double end) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double room = std::max(1.15, std::pow(*high / *low, 0.08));
  return {*low / room, *high * room, begin, end};
}

std::string Escape(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    escaped += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : c == '"' ? "&quot;" : std::string(1, c);
  }
  return escaped;
}

std::string Line(const char* kind, double x1, double y1, double x2, double y2) {
  return fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n", kind, x1, y1, x2, y2);
}

std::string Text(const char* kind, double x, double y, const char* anchor, const std::string& text) {
  return fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", kind, x, y, anchor, Escape(text));
}

bool IsPublished(const std::string& name) {
  return name.ends_with("@published");
}

// Beside the mark where there is room, else further off, with a line back; nothing where there is none.
std::optional<Box> PlaceName(const Box& mark, double width, const std::vector<Box>& taken) {
  const double cx = mark.x + 0.5 * mark.width, cy = mark.y + 0.5 * mark.height;
  std::vector<Box> places = {{cx + 10, cy - 8, width, 16}, {cx - 10 - width, cy - 8, width, 16},
                             {cx - width / 2, cy - 25, width, 16}, {cx - width / 2, cy + 9, width, 16}};
  for (const double radius : {28.0, 42.0, 60.0, 84.0, 110.0}) {
    for (int i = 0; i < 16; ++i) {
      const double a = (i + 0.5) * std::numbers::pi / 8.0, c = std::cos(a);
      places.push_back({cx + radius * c - (c > 0.4 ? 0.0 : c < -0.4 ? width : width / 2), cy - 8 + radius * std::sin(a), width, 16});
    }
  }
  for (const Box& place : places) {
    if (place.x < kLeft + 2 || place.x + width > kRight || place.y < kTop || place.y + 16 > kBottom) continue;
    if (std::none_of(taken.begin(), taken.end(), [&](const Box& t) { return place.Meets(t); })) return place;
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::size_t> Frontier(const std::vector<ParetoMark>& marks) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < marks.size(); ++i) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(marks[a].cost, marks[a].error) < std::pair(marks[b].cost, marks[b].error);
  });
  double least = std::numeric_limits<double>::infinity();
  std::erase_if(order, [&](std::size_t i) {
    const bool beaten = !(marks[i].error < least);
    least = std::min(least, marks[i].error);
    return beaten;
  });
  return order;
}

ParetoPlot MakeParetoPlot(std::span<const SceneResult> scenes, bool software) {
  std::set<std::string> gpus;
  bool timed = false;
  for (const SceneResult& scene : scenes) {
    for (const VariantResult& variant : scene.variants) {
      timed = timed || std::isfinite(variant.time.ratio_to_point.value);
      for (const auto& [gpu, cost] : variant.isa) gpus.insert(gpu);
    }
  }
  ParetoPlot plot;
  if (!timed && gpus.empty()) return plot;
  const std::string gpu = gpus.empty() ? "" : *gpus.begin();
  plot.cost_title = !timed     ? fmt::format("cycles per wave on {}, technique alone, estimated by its compiler", gpu)
                    : software ? "time of the lighting pass over point's, on a CPU rasteriser, not a GPU"
                               : "time of the lighting pass over point's";
  // In one scene, or nothing.
  const auto place = [&](const SceneResult& scene, const std::string& name) -> std::optional<ParetoMark> {
    const auto variant = std::find_if(scene.variants.begin(), scene.variants.end(), [&](const VariantResult& v) { return v.name == name; });
    if (variant == scene.variants.end() || !variant->supported) return std::nullopt;
    ParetoMark mark{variant->short_name, kNotMeasured, variant->total.rel_rmse, {}};
    if (variant->within_truth_error) mark.error = scene.truth_relative_error;
    const auto isa = variant->isa.find(gpu);
    if (timed) {
      mark.interval = variant->time.ratio_to_point;
      mark.cost = mark.interval.value;
    } else if (isa != variant->isa.end()) {
      mark.cost = isa->second.core.cycles;
    }
    if (!(mark.cost > 0.0) || !(mark.error > 0.0) || !std::isfinite(mark.cost + mark.error)) return std::nullopt;
    return mark;
  };
  std::vector<std::string> names;
  for (const SceneResult& scene : scenes) {
    for (const VariantResult& variant : scene.variants) {
      if (std::find(names.begin(), names.end(), variant.name) == names.end()) names.push_back(variant.name);
    }
  }
  const auto in = [&](const std::string& name) { return [&, name](const SceneResult& scene) { return place(scene, name).has_value(); }; };
  std::erase_if(names, [&](const std::string& name) {
    const auto count = static_cast<std::size_t>(std::count_if(scenes.begin(), scenes.end(), in(name)));
    return count == 0 || 2 * count < scenes.size();
  });
  std::vector<const SceneResult*> common;
  std::vector<std::string> common_names;
  for (const SceneResult& scene : scenes) {
    if (!std::all_of(names.begin(), names.end(), [&](const std::string& name) { return place(scene, name); })) continue;
    common.push_back(&scene);
    common_names.push_back(scene.name);
  }
  if (common.empty()) return plot;
  plot.title = scenes.size() == 1 ? fmt::format("{}: relative RMSE against cost", scenes[0].name)
                                  : fmt::format("Relative RMSE against cost, geometric means over {}", fmt::join(common_names, ", "));
  for (const std::string& name : names) {
    ParetoMark mark{"", 0.0, 0.0, {0.0, 0.0, 0.0}};
    const double share = 1.0 / static_cast<double>(common.size());
    for (const SceneResult* scene : common) {
      const ParetoMark one = *place(*scene, name);
      mark.name = one.name;
      mark.cost += share * std::log(one.cost);
      mark.error += share * std::log(one.error);
      mark.interval.low += share * std::log(one.interval.low);  // NaN where there is none
      mark.interval.high += share * std::log(one.interval.high);
    }
    mark.cost = std::exp(mark.cost);
    mark.error = std::exp(mark.error);
    mark.interval = {mark.cost, std::exp(mark.interval.low), std::exp(mark.interval.high)};
    plot.marks.push_back(mark);
  }
  return plot;
}

std::string ParetoSvg(const ParetoPlot& plot) {
  std::vector<double> costs, errors;
  for (const ParetoMark& mark : plot.marks) {
    costs.push_back(mark.cost);
    errors.push_back(mark.error);
    if (std::isfinite(mark.interval.low)) costs.insert(costs.end(), {mark.interval.low, mark.interval.high});
  }
  const Axis x = MakeAxis(costs, kLeft, kRight), y = MakeAxis(errors, kBottom, kTop);
  const std::vector<std::size_t> front = Frontier(plot.marks);
  const auto is_best = [&](std::size_t i) { return std::find(front.begin(), front.end(), i) != front.end(); };

  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\">\n<style>\n"
      "text {{ font: 13px 'DejaVu Sans', Arial, sans-serif; fill: #3d434b; }} .title {{ font-size: 15px; fill: #17191d; }}\n"
      ".best {{ font-weight: bold; fill: #17191d; }} line {{ stroke: #dcd9d3; }} .bar, .tie {{ stroke: #8a9099; stroke-width: 1.5; }} .leader {{ stroke: #b9b5ad; }}\n"
      ".front {{ fill: none; stroke: #9a4a00; stroke-width: 2; }} circle {{ stroke-width: 2.5; }}\n</style>\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
      kWidth, kHeight);
  svg += Text("title", kLeft, 30, "start", plot.title);
  for (const double v : x.Ticks()) {
    svg += Line("grid", x(v), kTop, x(v), kBottom) + Text("tick", x(v), kBottom + 20, "middle", fmt::format("{:g}", v));
  }
  for (const double v : y.Ticks()) {
    svg += Line("grid", kLeft, y(v), kRight, y(v)) + Text("tick", kLeft - 8, y(v) + 4.5, "end", fmt::format("{:g} %", 100.0 * v));
  }
  svg += Text("axis", 0.5 * (kLeft + kRight), kHeight - 14, "middle", plot.cost_title);

  std::vector<Box> taken;
  std::string path;
  for (std::size_t i = 0; i < front.size(); ++i) {
    const ParetoMark& mark = plot.marks[front[i]];
    path += i == 0 ? fmt::format("M{:.1f} {:.1f}", x(mark.cost), y(mark.error)) : fmt::format("H{:.1f}V{:.1f}", x(mark.cost), y(mark.error));
    if (i == 0) continue;
    const ParetoMark& before = plot.marks[front[i - 1]];
    taken.push_back({x(before.cost), y(before.error) - 1, x(mark.cost) - x(before.cost), 2});
    taken.push_back({x(mark.cost) - 1, y(before.error), 2, y(mark.error) - y(before.error)});
  }
  svg += fmt::format("<path class=\"front\" d=\"{}H{:.1f}\"/>\n", path, kRight);
  std::map<std::string, const ParetoMark*> by_name;
  for (const ParetoMark& mark : plot.marks) by_name[mark.name] = &mark;
  for (const ParetoMark& mark : plot.marks) {
    if (!IsPublished(mark.name)) continue;
    const auto ours = by_name.find(mark.name.substr(0, mark.name.find('@')));
    if (ours != by_name.end()) svg += Line("tie", x(mark.cost), y(mark.error), x(ours->second->cost), y(ours->second->error));
  }
  for (const ParetoMark& mark : plot.marks) taken.push_back({x(mark.cost) - 6, y(mark.error) - 6, 12, 12});
  std::vector<std::size_t> order = front;  // the best are named first
  for (std::size_t i = 0; i < plot.marks.size(); ++i) {
    if (!is_best(i)) order.push_back(i);
  }
  for (const std::size_t i : order) {
    const ParetoMark& mark = plot.marks[i];
    const char* color = is_best(i) ? "#0b62a8" : "#9aa0a8";
    if (std::isfinite(mark.interval.low)) svg += Line("bar", x(mark.interval.low), y(mark.error), x(mark.interval.high), y(mark.error));
    svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" stroke=\"{}\" fill=\"{}\"/>\n", x(mark.cost), y(mark.error), color,
                       IsPublished(mark.name) ? "#ffffff" : color);
    const Box dot{x(mark.cost) - 6, y(mark.error) - 6, 12, 12};
    const auto name = PlaceName(dot, kLetter * static_cast<double>(mark.name.size()) + 4, taken);
    if (!name) continue;
    taken.push_back(*name);
    const double cx = dot.x + 6, cy = dot.y + 6;
    if (std::hypot(std::clamp(cx, name->x, name->x + name->width) - cx, std::clamp(cy, name->y, name->y + 16) - cy) > 14) {
      svg += Line("leader", cx, cy, std::clamp(cx, name->x, name->x + name->width), cy < name->y ? name->y : name->y + 16);
    }
    svg += Text(is_best(i) ? "best" : "beaten", name->x + 2, name->y + 12.5, "start", mark.name);
  }
  return svg + "</svg>\n";
}

}  // namespace arealab
