// One light, one shaded point: closed form factor, and the specular integrals by the rule of
// glsl/polar_rule.glsl with Gauss nodes in batches that the compiler turns into vector code (without errno
// and traps of mathematics, see compare/CMakeLists.txt: else square roots and max stay scalar).
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "compare/closed_forms.h"
#include "compare/truth.h"
#include "compare/truth_levels.h"
// clang-format off: the order matters
#include "glsl/dual_begin.h"

// The library's is a call, which no loop becomes vector code around. Within 3e-16 for x in [−708, 709], its value at the end
// beyond: x = n ln 2 + r, |r| ≤ 0.347, Taylor's series of r to r¹³/13! (the next term is 4e-18), 2ⁿ in the exponent's bits.
[[gnu::always_inline]] inline double VectorExp(double x) {
  constexpr double kShift = 0x1.8p52;  // adding it rounds to the nearest integer, which its low bits then hold
  x = x < -708.0 ? -708.0 : x > 709.0 ? 709.0 : x;
  const double shifted = x * 1.4426950408889634 + kShift, n = shifted - kShift;
  const double r = (x - n * 0x1.62e42fefa3800p-1) - n * 0x1.ef35793c76730p-45;  // ln 2, its first part short enough for n
  double sum = 1.0 / 6227020800.0;
  sum = sum * r + 1.0 / 479001600.0;
  sum = sum * r + 1.0 / 39916800.0;
  sum = sum * r + 1.0 / 3628800.0;
  sum = sum * r + 1.0 / 362880.0;
  sum = sum * r + 1.0 / 40320.0;
  sum = sum * r + 1.0 / 5040.0;
  sum = sum * r + 1.0 / 720.0;
  sum = sum * r + 1.0 / 120.0;
  sum = sum * r + 1.0 / 24.0;
  sum = sum * r + 1.0 / 6.0;
  sum = sum * r + 0.5;
  sum = sum * r + 1.0;
  sum = sum * r + 1.0;
  return sum * std::bit_cast<double>((std::bit_cast<std::uint64_t>(shifted) + 1023u) << 52);
}

#define exp VectorExp
#include "glsl/polar_rule.glsl"
#include "glsl/brdf_choices.h"
#undef exp
#include "glsl/dual_end.h"
// clang-format on

