// One light, one shaded point: closed form factor, and the specular integrals by the rule of
// glsl/polar_rule.glsl with Gauss nodes in batches that the compiler turns into vector code. The two options
// let √ and max become vector instructions; no result depends on errno or on floating-point traps.
#pragma GCC optimize("no-math-errno", "no-trapping-math")
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "compare/closed_forms.h"
#include "compare/truth.h"
#include "compare/truth_levels.h"
// clang-format off: the order matters
#include "glsl/dual_begin.h"
#include "glsl/polar_rule.glsl"
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

// Where an arc is sampled densely, t = center + width·tan ϑ with ϑ between the ends, uniformly in tan of a
// half angle.
struct Panel {
  const Arc* arc;
  double t0, t1, center, width;
  // (1, (t_i − center)/width) normalised, their mean direction, and tan of a quarter of the angle between
  // them.
  double middle_cos, middle_sin, reach, range;
};

Panel MakePanel(const Arc& arc, double t0, double t1, double center, double width) {
  Panel panel{&arc, t0, t1, center, width, 1.0, 0.0, 0.0, 0.0};
  double a0 = (t0 - center) / width, a1 = (t1 - center) / width;
  double c0 = 1.0 / std::sqrt(1.0 + a0 * a0), c1 = 1.0 / std::sqrt(1.0 + a1 * a1);
  double mx = c0 + c1, my = a0 * c0 + a1 * c1;
  double length = std::sqrt(mx * mx + my * my);
  panel.middle_cos = mx / length;
  panel.middle_sin = my / length;
  double sine =
      (a1 - a0) * c0 * c1 / length;  // sin of half the angle: sin(2x) / (2 cos x), cos x = length / 2
  panel.reach = sine / (1.0 + 0.5 * length);
  panel.range = 2.0 * std::atan2(sine, 0.5 * length);
  return panel;
}

// The outline of the visible part of a light, in panels, and the ring that the rays start from.
struct Outline {
  std::array<Arc, 8> arcs;
  int arc_count = 0;
  std::array<Panel, 40> panels;
  int panel_count = 0;
  double ring_slope = 0.0;
};

// Outer nodes in batches: the inner loop runs over them.
struct Batch {
  static constexpr int kSize = 64;
  alignas(64) std::array<double, kSize> cos_phi, reach, crowd, weight, sum, sum_grazing;
  int count = 0;
};

struct Sums {
  double specular = 0.0, grazing = 0.0;
};

// Adds the radial integrals of a batch; inlined into one function per instruction set.
inline __attribute__((always_inline)) void SumRaysBody(Batch& batch, const LobeView& view, double ring_cos,
                                                       double ring_sin, const GaussRule& radial,
                                                       int radial_count, int splits) {
  int count = (batch.count + 7) & ~7;
  for (int i = batch.count; i < count; ++i) {
    auto j = static_cast<std::size_t>(i);
    batch.cos_phi[j] = 0.0;
    batch.reach[j] = batch.crowd[j] = batch.weight[j] = 0.0;
  }
  for (int i = 0; i < count; ++i) {
    batch.sum[static_cast<std::size_t>(i)] = batch.sum_grazing[static_cast<std::size_t>(i)] = 0.0;
  }
  for (int split = 0; split < splits; ++split) {
    for (int k = 0; k < radial_count; ++k) {
      const double x = (split + radial.x[static_cast<std::size_t>(k)]) / splits;
      const double w = radial.weight[static_cast<std::size_t>(k)] / splits;
      const double* __restrict cos_phi = batch.cos_phi.data();
      const double* __restrict reach = batch.reach.data();
      const double* __restrict crowd = batch.crowd.data();
      double* __restrict sum = batch.sum.data();
      double* __restrict sum_grazing = batch.sum_grazing.data();
      for (int i = 0; i < count; ++i) {
        double near_end = 1.0 / (1.0 + crowd[i] * x);
        double y = reach[i] * (1.0 - (1.0 - x) * near_end);
        double step = reach[i] * (1.0 + crowd[i]) * near_end * near_end;
        // χ is the ring's plus 2 atan y.
        double c = 1.0 - y * y, s = 2.0 * y, g = 1.0 / (1.0 + y * y);
        double sine = ring_sin * c + ring_cos * s, cosine = ring_cos * c - ring_sin * s;
        double slope = view.alpha * sine / cosine;
        dual::vec2 f = dual::LobeWeights(view, slope * cos_phi[i], slope * slope);
        double measure = w * step * 4.0 * sine * cosine * (g * g * g);
        sum[i] += measure * f.x;
        sum_grazing[i] += measure * f.y;
      }
    }
  }
}

