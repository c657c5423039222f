#include "glsl/fit_cell.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

namespace arealab::fit {
namespace {

constexpr int kAlbedoNodes = 48;       // relative error of the albedo at most 4e-8 (measured, against 192)
constexpr int kPublishedSamples = 32;  // per axis, ltc_code's

template <int kCount>
using Vector = Eigen::Matrix<double, kCount, 1>;

// Four terms of P and, where it is free, the weight of the cosine lobe.
using Unknowns = Vector<5>;
// Four terms of one lobe, four of another, and the other's share.
using PairUnknowns = Vector<9>;

template <int kCount>
struct ExpansionOf {  // of a loss about a point: value, gradient/2 and the Gauss–Newton matrix/2
  double loss = 0.0;
  Vector<kCount> gradient = Vector<kCount>::Zero();
  Eigen::Matrix<double, kCount, kCount> hessian = Eigen::Matrix<double, kCount, kCount>::Zero();

  void Add(double residual, const Vector<kCount>& jacobian, double weight) {
    loss += weight * residual * residual;
    gradient += (weight * residual) * jacobian;
    AddSquare(jacobian, weight);
  }
  // Its lower triangle; written out, it is faster than Eigen's general rank update.
  void AddSquare(const Vector<kCount>& jacobian, double weight) {
    for (int column = 0; column < kCount; ++column) {
      const double scaled = weight * jacobian[column];
      for (int row = column; row < kCount; ++row) hessian(row, column) += scaled * jacobian[row];
    }
  }
};
using Expansion = ExpansionOf<5>;

bool IsLobe(const Terms& p) {
  return p[0] > 0.0 && p[3] > 0.0 && Determinant(p) > 0.0;
}

bool Admissible(const Terms& p) {
  return p.allFinite() && IsLobe(p);
}

bool Admissible(const Unknowns& p) {
  return p.allFinite() && IsLobe(p.head<4>());
}

bool Admissible(const PairUnknowns& p) {
  return p.allFinite() && IsLobe(p.head<4>()) && IsLobe(p.segment<4>(4));
}

// Puts a step's end where it may be: the second of two lobes is the lesser, or they could change roles from cell to cell.
void Confine(Terms&) {}
void Confine(Unknowns&) {}
void Confine(PairUnknowns& p) {
  p[8] = std::clamp(p[8], 0.0, 0.5);
}

// Of any number of unknowns, so that the decomposition is compiled once.
constexpr int kMostUnknowns = 9;
using AnyVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostUnknowns, 1>;
using AnyMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostUnknowns, kMostUnknowns>;
AnyVector Solve(const AnyMatrix& matrix, const AnyVector& right) {
  return matrix.selfadjointView<Eigen::Lower>().ldlt().solve(right);
}

// Levenberg–Marquardt on the active unknowns: damping × 0.1 after an accepted step, × 10 after a refused one
// [Marquardt 1963]. Ends when a step gains less than `gain` of the loss.
template <typename Function, int kCount>
double Minimise(const Function& expand, Vector<kCount>* p, const std::array<bool, static_cast<std::size_t>(kCount)>& active, int most_steps,
                double gain) {
  double damping = 1e-3;
  ExpansionOf<kCount> here = expand(*p);
  for (int step = 0; step < most_steps; ++step) {
    AnyMatrix matrix = here.hessian;  // its lower triangle
    AnyVector right = -here.gradient;
    for (int i = 0; i < kCount; ++i) {
      if (active[static_cast<std::size_t>(i)]) {
        matrix(i, i) *= 1.0 + damping;
      } else {
        matrix.row(i).setZero();
        matrix.col(i).setZero();
        matrix(i, i) = 1.0;
        right[i] = 0.0;
      }
    }
    Vector<kCount> trial = *p + Solve(matrix, right);
    Confine(trial);
    if (!Admissible(trial)) {
      damping *= 10.0;
      if (damping > 1e8) break;
      continue;
    }
    ExpansionOf<kCount> there = expand(trial);
    if (there.loss <= here.loss) {
      const double gained = here.loss - there.loss;
      *p = trial;
      here = there;
      damping = std::max(damping * 0.1, 1e-9);
      if (gained <= gain * here.loss) break;
    } else {
      damping *= 10.0;
      if (damping > 1e8) break;
    }
  }
  return here.loss;
}

// Nodes in whitened coordinates.
struct WhiteNodes {
  std::vector<glm::dvec3> direction;  // not unit
  double scale = 1.0;                 // |det| of the whitening
};

WhiteNodes Whiten(const Whitening& whitening, const Nodes& nodes) {
  WhiteNodes white;
  white.scale = whitening.width * whitening.depth;
  white.direction.reserve(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    white.direction.push_back(whitening.Apply({nodes.x[i], nodes.y[i], nodes.z[i]}));
  return white;
}

// ∫(ρ − k·LTC)² above the horizon over ∫ρ², with k = albedo/(1 − b), plus the penalty on b.
ExpansionOf<4> ExpandDensityLoss(const Terms& p, const Nodes& nodes, const WhiteNodes& white,
                            const Whitening& whitening, double albedo, double total, double leak_penalty) {
  ExpansionOf<4> sum;
  const Leak leak = BelowHorizon(whitening, p);
  const double magnitude = albedo / (1.0 - leak.share), kept = 1.0 / (1.0 - leak.share), inverse_total = 1.0 / total;
  Terms gradient;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double density = LtcDensity(p, white.direction[i], white.scale, &gradient);
    sum.Add(magnitude * density - nodes.density[i], magnitude * (gradient + density * kept * leak.gradient), nodes.weight[i] * inverse_total);
  }
  sum.Add(leak.share, leak.gradient, leak_penalty);
  return sum;
}

// Adds nodes of the directions below the true horizon, where ρ = 0: polar about +z of the whitened space, in
// which a fitted lobe has about unit width, from the horizon's great circle to the opposite pole.
void AppendLowerNodes(const Whitening& whitening, int count, Nodes* nodes) {
  const double qx = -whitening.axis_x / whitening.width, qz = whitening.axis_z / whitening.depth;
  for (const auto& [phi_position, phi_weight] : GaussRule(count)) {
    const double phi = glm::pi<double>() * phi_position;
    const double horizon = std::atan2(qz, -qx * std::cos(phi));
    const double span = glm::pi<double>() - horizon;
    for (const auto& [position, weight] : GaussRule(count)) {
      const double psi = horizon + span * position;
      const glm::dvec3 w(std::sin(psi) * std::cos(phi), std::sin(psi) * std::sin(phi), std::cos(psi));
      const glm::dvec3 v = whitening.Undo(w);
      const double length = glm::length(v);
      const double jacobian = std::sin(psi) * span * glm::two_pi<double>() /
                              (whitening.width * whitening.depth * length * length * length);
      nodes->x.push_back(v.x / length);
      nodes->y.push_back(v.y / length);
      nodes->z.push_back(v.z / length);
      nodes->weight.push_back(jacobian * weight * phi_weight);
      nodes->density.push_back(0.0);
      nodes->schlick.push_back(0.0);
    }
  }
}

// Whitened terms of the isotropic lobe of a given width about `direction` (in the plane of incidence),
// narrowed in that plane by `squeeze`.
Terms StartAbout(const Whitening& whitening, const glm::dvec3& direction, double width, double squeeze) {
  const Whitening about{direction.x, direction.z, 1.0, 1.0};
  return whitening.FromLocal(about.ToLocal(Terms(squeeze, 0.0, 0.0, width)));
}

struct DensityStage {
  Terms p = Terms::Zero();
  double loss = 0.0;
};

DensityStage FitDensity(const View& view, const Nodes& nodes, const Whitening& whitening,
                        const LobeMoments& moments, const Cell* previous, double leak_penalty) {
  const WhiteNodes white = Whiten(whitening, nodes);
  double total = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    total += nodes.weight[i] * nodes.density[i] * nodes.density[i];
  const auto expand = [&](const Terms& p) {
    return ExpandDensityLoss(p, nodes, white, whitening, moments.albedo, total, leak_penalty);
  };
  std::vector<Terms> starts;
  const double width = 2.0 * view.alpha / (1.0 + view.alpha);
  if (previous) {
    starts.push_back(StartAbout(whitening, moments.mean, width, 1.0));
    starts.push_back(StartAbout(whitening, moments.mean, width * view.cosine, view.cosine));
    starts.push_back(whitening.FromLocal(previous->m));
    starts.push_back(Terms(1.0, 0.0, 0.0, 1.0));
  } else {
    starts.push_back(Terms(1.0, 0.0, 0.0, width / whitening.depth));
  }
  const bool free = previous != nullptr;
  const std::array<bool, 4> active{free, free, free, true};
  DensityStage best;
  best.loss = std::numeric_limits<double>::infinity();
  for (const Terms& start : starts) {
    Terms p = start;
    if (!Admissible(p)) continue;
    const double loss = Minimise(expand, &p, active, 30, 1e-6);
    if (loss < best.loss) best = {p, loss};
  }
  return best;
}

// Of one lobe or two; 1/sr.
double Density(const Cell& cell, const glm::dvec3& direction) {
  const double first = LtcDensity(cell.m, direction, 1.0, nullptr);
  return cell.share == 0.0 ? first : (1.0 - cell.share) * first + cell.share * LtcDensity(cell.second, direction, 1.0, nullptr);
}

double UpperQuadIntegral(const Cell& cell, const Quad& quad) {
  const double first = UpperQuadIntegral(cell.m, quad);
  return cell.share == 0.0 ? first : (1.0 - cell.share) * first + cell.share * UpperQuadIntegral(cell.second, quad);
}

// cosine: weight of the cosine lobe beside it.
Cell MakeCell(const Whitening& whitening, const LobeMoments& moments, const Terms& p, double cosine = 0.0) {
  Cell cell;
  cell.m = whitening.ToLocal(p);
  cell.albedo = moments.albedo;
  cell.schlick = moments.schlick;
  cell.leak = BelowHorizon(whitening, p).share;
  cell.cosine = cosine;
  return cell;
}

// The direction that M⁻¹ takes to `w`.
glm::dvec3 Undo(const Terms& m, const glm::dvec3& w) {
  const double determinant = Determinant(m);
  return {(m[3] * w.x - m[2] * w.z) / determinant, w.y, (m[0] * w.z - m[1] * w.x) / determinant};
}

// Nodes per axis of the masks: at grazing views the horizon shears the half vector's coordinates, and what
// the control misses grows. Measured at roughness 0.2, 88°: relative error of the integrals 13 % with 24, 2 %
// with 48, 0.8 % with 64.
int MaskNodes(const View& view, int nodes) {
  return std::clamp(static_cast<int>(nodes * std::sqrt(0.35 / view.cosine)) / 2 * 2, nodes, 64);
}

// Of the squared errors of each integral: the first `world` quads and the others, each over their sum of squares.
std::vector<double> LossWeights(const std::vector<double>& wanted, std::size_t world, double lobe_share) {
  double total_world = 0.0, total_lobe = 0.0;
  for (std::size_t i = 0; i < wanted.size(); ++i) (i < world ? total_world : total_lobe) += wanted[i] * wanted[i];
  std::vector<double> weight;
  for (std::size_t i = 0; i < wanted.size(); ++i) weight.push_back(i < world ? (1.0 - lobe_share) / total_world : lobe_share / total_lobe);
  return weight;
}

// Compiled for wider vectors too; without fused products, so that both give the same bits.
#if defined(__x86_64__) && !defined(__clang__)
#define AREALAB_FIT_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define AREALAB_FIT_CLONES
#endif
constexpr std::size_t kLanes = 8;
// Σ share over the directions with n·d > 0 for the four n, whose length makes the clamp below a step. count: a multiple of kLanes.
AREALAB_FIT_CLONES float SumInside(const float* x, const float* y, const float* z, const float* share, std::size_t count,
                                   const std::array<glm::vec3, 4>& n) {
  std::array<float, kLanes> sum{};
  for (std::size_t i = 0; i < count; i += kLanes) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      const std::size_t j = i + k;
      float least = 1.0f;
      for (const glm::vec3& normal : n) {
        const float d = x[j] * normal.x + y[j] * normal.y + z[j] * normal.z;
        least = d < least ? d : least;
      }
      sum[k] += (least > 0.0f ? least : 0.0f) * share[j];
    }
  }
  return ((sum[0] + sum[4]) + (sum[2] + sum[6])) + ((sum[1] + sum[5]) + (sum[3] + sum[7]));
}