namespace arealab {
namespace {

using dual::Arc;
using dual::LobeView;

constexpr int kMaxNodes = 64;  // of one Gauss rule

struct GaussRule {
  std::array<double, kMaxNodes> x{}, weight{};  // on [0, 1]
};

// Gauss–Legendre nodes by Newton's method on the Legendre recurrence, 1 to kMaxNodes points.
const GaussRule& Gauss(int count) {
  static const std::vector<GaussRule> rules = [] {
    std::vector<GaussRule> all(kMaxNodes + 1);
    for (int n = 1; n <= kMaxNodes; ++n) {
      for (int i = 0; i < n; ++i) {
        double x = std::cos(glm::pi<double>() * (i + 0.75) / (n + 0.5)), slope = 1.0;
        for (int step = 0; step < 8; ++step) {
          double p0 = 1.0, p1 = x;
          for (int k = 2; k <= n; ++k) {
            double p2 = ((2.0 * k - 1.0) * x * p1 - (k - 1.0) * p0) / k;
            p0 = p1;
            p1 = p2;
          }
          slope = n * (x * p1 - p0) / (x * x - 1.0);
          x -= p1 / slope;
        }
        all[static_cast<std::size_t>(n)].x[static_cast<std::size_t>(i)] = 0.5 * (1.0 - x);
        all[static_cast<std::size_t>(n)].weight[static_cast<std::size_t>(i)] =
            1.0 / ((1.0 - x * x) * slope * slope);
      }
    }
    return all;
  }();
  return rules[static_cast<std::size_t>(count)];
}

// A stretch of an arc, t = center + width·sinh u with u from u0 to u1.
struct Panel {
  int arc;
  double center, width, u0, u1;
};

// The outline of the visible part of a light, in panels, and the center of the rays.
struct Outline {
  static constexpr int kMaxArcs = 32;  // a tube's: two lines, two rims of up to five parts each, stretches of the horizon
  std::array<Arc, kMaxArcs> arcs;
  int arc_count = 0;
  std::array<Panel, 3 * kMaxArcs> panels;
  int panel_count = 0;
  dual::vec2 center{0.0};
  double ring = 0.0;   // where the rays begin: 0, or the circle about 0 that touches the outline
  double scale = 1.0;  // b: √(α² + |center|²)
  double reach = 0.0;  // y of the farthest sample of the outline
};

// Rays in batches: the inner loop runs over them. A node has r = origin + scale·p(reach·x).
struct Batch {
  static constexpr int kSize = 64;
  alignas(64) std::array<double, kSize> direction_x, along_center, origin, scale, reach, weight, sum,
      sum_grazing;
  int count = 0;
};

// Nodes on the outline before their rays are known: the slope, ds/dt, and dt with the node's weight.
struct OuterNodes {
  alignas(64) std::array<double, Batch::kSize> step, slope_x, slope_y, derivative_x, derivative_y;
  alignas(64) std::array<double, Batch::kSize> length, thickness, layer, layer_reach;
  int count = 0;
};

struct Sums {
  double specular = 0.0, grazing = 0.0;
  double absolute = 0.0;  // Σ|terms| of `specular`: what rounding is relative to, and how much cancels
};

// What the rays of a batch have in common.
struct RayRule {
  LobeView view;
  double center_x, center2;
  const GaussRule* nodes;
  int count, splits;
};

// The functions below are inlined into one caller for each instruction set.
#define AREALAB_INLINE inline __attribute__((always_inline))

// The radial integrals of a batch. `over_ggx`: see WithBrdf in glsl/brdf_choices.h.
template <typename OverGgx>
AREALAB_INLINE void SumRays(Batch& batch, const RayRule& rule, const OverGgx& over_ggx, Sums& sums) {
  int count = (batch.count + 3) & ~3;
  for (int i = batch.count; i < count; ++i) {
    auto j = static_cast<std::size_t>(i);
    batch.direction_x[j] = batch.along_center[j] = batch.origin[j] = batch.scale[j] = batch.reach[j] = 0.0;
    batch.weight[j] = 0.0;
  }
  const double* __restrict direction_x = batch.direction_x.data();
  const double* __restrict along_center = batch.along_center.data();
  const double* __restrict origin = batch.origin.data();
  const double* __restrict scale = batch.scale.data();
  const double* __restrict reach = batch.reach.data();
  double* __restrict sum = batch.sum.data();
  double* __restrict sum_grazing = batch.sum_grazing.data();
  for (int i = 0; i < count; ++i) {
    sum[i] = sum_grazing[i] = 0.0;
  }
  const LobeView view = rule.view;
  const double alpha2 = view.alpha * view.alpha, center_x = rule.center_x, center2 = rule.center2;
  for (int split = 0; split < rule.splits; ++split) {
    for (int k = 0; k < rule.count; ++k) {
      const double x = (split + rule.nodes->x[static_cast<std::size_t>(k)]) / rule.splits;
      const double w = rule.nodes->weight[static_cast<std::size_t>(k)] / rule.splits;
      for (int i = 0; i < count; ++i) {
        double p, derivative;
        dual::RayMap(reach[i] * x, p, derivative);
        double r = origin[i] + scale[i] * p;
        double slope2 = center2 + r * (2.0 * along_center[i] + r);
        dual::SlopeLight light = dual::LightAtSlope(view, center_x + r * direction_x[i], slope2);
        dual::vec2 f =
            dual::LobeWeights(light, over_ggx(view.cos_v, light.n_dot_l, light.v_dot_h, slope2, view.alpha));
        double tail = alpha2 + slope2;
        double measure = w * derivative * r / (tail * tail);
        sum[i] += measure * f.x;
        sum_grazing[i] += measure * f.y;
      }
    }
  }
  for (int i = 0; i < batch.count; ++i) {
    auto j = static_cast<std::size_t>(i);
    sums.specular += batch.weight[j] * batch.sum[j];
    sums.grazing += batch.weight[j] * batch.sum_grazing[j];
    sums.absolute += std::abs(batch.weight[j] * batch.sum[j]);
  }
  batch.count = 0;
}

// Adds the nodes of part `split` of a panel.
AREALAB_INLINE void AddNodes(OuterNodes& nodes, const Arc& arc, const Panel& panel, const LobeView& view,
                             const GaussRule& rule, int count, int split, int splits) {
  const double range = (panel.u1 - panel.u0) / splits;
  const double middle = std::exp(panel.u0 + range * (split + 0.5));
  const double center = panel.center, half_width = 0.5 * panel.width;
  double* __restrict step = nodes.step.data() + nodes.count;
  double* __restrict slope_x = nodes.slope_x.data() + nodes.count;
  double* __restrict slope_y = nodes.slope_y.data() + nodes.count;
  double* __restrict derivative_x = nodes.derivative_x.data() + nodes.count;
  double* __restrict derivative_y = nodes.derivative_y.data() + nodes.count;
  const double* __restrict x = rule.x.data();
  const double* __restrict weight = rule.weight.data();
  const Arc local = arc;
  for (int k = 0; k < count; ++k) {
    // e^δ as (e^(δ/32))^32 by Taylor's series: |δ| is below 16, so the remainder is below 1e-10, and the map
    // need not be exact, only smooth.
    double d = range * (x[k] - 0.5) * (1.0 / 32.0);
    double e =
        1.0 +
        d * (1.0 +
             d / 2 *
                 (1.0 +
                  d / 3 * (1.0 + d / 4 * (1.0 + d / 5 * (1.0 + d / 6 * (1.0 + d / 7 * (1.0 + d / 8)))))));
    e *= e;
    e *= e;
    e *= e;
    e *= e;
    e *= e;
    double grow = middle * e, shrink = 1.0 / grow;
    double t = center + half_width * (grow - shrink);
    step[k] = half_width * (grow + shrink) * range * weight[k];
    dual::vec2 slope, derivative;
    dual::ArcSlope(local, view, t, slope, derivative);
    slope_x[k] = slope.x;
    slope_y[k] = slope.y;
    derivative_x[k] = derivative.x;
    derivative_y[k] = derivative.y;
  }
  nodes.count += count;
}

// Makes the rays of the nodes and sums them.
template <typename OverGgx>
AREALAB_INLINE void FinishNodes(OuterNodes& nodes, const Outline& outline, const RayRule& rays,
                                const OverGgx& over_ggx, Sums& sums) {
  const LobeView view = rays.view;
  const double center_x = outline.center.x, center_y = outline.center.y, ring = outline.ring,
               b = outline.scale;
  const double factor = view.alpha * view.alpha / glm::pi<double>();
  Batch batch;
  const int count = nodes.count;
  bool any_layer = false;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    double x = nodes.slope_x[i] - center_x, y = nodes.slope_y[i] - center_y;
    double length2 = std::max(x * x + y * y, 1e-300), length = std::sqrt(length2), inv = 1.0 / length;
    double turn =
        (x * nodes.derivative_y[i] - y * nodes.derivative_x[i]) * inv * inv * nodes.step[i] * factor;
    x *= inv;
    y *= inv;
    double end = length - ring;
    // The layer of shadowing at the end; the cut is halfway in its logarithm.
    double thickness =
        dual::LayerLength(view, dual::vec2(nodes.slope_x[i], nodes.slope_y[i]), dual::vec2(x, y));
    double part = thickness * dual::kThinLayer < end
                      ? std::min(std::sqrt(thickness * std::max(end, 0.0)), 0.5 * end)
                      : 0.0;
    nodes.length[i] = length;
    nodes.thickness[i] = thickness;
    nodes.layer[i] = part;
    end -= part;
    double reach = dual::RayMapInverse(std::abs(end) / b), size = end < 0.0 ? -b : b;
    batch.direction_x[i] = x;
    batch.along_center[i] = center_x * x + center_y * y;
    batch.origin[i] = ring;
    batch.scale[i] = size;
    batch.reach[i] = reach;
    batch.weight[i] = turn * reach * size;
    nodes.layer_reach[i] = turn;
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    any_layer = any_layer || nodes.layer[i] > 0.0;
  }
  batch.count = count;
  if (any_layer) {
    Batch layers;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      if (nodes.layer[i] > 0.0) {
        auto j = static_cast<std::size_t>(layers.count++);
        double reach = dual::RayMapInverse(nodes.layer[i] / nodes.thickness[i]);
        layers.direction_x[j] = batch.direction_x[i];
        layers.along_center[j] = batch.along_center[i];
        layers.origin[j] = nodes.length[i];
        layers.scale[j] = -nodes.thickness[i];
        layers.reach[j] = reach;
        layers.weight[j] = nodes.layer_reach[i] * reach * nodes.thickness[i];
      }
    }
    SumRays(layers, rays, over_ggx, sums);
  }
  SumRays(batch, rays, over_ggx, sums);
  nodes.count = 0;
}

