#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <mutex>

#include "glsl/fit.h"
#include "glsl/fit_cell.h"

namespace arealab {
namespace {

// None of them a node of a 64 × 64 table, so that interpolation counts.
constexpr double kRoughness[] = {0.1, 0.25, 0.5, 0.75, 1.0};
constexpr double kDegrees[] = {10.0, 30.0, 50.0, 70.0, 85.0};
constexpr double kLowRoughness[] = {0.05, 0.08, 0.11, 0.15, 0.2};
constexpr double kGrazingDegrees[] = {60.0, 70.0, 78.0, 84.0, 88.0};
constexpr double kMapRoughness[] = {0.05, 0.1, 0.15, 0.2, 0.27, 0.35, 0.44, 0.53, 0.63, 0.75, 0.87, 1.0};
constexpr double kMapDegrees[] = {1.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 75.0, 80.0, 84.0, 87.0};

struct Point {
  double roughness, degrees;
  double relative_rmse = 0.0, bias = 0.0;
};

// A lobe near ρ, so that the masks have little left to find; the result does not depend on how near.
fit::Cell Control(const fit::View& view) {
  const fit::Cell anywhere;  // only a start
  return fit::FitDensityCell(view, 24, &anywhere);
}

void Measure(const LtcTables& tables, const std::vector<fit::Quad>& quads, int nodes, Point* point) {
  const fit::View view = fit::MakeView(tables.brdf, point->roughness, std::cos(glm::radians(point->degrees)));
  const std::vector<double> wanted = fit::LobeIntegrals(view, quads, nodes, Control(view));
  const LtcLookup look = Look(tables, point->roughness, view.cosine);
  const fit::Terms m(look.m.x, look.m.y, look.m.z, look.m.w);
  const fit::Terms second(look.second.x, look.second.y, look.second.z, look.second.w);
  double squares = 0.0, difference = 0.0, total_squares = 0.0, total = 0.0;
  for (std::size_t i = 0; i < quads.size(); ++i) {
    double value = tables.kind == FitKind::kHorizon ? fit::UpperQuadIntegral(m, quads[i])
                                                    : fit::QuadIntegral(m, quads[i]);
    if (look.terms.z != 0.0) value += look.terms.z * fit::QuadIntegral(second, quads[i]);
    value *= look.terms.x;
    squares += (value - wanted[i]) * (value - wanted[i]);
    difference += value - wanted[i];
    total_squares += wanted[i] * wanted[i];
    total += wanted[i];
  }
  point->relative_rmse = std::sqrt(squares / total_squares);
  point->bias = difference / total;
}

// The LTC's share below the surface's horizon, of two lobes their sum's; a cosine lobe has none there.
double ShareBelow(FitKind kind, const LtcLookup& look) {
  const auto below = [](const glm::dvec4& m) { return 0.5 * (1.0 - m.x / std::hypot(m.x, m.y)); };
  return kind == FitKind::kTwo ? (below(look.m) + look.terms.z * below(look.second)) / (1.0 + look.terms.z) : below(look.m);
}

std::array<double, 3> MeasureCell(const LtcTables& tables, const std::vector<fit::Quad>& quads, double roughness, double degrees,
                                  int node_count) {
  Point point{roughness, degrees};
  Measure(tables, quads, node_count, &point);
  const fit::View view = fit::MakeView(tables.brdf, roughness, std::cos(glm::radians(degrees)));
  const LtcLookup look = Look(tables, roughness, view.cosine);
  const fit::Terms m(look.m.x, look.m.y, look.m.z, look.m.w);
  const fit::Terms second(look.second.x, look.second.y, look.second.z, look.second.w);
  const fit::Nodes nodes = fit::UpperNodes(view, node_count, node_count);
  double difference = 0.0, total = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const glm::dvec3 direction(nodes.x[i], nodes.y[i], nodes.z[i]);
    const double lobe = fit::LtcDensity(m, direction, 1.0, nullptr) + look.terms.z * fit::LtcDensity(second, direction, 1.0, nullptr);
    difference += nodes.weight[i] * std::abs(nodes.density[i] - look.terms.x * lobe);
    total += nodes.weight[i] * nodes.density[i];
  }
  return {point.relative_rmse, difference / total, ShareBelow(tables.kind, look)};
}

}  // namespace

std::array<double, 3> MeasureFitAt(const LtcTables& tables, double roughness, double degrees, const MeasureOptions& options) {
  return MeasureCell(tables, fit::RandomRectangles(options.rectangles, options.seed), roughness, degrees, options.nodes);
}