// Sums over the nodes inside a quad.
class MaskedSum {
 public:
  MaskedSum(const Nodes& nodes, const std::vector<double>& values) {
    for (std::vector<float>* array : {&x_, &y_, &z_, &share_}) array->resize((nodes.size() + kLanes - 1) / kLanes * kLanes);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      x_[i] = static_cast<float>(nodes.x[i]);
      y_[i] = static_cast<float>(nodes.y[i]);
      z_[i] = static_cast<float>(nodes.z[i]);
      share_[i] = static_cast<float>(nodes.weight[i] * values[i]);
    }
  }

  double operator()(const Quad& quad) const {
    // Scaled so that the clamp is a step, but for directions within 1e-25 of an edge's plane.
    constexpr double kSteep = 1e25;
    std::array<glm::vec3, 4> n;
    for (std::size_t i = 0; i < 4; ++i) n[i] = glm::vec3(glm::normalize(quad.normal[i]) * kSteep);
    return static_cast<double>(SumInside(x_.data(), y_.data(), z_.data(), share_.data(), x_.size(), n));
  }

 private:
  std::vector<float> x_, y_, z_, share_;
};

}  // namespace

double LtcDensity(const Terms& p, const glm::dvec3& v, double scale, Terms* gradient) {
  const double ux = p[0] * v.x + p[2] * v.z, uz = p[1] * v.x + p[3] * v.z;
  if (uz <= 0.0) {
    if (gradient) gradient->setZero();
    return 0.0;
  }
  const double determinant = Determinant(p);
  const double length2 = ux * ux + v.y * v.y + uz * uz;
  const double base = scale / (glm::pi<double>() * length2 * length2);
  const double density = uz * determinant * base;
  if (gradient) {
    const double by_x = -4.0 * ux / length2 * density;
    const double by_z = determinant * base - 4.0 * uz / length2 * density;
    const double by_determinant = uz * base;
    *gradient = {by_x * v.x + by_determinant * p[3], by_z * v.x - by_determinant * p[2],
                 by_x * v.z - by_determinant * p[1], by_z * v.z + by_determinant * p[0]};
  }
  return density;
}