template <typename OverGgx>
AREALAB_INLINE Sums IntegrateBody(const Outline& outline, const LobeView& view, const TruthLevel& level,
                                  const OverGgx& over_ggx) {
  Sums sums;
  OuterNodes nodes;
  const int radial =
      std::min(static_cast<int>(std::ceil(level.radial + level.radial_per_reach * outline.reach)), kMaxNodes);
  const RayRule rays{view,           outline.center.x, glm::dot(outline.center, outline.center),
                     &Gauss(radial), radial,           level.splits};
  for (int p = 0; p < outline.panel_count; ++p) {
    const Panel& panel = outline.panels[static_cast<std::size_t>(p)];
    const Arc& arc = outline.arcs[static_cast<std::size_t>(panel.arc)];
    const int count = std::min(
        static_cast<int>(std::ceil(level.outer + level.outer_per_range * (panel.u1 - panel.u0))), kMaxNodes);
    const GaussRule& rule = Gauss(count);
    for (int split = 0; split < level.splits; ++split) {
      if (nodes.count + count > Batch::kSize) {
        FinishNodes(nodes, outline, rays, over_ggx, sums);
      }
      AddNodes(nodes, arc, panel, view, rule, count, split, level.splits);
    }
  }
  FinishNodes(nodes, outline, rays, over_ggx, sums);
  return sums;
}

template <typename OverGgx>
__attribute__((target("avx2,fma"), flatten)) Sums IntegrateAvx2(const Outline& outline, const LobeView& view,
                                                                const TruthLevel& level,
                                                                const OverGgx& over_ggx) {
  return IntegrateBody(outline, view, level, over_ggx);
}
template <typename OverGgx>
__attribute__((flatten)) Sums IntegratePlain(const Outline& outline, const LobeView& view,
                                             const TruthLevel& level, const OverGgx& over_ggx) {
  return IntegrateBody(outline, view, level, over_ggx);
}

Sums Integrate(const Outline& outline, const LobeView& view, const TruthLevel& level, Brdf brdf) {
  static const bool kAvx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return dual::WithBrdf(brdf, view.roughness, [&](const auto& over_ggx) {
    return kAvx2 ? IntegrateAvx2(outline, view, level, over_ggx)
                 : IntegratePlain(outline, view, level, over_ggx);
  });
}

// Adds the great-circle arc from p to q (any lengths).
void AddGreatCircle(Outline& outline, const glm::dvec3& p, const glm::dvec3& q) {
  glm::dvec3 a = glm::normalize(p), b = glm::normalize(q);
  glm::dvec3 middle = a + b, along = b - a;
  double cosine = glm::length(middle), sine = glm::length(along);
  if (sine == 0.0 || cosine == 0.0) {
    return;
  }
  Arc& arc = outline.arcs[static_cast<std::size_t>(outline.arc_count++)];
  arc.axis_1 = middle / cosine;
  arc.axis_2 = along / sine;
  arc.axis_3 = glm::dvec3(0.0);
  arc.sin_1 = arc.sin_2 = 1.0;
  arc.cos_1 = arc.cos_2 = 0.0;
  arc.t1 = sine / (2.0 + cosine);  // tan of a quarter of the arc's angle
  arc.t0 = -arc.t1;
}

