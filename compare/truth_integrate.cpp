// One light, one shaded point: closed form factor, and the specular integrals by the rule of
// glsl/polar_rule.glsl with Gauss nodes in batches that the compiler turns into vector code (without errno
// and traps of mathematics, see compare/CMakeLists.txt: else square roots and max stay scalar).
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <type_traits>
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

// A stretch of an arc, t = center + width·(e − 1/e)/2 with e = middle·exp(range·(x − ½)), x from 0 to 1.
struct Panel {
  int arc;
  double center, width, middle, range;
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

constexpr int kBatch = 64, kPad = 8;  // a batch's nodes, and room for what runs in eights
template <typename Real>
using Column = std::array<Real, kBatch + kPad>;

// The numerators and the denominator of the slope of an arc, with a center taken off: quadratics in t, plus a part of its own where the
// arc is no great circle.
struct ArcCurve {
  glm::dvec3 k0, k1, k2, curved;
  double cos_1, cos_2;

  ArcCurve(const Arc& arc, const LobeView& view, const dual::vec2& center) : cos_1(arc.cos_1), cos_2(arc.cos_2) {
    const glm::dvec3 v(view.sin_v, 0.0, view.cos_v), a = arc.axis_1 * arc.sin_1;
    const auto from = [&](const glm::dvec3& q) { return glm::dvec3(q.x - center.x * q.z, q.y - center.y * q.z, q.z); };
    k0 = from(v + a);
    k1 = from(arc.axis_2 * (2.0 * arc.sin_2));
    k2 = from(v - a);
    curved = from(arc.axis_3);
  }
};

// Nodes on the outline: of panels, x in the panel as d = range·(x − ½)/32, with the node's weight. A run of them is on one arc.
struct OuterNodes {
  struct Run {
    int arc, begin, count;
  };
  alignas(64) Column<double> d, weight, center, half_width, middle;
  std::array<Run, kBatch> runs;
  int run_count = 0, count = 0;
};

// Rays in batches. A node has r = origin + scale·p(reach·x) along a direction e.
struct Rays {
  alignas(64) Column<double> rise, along, origin, scale, reach, weight;  // rise = sin_v·e_x, along = 2 c·e, scale twice that of r
  alignas(64) Column<double> e_x, e_y, length, thin;                     // thin: 1 where a thin layer of shadowing is at the end, else 0
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
bool HasAvx2() {
  static const bool kHas = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return kHas;
}

// As many numbers as one instruction takes.
template <typename Real>
using Wide [[gnu::vector_size(32)]] = Real;
using Lanes = Wide<double>;
using LaneMask = decltype(Lanes() < Lanes());
constexpr int kLanes = 4;
template <typename Vector>
AREALAB_INLINE Vector Root(Vector x) {
  for (std::size_t j = 0; j < sizeof x / sizeof x[0]; ++j) x[j] = std::sqrt(x[j]);
  return x;
}
template <typename Vector>
AREALAB_INLINE Vector Least(Vector a, Vector b) {
  return a < b ? a : b;
}
template <typename Vector>
AREALAB_INLINE Vector Most(Vector a, Vector b) {
  return a > b ? a : b;
}
template <typename Vector>
AREALAB_INLINE Vector Abs(Vector x) {
  return Most(x, -x);
}
AREALAB_INLINE bool Any(LaneMask m) { return (m[0] | m[1] | m[2] | m[3]) != 0; }

// A BRDF as its text has it, `over_ggx`: see WithBrdf in glsl/brdf_choices.h.
template <typename OverGgx>
struct TextOf {
  using Real = double;
  const OverGgx& over_ggx;
};
// GGX with height-correlated masking, with what it has in common with the rule taken together: with D = 1 + |s|², N = D n·l,
// A = √((n·v)²(1 − α²) + α²), SmithVisibility · n·l = ½N / (N A + n·v √(N²(1 − α²) + α²D²)).
template <typename Number>
struct FoldedGgx {
  using Real = Number;
};

// The radial integrals of a batch. RayMap divides by powers of c = 1 − y²; here r stands times c⁴, |s|² times c⁸ and so on, so that
// the integrand P22 · 4 stretch · V · n·l · r dr/dy, with P22 = α²/π/(α² + |s|²)² and dr/dy = 8 g⁷/(c⁵ q), is one fraction, `tops` over `belows`.
template <typename Lobe>
AREALAB_INLINE void SumRays(const Rays& rays, int ray_count, const RayRule& rule, const Lobe& lobe, Sums& sums) {
  using Real = typename Lobe::Real;
  using Vector = Wide<Real>;
  constexpr bool kFolded = std::is_same_v<Lobe, FoldedGgx<Real>>;
  constexpr std::size_t kWidth = sizeof(Vector) / sizeof(Real), kMostGroups = (kBatch + kPad) / kWidth, kStage = 64;
  struct Group {
    Vector rise, along, origin, scale, reach, weight;
  };
  Group groups[kMostGroups];
  const std::size_t group_count = (static_cast<std::size_t>(ray_count) + kWidth - 1) / kWidth;
  for (std::size_t g = 0; g < group_count; ++g) {
    const auto load = [&](const Column<double>& from, Vector& to) __attribute__((always_inline)) {
      for (std::size_t j = 0; j < kWidth; ++j) to[j] = static_cast<Real>(from[g * kWidth + j]);
    };
    load(rays.rise, groups[g].rise);
    load(rays.along, groups[g].along);
    load(rays.origin, groups[g].origin);
    load(rays.scale, groups[g].scale);
    load(rays.reach, groups[g].reach);
    load(rays.weight, groups[g].weight);
  }
  const auto all = [](double x) __attribute__((always_inline)) { return Vector() + static_cast<Real>(x); };
  const LobeView view = rule.view;
  const double alpha2 = view.alpha * view.alpha, cos2_v = view.cos_v * view.cos_v;
  const Vector view_alpha2 = all(alpha2), cos_v = all(view.cos_v), lift = all(view.sin_v * rule.center_x + view.cos_v), center2 = all(rule.center2),
               view_root = all(std::sqrt(cos2_v * (1.0 - alpha2) + alpha2)), shadow_cosine = all(cos2_v * (1.0 - alpha2)),
               shadow_all = all(cos2_v * alpha2), one = all(1.0), tiny = all(1e-30);  // tiny: in place of 0, which is cheaper so
  Vector c4s[kStage], rs[kStage], qs[kStage], alongs[kStage], stretches[kStage], tops[kStage], belows[kStage];
  [[maybe_unused]] Vector cosines[kFolded ? 1 : kStage], tangents[kFolded ? 1 : kStage];
  Vector sum = all(0.0), sum_grazing = sum, sum_absolute = sum;
  const int node_count = rule.splits * rule.count, at_once = static_cast<int>(kStage / std::max<std::size_t>(group_count, 1));
  for (int begin = 0; begin < node_count; begin += at_once) {
    // In stages, since one long chain of roots would wait for its own results.
    std::size_t count = 0;
    for (int n = begin; n < std::min(begin + at_once, node_count); ++n) {
      const auto split = n / rule.count, k = n - split * rule.count;
      const Vector x = all((split + rule.nodes->x[static_cast<std::size_t>(k)]) / rule.splits),
                   weight = all(16.0 * rule.nodes->weight[static_cast<std::size_t>(k)] / rule.splits);
      for (std::size_t g = 0; g < group_count; ++g, ++count) {
        const Group& ray = groups[g];
        const Vector y = ray.reach * x, y2 = y * y, c = one - y2, g1 = one + y2, c2 = c * c, g2 = g1 * g1, c4 = c2 * c2, g4 = g2 * g2;
        const Vector q = Root((g2 + c2) * (g4 + c4)), r = ray.origin * c4 + ray.scale * (y * q), cg = c * g1;
        c4s[count] = c4;
        rs[count] = r;
        qs[count] = q;
        alongs[count] = ray.along * c4 + r;
        stretches[count] = lift * c4 + ray.rise * r;
        tops[count] = ((cg * cg) * (cg * g4)) * ((weight * ray.weight) * r);
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      const Vector c4 = c4s[i], c8 = c4 * c4, slope2 = center2 * c8 + rs[i] * alongs[i], all2 = c8 + slope2, tail = view_alpha2 * c8 + slope2;
      const Vector stretch = stretches[i], facing = Most((stretch + stretch) * c4 - cos_v * all2, tiny);
      tops[i] *= stretch * facing;
      if constexpr (kFolded) {
        const Vector shadow = Root(facing * facing * shadow_cosine + all2 * (shadow_all * all2));
        belows[i] = (qs[i] * (tail * tail)) * (facing * view_root + shadow);
      } else {
        belows[i] = (all(0.5) * qs[i] * (tail * tail)) * all2;
        cosines[i] = facing / all2;
        tangents[i] = slope2 / c8;
      }
      qs[i] = Root(all2);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const Vector root = qs[i], below = belows[i], inv = one / (below * root);
      const Vector v_dot_h = stretches[i] * (inv * below);
      Vector value = tops[i] * (inv * root);
      if constexpr (!kFolded) {
        for (std::size_t j = 0; j < kWidth; ++j) value[j] *= lobe.over_ggx(view.cos_v, cosines[i][j], v_dot_h[j], tangents[i][j], view.alpha);
      }
      const Vector m = Most(one - v_dot_h, tiny), m2 = m * m;
      sum += value;
      sum_grazing += value * (m2 * m2 * m);
      sum_absolute += Abs(value);
    }
  }
  for (std::size_t j = 0; j < kWidth; ++j) {
    sums.specular += static_cast<double>(sum[j]);
    sums.grazing += static_cast<double>(sum_grazing[j]);
    sums.absolute += static_cast<double>(sum_absolute[j]);
  }
}

// Adds the nodes of part `split` of a panel; those of the lanes beyond `count` give way to the next panel's.
AREALAB_INLINE void AddNodes(OuterNodes& nodes, const Panel& panel, const GaussRule& rule, int count, int split, int splits) {
  const double range = panel.range / splits, center = panel.center, half_width = 0.5 * panel.width;
  const double middle = splits == 1 ? panel.middle : panel.middle * std::exp(panel.range * ((split + 0.5) / splits - 0.5));
  const auto begin = static_cast<std::size_t>(nodes.count);
  for (std::size_t k = 0; k < static_cast<std::size_t>((count + 3) & ~3); ++k) {
    nodes.d[begin + k] = range * (rule.x[k] - 0.5) * (1.0 / 32.0);
    nodes.weight[begin + k] = half_width * range * rule.weight[k];
    nodes.center[begin + k] = center;
    nodes.half_width[begin + k] = half_width;
    nodes.middle[begin + k] = middle;
  }
  nodes.runs[static_cast<std::size_t>(nodes.run_count++)] = {panel.arc, nodes.count, count};
  nodes.count += count;
}

template <typename Lobe>
__attribute__((target("avx2,fma"), flatten)) void SumRaysAvx2(const Rays& rays, int count, const RayRule& rule, const void* lobe, Sums& sums) {
  SumRays(rays, count, rule, *static_cast<const Lobe*>(lobe), sums);
}
template <typename Lobe>
__attribute__((flatten)) void SumRaysPlain(const Rays& rays, int count, const RayRule& rule, const void* lobe, Sums& sums) {
  SumRays(rays, count, rule, *static_cast<const Lobe*>(lobe), sums);
}

// A level of the rule, and one of these with its lobe.
struct Task {
  TruthLevel level;
  const void* lobe;
  void (*sum_rays)(const Rays&, int, const RayRule&, const void*, Sums&);
};

// dual::RayMapInverse in lanes.
AREALAB_INLINE Lanes RayMapInverses(Lanes x) {
  const Lanes s4 = Root(1.0 + x * x), s2 = Root(s4), s = Root(s2);
  return x / ((1.0 + s) * Root((1.0 + s2) * (1.0 + s4)));
}

// Makes the rays of the nodes and sums them.
AREALAB_INLINE void FinishNodes(OuterNodes& nodes, const Outline& outline, const RayRule& rule, const Task& task, Sums& sums) {
  const LobeView view = rule.view;
  const auto count = static_cast<std::size_t>(nodes.count);
  const auto get = [](const Column<double>& from, std::size_t i) __attribute__((always_inline)) {
    Lanes lanes;
    std::memcpy(&lanes, &from[i], sizeof lanes);
    return lanes;
  };
  const auto put = [](Column<double>& to, std::size_t i, Lanes lanes) __attribute__((always_inline)) { std::memcpy(&to[i], &lanes, sizeof lanes); };
  alignas(64) Column<double> times, steps, x_of, y_of, w_of, turns;
  for (std::size_t i = count; i < count + kLanes; ++i) nodes.d[i] = nodes.weight[i] = nodes.center[i] = nodes.half_width[i] = nodes.middle[i] = 1.0;
  std::size_t i = 0;
  for (; i < count; i += kLanes) {
    // e^δ as (e^(δ/32))^32 by Taylor's series: |δ| is below 16, so the remainder is below 1e-10, and the map
    // need not be exact, only smooth.
    const Lanes d = get(nodes.d, i);
    Lanes e = d * (1.0 / 40320.0) + 1.0 / 5040.0;
    e = e * d + 1.0 / 720.0;
    e = e * d + 1.0 / 120.0;
    e = e * d + 1.0 / 24.0;
    e = e * d + 1.0 / 6.0;
    e = e * d + 0.5;
    e = e * d + 1.0;
    e = e * d + 1.0;
    e *= e;
    e *= e;
    e *= e;
    e *= e;
    e *= e;
    const Lanes grow = get(nodes.middle, i) * e, shrink = 1.0 / grow;
    put(times, i, get(nodes.center, i) + get(nodes.half_width, i) * (grow - shrink));
    put(steps, i, (grow + shrink) * get(nodes.weight, i));
  }
  put(times, i, Lanes());
  // Where they are seen from the center, (x, y)/w, and x dy − y dx.
  for (int run = 0; run < nodes.run_count; ++run) {
    const OuterNodes::Run& of = nodes.runs[static_cast<std::size_t>(run)];
    const ArcCurve arc(outline.arcs[static_cast<std::size_t>(of.arc)], view, outline.center);
    for (auto k = static_cast<std::size_t>(of.begin); k < static_cast<std::size_t>(of.begin + of.count); k += kLanes) {
      const Lanes t = get(times, k);
      Lanes x = arc.k0.x + t * (arc.k1.x + t * arc.k2.x), y = arc.k0.y + t * (arc.k1.y + t * arc.k2.y), w = arc.k0.z + t * (arc.k1.z + t * arc.k2.z);
      Lanes dx = arc.k1.x + 2.0 * t * arc.k2.x, dy = arc.k1.y + 2.0 * t * arc.k2.y;
      if (arc.cos_2 > 0.0) {
        const Lanes x1 = arc.cos_1 * (1.0 - t * t), x2 = arc.cos_2 * 2.0 * t, x3 = Root(x1 * x1 + x2 * x2);
        const Lanes dx3 = 2.0 * (arc.cos_2 * x2 - arc.cos_1 * x1 * t) / Most(x3, Lanes() + 1e-30);
        x += arc.curved.x * x3, y += arc.curved.y * x3, w += arc.curved.z * x3;
        dx += arc.curved.x * dx3, dy += arc.curved.y * dx3;
      }
      put(x_of, k, x);
      put(y_of, k, y);
      put(w_of, k, w);
      put(turns, k, x * dy - y * dx);
    }
  }
  const std::size_t padded = (count + kPad - 1) / kPad * kPad;
  for (i = count; i < padded; ++i) {  // no rays
    x_of[i] = w_of[i] = 1.0;
    y_of[i] = turns[i] = 0.0;
  }
  const double ring = outline.ring, b = outline.scale, inv_b = 1.0 / b, layer_height = dual::LayerHeight(view);
  const double factor = view.alpha * view.alpha / glm::pi<double>() * b;
  Rays rays;
  LaneMask any = LaneMask();
  for (i = 0; i < padded; i += kLanes) {
    const Lanes x = get(x_of, i), y = get(y_of, i), w = get(w_of, i), qx = x + outline.center.x * w, qy = y + outline.center.y * w;
    const Lanes length2 = Most(x * x + y * y, Lanes() + 1e-300), both = 1.0 / (Root(length2) * w), inv = both * w;
    const Lanes far = length2 * both, end = far - ring, e_x = x * inv, e_y = y * inv;
    // dual::LayerLength without a division: whether a layer of shadowing at the end is thin.
    const Lanes stretch = view.sin_v * qx + view.cos_v * w, q2 = qx * qx + qy * qy + w * w;
    const Lanes height = (Most(2.0 * stretch * w - view.cos_v * q2, Lanes()) + layer_height * q2) * q2;
    const Lanes fall = 2.0 * w * w * (2.0 * stretch * (qx * e_x + qy * e_y) - q2 * view.sin_v * e_x);
    const LaneMask thin = height * dual::kThinLayer < end * Most(fall, 1e-9 * q2 * q2);
    any |= thin;
    const Lanes sense = end < 0.0 ? Lanes() - 1.0 : Lanes() + 1.0;
    put(rays.e_x, i, e_x);
    put(rays.e_y, i, e_y);
    put(rays.length, i, far);
    put(rays.thin, i, thin ? Lanes() + 1.0 : Lanes());
    put(rays.rise, i, view.sin_v * e_x);
    put(rays.along, i, 2.0 * (outline.center.x * e_x + outline.center.y * e_y));
    put(rays.origin, i, Lanes() + ring);
    put(rays.scale, i, 2.0 * b * sense);
    put(rays.reach, i, end * sense * inv_b);
    put(rays.weight, i, get(steps, i) * get(turns, i) * (inv * inv) * (factor * sense));
  }
  for (i = 0; i < padded; i += kLanes) {
    const Lanes reach = RayMapInverses(get(rays.reach, i));
    put(rays.reach, i, reach);
    put(rays.weight, i, get(rays.weight, i) * reach);
  }
  if (Any(any)) {
    Rays layers;
    std::size_t layer_count = 0;
    for (i = 0; i < count; ++i) {
      if (rays.thin[i] == 0.0) continue;
      // The layer has rays of its own, which begin at the end; the cut is halfway in its logarithm.
      const dual::vec2 e(rays.e_x[i], rays.e_y[i]);
      const double thickness = dual::LayerLength(view, outline.center + e * rays.length[i], e), end = rays.length[i] - ring;
      const double part = std::min(std::sqrt(thickness * end), 0.5 * end), turn = rays.weight[i] / (rays.reach[i] * b);
      const double layer_reach = dual::RayMapInverse(part / thickness), reach = dual::RayMapInverse((end - part) * inv_b);
      layers.rise[layer_count] = rays.rise[i];
      layers.along[layer_count] = rays.along[i];
      layers.origin[layer_count] = rays.length[i];
      layers.scale[layer_count] = -2.0 * thickness;
      layers.reach[layer_count] = layer_reach;
      layers.weight[layer_count++] = turn * layer_reach * thickness;
      rays.reach[i] = reach;
      rays.weight[i] = turn * reach * b;
    }
    for (i = layer_count; i < (layer_count + kPad - 1) / kPad * kPad; ++i) {
      layers.rise[i] = layers.along[i] = layers.origin[i] = layers.scale[i] = layers.reach[i] = layers.weight[i] = 0.0;
    }
    task.sum_rays(layers, static_cast<int>(layer_count), rule, task.lobe, sums);
  }
  task.sum_rays(rays, nodes.count, rule, task.lobe, sums);
  nodes.count = nodes.run_count = 0;
}

AREALAB_INLINE Sums IntegrateBody(const Outline& outline, const LobeView& view, const Task& task) {
  Sums sums;
  OuterNodes nodes;
  const TruthLevel& level = task.level;
  const int radial = std::min(static_cast<int>(std::ceil(level.radial + level.radial_per_reach * outline.reach)), kMaxNodes);
  const RayRule rule{view, outline.center.x, glm::dot(outline.center, outline.center), &Gauss(radial), radial, level.splits};
  for (int p = 0; p < outline.panel_count; ++p) {
    const Panel& panel = outline.panels[static_cast<std::size_t>(p)];
    const int count = std::min(static_cast<int>(std::ceil(level.outer + level.outer_per_range * panel.range)), kMaxNodes);
    for (int split = 0; split < level.splits; ++split) {
      if (nodes.count + count > kBatch) FinishNodes(nodes, outline, rule, task, sums);
      AddNodes(nodes, panel, Gauss(count), count, split, level.splits);
    }
  }
  FinishNodes(nodes, outline, rule, task, sums);
  return sums;
}

__attribute__((target("avx2,fma"), flatten)) Sums IntegrateAvx2(const Outline& outline, const LobeView& view, const Task& task) {
  return IntegrateBody(outline, view, task);
}
__attribute__((flatten)) Sums IntegratePlain(const Outline& outline, const LobeView& view, const Task& task) {
  return IntegrateBody(outline, view, task);
}
Sums Integrate(const Outline& outline, const LobeView& view, const Task& task) {
  return HasAvx2() ? IntegrateAvx2(outline, view, task) : IntegratePlain(outline, view, task);
}

// Calls function(task), task(level, form) being the work that Integrate does.
template <typename Function>
auto WithTasks(Brdf brdf, double roughness, const Function& function) {
  const auto make = [](const TruthLevel& level, const auto& lobe) {
    using Lobe = std::decay_t<decltype(lobe)>;
    return Task{level, &lobe, HasAvx2() ? SumRaysAvx2<Lobe> : SumRaysPlain<Lobe>};
  };
  return dual::WithBrdf(brdf, roughness, [&](const auto& over_ggx) {
    const TextOf<std::decay_t<decltype(over_ggx)>> text{over_ggx};
    const FoldedGgx<double> folded;
    const FoldedGgx<float> in_float;
    return function([&](const TruthLevel& level, TruthForm form) {
      if (brdf != Brdf::kGgx || form == TruthForm::kText) return make(level, text);
      return form == TruthForm::kCheck ? make(level, in_float) : make(level, folded);
    });
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

// Whether the lobe's tail falls as exp(−|s|²/α²) or nearly so, where GGX's falls as |s|⁻⁴.
bool IsSteep(Brdf brdf) {
  return brdf != Brdf::kGgx && brdf != Brdf::kGgxSeparable && !IsDiffuse(brdf);
}

// ln x, x ≥ 1, to 1e-13 of it: x = 2ⁿ m, m within √½ and √2, ln m = 2 artanh z, z = (m − 1)/(m + 1), by its series to z¹⁵.
AREALAB_INLINE Lanes Logarithm(Lanes x) {
  using Bits = std::uint64_t __attribute__((vector_size(32)));
  const Bits bits = std::bit_cast<Bits>(x), n = (bits - 0x3fe6a09e667f3bcdu) >> 52;
  const Lanes m = std::bit_cast<Lanes>(bits - (n << 52)), count = std::bit_cast<Lanes>(n | 0x4330000000000000u) - 0x1p52;
  const Lanes z = (m - 1.0) / (m + 1.0), z2 = z * z;
  Lanes sum = z2 * (1.0 / 15.0) + 1.0 / 13.0;
  sum = sum * z2 + 1.0 / 11.0;
  sum = sum * z2 + 1.0 / 9.0;
  sum = sum * z2 + 1.0 / 7.0;
  sum = sum * z2 + 1.0 / 5.0;
  sum = sum * z2 + 1.0 / 3.0;
  return count * 0.6931471805599453 + 2.0 * z * (1.0 + z2 * sum);
}

// atan x, x in [0, 1]: two halvings of the angle leave z ≤ 0.199, whose series runs to z²¹/21.
AREALAB_INLINE Lanes ArcTangent(Lanes x) {
  const Lanes y = x / (1.0 + Root(1.0 + x * x)), z = y / (1.0 + Root(1.0 + y * y)), z2 = -z * z;
  Lanes sum = z2 * (1.0 / 21.0) + 1.0 / 19.0;
  sum = sum * z2 + 1.0 / 17.0;
  sum = sum * z2 + 1.0 / 15.0;
  sum = sum * z2 + 1.0 / 13.0;
  sum = sum * z2 + 1.0 / 11.0;
  sum = sum * z2 + 1.0 / 9.0;
  sum = sum * z2 + 1.0 / 7.0;
  sum = sum * z2 + 1.0 / 5.0;
  sum = sum * z2 + 1.0 / 3.0;
  return 4.0 * (z + z * (z2 * sum));
}

// The outline of a polygon above the horizon; gives its form factor, as PolygonFormFactor does, and whether the mirror direction is inside.
AREALAB_INLINE double AddPolygonBody(Outline& outline, const HorizonPolygon& polygon, const glm::dvec3& mirror, bool& mirror_inside) {
  constexpr std::size_t kMost = (kMostCorners + 1 + kLanes - 1) / kLanes * kLanes;
  alignas(32) std::array<double, kMost + kLanes> xs{}, ys{}, zs{};
  const auto count = static_cast<std::size_t>(polygon.count);
  for (std::size_t i = 0; i <= count; ++i) {
    const glm::dvec3& p = polygon.corners[i < count ? i : 0];
    xs[i] = p.x, ys[i] = p.y, zs[i] = p.z;
  }
  const auto at = [](const auto& from, std::size_t i) __attribute__((always_inline)) {
    Lanes lanes;
    std::memcpy(&lanes, &from[i], sizeof lanes);
    return lanes;
  };
  const auto unit = [&](std::size_t i) __attribute__((always_inline)) {
    const Lanes x = at(xs, i), y = at(ys, i), z = at(zs, i), inv = 1.0 / Root(Most(x * x + y * y + z * z, Lanes() + 1e-300));
    return std::array{x * inv, y * inv, z * inv};
  };
  double sum = 0.0;
  for (std::size_t i = 0; i < count; i += kLanes) {
    const auto p = unit(i), q = unit(i + 1);
    const std::array along = {q[0] - p[0], q[1] - p[1], q[2] - p[2]}, middle = {p[0] + q[0], p[1] + q[1], p[2] + q[2]};
    const Lanes sine = Root(along[0] * along[0] + along[1] * along[1] + along[2] * along[2]),
                cosine = Root(middle[0] * middle[0] + middle[1] * middle[1] + middle[2] * middle[2]);
    const Lanes t1 = sine / (2.0 + cosine);  // tan of a quarter of the edge's angle
    const Lanes inv_sine = 1.0 / sine, inv_cosine = 1.0 / cosine;
    const Lanes turn = 4.0 * ArcTangent(t1) * (middle[0] * along[1] - middle[1] * along[0]) * (inv_sine * inv_cosine);
    const Lanes side = (p[1] * q[2] - p[2] * q[1]) * mirror.x + (p[2] * q[0] - p[0] * q[2]) * mirror.y + (p[0] * q[1] - p[1] * q[0]) * mirror.z;
    for (std::size_t j = 0; j < std::min<std::size_t>(kLanes, count - i); ++j) {
      mirror_inside = mirror_inside && side[j] > 0.0;
      if (sine[j] == 0.0 || cosine[j] == 0.0) continue;
      sum += turn[j];
      Arc& arc = outline.arcs[static_cast<std::size_t>(outline.arc_count++)];
      arc.axis_1 = glm::dvec3(middle[0][j], middle[1][j], middle[2][j]) * inv_cosine[j];
      arc.axis_2 = glm::dvec3(along[0][j], along[1][j], along[2][j]) * inv_sine[j];
      arc.axis_3 = glm::dvec3(0.0);
      arc.sin_1 = arc.sin_2 = 1.0;
      arc.cos_1 = arc.cos_2 = 0.0;
      arc.t0 = -t1[j];
      arc.t1 = t1[j];
    }
  }
  return sum / (2.0 * glm::pi<double>());
}
__attribute__((target("avx2,fma"), flatten)) double AddPolygonAvx2(Outline& outline, const HorizonPolygon& polygon, const glm::dvec3& mirror,
                                                                   bool& mirror_inside) {
  return AddPolygonBody(outline, polygon, mirror, mirror_inside);
}
__attribute__((flatten)) double AddPolygonPlain(Outline& outline, const HorizonPolygon& polygon, const glm::dvec3& mirror, bool& mirror_inside) {
  return AddPolygonBody(outline, polygon, mirror, mirror_inside);
}

struct ArcLanes {
  struct Axis {
    Lanes k0, k1, k2, curved;
  };
  Axis x, y, z;  // of ArcCurve, about 0
  Lanes cos_1, cos_2, t0, t1;
  bool any_curved;
  int count;
};

struct SlopeLanes {
  Lanes x, y, derivative_x, derivative_y;
};

AREALAB_INLINE SlopeLanes SlopeAt(const ArcLanes& arc, Lanes t) {
  const auto at = [&](const ArcLanes::Axis& axis) { return axis.k0 + t * (axis.k1 + t * axis.k2); };
  const auto change = [&](const ArcLanes::Axis& axis) { return axis.k1 + 2.0 * t * axis.k2; };
  Lanes x = at(arc.x), y = at(arc.y), z = at(arc.z), dx = change(arc.x), dy = change(arc.y), dz = change(arc.z);
  if (arc.any_curved) {
    const Lanes x1 = arc.cos_1 * (1.0 - t * t), x2 = arc.cos_2 * 2.0 * t, x3 = Root(x1 * x1 + x2 * x2);
    const Lanes dx3 = 2.0 * (arc.cos_2 * x2 - arc.cos_1 * x1 * t) / Most(x3, Lanes() + 1e-30);
    x += arc.x.curved * x3, y += arc.y.curved * x3, z += arc.z.curved * x3;
    dx += arc.x.curved * dx3, dy += arc.y.curved * dx3, dz += arc.z.curved * dx3;
  }
  const Lanes inv = 1.0 / z, slope_x = x * inv, slope_y = y * inv;
  return {slope_x, slope_y, (dx - slope_x * dz) * inv, (dy - slope_y * dz) * inv};
}

struct ChordLanes {
  Lanes t0, t1, begin_x, begin_y, end_x, end_y;
  Lanes part, distance2;  // where it is nearest, and how near
};

AREALAB_INLINE ChordLanes ChordTo(const dual::vec2& to, Lanes t0, Lanes begin_x, Lanes begin_y, Lanes t1, Lanes end_x, Lanes end_y) {
  const Lanes from_x = begin_x - to.x, from_y = begin_y - to.y, along_x = end_x - begin_x, along_y = end_y - begin_y;
  const Lanes part = Least(Most(-(from_x * along_x + from_y * along_y) / Most(along_x * along_x + along_y * along_y, Lanes() + 1e-300), Lanes()), Lanes() + 1.0);
  const Lanes x = from_x + along_x * part, y = from_y + along_y * part;
  return {t0, t1, begin_x, begin_y, end_x, end_y, part, x * x + y * y};
}

AREALAB_INLINE void Take(ChordLanes& to, const ChordLanes& from, LaneMask where) {
  to.t0 = where ? from.t0 : to.t0;
  to.t1 = where ? from.t1 : to.t1;
  to.begin_x = where ? from.begin_x : to.begin_x;
  to.begin_y = where ? from.begin_y : to.begin_y;
  to.end_x = where ? from.end_x : to.end_x;
  to.end_y = where ? from.end_y : to.end_y;
  to.part = where ? from.part : to.part;
  to.distance2 = where ? from.distance2 : to.distance2;
}

constexpr int kSamples = 5;  // of an arc, to begin with
struct SampleLanes {
  std::array<Lanes, kSamples> x, y;
};

AREALAB_INLINE Lanes TimeOf(const ArcLanes& arc, int i) { return arc.t0 + (arc.t1 - arc.t0) * (static_cast<double>(i) / (kSamples - 1)); }

struct FootLanes {
  Lanes t, offset, distance2;
  SlopeLanes slope;
};

// The point of an arc nearest to `to`, to within `slack`, from the nearest chord between samples, so that a near pass between two of them is
// not missed; t + offset is the foot on the tangent there, beyond the arc where it may be.
AREALAB_INLINE FootLanes NearestTo(const dual::vec2& to, const ArcLanes& arc, const SampleLanes& samples, double slack) {
  constexpr int kCuts = 10, kSteps = 3;  // of halving, then of Gauss–Newton towards the nearest point
  const auto between = [&](std::size_t i) __attribute__((always_inline)) {
    const int k = static_cast<int>(i);
    return ChordTo(to, TimeOf(arc, k), samples.x[i], samples.y[i], TimeOf(arc, k + 1), samples.x[i + 1], samples.y[i + 1]);
  };
  ChordLanes best = between(0);
  for (std::size_t i = 1; i + 1 < kSamples; ++i) {
    const ChordLanes chord = between(i);
    Take(best, chord, chord.distance2 < best.distance2);
  }
  const Lanes low = best.t0, high = best.t1;
  // Halves the chord while the arc runs unevenly along it.
  LaneMask active = low == low;
  for (int cut = 0; cut < kCuts && Any(active); ++cut) {
    const Lanes t = 0.5 * (best.t0 + best.t1);
    const SlopeLanes at = SlopeAt(arc, t);
    const Lanes bend_x = at.x - 0.5 * (best.begin_x + best.end_x), bend_y = at.y - 0.5 * (best.begin_y + best.end_y);
    const Lanes along_x = best.end_x - best.begin_x, along_y = best.end_y - best.begin_y;
    const LaneMask uneven = bend_x * bend_x + bend_y * bend_y >= 0.01 * (along_x * along_x + along_y * along_y);
    ChordLanes half = ChordTo(to, best.t0, best.begin_x, best.begin_y, t, at.x, at.y);
    const ChordLanes second = ChordTo(to, t, at.x, at.y, best.t1, best.end_x, best.end_y);
    Take(half, second, second.distance2 < half.distance2);
    Take(best, half, active);
    active = active & uneven;
  }
  FootLanes foot{};
  foot.t = best.t0 + best.part * (best.t1 - best.t0);
  for (int step = 0;; ++step) {
    foot.slope = SlopeAt(arc, foot.t);
    const Lanes x = foot.slope.x - to.x, y = foot.slope.y - to.y, dx = foot.slope.derivative_x, dy = foot.slope.derivative_y;
    const Lanes speed2 = Most(dx * dx + dy * dy, Lanes() + 1e-300);
    foot.offset = -(x * dx + y * dy) / speed2;
    foot.distance2 = x * x + y * y;
    const Lanes next = Least(Most(foot.t + foot.offset, low), high), move = next - foot.t;
    const LaneMask moves = move * move * speed2 >= slack * slack;
    if (step == kSteps || !Any(moves)) return foot;
    foot.t = moves ? next : foot.t;
  }
}

// Cuts arcs into panels, each about the place where most happens.
AREALAB_INLINE void AddPanels(Outline& outline, const LobeView& view, const ArcLanes& arc, int first, Lanes foot, Lanes width) {
  const auto add = [&](Lanes t0, Lanes t1, Lanes center, Lanes size) __attribute__((always_inline)) {
    const auto grown = [&](Lanes t) __attribute__((always_inline)) {  // e^u, t = center + size·sinh u
      const Lanes z = (t - center) / size, e = Abs(z) + Root(z * z + 1.0);
      return z < 0.0 ? 1.0 / e : e;
    };
    const Lanes e0 = grown(t0), e1 = grown(t1), middle = Root(e0 * e1), range = Logarithm(Most(e1 / e0, Lanes() + 1.0));
    for (int j = 0; j < arc.count; ++j) {
      if (t1[j] > t0[j]) outline.panels[static_cast<std::size_t>(outline.panel_count++)] = Panel{first + j, center[j], size[j], middle[j], range[j]};
    }
  };
  const Lanes t0 = arc.t0, t1 = arc.t1, half = 0.5 * (t1 - t0);
  // Where shadowing has a layer at an end that comes down to the horizon, or a thin outline its tip at t = 0.
  const auto layer = [&](Lanes t, double sense) __attribute__((always_inline)) {
    const Lanes x1 = arc.cos_1 * (1.0 - t * t), x2 = arc.cos_2 * 2.0 * t, x3 = Root(x1 * x1 + x2 * x2), inv = 1.0 / (1.0 + t * t);
    const Lanes dx3 = 2.0 * (arc.cos_2 * x2 - arc.cos_1 * x1 * t) / Most(x3, Lanes() + 1e-30);
    const Lanes height = (arc.z.k0 + t * (arc.z.k1 + t * arc.z.k2) + arc.z.curved * x3) * inv - view.cos_v;
    const Lanes rise = (arc.z.k1 + 2.0 * t * arc.z.k2 + arc.z.curved * dx3 - 2.0 * t * (height + view.cos_v)) * inv;
    const Lanes size = (height + dual::LayerHeight(view)) / Most(sense * rise, Lanes() + 1e-9);
    const Lanes tip = Most(0.5 * arc.cos_1 / Most(arc.cos_2, Lanes() + 1e-30), Lanes() + 1e-12);
    return ((arc.cos_2 > 0.0) & (t == 0.0)) ? Least(size, tip) : size;
  };
  const auto crowd = [&](Lanes end, Lanes size) __attribute__((always_inline)) {
    const Lanes spacing = Root(width * width + (end - foot) * (end - foot));
    return size * dual::kThinLayer < Least(spacing, 2.0 * half) ? Least(Root(size * spacing), half) : Lanes();
  };
  const Lanes layer_0 = layer(t0, 1.0), layer_1 = layer(t1, -1.0), cut_0 = crowd(t0, layer_0), cut_1 = crowd(t1, layer_1);
  add(t0 + cut_0, t1 - cut_1, foot, width);
  if (Any(cut_0 > 0.0)) add(t0, t0 + cut_0, t0, layer_0);
  if (Any(cut_1 > 0.0)) add(t1 - cut_1, t1, t1, layer_1);
}

// The outline's nearest points to the center, hence its panels.
AREALAB_INLINE void MakePanelsBody(Outline& outline, const LobeView& view, bool steep, bool mirror_inside) {
  using dual::vec2;
  constexpr int kMostGroups = Outline::kMaxArcs / kLanes;
  std::array<ArcLanes, kMostGroups> arcs;
  std::array<SampleLanes, kMostGroups> samples;
  const std::size_t groups = static_cast<std::size_t>((outline.arc_count + kLanes - 1) / kLanes);
  for (std::size_t g = 0; g < groups; ++g) {
    ArcLanes& to = arcs[g];
    to.count = std::min(outline.arc_count - static_cast<int>(g) * kLanes, kLanes);
    to.any_curved = false;
    for (int j = 0; j < kLanes; ++j) {  // lanes to spare repeat the last arc
      const Arc& arc = outline.arcs[g * kLanes + static_cast<std::size_t>(std::min(j, to.count - 1))];
      const ArcCurve curve(arc, view, vec2(0.0));
      to.x.k0[j] = curve.k0.x, to.x.k1[j] = curve.k1.x, to.x.k2[j] = curve.k2.x, to.x.curved[j] = curve.curved.x;
      to.y.k0[j] = curve.k0.y, to.y.k1[j] = curve.k1.y, to.y.k2[j] = curve.k2.y, to.y.curved[j] = curve.curved.y;
      to.z.k0[j] = curve.k0.z, to.z.k1[j] = curve.k1.z, to.z.k2[j] = curve.k2.z, to.z.curved[j] = curve.curved.z;
      to.cos_1[j] = arc.cos_1, to.cos_2[j] = arc.cos_2, to.t0[j] = arc.t0, to.t1[j] = arc.t1;
      to.any_curved = to.any_curved || arc.cos_2 > 0.0;
    }
    for (int i = 0; i < kSamples; ++i) {
      const SlopeLanes at = SlopeAt(to, TimeOf(to, i));
      samples[g].x[static_cast<std::size_t>(i)] = at.x;
      samples[g].y[static_cast<std::size_t>(i)] = at.y;
    }
  }
  outline.center = vec2(0.0);
  if (!mirror_inside) {
    double least = std::numeric_limits<double>::max();
    for (std::size_t g = 0; g < groups; ++g) {
      const FootLanes foot = NearestTo(vec2(0.0), arcs[g], samples[g], 0.01 * view.alpha);
      for (int j = 0; j < kLanes; ++j) {
        if (foot.distance2[j] >= least) continue;
        least = foot.distance2[j];
        outline.center = vec2(foot.slope.x[j], foot.slope.y[j]);
      }
    }
  }
  outline.scale = std::sqrt(view.alpha * view.alpha + glm::dot(outline.center, outline.center));
  // From c outwards exp(−|s|²/α²) falls over α²/|c|, and along the outline over α.
  const double across_scale = steep ? view.alpha : outline.scale;
  if (steep) outline.scale = view.alpha * view.alpha / outline.scale;
  // Where rays from the center to the far side of the outline pass close by 0, over the lobe's peak, radial
  // rays from a ring serve better.
  const double center2 = glm::dot(outline.center, outline.center);
  bool over_peak = false;
  const auto each_sample = [&](const auto& visit) __attribute__((always_inline)) {
    for (std::size_t g = 0; g < groups; ++g) {
      for (std::size_t i = 0; i < kSamples; ++i) visit(samples[g].x[i] - outline.center.x, samples[g].y[i] - outline.center.y);
    }
  };
  if (center2 > 0.25 * view.alpha * view.alpha) {
    LaneMask over = LaneMask();
    each_sample([&](Lanes x, Lanes y) __attribute__((always_inline)) {
      const Lanes length2 = Most(x * x + y * y, Lanes() + 1e-300), back = -(x * outline.center.x + y * outline.center.y);
      over |= (back > 0.0) & (back < length2) & (back * back > 0.75 * center2 * length2);
    });
    over_peak = Any(over);
  }
  if (over_peak) {
    outline.ring = std::sqrt(center2);
    outline.center = vec2(0.0);
  }
  Lanes farthest2 = Lanes();
  each_sample([&](Lanes x, Lanes y) __attribute__((always_inline)) { farthest2 = Most(farthest2, x * x + y * y); });
  for (std::size_t g = 0; g < groups; ++g) {
    const FootLanes foot = NearestTo(outline.center, arcs[g], samples[g], 0.02 * outline.scale);
    const Lanes dx = foot.slope.derivative_x, dy = foot.slope.derivative_y, speed2 = Most(dx * dx + dy * dy, Lanes() + 1e-300);
    const Lanes across2 = Most(foot.distance2 - foot.offset * foot.offset * speed2, Lanes());
    // Rays from a ring leave a pole where the outline's continuation meets 0.
    const double blur2 = over_peak ? 0.0 : across_scale * across_scale;
    AddPanels(outline, view, arcs[g], static_cast<int>(g) * kLanes, foot.t + foot.offset, Least(Root((blur2 + across2) / speed2), Lanes() + 8.0));
  }
  const double most2 = std::max(std::max(farthest2[0], farthest2[1]), std::max(farthest2[2], farthest2[3]));
  outline.reach = dual::RayMapInverse(std::sqrt(most2) / outline.scale);
}

__attribute__((target("avx2,fma"), flatten)) void MakePanelsAvx2(Outline& outline, const LobeView& view, bool steep, bool mirror_inside) {
  MakePanelsBody(outline, view, steep, mirror_inside);
}
__attribute__((flatten)) void MakePanelsPlain(Outline& outline, const LobeView& view, bool steep, bool mirror_inside) {
  MakePanelsBody(outline, view, steep, mirror_inside);
}
void MakePanels(Outline& outline, const LobeView& view, bool steep, bool mirror_inside) {
  HasAvx2() ? MakePanelsAvx2(outline, view, steep, mirror_inside) : MakePanelsPlain(outline, view, steep, mirror_inside);
}

}  // namespace

const std::array<TruthLevel, kTruthLevelCount>& TruthLevels() {
  static const std::array<TruthLevel, kTruthLevelCount> levels = {{{2.0, 1.0, 3.0, 2.5, 1},
                                                                   {3.0, 1.25, 4.0, 3.5, 1},
                                                                   {4.0, 1.5, 4.0, 5.0, 1},
                                                                   {5.0, 2.0, 5.0, 6.0, 1},
                                                                   {7.0, 2.5, 7.0, 8.0, 1},
                                                                   {9.0, 3.0, 10.0, 12.0, 1},
                                                                   {9.0, 3.0, 10.0, 12.0, 2},
                                                                   {12.0, 3.5, 12.0, 14.0, 3},
                                                                   {12.0, 3.5, 12.0, 14.0, 8}}};
  return levels;
}

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
    const auto add = HasAvx2() ? AddPolygonAvx2 : AddPolygonPlain;
    result.form_factor = std::max(add(outline, polygon, mirror, mirror_inside), 0.0);
    if (cos_v <= 0.0) {
      return true;
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

LightIntegrals IntegrateLightAtLevel(const ShadingPoint& point, const Light& light, int level, TruthForm form) {
  LightIntegrals result;
  Outline outline;
  LobeView view;
  if (!MakeOutline(point, light, outline, view, result) || view.cos_v <= 0.0) {
    return result;
  }
  const Sums sums = WithTasks(point.brdf, view.roughness, [&](const auto& task) {
    return Integrate(outline, view, task(TruthLevels()[static_cast<std::size_t>(level)], form));
  });
  result.specular = sums.specular;
  result.specular_grazing = sums.grazing;
  return result;
}

}  // namespace arealab

namespace arealab {

namespace {

constexpr double kFormFactorRounding = 1e-12;
constexpr double kRounding = 1e-12;  // of the sum of absolute terms
// What the first kept level is held against where that is the third: the second comes too near it, and with it five times as many
// agree by chance.
constexpr TruthLevel kCheck = {3.0, 1.25, 3.0, 4.0, 1};
// From this tolerance on what only serves as a check is summed in float, good to 1e-5 in 99 of 100 hard configurations; elsewhere it
// fails to agree, and the next level decides.
constexpr double kFloatTolerance = 1e-5;
// Two levels that differ by no more than this share of the tolerance are believed: with it the tolerances
// 1e-3 and 1e-4 were exceeded in 0.01 and 0.04 % of the 20 000 first of tests/compare/hard_configurations.h,
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
  const TruthLevel& check = first == 1 ? kCheck : TruthLevels()[first];
  WithTasks(point.brdf, view.roughness, [&](const auto& task) {
    Sums before = Integrate(outline, view, task(check, tolerance >= kFloatTolerance ? TruthForm::kCheck : TruthForm::kKept));
    for (std::size_t level = first + 1; level < kTruthLevelCount; ++level) {
      const Sums sums = Integrate(outline, view, task(TruthLevels()[level], TruthForm::kKept));
      const double change = std::abs(sums.specular - before.specular), change_grazing = std::abs(sums.grazing - before.grazing);
      const double floor = kLeastStated * tolerance;
      result.specular = std::max(sums.specular, 0.0);
      result.specular_grazing = std::max(sums.grazing, 0.0);
      result.specular_error = std::max({spread * change, floor * result.specular, kRounding * sums.absolute});
      result.specular_grazing_error = std::max({spread * change_grazing, floor * result.specular_grazing, kRounding * sums.absolute});
      const double share = steep || tube || sums.absolute > kMuchCancels * sums.specular ? kCautiousShare : kShare;
      if (change <= share * tolerance * sums.specular + nothing &&
          change_grazing <= share * tolerance * (sums.grazing + 0.04 * sums.specular) + nothing) {
        return;
      }
      before = sums;
    }
  });
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