Whitening LobeWhitening(const View& view) {
  if (IsDiffuse(view.brdf)) return {};
  // The half vector's slope across is (l·n + v·n)/2 × the light's: a lobe that spreads to heights of α widens
  // by as much.
  const double width = std::min(1.0, view.cosine + 0.5 * view.alpha);
  return {-view.sine, view.cosine, width, 2.0 * view.alpha / (1.0 + view.alpha) * width};
}

LossQuads MakeLossQuads(int count) {
  return {RandomRectangles(count / 2, 11), RandomLobeQuads(count - count / 2, 12)};
}

std::vector<double> LobeIntegrals(const View& view, const std::vector<Quad>& quads, int nodes,
                                  const Cell& control) {
  const Nodes both = BothSides(UpperNodes(view, nodes, nodes));
  const double magnitude = control.albedo / (1.0 - control.leak);
  std::vector<double> residual(both.size());
  for (std::size_t i = 0; i < both.size(); ++i)
    residual[i] =
        both.density[i] - magnitude * Density(control, {both.x[i], both.y[i], both.z[i]});
  const MaskedSum masked(both, residual);
  std::vector<double> integrals;
  integrals.reserve(quads.size());
  for (const Quad& quad : quads)
    integrals.push_back(magnitude * UpperQuadIntegral(control, quad) + masked(quad));
  return integrals;
}