// Adds the part of a cone's outline from angle `begin` to `end`, cut at the ends of its axes; `clipped`: both
// ends are on the horizon.
void AddCone(Outline& outline, const LightCone& cone, double begin, double end) {
  constexpr double kQuarter = 0.5 * glm::pi<double>();
  for (int quarter = static_cast<int>(std::floor(begin / kQuarter)); quarter * kQuarter < end; ++quarter) {
    int half = (quarter + 1) >> 1;  // measured from the nearer end of the long axis: even 0, odd π
    double low = quarter * kQuarter, high = low + kQuarter;
    double from = std::max(begin, low), to = std::min(end, high);
    if (from >= to) {
      continue;
    }
    double sign = half % 2 == 0 ? 1.0 : -1.0, zero = half * 2.0 * kQuarter;
    Arc& arc = outline.arcs[static_cast<std::size_t>(outline.arc_count++)];
    arc.axis_1 = cone.axis_1 * sign;
    arc.axis_2 = cone.axis_2 * sign;
    arc.axis_3 = cone.axis_3;
    arc.sin_1 = cone.sin_1;
    arc.cos_1 = cone.cos_1;
    arc.sin_2 = cone.sin_2;
    arc.cos_2 = cone.cos_2;
    arc.t0 = std::tan(0.5 * (from - zero));
    arc.t1 = std::tan(0.5 * (to - zero));
  }
}

// What is above the horizon of a closed outline, piece by piece, with its form factor's contour integral; pieces that end on the horizon
// are joined along it.
class ClippedOutline {
 public:
  ClippedOutline(Outline& outline, double& contour) : outline_(outline), contour_(contour) {}

  void Line(glm::dvec3 p, glm::dvec3 q) {
    if (p.z <= 0.0 && q.z <= 0.0) return;
    const glm::dvec3 cut = p.z == q.z ? p : p + (q - p) * (p.z / (p.z - q.z));
    if (p.z < 0.0) p = glm::dvec3(cut.x, cut.y, 0.0);
    if (q.z < 0.0) q = glm::dvec3(cut.x, cut.y, 0.0);
    Join(p);
    Chord(p, q);
    at_ = q;
  }

  // From ψ = from to `to`, which may run either way.
  void Curve(const LightCone& cone, double from, double to) {
    const bool back = to < from;
    const ConeHorizon horizon = ClipToHorizon(cone);
    if (horizon.kind == ConeHorizon::Kind::kBelow) return;
    const double low = std::min(from, to), high = std::max(from, to);
    std::array<std::pair<double, double>, 5> parts;
    int count = 0;
    if (horizon.kind == ConeHorizon::Kind::kAbove) {
      parts[static_cast<std::size_t>(count++)] = {low, high};
    } else {
      for (int turn = -2; turn <= 2; ++turn) {
        const double shift = turn * 2.0 * glm::pi<double>();
        const double begin = std::max(low, horizon.psi_begin + shift), end = std::min(high, horizon.psi_end + shift);
        if (begin < end) parts[static_cast<std::size_t>(count++)] = {begin, end};
      }
    }
    LightCone mirrored = cone;
    mirrored.axis_2 = -cone.axis_2;
    if (back) std::reverse(parts.begin(), parts.begin() + count);
    for (int i = 0; i < count; ++i) {
      const auto [begin, end] = parts[static_cast<std::size_t>(i)];
      const glm::dvec3 first = At(cone, back ? end : begin, back ? end < high : begin > low);
      const glm::dvec3 last = At(cone, back ? begin : end, back ? begin > low : end < high);
      Join(first);
      contour_ += (back ? -1.0 : 1.0) * ConeContour(cone, begin, end);
      back ? AddCone(outline_, mirrored, -end, -begin) : AddCone(outline_, cone, begin, end);
      at_ = last;
    }
  }

  void Close() {
    if (start_) Join(*start_);
  }

 private:
  static glm::dvec3 At(const LightCone& cone, double psi, bool on_horizon) {
    const double c = std::cos(psi), s = std::sin(psi);
    glm::dvec3 p = cone.axis_1 * (cone.sin_1 * c) + cone.axis_2 * (cone.sin_2 * s) + cone.axis_3 * std::hypot(cone.cos_1 * c, cone.cos_2 * s);
    if (on_horizon) p.z = 0.0;
    return p;
  }

  void Chord(const glm::dvec3& p, const glm::dvec3& q) {
    const glm::dvec3 a = glm::normalize(p), b = glm::normalize(q), along = b - a, middle = a + b;
    const double sine = glm::length(along), cosine = glm::length(middle);
    if (sine == 0.0 || cosine == 0.0) return;
    contour_ += 2.0 * std::atan2(sine, cosine) * (middle.x * along.y - middle.y * along.x) / (sine * cosine);
    AddGreatCircle(outline_, p, q);
  }

  // Along the horizon from where the last piece ended; nothing where the next begins there.
  void Join(const glm::dvec3& p) {
    if (!start_) start_ = p;
    if (at_ && at_->z == 0.0 && p.z == 0.0) Chord(*at_, p);
    at_ = p;
  }

  Outline& outline_;
  double& contour_;
  std::optional<glm::dvec3> start_, at_;
};

