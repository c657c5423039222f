#include "scenes/texture_weights.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace arealab {
namespace {

// The polynomial that is 1 at node k and 0 at the others.
double Lagrange(const GaussRuleOnUnit& rule, std::size_t k, double x) {
  double value = 1.0;
  for (std::size_t i = 0; i < rule.place.size(); ++i) {
    if (i != k) value *= (x - rule.place[i]) / (rule.place[k] - rule.place[i]);
  }
  return value;
}

// Of one axis: what each texel of a range adds to each node of one of `cells` intervals, in means over the interval.
struct AxisWeights {
  int first = 0;
  std::vector<std::vector<double>> texels;  // [texel − first][node]
};

AxisWeights MakeAxisWeights(const GaussRuleOnUnit& rule, int cell, int cells, int size) {
  // Between texels' centres, where the texture is linear, the integrand has at most degree 6: four points are exact.
  constexpr std::array<double, 4> place = {0.069431844202974, 0.330009478207572, 0.669990521792428, 0.930568155797026};
  constexpr std::array<double, 4> weight = {0.173927422568727, 0.326072577431273, 0.326072577431273, 0.173927422568727};
  const double begin = static_cast<double>(cell) / cells, end = (cell + 1.0) / cells;
  const auto below = [&](double u) { return std::clamp(static_cast<int>(std::floor(u * size - 0.5)), 0, size - 1); };
  AxisWeights axis;
  axis.first = below(begin);
  axis.texels.assign(static_cast<std::size_t>(std::min(below(end) + 1, size - 1) - axis.first + 1), std::vector<double>(rule.place.size()));
  for (double u = begin; u < end;) {
    const double knot = (std::floor(u * size - 0.5 + 1e-9) + 1.5) / size, next = std::min(end, std::max(knot, u + 1e-12));
    for (std::size_t g = 0; g < 4; ++g) {
      const double at = u + (next - u) * place[g], p = std::clamp(at * size - 0.5, 0.0, size - 1.0);
      const int low = below(at), high = std::min(low + 1, size - 1);
      const double share = p - low;
      for (std::size_t k = 0; k < rule.place.size(); ++k) {
        const double w = weight[g] * (next - u) * cells * Lagrange(rule, k, (at - begin) * cells);
        axis.texels[static_cast<std::size_t>(low - axis.first)][k] += w * (1.0 - share);
        axis.texels[static_cast<std::size_t>(high - axis.first)][k] += w * share;
      }
    }
    u = next;
  }
  return axis;
}

}  // namespace

const GaussRuleOnUnit& GaussOnUnit(std::size_t nodes) {
  // [Abramowitz & Stegun 1964, table 25.4]
  const auto mirrored = [](std::vector<double> half_place, std::vector<double> half_weight) {
    GaussRuleOnUnit rule;
    for (std::size_t i = half_place.size(); i-- > 0;) {
      rule.place.push_back(0.5 - 0.5 * half_place[i]);
      rule.weight.push_back(0.5 * half_weight[i]);
    }
    for (std::size_t i = half_place[0] == 0.0 ? 1 : 0; i < half_place.size(); ++i) {
      rule.place.push_back(0.5 + 0.5 * half_place[i]);
      rule.weight.push_back(0.5 * half_weight[i]);
    }
    return rule;
  };
  static const GaussRuleOnUnit one = mirrored({0.0}, {2.0});
  static const GaussRuleOnUnit three = mirrored({0.0, 0.774596669241483}, {0.888888888888889, 0.555555555555556});
  static const GaussRuleOnUnit six = mirrored({0.238619186083197, 0.661209386466265, 0.932469514203152},
                                              {0.467913934572691, 0.360761573048139, 0.171324492379170});
  assert(nodes == 1 || nodes == 3 || nodes == 6);
  return nodes == 1 ? one : nodes == 3 ? three : six;
}

int TextureWeights::LevelsFor(const Image& texture, int most) {
  int levels = 1;
  while (levels < most && (1 << (levels - 1)) < std::max(texture.width, texture.height)) ++levels;
  return levels;
}