Cell FitPolygonCell(const View& view, const LossQuads& quads, const PolygonFit& settings,
                    const Cell* previous) {
  const Nodes upper = UpperNodes(view, settings.nodes, settings.nodes);
  const LobeMoments moments = Moments(UpperNodes(view, kAlbedoNodes, kAlbedoNodes));
  const Whitening whitening = LobeWhitening(view);
  const DensityStage density = FitDensity(view, upper, whitening, moments, previous, settings.leak_penalty);
  const Cell control = MakeCell(whitening, moments, density.p);

  std::vector<Quad> local = quads.world;
  for (const Quad& quad : quads.lobe) {
    std::array<glm::dvec3, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) corners[i] = Undo(control.m, quad.corner[i]);
    local.push_back(MakeQuad(corners));
  }
  const std::vector<double> wanted = LobeIntegrals(view, local, MaskNodes(view, settings.nodes), control);
  std::vector<Quad> white;
  std::vector<double> cosine;
  for (std::size_t i = 0; i < local.size(); ++i) {
    white.push_back(Transform(whitening, settings.above_horizon ? ClipAbove(local[i]) : local[i]));
    cosine.push_back(settings.with_cosine ? UpperQuadIntegral(Terms(1.0, 0.0, 0.0, 1.0), local[i]) : 0.0);
  }
  const std::vector<double> weight = LossWeights(wanted, quads.world.size(), settings.lobe_share);
  const auto expand = [&](const Unknowns& p) {
    Expansion sum;
    const Terms terms = p.head<4>();
    const Leak leak = BelowHorizon(whitening, terms);
    const double kept = 1.0 - leak.share, magnitude = (moments.albedo - p[4]) / kept;
    Unknowns jacobian;
    Terms gradient;
    for (std::size_t i = 0; i < white.size(); ++i) {
      const double integral = QuadIntegral(terms, white[i], &gradient);
      jacobian.head<4>() = magnitude * (gradient + integral / kept * leak.gradient);
      jacobian[4] = cosine[i] - integral / kept;
      sum.Add(magnitude * integral + p[4] * cosine[i] - wanted[i], jacobian, weight[i]);
    }
    jacobian.head<4>() = leak.gradient;
    jacobian[4] = 0.0;
    sum.Add(leak.share, jacobian, settings.leak_penalty);
    jacobian.setZero();
    jacobian[4] = 1.0;
    sum.Add(p[4], jacobian, settings.cosine_penalty);
    return sum;
  };
  const bool free = previous != nullptr;
  const std::array<bool, 5> active{free, free, free, true, settings.with_cosine};
  // One valley: where tried, at 80° and 88°, ten to twelve of twelve random starts met in the same optimum.
  Unknowns best = Unknowns::Zero();
  best.head<4>() = density.p;
  if (previous) {
    Unknowns other = Unknowns::Zero();
    other.head<4>() = whitening.FromLocal(previous->m);
    other[4] = previous->cosine;
    if (Admissible(other) && expand(other).loss < expand(best).loss) best = other;
  }
  Minimise(expand, &best, active, 30, 1e-6);
  return MakeCell(whitening, moments, best.head<4>(), best[4]);
}