// Adds the outline of what the origin sees of a tube: of the wall, whose ends are open, what lies between the lines where planes through
// the origin touch it; front halves of the rims, or less, join these. half_size: half its length, its radius. False where it sees none.
bool AddTube(Outline& outline, const glm::dvec3& center, const glm::dvec3& axis, const glm::dvec2& half_size, const glm::dvec3& mirror,
             double& form_factor, bool& mirror_inside) {
  const double radius = half_size.y, along = -glm::dot(center, axis);
  const glm::dvec3 away = -center - axis * along;  // from the axis
  const double distance = glm::length(away);
  if (distance <= radius) return false;
  const glm::dvec3 front = away / distance, side = glm::cross(axis, front);
  const double cosine = radius / distance, sine = std::sqrt((distance - radius) * (distance + radius)) / distance;
  const auto middle = [&](double end) { return center + axis * (half_size.x * end); };  // of a rim
  const auto corner = [&](double of, double end) { return middle(end) + front * (radius * cosine) + side * (radius * sine * of); };
  double contour = 0.0;
  ClippedOutline path(outline, contour);
  const auto rim = [&](double end, double from) {
    const double over = glm::dot(middle(end), axis);  // of the rim's plane, from the origin
    if (std::abs(over) < 1e-9 * radius) {             // edge-on
      path.Line(corner(from, end), corner(-from, end));
      return;
    }
    const LightCone cone = DiskCone(middle(end), over > 0.0 ? -axis : axis, radius);
    const auto psi = [&](const glm::dvec3& p) { return std::atan2(glm::dot(p, cone.axis_2) / cone.sin_2, glm::dot(p, cone.axis_1) / cone.sin_1); };
    const double begin = psi(corner(from, end)), turn = 2.0 * glm::pi<double>();
    const double half_way = begin + std::remainder(psi(middle(end) + front * radius) - begin, turn);
    path.Curve(cone, begin, half_way + std::remainder(psi(corner(-from, end)) - half_way, turn));
  };
  path.Line(corner(-1.0, -1.0), corner(-1.0, 1.0));
  rim(1.0, -1.0);
  path.Line(corner(1.0, 1.0), corner(1.0, -1.0));
  rim(-1.0, 1.0);
  path.Close();
  form_factor = std::max(contour / (2.0 * glm::pi<double>()), 0.0);
  // Where the mirrored ray first meets the cylinder: of a t² + 2bt + c = 0 the lesser root.
  const glm::dvec3 across = mirror - axis * glm::dot(mirror, axis);
  const double a = glm::dot(across, across), b = glm::dot(across, away), c = (distance - radius) * (distance + radius), d = b * b - a * c;
  mirror_inside = b < 0.0 && d > 0.0 && std::abs(along + c / (std::sqrt(d) - b) * glm::dot(mirror, axis)) < half_size.x;
  return outline.arc_count > 0;
}

// Cuts an arc into panels, each about the place where most happens.
void AddPanels(Outline& outline, const LobeView& view, int index, double foot, double width) {
  const Arc& arc = outline.arcs[static_cast<std::size_t>(index)];
  auto add = [&](double t0, double t1, double center, double size) {
    if (t1 > t0) {
      outline.panels[static_cast<std::size_t>(outline.panel_count++)] =
          Panel{index, center, size, std::asinh((t0 - center) / size), std::asinh((t1 - center) / size)};
    }
  };
  double t0 = arc.t0, t1 = arc.t1, half = 0.5 * (arc.t1 - arc.t0);
  // A layer of shadowing at an end that comes down to the horizon, or the tip of a thin outline at t = 0.
  auto crowd = [&](double end, double size) {
    double spacing = std::sqrt(width * width + (end - foot) * (end - foot));
    return size * dual::kThinLayer < std::min(spacing, 2.0 * half) ? std::min(std::sqrt(size * spacing), half)
                                                                   : 0.0;
  };
  double height, rise;
  dual::ArcHeight(arc, t0, height, rise);
  double layer_0 = (height + dual::LayerHeight(view)) / std::max(rise, 1e-9);
  dual::ArcHeight(arc, t1, height, rise);
  double layer_1 = (height + dual::LayerHeight(view)) / std::max(-rise, 1e-9);
  if (arc.cos_2 > 0.0) {
    double tip = std::max(0.5 * arc.cos_1 / arc.cos_2, 1e-12);
    layer_0 = arc.t0 == 0.0 ? std::min(layer_0, tip) : layer_0;
    layer_1 = arc.t1 == 0.0 ? std::min(layer_1, tip) : layer_1;
  }
  double cut_0 = crowd(t0, layer_0), cut_1 = crowd(t1, layer_1);
  add(t0, t0 + cut_0, t0, layer_0);
  add(t0 + cut_0, t1 - cut_1, foot, width);
  add(t1 - cut_1, t1, t1, layer_1);
}

// Whether the lobe's tail falls as exp(−|s|²/α²) or nearly so, where GGX's falls as |s|⁻⁴.
bool IsSteep(Brdf brdf) {
  return brdf != Brdf::kGgx && brdf != Brdf::kGgxSeparable && !IsDiffuse(brdf);
}