TextureWeights::TextureWeights(const Image& image, std::size_t nodes, int levels) : nodes_(nodes) {
  const GaussRuleOnUnit& rule = GaussOnUnit(nodes);
  const std::size_t count = nodes * nodes;
  const int depth = levels - 1;
  const int cells = 1 << depth;
  std::vector<AxisWeights> columns;
  for (int x = 0; x < cells; ++x) columns.push_back(MakeAxisWeights(rule, x, cells, image.width));
  // Of the level last made, square after square.
  std::vector<glm::dvec3> exact(static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells) * count, glm::dvec3(0.0));
  std::vector<glm::dvec3> row(nodes);
  for (int y = 0; y < cells; ++y) {
    const AxisWeights rows = MakeAxisWeights(rule, y, cells, image.height);
    for (int x = 0; x < cells; ++x) {
      glm::dvec3* square = &exact[static_cast<std::size_t>(y * cells + x) * count];
      const AxisWeights& column = columns[static_cast<std::size_t>(x)];
      for (std::size_t j = 0; j < rows.texels.size(); ++j) {
        std::fill(row.begin(), row.end(), glm::dvec3(0.0));
        const std::size_t at = (static_cast<std::size_t>(rows.first) + j) * static_cast<std::size_t>(image.width) +
                               static_cast<std::size_t>(column.first);
        for (std::size_t i = 0; i < column.texels.size(); ++i) {
          for (std::size_t k = 0; k < nodes; ++k) row[k] += column.texels[i][k] * glm::dvec3(image.pixels[at + i]);
        }
        for (std::size_t l = 0; l < nodes; ++l) {
          for (std::size_t k = 0; k < nodes; ++k) square[l * nodes + k] += rows.texels[j][l] * row[k];
        }
      }
    }
  }
  const auto keep = [&] { levels_.emplace_back(exact.begin(), exact.end()); };
  keep();
  // A square's polynomials are polynomials on its quarters: their weights follow from the quarters'.
  const auto down = [&](std::size_t half, std::size_t quarter_node, std::size_t node) {
    return Lagrange(rule, node, 0.5 * (static_cast<double>(half) + rule.place[quarter_node]));
  };
  std::vector<double> shares(2 * count);  // [half][quarter's node][node]
  for (std::size_t i = 0; i < shares.size(); ++i) shares[i] = down(i / count, i / nodes % nodes, i % nodes);
  for (int level = depth - 1; level >= 0; --level) {
    const auto side = std::size_t{1} << level;
    std::vector<glm::dvec3> squares(side * side * count, glm::dvec3(0.0));
    for (std::size_t q = 0; q < 4 * side * side; ++q) {
      const std::size_t qx = q % (2 * side), qy = q / (2 * side);
      const double *across = &shares[qx % 2 * count], *along = &shares[qy % 2 * count];
      glm::dvec3* square = &squares[(qy / 2 * side + qx / 2) * count];
      for (std::size_t j = 0; j < nodes; ++j) {
        std::fill(row.begin(), row.end(), glm::dvec3(0.0));
        for (std::size_t i = 0; i < nodes; ++i) {
          for (std::size_t k = 0; k < nodes; ++k) row[k] += across[i * nodes + k] * exact[q * count + j * nodes + i];
        }
        for (std::size_t l = 0; l < nodes; ++l) {
          for (std::size_t k = 0; k < nodes; ++k) square[l * nodes + k] += 0.25 * along[j * nodes + l] * row[k];
        }
      }
    }
    exact = std::move(squares);
    keep();
  }
  std::reverse(levels_.begin(), levels_.end());
}

std::span<const glm::vec3> TextureWeights::Of(int level, int x, int y) const {
  const std::size_t count = nodes_ * nodes_, square = (static_cast<std::size_t>(y) << level) + static_cast<std::size_t>(x);
  return std::span(levels_[static_cast<std::size_t>(level)]).subspan(square * count, count);
}

}  // namespace arealab