namespace {

// The whitenings in which two lobes are fitted. A sharp ρ's second lobe may be wide or as narrow as the first: it is measured between.
struct PairFrames {
  Whitening first, second;
};

PairFrames FramesOf(const View& view) {
  PairFrames frames{LobeWhitening(view), LobeWhitening(view)};
  frames.second.width = std::sqrt(frames.first.width);
  frames.second.depth = std::sqrt(frames.first.depth);
  return frames;
}

// At roughness 1 and normal incidence, where the whitenings are the identity.
const PairUnknowns kPairStart{{1.0, 0.0, 0.0, 0.7, 1.0, 0.0, 0.0, 1.5, 0.25}};

// A loss of two lobes about a point: what both stages share. Their sum's magnitude is albedo/(1 − b), b its share below the horizon.
class PairLoss {
 public:
  PairLoss(const PairFrames& frames, const PairUnknowns& p, double albedo)
      : share_(p[8]), first_(BelowHorizon(frames.first, p.head<4>())), second_(BelowHorizon(frames.second, p.segment<4>(4))) {
    below_ = (1.0 - share_) * first_.share + share_ * second_.share;
    below_gradient_ << (1.0 - share_) * first_.gradient, share_ * second_.gradient, second_.share - first_.share;
    magnitude_ = albedo / (1.0 - below_);
  }

  // What each lobe has of a direction or a quad, with its derivatives, against ρ's.
  void Add(double first, const Terms& by_first, double second, const Terms& by_second, double wanted, double weight) {
    const double both = (1.0 - share_) * first + share_ * second;
    PairUnknowns jacobian;
    jacobian << (1.0 - share_) * by_first, share_ * by_second, second - first;
    jacobian = magnitude_ * (jacobian + both / (1.0 - below_) * below_gradient_);
    sum.Add(magnitude_ * both - wanted, jacobian, weight);
  }