// The outline's nearest points to the center, hence its panels; 5 samples on each arc to begin with.
void MakePanels(Outline& outline, const LobeView& view, bool steep, bool mirror_inside) {
  constexpr int kSamples = 5;
  constexpr int kCuts = 10, kSteps = 3;  // of halving, then of Gauss–Newton towards the nearest point
  using dual::vec2;
  const int arc_count = outline.arc_count;
  std::array<std::array<vec2, kSamples>, Outline::kMaxArcs> samples;
  auto time = [](const Arc& arc, int i) { return arc.t0 + (arc.t1 - arc.t0) * i / (kSamples - 1); };
  vec2 unused;
  for (int a = 0; a < arc_count; ++a) {
    const Arc& arc = outline.arcs[static_cast<std::size_t>(a)];
    for (int i = 0; i < kSamples; ++i) {
      dual::ArcSlope(arc, view, time(arc, i),
                     samples[static_cast<std::size_t>(a)][static_cast<std::size_t>(i)], unused);
    }
  }
  struct Chord {
    double t0, t1;
    vec2 begin, end;
    double part, distance2;  // where it is nearest, and how near
  };
  auto chord_to = [](const vec2& to, double t0, const vec2& begin, double t1, const vec2& end) {
    vec2 from = begin - to, along = end - begin;
    double part = std::clamp(-glm::dot(from, along) / std::max(glm::dot(along, along), 1e-300), 0.0, 1.0);
    vec2 at = from + along * part;
    return Chord{t0, t1, begin, end, part, glm::dot(at, at)};
  };
  // The nearest chord between samples, so that a near pass between two of them is not missed.
  auto nearest_chord = [&](int a, const vec2& to) {
    const Arc& arc = outline.arcs[static_cast<std::size_t>(a)];
    const auto& here = samples[static_cast<std::size_t>(a)];
    Chord best{};
    for (std::size_t i = 0; i + 1 < kSamples; ++i) {
      int k = static_cast<int>(i);
      Chord chord = chord_to(to, time(arc, k), here[i], time(arc, k + 1), here[i + 1]);
      best = i == 0 || chord.distance2 < best.distance2 ? chord : best;
    }
    return best;
  };
  struct Foot {
    double t, offset, distance2;
    vec2 slope, derivative;
  };
  // The point of an arc nearest to `to`, to within `slack`; t + offset is the foot on the tangent there,
  // beyond the arc where it may be.
  auto refine = [&](int a, const vec2& to, Chord best, double slack) {
    const Arc& arc = outline.arcs[static_cast<std::size_t>(a)];
    double low = best.t0, high = best.t1;
    Foot foot{};
    // Halves the chord while the arc runs unevenly along it.
    for (int cut = 0; cut < kCuts; ++cut) {
      foot.t = 0.5 * (best.t0 + best.t1);
      dual::ArcSlope(arc, view, foot.t, foot.slope, foot.derivative);
      vec2 bend = foot.slope - 0.5 * (best.begin + best.end), along = best.end - best.begin;
      double length2 = glm::dot(along, along), bend2 = glm::dot(bend, bend);
      bool even = bend2 < 0.01 * length2;
      Chord first = chord_to(to, best.t0, best.begin, foot.t, foot.slope),
            second = chord_to(to, foot.t, foot.slope, best.t1, best.end);
      best = first.distance2 <= second.distance2 ? first : second;
      if (even) {
        break;
      }
    }
    foot.t = best.t0 + best.part * (best.t1 - best.t0);
    for (int step = 0;; ++step) {
      dual::ArcSlope(arc, view, foot.t, foot.slope, foot.derivative);
      vec2 offset = foot.slope - to;
      double speed2 = std::max(glm::dot(foot.derivative, foot.derivative), 1e-300);
      foot.offset = -glm::dot(offset, foot.derivative) / speed2;
      foot.distance2 = glm::dot(offset, offset);
      double next = std::clamp(foot.t + foot.offset, low, high), move = next - foot.t;
      if (step == kSteps || move * move * speed2 < slack * slack) {
        return foot;
      }
      foot.t = next;
    }
  };
  outline.center = vec2(0.0);
  if (!mirror_inside) {
    std::array<Chord, Outline::kMaxArcs> chords;
    double least = std::numeric_limits<double>::max();
    for (int a = 0; a < arc_count; ++a) {
      chords[static_cast<std::size_t>(a)] = nearest_chord(a, vec2(0.0));
      least = std::min(least, chords[static_cast<std::size_t>(a)].distance2);
    }
    // Arcs whose chords are more than twice as far can hardly be nearest, and the center need not be.
    double bound = 4.0 * least + view.alpha * view.alpha;
    least = std::numeric_limits<double>::max();
    for (int a = 0; a < arc_count; ++a) {
      const Chord& chord = chords[static_cast<std::size_t>(a)];
      if (chord.distance2 <= bound) {
        Foot foot = refine(a, vec2(0.0), chord, 0.01 * view.alpha);
        if (foot.distance2 < least) {
          least = foot.distance2;
          outline.center = foot.slope;
        }
      }
    }
  }
  outline.scale = std::sqrt(view.alpha * view.alpha + glm::dot(outline.center, outline.center));
  // From c outwards exp(−|s|²/α²) falls over α²/|c|, and along the outline over α.
  const double across_scale = steep ? view.alpha : outline.scale;
  if (steep) outline.scale = view.alpha * view.alpha / outline.scale;
  // Where rays from the center to the far side of the outline pass close by 0, over the lobe's peak, radial
  // rays from a ring serve better.
  double center2 = glm::dot(outline.center, outline.center);
  bool over_peak = false;
  if (center2 > 0.25 * view.alpha * view.alpha) {
    for (int a = 0; a < arc_count && !over_peak; ++a) {
      for (const vec2& sample : samples[static_cast<std::size_t>(a)]) {
        vec2 ray = sample - outline.center;
        double length2 = std::max(glm::dot(ray, ray), 1e-300), back = -glm::dot(ray, outline.center);
        over_peak = over_peak || (back > 0.0 && back < length2 && back * back > 0.75 * center2 * length2);
      }
    }
  }
  if (over_peak) {
    outline.ring = std::sqrt(center2);
    outline.center = vec2(0.0);
  }
  double farthest2 = 0.0;
  for (int a = 0; a < arc_count; ++a) {
    for (const vec2& sample : samples[static_cast<std::size_t>(a)]) {
      vec2 offset = sample - outline.center;
      farthest2 = std::max(farthest2, glm::dot(offset, offset));
    }
    Foot foot = refine(a, outline.center, nearest_chord(a, outline.center), 0.02 * outline.scale);
    double speed2 = std::max(glm::dot(foot.derivative, foot.derivative), 1e-300);
    double along = foot.offset * foot.offset * speed2;
    double across = std::max(foot.distance2 - along, 0.0);
    // Rays from a ring leave a pole where the outline's continuation meets 0.
    double blur2 = over_peak ? 0.0 : across_scale * across_scale;
    double width = std::min(std::sqrt((blur2 + across) / speed2), 8.0);
    AddPanels(outline, view, a, foot.t + foot.offset, width);
  }
  outline.reach = dual::RayMapInverse(std::sqrt(farthest2) / outline.scale);
}

}  // namespace