__attribute__((target("avx2,fma"))) void SumRaysAvx2(Batch& batch, const LobeView& view, double ring_cos,
                                                     double ring_sin, const GaussRule& radial,
                                                     int radial_count, int splits) {
  SumRaysBody(batch, view, ring_cos, ring_sin, radial, radial_count, splits);
}
void SumRaysPlain(Batch& batch, const LobeView& view, double ring_cos, double ring_sin,
                  const GaussRule& radial, int radial_count, int splits) {
  SumRaysBody(batch, view, ring_cos, ring_sin, radial, radial_count, splits);
}

void SumRays(Batch& batch, const LobeView& view, double ring_cos, double ring_sin, int radial_count,
             int splits, Sums& sums) {
  static const bool kAvx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  (kAvx2 ? SumRaysAvx2 : SumRaysPlain)(batch, view, ring_cos, ring_sin, Gauss(radial_count), radial_count,
                                       splits);
  for (int i = 0; i < batch.count; ++i) {
    auto j = static_cast<std::size_t>(i);
    sums.specular += batch.weight[j] * batch.sum[j];
    sums.grazing += batch.weight[j] * batch.sum_grazing[j];
  }
  batch.count = 0;
}

Sums Integrate(const Outline& outline, const LobeView& view, const TruthLevel& level) {
  Sums sums;
  Batch batch;
  double ring_cos = view.alpha / std::sqrt(view.alpha * view.alpha + outline.ring_slope * outline.ring_slope);
  double ring_sin =
      outline.ring_slope / std::sqrt(view.alpha * view.alpha + outline.ring_slope * outline.ring_slope);
  for (int p = 0; p < outline.panel_count; ++p) {
    const Panel& panel = outline.panels[static_cast<std::size_t>(p)];
    int count =
        std::min(static_cast<int>(std::ceil(level.outer + level.outer_per_radian * panel.range)), kMaxNodes);
    const GaussRule& rule = Gauss(count);
    for (int split = 0; split < level.splits; ++split) {
      for (int k = 0; k < count; ++k) {
        double x = (split + rule.x[static_cast<std::size_t>(k)]) / level.splits;
        double y = panel.reach * (2.0 * x - 1.0);
        double c = 1.0 - y * y, s = 2.0 * y, g = 1.0 + y * y;
        double cosine = panel.middle_cos * c - panel.middle_sin * s,
               sine = panel.middle_sin * c + panel.middle_cos * s;
        double t = panel.center + panel.width * sine / cosine;
        // dt = width dϑ / cos²ϑ, ϑ's change 2 dy / (1 + y²), dy = 2 reach dx; cosine is (1 + y²) cosϑ.
        double dt = panel.width * g * 4.0 * panel.reach * rule.weight[static_cast<std::size_t>(k)] /
                    (cosine * cosine * level.splits);
        dual::vec2 slope, derivative;
        dual::ArcSlope(*panel.arc, view, t, slope, derivative);
        double slope2 = std::max(slope.x * slope.x + slope.y * slope.y, 1e-300), length = std::sqrt(slope2);
        double tangent = view.alpha * (length - outline.ring_slope) /
                         (view.alpha * view.alpha + length * outline.ring_slope);
        auto i = static_cast<std::size_t>(batch.count++);
        batch.cos_phi[i] = slope.x / length;
        batch.reach[i] = tangent / (1.0 + std::sqrt(1.0 + tangent * tangent));
        double n_dot_l_end = dual::CosineFromSlope(view, slope.x, slope2);
        double n_dot_l_ring = dual::CosineFromSlope(view, outline.ring_slope * batch.cos_phi[i],
                                                    outline.ring_slope * outline.ring_slope);
        double fall = std::max(n_dot_l_ring - n_dot_l_end, 0.0) / (std::max(n_dot_l_end, 0.0) + view.alpha);
        batch.crowd[i] = fall * fall / (1.0 + fall);
        batch.weight[i] =
            dt * (slope.x * derivative.y - slope.y * derivative.x) / slope2 / (2.0 * glm::pi<double>());
        if (batch.count == Batch::kSize) {
          SumRays(batch, view, ring_cos, ring_sin, level.radial, level.splits, sums);
        }
      }
    }
  }
  SumRays(batch, view, ring_cos, ring_sin, level.radial, level.splits, sums);
  return sums;
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

// Adds the part of a cone's outline between two angles, in half turns about the ends of the long axis.
void AddCone(Outline& outline, const LightCone& cone, double begin, double end) {
  constexpr double kPi = glm::pi<double>();
  for (int half = static_cast<int>(std::floor((begin + 0.5 * kPi) / kPi)); half * kPi - 0.5 * kPi < end;
       ++half) {
    double from = std::max(begin - half * kPi, -0.5 * kPi), to = std::min(end - half * kPi, 0.5 * kPi);
    if (from >= to) {
      continue;
    }
    double sign = half % 2 == 0 ? 1.0 : -1.0;
    Arc& arc = outline.arcs[static_cast<std::size_t>(outline.arc_count++)];
    arc.axis_1 = cone.axis_1 * sign;
    arc.axis_2 = cone.axis_2 * sign;
    arc.axis_3 = cone.axis_3;
    arc.sin_1 = cone.sin_1;
    arc.cos_1 = cone.cos_1;
    arc.sin_2 = cone.sin_2;
    arc.cos_2 = cone.cos_2;
    arc.t0 = std::tan(0.5 * from);
    arc.t1 = std::tan(0.5 * to);
  }
}

struct Center {
  double t, width;
};

// Where the arc comes nearest to the mirror direction, as the lobe sees it, and the distance over which
// things change.
Center FindFoot(const Arc& arc, const LobeView& view, double& least_slope2) {
  constexpr int kSamples = 5;
  double best_t = arc.t0, best = std::numeric_limits<double>::max();
  dual::vec2 slope, derivative;
  for (int i = 0; i < kSamples; ++i) {
    double t = arc.t0 + (arc.t1 - arc.t0) * i / (kSamples - 1);
    dual::ArcSlope(arc, view, t, slope, derivative);
    double slope2 = slope.x * slope.x + slope.y * slope.y;
    if (slope2 < best) {
      best = slope2;
      best_t = t;
    }
  }
  double spacing = (arc.t1 - arc.t0) / (kSamples - 1);
  double low = std::max(best_t - spacing, arc.t0), high = std::min(best_t + spacing, arc.t1);
  double t = best_t, offset = 0.0;
  double speed2 = 1.0, slope2 = best;
  for (int step = 0; step < 4; ++step) {
    dual::ArcSlope(arc, view, t, slope, derivative);
    speed2 = std::max(derivative.x * derivative.x + derivative.y * derivative.y, 1e-300);
    slope2 = slope.x * slope.x + slope.y * slope.y;
    best = std::min(best, slope2);
    offset = -(slope.x * derivative.x + slope.y * derivative.y) / speed2;
    if (step < 3) {
      t = std::clamp(t + offset, low, high);
    }
  }
  least_slope2 = std::min(least_slope2, best);
  double cross = slope.x * derivative.y - slope.y * derivative.x;
  return {t + offset, std::min(std::sqrt((view.alpha * view.alpha + cross * cross / speed2) / speed2), 8.0)};
}

void AddPanels(Outline& outline, const Arc& arc, const Center& foot) {
  auto add = [&](double t0, double t1, const Center& center) {
    if (t1 > t0) {
      outline.panels[static_cast<std::size_t>(outline.panel_count++)] =
          MakePanel(arc, t0, t1, center.t, center.width);
    }
  };
  // The tip of a long thin outline is a second place where much happens within a short stretch of t.
  double tip_width = arc.cos_2 > 0.0 ? 0.5 * arc.cos_1 / arc.cos_2 : 1.0;
  double spacing_at_tip = foot.width + foot.t * foot.t / foot.width;
  if (tip_width < 0.3 && arc.t0 < 0.0 && arc.t1 > 0.0 && tip_width < 0.5 * spacing_at_tip) {
    Center tip{0.0, std::max(tip_width, 1e-12)};
    double cut = foot.t * std::sqrt(tip.width) / (std::sqrt(tip.width) + std::sqrt(foot.width));
    cut = std::clamp(cut, arc.t0, arc.t1);
    if (foot.t < 0.0) {
      add(arc.t0, cut, foot);
      add(cut, 0.0, tip);
      add(0.0, arc.t1, tip);
    } else {
      add(arc.t0, 0.0, tip);
      add(0.0, cut, tip);
      add(cut, arc.t1, foot);
    }
  } else {
    add(arc.t0, arc.t1, foot);
  }
}

void MakePanels(Outline& outline, const LobeView& view, bool mirror_inside) {
  double least = std::numeric_limits<double>::max();
  for (int i = 0; i < outline.arc_count; ++i) {
    const Arc& arc = outline.arcs[static_cast<std::size_t>(i)];
    AddPanels(outline, arc, FindFoot(arc, view, least));
  }
  outline.ring_slope = mirror_inside || outline.arc_count == 0 ? 0.0 : std::sqrt(least);
}

}  // namespace