  void AddPenalties(const PairUnknowns& p, double alpha, const std::vector<Cell>& neighbours, const PolygonFit& settings) {
    sum.Add(below_, below_gradient_, settings.leak_penalty);
    sum.Add(p[8] - kPairStart[8], PairUnknowns::Unit(8), settings.share_penalty);
    const double penalty = settings.step_penalty * (1.0 + 0.02 / alpha);
    for (const Cell& neighbour : neighbours)
      for (int i = 0; i < 9; ++i) sum.Add(p[i] - neighbour.fitted[i], PairUnknowns::Unit(i), penalty);
  }

  ExpansionOf<9> sum;

 private:
  double share_;
  Leak first_, second_;
  double below_, magnitude_;
  PairUnknowns below_gradient_;
};

Cell MakePairCell(const PairFrames& frames, const LobeMoments& moments, const PairUnknowns& p) {
  Cell cell;
  cell.m = frames.first.ToLocal(p.head<4>());
  cell.second = frames.second.ToLocal(p.segment<4>(4));
  cell.share = p[8];
  cell.albedo = moments.albedo;
  cell.schlick = moments.schlick;
  cell.leak = (1.0 - p[8]) * BelowHorizon(frames.first, p.head<4>()).share + p[8] * BelowHorizon(frames.second, p.segment<4>(4)).share;
  cell.fitted = p;
  return cell;
}

// Divides ∫ρ(1 − v·h)⁵ among the lobes as their own integrals are.
void DivideSchlick(const Nodes& upper, Cell* cell) {
  double first = 0.0, second = 0.0;
  for (std::size_t i = 0; i < upper.size(); ++i) {
    const glm::dvec3 direction(upper.x[i], upper.y[i], upper.z[i]);
    const double weight = upper.weight[i] * upper.schlick[i];
    first += weight * (1.0 - cell->share) * LtcDensity(cell->m, direction, 1.0, nullptr);
    second += weight * cell->share * LtcDensity(cell->second, direction, 1.0, nullptr);
  }
  cell->second_schlick = cell->schlick * second / (first + second);
}

}  // namespace

Cell FitPairCell(const View& view, const LossQuads& quads, const PolygonFit& settings, bool isotropic, const std::vector<Cell>& neighbours) {
  const Nodes upper = UpperNodes(view, settings.nodes, settings.nodes);
  const Nodes dense = UpperNodes(view, kAlbedoNodes, kAlbedoNodes);
  const LobeMoments moments = Moments(dense);
  const PairFrames frames = FramesOf(view);
  const WhiteNodes white_first = Whiten(frames.first, upper), white_second = Whiten(frames.second, upper);
  double total = 0.0;
  for (std::size_t i = 0; i < upper.size(); ++i) total += upper.weight[i] * upper.density[i] * upper.density[i];
  const auto expand_density = [&](const PairUnknowns& p) {
    PairLoss loss(frames, p, moments.albedo);
    Terms by_first, by_second;
    for (std::size_t i = 0; i < upper.size(); ++i) {
      const double first = LtcDensity(p.head<4>(), white_first.direction[i], white_first.scale, &by_first);
      const double second = LtcDensity(p.segment<4>(4), white_second.direction[i], white_second.scale, &by_second);
      loss.Add(first, by_first, second, by_second, upper.density[i], upper.weight[i] / total);
    }
    loss.AddPenalties(p, view.alpha, neighbours, settings);
    return loss.sum;
  };
  std::array<bool, 9> active;
  active.fill(!isotropic);
  active[3] = active[7] = active[8] = true;
  PairUnknowns best = neighbours.empty() ? kPairStart : neighbours[0].fitted;
  Minimise(expand_density, &best, active, 30, 1e-6);
  const Cell control = MakePairCell(frames, moments, best);

  std::vector<Quad> local = quads.world;
  for (const Quad& quad : quads.lobe) {
    std::array<glm::dvec3, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) corners[i] = frames.first.Undo(quad.corner[i]);
    local.push_back(MakeQuad(corners));
  }
  const std::vector<double> wanted = LobeIntegrals(view, local, MaskNodes(view, settings.nodes), control);
  const std::vector<double> weight = LossWeights(wanted, quads.world.size(), settings.lobe_share);
  std::vector<Quad> first_quads, second_quads;
  for (const Quad& quad : local) {
    first_quads.push_back(Transform(frames.first, quad));
    second_quads.push_back(Transform(frames.second, quad));
  }
  const auto expand = [&](const PairUnknowns& p) {
    PairLoss loss(frames, p, moments.albedo);
    Terms by_first, by_second;
    for (std::size_t i = 0; i < local.size(); ++i) {
      const double first = QuadIntegral(p.head<4>(), first_quads[i], &by_first);
      const double second = QuadIntegral(p.segment<4>(4), second_quads[i], &by_second);
      loss.Add(first, by_first, second, by_second, wanted[i], weight[i]);
    }
    loss.AddPenalties(p, view.alpha, neighbours, settings);
    return loss.sum;
  };
  if (!isotropic)
    for (const Cell& neighbour : neighbours)
      if (expand(neighbour.fitted).loss < expand(best).loss) best = neighbour.fitted;
  Minimise(expand, &best, active, 60, 1e-6);
  Cell cell = MakePairCell(frames, moments, best);
  DivideSchlick(dense, &cell);
  return cell;
}