const std::array<TruthLevel, kTruthLevelCount>& TruthLevels() {
  static const std::array<TruthLevel, kTruthLevelCount> levels = {{{2.0, 1.0, 2.0, 3.0, 1},
                                                                   {3.0, 1.25, 3.0, 4.0, 1},
                                                                   {4.0, 1.5, 4.0, 5.0, 1},
                                                                   {5.0, 2.0, 5.0, 6.0, 1},
                                                                   {7.0, 2.5, 7.0, 8.0, 1},
                                                                   {9.0, 3.0, 10.0, 12.0, 1},
                                                                   {9.0, 3.0, 10.0, 12.0, 2},
                                                                   {12.0, 3.5, 12.0, 14.0, 3},
                                                                   {12.0, 3.5, 12.0, 14.0, 8}}};
  return levels;
}

LightIntegrals IntegrateLightAtLevel(const ShadingPoint& point, const Light& light, int level);

namespace {

// Everything about one point and light that does not depend on the level.
bool MakeOutline(const ShadingPoint& point, const Light& light, Outline& outline, LobeView& view,
                 LightIntegrals& result) {
  double cos_v = glm::dot(point.normal, point.to_view);
  glm::dvec3 across = point.to_view - point.normal * cos_v;
  double sin_v = glm::length(across);
  glm::dvec3 x_axis = sin_v > 1e-12
                          ? across / sin_v
                          : glm::normalize(glm::cross(point.normal, std::abs(point.normal.x) < 0.5
                                                                        ? glm::dvec3(1.0, 0.0, 0.0)
                                                                        : glm::dvec3(0.0, 1.0, 0.0)));
  glm::dvec3 y_axis = glm::cross(point.normal, x_axis);
  auto local = [&](const glm::dvec3& d) {
    return glm::dvec3(glm::dot(d, x_axis), glm::dot(d, y_axis), glm::dot(d, point.normal));
  };
  view.sin_v = sin_v;
  view.cos_v = cos_v;
  view.alpha = point.alpha;
  view.roughness = point.roughness;
  glm::dvec3 mirror(-sin_v, 0.0, cos_v);
  glm::dvec3 center = local(light.center - point.position);
  bool mirror_inside = true;
  if (light.shape == LightShape::kRectangle || light.shape == LightShape::kPolygon) {
    double height = -glm::dot(center, local(light.normal));  // of the point above the lit side
    if (height == 0.0 || (height < 0.0 && !light.two_sided)) {
      return false;
    }
    // Counter-clockwise seen from outside the sphere of directions: as from behind the light.
    std::array<glm::dvec3, kMostCorners> corners;
    std::size_t count = 4;
    if (light.shape == LightShape::kRectangle) {
      glm::dvec3 a = local(light.axis_x) * light.half_size.x, b = local(light.axis_y) * light.half_size.y;
      std::ranges::copy(std::array{center - a - b, center - a + b, center + a + b, center + a - b}, corners.begin());
    } else {
      count = light.corners.size();
      glm::dvec3 x = local(light.axis_x), y = local(light.axis_y);
      std::transform(light.corners.rbegin(), light.corners.rend(), corners.begin(),
                     [&](const glm::dvec2& c) { return center + x * c.x + y * c.y; });
    }
    if (height < 0.0) {
      std::reverse(corners.begin() + 1, corners.begin() + static_cast<std::ptrdiff_t>(count));
    }
    HorizonPolygon polygon = ClipToHorizon(std::span(corners.data(), count));
    if (polygon.count < 3) {
      return false;
    }
    result.form_factor = std::max(PolygonFormFactor(polygon), 0.0);
    if (cos_v <= 0.0) {
      return true;
    }
    for (int i = 0; i < polygon.count; ++i) {
      const glm::dvec3& p = polygon.corners[static_cast<std::size_t>(i)];
      const glm::dvec3& q = polygon.corners[static_cast<std::size_t>((i + 1) % polygon.count)];
      AddGreatCircle(outline, p, q);
      mirror_inside = mirror_inside && glm::dot(glm::cross(p, q), mirror) > 0.0;
    }
  } else if (light.shape == LightShape::kTube) {
    if (!AddTube(outline, center, local(light.axis_x), light.half_size, mirror, result.form_factor, mirror_inside)) return false;
    if (cos_v <= 0.0) return true;
  } else {
    LightCone cone;
    if (IsFlat(light.shape)) {
      glm::dvec3 normal = local(light.normal);
      double height = -glm::dot(center, normal);
      if (height == 0.0 || (height < 0.0 && !light.two_sided)) {
        return false;
      }
      normal = height < 0.0 ? -normal : normal;
      cone = light.shape == LightShape::kDisk
                 ? DiskCone(center, normal, light.half_size.x)
                 : EllipseCone(center, local(light.axis_x) * light.half_size.x, local(light.axis_y) * light.half_size.y, normal);
    } else {
      if (glm::length(center) <= light.half_size.x) {
        return false;
      }
      cone = SphereCone(center, light.half_size.x);
    }
    ConeHorizon horizon = ClipToHorizon(cone);
    if (horizon.kind == ConeHorizon::Kind::kBelow) {
      return false;
    }
    result.form_factor = std::max(ConeFormFactor(cone, horizon), 0.0);
    if (cos_v <= 0.0) {
      return true;
    }
    if (horizon.kind == ConeHorizon::Kind::kAbove) {
      AddCone(outline, cone, 0.0, 2.0 * glm::pi<double>());
    } else {
      AddCone(outline, cone, horizon.psi_begin, horizon.psi_end);
      auto at = [&](double psi) {
        double c = std::cos(psi), s = std::sin(psi);
        glm::dvec3 p = cone.axis_1 * (cone.sin_1 * c) + cone.axis_2 * (cone.sin_2 * s) +
                       cone.axis_3 * std::hypot(cone.cos_1 * c, cone.cos_2 * s);
        p.z = 0.0;
        return p;
      };
      AddGreatCircle(outline, at(horizon.psi_end), at(horizon.psi_begin));
    }
    double m1 = glm::dot(mirror, cone.axis_1) * cone.cos_1 / cone.sin_1;
    double m2 = glm::dot(mirror, cone.axis_2) * cone.cos_2 / cone.sin_2;
    double m3 = glm::dot(mirror, cone.axis_3);
    mirror_inside = m3 > 0.0 && m1 * m1 + m2 * m2 < m3 * m3;
  }
  MakePanels(outline, view, IsSteep(point.brdf), mirror_inside);
  return true;
}

}  // namespace