const std::array<TruthLevel, kTruthLevelCount>& TruthLevels() {
  static const std::array<TruthLevel, kTruthLevelCount> levels = {{{2.0, 1.0, 4, 1},
                                                                   {3.0, 2.0, 6, 1},
                                                                   {5.0, 3.0, 9, 1},
                                                                   {8.0, 4.0, 14, 1},
                                                                   {12.0, 6.0, 20, 1},
                                                                   {12.0, 6.0, 20, 2},
                                                                   {12.0, 6.0, 20, 4},
                                                                   {16.0, 6.0, 24, 8}}};
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
  glm::dvec3 mirror(-sin_v, 0.0, cos_v);
  glm::dvec3 center = local(light.center - point.position);
  bool mirror_inside = true;
  if (light.shape == LightShape::kRectangle) {
    glm::dvec3 a = local(light.axis_x) * light.half_size.x, b = local(light.axis_y) * light.half_size.y;
    double height = -glm::dot(center, local(light.normal));  // of the point above the lit side
    if (height == 0.0 || (height < 0.0 && !light.two_sided)) {
      return false;
    }
    // Counter-clockwise seen from outside the sphere of directions: as from behind the light.
    std::array<glm::dvec3, 4> corners = {center - a - b, center - a + b, center + a + b, center + a - b};
    if (height < 0.0) {
      std::swap(corners[1], corners[3]);
    }
    HorizonPolygon polygon = ClipToHorizon(corners);
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
  } else {
    LightCone cone;
    if (light.shape == LightShape::kDisk) {
      glm::dvec3 normal = local(light.normal);
      double height = -glm::dot(center, normal);
      if (height == 0.0 || (height < 0.0 && !light.two_sided)) {
        return false;
      }
      cone = DiskCone(center, height < 0.0 ? -normal : normal, light.half_size.x);
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
      AddCone(outline, cone, -0.5 * glm::pi<double>(), 1.5 * glm::pi<double>());
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
  MakePanels(outline, view, mirror_inside);
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
  Sums sums = Integrate(outline, view, TruthLevels()[static_cast<std::size_t>(level)]);
  result.specular = sums.specular;
  result.specular_grazing = sums.grazing;
  return result;
}

}  // namespace arealab

namespace arealab {

LightIntegrals IntegrateLight(const ShadingPoint& point, const Light& light, double tolerance) {
  LightIntegrals result;
  Outline outline;
  LobeView view;
  if (!MakeOutline(point, light, outline, view, result)) {
    return result;
  }
  result.form_factor_error = 1e-14 * result.form_factor;
  if (view.cos_v <= 0.0) {
    return result;
  }
  Sums before = Integrate(outline, view, TruthLevels()[1]);
  for (std::size_t level = 2; level < kTruthLevelCount; ++level) {
    Sums sums = Integrate(outline, view, TruthLevels()[level]);
    double change = std::abs(sums.specular - before.specular),
           change_grazing = std::abs(sums.grazing - before.grazing);
    result.specular = std::max(sums.specular, 0.0);
    result.specular_grazing = std::max(sums.grazing, 0.0);
    result.specular_error = std::max(change, 1e-14 * result.specular);
    result.specular_grazing_error = std::max(change_grazing, 1e-14 * result.specular_grazing);
    if (change <= tolerance * std::abs(sums.specular) &&
        change_grazing <= tolerance * std::abs(sums.grazing + 0.04 * sums.specular)) {
      break;
    }
    before = sums;
  }
  return result;
}

}  // namespace arealab