FitMap MapFit(const LtcTables& tables, const MeasureOptions& options, const std::function<void(double)>& progress) {
  FitMap map;
  map.table = TableName(tables.brdf, tables.kind);
  map.brdf = Name(tables.brdf);
  map.options = options;
  const std::vector<fit::Quad> quads = fit::RandomRectangles(options.rectangles, options.seed);
  map.roughness.assign(std::begin(kMapRoughness), std::end(kMapRoughness));
  map.degrees.assign(std::begin(kMapDegrees), std::end(kMapDegrees));
  const std::size_t columns = map.degrees.size(), cells = map.roughness.size() * columns;
  for (auto* figure : {&map.polygon, &map.lobe, &map.below}) figure->resize(cells);
  std::mutex mutex;
  std::size_t done = 0;
  tbb::parallel_for(std::size_t{0}, cells, [&](std::size_t i) {
    const auto [polygon, lobe, below] = MeasureCell(tables, quads, map.roughness[i / columns], map.degrees[i % columns], options.nodes);
    map.polygon[i] = polygon;
    map.lobe[i] = lobe;
    map.below[i] = below;
    const std::lock_guard lock(mutex);
    ++done;
    if (progress) progress(static_cast<double>(done) / static_cast<double>(cells));
  });
  return map;
}

double LtcQuadIntegral(const glm::dvec4& m, const std::array<glm::dvec3, 4>& corners) {
  return fit::QuadIntegral(fit::Terms(m.x, m.y, m.z, m.w), fit::MakeQuad(corners));
}

double LobeQuadIntegral(double roughness, double n_dot_v, const std::array<glm::dvec3, 4>& corners, int nodes,
                        Brdf brdf) {
  const fit::View view = fit::MakeView(brdf, roughness, n_dot_v);
  return fit::LobeIntegrals(view, {fit::MakeQuad(corners)}, nodes, Control(view)).front();
}

FitQuality MeasureFit(const LtcTables& tables, const MeasureOptions& options,
                      const std::function<void(double)>& progress) {
  const std::vector<fit::Quad> quads = fit::RandomRectangles(options.rectangles, options.seed);
  std::vector<Point> points;
  for (const double roughness : kRoughness)
    for (const double degrees : kDegrees) points.push_back({roughness, degrees});
  const std::size_t grid = points.size();
  for (const double roughness : kLowRoughness)
    for (const double degrees : kGrazingDegrees) points.push_back({roughness, degrees});
  std::mutex mutex;
  int done = 0;
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
    Measure(tables, quads, options.nodes, &points[i]);
    const std::lock_guard lock(mutex);
    ++done;
    if (progress) progress(static_cast<double>(done) / static_cast<double>(points.size()));
  });

  FitQuality quality;
  quality.options = options;
  quality.roughness.assign(std::begin(kRoughness), std::end(kRoughness));
  quality.degrees.assign(std::begin(kDegrees), std::end(kDegrees));
  const auto columns = static_cast<double>(quality.degrees.size());
  double all = 0.0;
  for (std::size_t row = 0; row < quality.roughness.size(); ++row) {
    double sum = 0.0;
    for (std::size_t column = 0; column < quality.degrees.size(); ++column) {
      const Point& point = points[row * quality.degrees.size() + column];
      quality.relative_rmse.push_back(point.relative_rmse);
      quality.bias.push_back(point.bias);
      sum += point.relative_rmse * point.relative_rmse;
    }
    quality.by_roughness.push_back(std::sqrt(sum / columns));
    all += sum;
  }
  quality.all = std::sqrt(all / static_cast<double>(grid));
  double grazing = 0.0;
  for (std::size_t i = grid; i < points.size(); ++i) {
    grazing += points[i].relative_rmse * points[i].relative_rmse;
    quality.grazing_max = std::max(quality.grazing_max, points[i].relative_rmse);
  }
  quality.grazing = std::sqrt(grazing / static_cast<double>(points.size() - grid));

  for (int row = 0; row < tables.size; ++row) {
    for (int column = 0; column < tables.size; ++column) {
      const double leak = ShareBelow(tables.kind, NodeLookup(tables, row, column));
      quality.leak_mean += leak;
      quality.leak_max = std::max(quality.leak_max, leak);
    }
  }
  quality.leak_mean /= tables.size * tables.size;
  return quality;
}

std::string QualityTable(const FitQuality& quality) {
  std::string text = fmt::format("relative RMSE in % over {} rectangles (seed {})\n\n| roughness |",
                                 quality.options.rectangles, quality.options.seed);
  for (const double degrees : quality.degrees) text += fmt::format(" {:.0f}° |", degrees);
  text += " all angles |\n|---|";
  for (std::size_t i = 0; i <= quality.degrees.size(); ++i) text += "---|";
  text += "\n";
  for (std::size_t row = 0; row < quality.roughness.size(); ++row) {
    text += fmt::format("| {} |", quality.roughness[row]);
    for (std::size_t column = 0; column < quality.degrees.size(); ++column)
      text += fmt::format(" {:.2f} |", 100.0 * quality.relative_rmse[row * quality.degrees.size() + column]);
    text += fmt::format(" {:.2f} |\n", 100.0 * quality.by_roughness[row]);
  }
  text += fmt::format(
      "\nall {:.2f}; roughness 0.05–0.2 at 60°–88°: {:.2f}, at most {:.2f}; share below the horizon: {:.2f} "
      "mean, "
      "{:.2f} at most\n",
      100.0 * quality.all, 100.0 * quality.grazing, 100.0 * quality.grazing_max, 100.0 * quality.leak_mean,
      100.0 * quality.leak_max);
  return text;
}

}  // namespace arealab