LightIntegrals IntegrateLightAtLevel(const ShadingPoint& point, const Light& light, int level) {
  LightIntegrals result;
  Outline outline;
  LobeView view;
  if (!MakeOutline(point, light, outline, view, result) || view.cos_v <= 0.0) {
    return result;
  }
  Sums sums = Integrate(outline, view, TruthLevels()[static_cast<std::size_t>(level)], point.brdf);
  result.specular = sums.specular;
  result.specular_grazing = sums.grazing;
  return result;
}

}  // namespace arealab

namespace arealab {

namespace {

constexpr double kFormFactorRounding = 1e-12;
constexpr double kRounding = 1e-12;  // of the sum of absolute terms
// Two levels that differ by no more than this share of the tolerance are believed: with it the tolerances
// 1e-3 and 1e-4 were exceeded in 0.03 and 0.04 % of the 20 000 first of tests/compare/hard_configurations.h,
// against the finest level but one. Where terms cancel, agreement by chance is likelier.
constexpr double kShare = 0.5, kCautiousShare = 0.1, kMuchCancels = 3.0;
// What is stated is this times the difference of the last two levels. Steep lobes converge late and then at
// once: their first levels agree by chance (with the others' settings 4 of the 20 steep cases of
// tests/compare/truth_independent_test.cpp had a point whose error was up to 5 times the stated one).
constexpr double kSpread = 2.0, kSteepSpread = 4.0;
constexpr std::size_t kSteepFirst = 3;
// Of a steep lobe's tail: less than this is nothing beside what the light's other lobes and pixels give (the
// peak gives about 1), and nobody asks for its digits.
constexpr double kSteepNothing = 1e-9;
// A tube is not believed early either: where the horizon cuts its rims, levels come nearer slowly, 5e-5 a step (at roughness 0.1 two of the 24 cases of
// tests/compare/truth_independent_test.cpp were off by 1.8e-4 and 9e-5).
constexpr std::size_t kTubeFirst = 2;
// A difference can be small by chance: no error below this share of the tolerance is stated.
constexpr double kLeastStated = 0.25;

// The closed form factor, and the specular lobe.
LightIntegrals IntegrateLobe(const ShadingPoint& point, const Light& light, double tolerance) {
  LightIntegrals result;
  Outline outline;
  LobeView view;
  if (!MakeOutline(point, light, outline, view, result)) {
    return result;
  }
  result.form_factor_error = kFormFactorRounding * std::max(result.form_factor, kFormFactorRounding);
  if (view.cos_v <= 0.0) {
    return result;
  }
  const bool steep = IsSteep(point.brdf);
  const double nothing = steep ? kSteepNothing : 0.0, spread = steep ? kSteepSpread : kSpread;
  // From the second level on, two that agree are believed; where much cancels, only from the third on.
  const bool tube = light.shape == LightShape::kTube;
  const std::size_t first = steep ? kSteepFirst : tube ? kTubeFirst : tolerance < 2.5e-4 ? 1 : 0;
  Sums before = Integrate(outline, view, TruthLevels()[first], point.brdf);
  for (std::size_t level = first + 1; level < kTruthLevelCount; ++level) {
    Sums sums = Integrate(outline, view, TruthLevels()[level], point.brdf);
    double change = std::abs(sums.specular - before.specular),
           change_grazing = std::abs(sums.grazing - before.grazing);
    result.specular = std::max(sums.specular, 0.0);
    result.specular_grazing = std::max(sums.grazing, 0.0);
    double floor = kLeastStated * tolerance;
    result.specular_error = std::max({spread * change, floor * result.specular, kRounding * sums.absolute});
    result.specular_grazing_error =
        std::max({spread * change_grazing, floor * result.specular_grazing, kRounding * sums.absolute});
    double share = steep || tube || sums.absolute > kMuchCancels * sums.specular ? kCautiousShare : kShare;
    if (change <= share * tolerance * sums.specular + nothing &&
        change_grazing <= share * tolerance * (sums.grazing + 0.04 * sums.specular) + nothing) {
      break;
    }
    before = sums;
  }
  return result;
}

}  // namespace

LightIntegrals IntegrateLight(const ShadingPoint& point, const Light& light, double tolerance) {
  LightIntegrals result = IntegrateLobe(point, light, tolerance);
  if (point.diffuse == Brdf::kLambert || result.form_factor == 0.0) return result;
  ShadingPoint matte = point;
  matte.brdf = point.diffuse;
  matte.alpha = 1.0;
  const LightIntegrals lobe = IntegrateLobe(matte, light, tolerance);
  result.form_factor = lobe.specular;
  result.form_factor_error = lobe.specular_error;
  return result;
}

}  // namespace arealab