PublishedCell FitPublishedCell(const View& view, int nodes, bool isotropic, const AverageFrameTerms& start) {
  // The authors' estimator draws from the lobe's own density; where that is not GGX's, which ours draws from,
  // quadrature does them more justice.
  const bool sampled = view.brdf == Brdf::kGgx || view.brdf == Brdf::kGgxSeparable;
  const LobeMoments moments = sampled ? SampledMoments(view, kPublishedSamples)
                                      : Moments(UpperNodes(view, kAlbedoNodes, kAlbedoNodes));
  const Whitening mirror = LobeWhitening(view);
  Nodes all = UpperNodes(view, nodes, nodes);
  AppendLowerNodes(mirror, nodes, &all);
  const glm::dvec3 mean = isotropic ? glm::dvec3(0.0, 0.0, 1.0) : moments.mean;
  const Whitening frame{mean.x, mean.z, 1.0, 1.0};
  const WhiteNodes white = Whiten(frame, all);
  double total = 0.0;
  for (std::size_t i = 0; i < all.size(); ++i) total += all.weight[i] * std::pow(all.density[i], 3.0);
  // |e|³ = |e|·e²: each step is one of least squares weighted by |e|, doubled in the matrix for the weight's
  // own slope.
  const auto expand = [&](const Unknowns& p) {
    Expansion sum;
    const Terms terms = p.head<4>();
    Unknowns jacobian = Unknowns::Zero();
    Terms gradient;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double error =
          moments.albedo * LtcDensity(terms, white.direction[i], 1.0, &gradient) - all.density[i];
      jacobian.head<4>() = moments.albedo * gradient;
      const double weight = all.weight[i] / total * std::abs(error);
      sum.loss += weight * error * error;
      sum.gradient += (1.5 * weight * error) * jacobian;
      sum.AddSquare(jacobian, 3.0 * weight);
    }
    return sum;
  };
  // M⁻¹ in the average frame over its middle element: (m22/m11, 0, −m13 m22/m11; ·; 0, 0, m22), rows.
  Unknowns p = Unknowns::Zero();
  p.head<4>() = isotropic ? Terms(1.0, 0.0, 0.0, start.m11)
                          : Terms(start.m22 / start.m11, 0.0, -start.m13 * start.m22 / start.m11, start.m22);
  Minimise(expand, &p, {!isotropic, false, !isotropic, true, false}, 100, 1e-9);
  PublishedCell result;
  result.cell = MakeCell(frame, moments, p.head<4>());
  result.terms = {p[3] / p[0], p[3], -p[2] / p[0]};
  return result;
}

Cell FitDensityCell(const View& view, int nodes, const Cell* previous) {
  const Nodes upper = UpperNodes(view, nodes, nodes);
  const LobeMoments moments = Moments(upper);
  const Whitening whitening = LobeWhitening(view);
  return MakeCell(whitening, moments, FitDensity(view, upper, whitening, moments, previous, 0.0).p);
}

}  // namespace arealab::fit
