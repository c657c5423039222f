#include "glsl/fit_lobe.h"

#include <algorithm>
#include <array>
#include <limits>
#include <mutex>

#include "glsl/dual_begin.h"

#include "glsl/brdf.glsl"

#include "glsl/brdf_choices.h"

#include "glsl/dual_end.h"

namespace arealab::fit {
namespace {

// Newton's method on the Legendre polynomial P_n, from Chebyshev-like starts; full double precision in a few
// steps.
std::vector<std::pair<double, double>> MakeGaussRule(int count) {
  std::vector<std::pair<double, double>> rule(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    double x = std::cos(glm::pi<double>() * (i + 0.75) / (count + 0.5));
    double derivative = 1.0;
    for (int step = 0; step < 100; ++step) {
      double p = 1.0, previous = 0.0;
      for (int n = 1; n <= count; ++n) {
        const double next = ((2.0 * n - 1.0) * x * p - (n - 1.0) * previous) / n;
        previous = p;
        p = next;
      }
      derivative = count * (x * p - previous) / (x * x - 1.0);
      const double move = p / derivative;
      x -= move;
      if (std::abs(move) < 1e-16) break;
    }
    const double weight =
        1.0 / ((1.0 - x * x) * derivative * derivative);  // 2/(…) on [−1, 1], halved on [0, 1]
    rule[static_cast<std::size_t>(i)] = {0.5 * (1.0 - x), weight};
  }
  return rule;
}

// The slope tan θh beyond which a lobe has less than e⁻³⁶ of its peak, towards azimuth φ; infinite for those
// with GGX's tail.
double LastSlope(const View& view, double cos_phi) {
  constexpr double kNegligible = 36.0;
  const double alpha2 = view.alpha * view.alpha, c = view.cosine, s = view.sine;
  switch (view.brdf) {
    case Brdf::kBeckmann:
    case Brdf::kWard:
      return view.alpha * std::sqrt(kNegligible);
    case Brdf::kBlinnPhong:
      return std::sqrt(std::expm1(kNegligible / (1.0 / alpha2 + 1.0)));
    case Brdf::kPhong: {
      // r·l = 2 (c² − s² τ² cos²φ)/(1 + τ²) − c² + s² is 1 − x.
      const double x = -std::expm1(-2.0 * alpha2 * kNegligible);
      const double rest = 2.0 * c * c - x + 2.0 * s * s * cos_phi * cos_phi;
      return rest > 0.0 ? std::sqrt(x / rest) : std::numeric_limits<double>::infinity();
    }
    case Brdf::kGgx:
    case Brdf::kGgxSeparable:
    case Brdf::kLambert:
    case Brdf::kDisney:
      break;
  }
  return std::numeric_limits<double>::infinity();
}

void Reserve(Nodes& nodes, std::size_t count) {
  for (std::vector<double>* values : {&nodes.x, &nodes.y, &nodes.z, &nodes.weight, &nodes.density, &nodes.schlick}) values->reserve(count);
}

// Of a diffuse lobe, which follows no half vector: even in n·l and azimuth.
Nodes DiffuseNodes(const View& view, int radial, int azimuthal) {
  Nodes nodes;
  Reserve(nodes, static_cast<std::size_t>(radial * azimuthal));
  for (const auto& [phi_position, phi_weight] : GaussRule(azimuthal)) {
    const double cos_phi = std::cos(glm::pi<double>() * phi_position), sin_phi = std::sin(glm::pi<double>() * phi_position);
    for (const auto& [z, z_weight] : GaussRule(radial)) {
      const double sine = std::sqrt((1.0 - z) * (1.0 + z));
      const glm::dvec3 to_light(sine * cos_phi, sine * sin_phi, z);
      nodes.x.push_back(to_light.x);
      nodes.y.push_back(to_light.y);
      nodes.z.push_back(z);
      nodes.weight.push_back(glm::two_pi<double>() * z_weight * phi_weight);  // both halves of φ
      nodes.density.push_back(LobeDensity(view, to_light));
      nodes.schlick.push_back(dual::SchlickWeight(std::sqrt(std::max(0.5 + 0.5 * glm::dot(view.ToView(), to_light), 0.0))));
    }
  }
  return nodes;
}

}  // namespace

View MakeView(Brdf brdf, double roughness, double cosine) {
  const double alpha = IsDiffuse(brdf) ? 1.0 : std::max(roughness * roughness, dual::kMinAlpha);
  return {brdf, alpha, roughness, cosine, std::sqrt(std::max(0.0, (1.0 - cosine) * (1.0 + cosine)))};
}

double LobeDensity(const View& view, const glm::dvec3& to_light) {
  if (to_light.z <= 0.0) return 0.0;
  const glm::dvec3 half = glm::normalize(view.ToView() + to_light);
  // The sine keeps the digits of the peak; GgxDensity's own argument cannot hold α = 1e-4 to more than 1e-8.
  const double tan2 = (half.x * half.x + half.y * half.y) / (half.z * half.z);
  const double v_dot_h = glm::dot(view.ToView(), half);
  return dual::GgxDensity(half.z, view.alpha) *
         dual::BrdfOverGgx(view.brdf, view.cosine, to_light.z, v_dot_h, tan2, view.alpha, view.roughness) * to_light.z;
}

const std::vector<std::pair<double, double>>& GaussRule(int count) {
  constexpr int kLargest = 256;
  static std::array<std::once_flag, kLargest + 1> flags;
  static std::array<std::vector<std::pair<double, double>>, kLargest + 1> rules;
  assert(count >= 1 && count <= kLargest);
  const auto index = static_cast<std::size_t>(count);
  std::call_once(flags[index], [&] { rules[index] = MakeGaussRule(count); });
  return rules[index];
}

Nodes UpperNodes(const View& view, int radial, int azimuthal) {
  if (IsDiffuse(view.brdf)) return DiffuseNodes(view, radial, azimuthal);
  const auto& across = GaussRule(radial);
  const auto& around = GaussRule(azimuthal / 2);
  const double c = view.cosine, s = view.sine, alpha = view.alpha;
  Nodes nodes;
  Reserve(nodes, 2 * around.size() * across.size());
  for (int side = 0; side < 2; ++side) {
    for (const auto& [phi_position, phi_weight] : around) {
      const double phi = glm::half_pi<double>() * (side + phi_position);
      const double cos_phi = std::cos(phi), sin_phi = std::sin(phi);
      // l·n = (c + 2 s τ cos φ − c τ²)/(1 + τ²) with τ = tan θh; its positive root, without cancellation for
      // cos φ < 0.
      const double k = s * cos_phi;
      const double root = std::sqrt(k * k + c * c);
      const double tan_last = k > 0.0 ? (k + root) / c : c / (root - k);
      const double last = std::asinh(std::min(tan_last, LastSlope(view, cos_phi)) / alpha);
      for (const auto& [t_position, t_weight] : across) {
        const double t = last * t_position;
        const double grown = std::exp(t), shrunk = 1.0 / grown;
        const double tan_h = alpha * 0.5 * (grown - shrunk);
        const double tan2 = tan_h * tan_h;
        const double cos_h = 1.0 / std::sqrt(1.0 + tan2);
        const glm::dvec3 half(tan_h * cos_phi * cos_h, tan_h * sin_phi * cos_h, cos_h);
        const double v_dot_h = s * half.x + c * half.z;
        const double n_dot_l = std::max((c + 2.0 * k * tan_h - c * tan2) * cos_h * cos_h, 0.0);
        // dωl = 4 v·h dωh, dωh = τ/(1+τ²)^{3/2} dτ dφ, dτ = α cosh t dt; both halves of φ.
        const double jacobian = 4.0 * v_dot_h * tan_h * cos_h * cos_h * cos_h * alpha * 0.5 * (grown + shrunk) * last *
                                glm::half_pi<double>();
        nodes.x.push_back(2.0 * v_dot_h * half.x - s);
        nodes.y.push_back(2.0 * v_dot_h * half.y);
        nodes.z.push_back(n_dot_l);
        nodes.weight.push_back(2.0 * jacobian * t_weight * phi_weight);
        // D from tan θh directly: cos θh alone cannot resolve the peak at α = 1e-4.
        const double shape = 1.0 + tan2 / (alpha * alpha);
        const double density =
            (1.0 + tan2) * (1.0 + tan2) / (glm::pi<double>() * alpha * alpha * shape * shape);
        nodes.density.push_back(density * dual::BrdfOverGgx(view.brdf, c, n_dot_l, v_dot_h, tan2, alpha, view.roughness) *
                                n_dot_l);
        nodes.schlick.push_back(dual::SchlickWeight(v_dot_h));
      }
    }
  }
  return nodes;
}

Nodes BothSides(const Nodes& half) {
  Nodes nodes = half;
  for (double& weight : nodes.weight) weight *= 0.5;
  nodes.x.insert(nodes.x.end(), half.x.begin(), half.x.end());
  for (double y : half.y) nodes.y.push_back(-y);
  nodes.z.insert(nodes.z.end(), half.z.begin(), half.z.end());
  for (double weight : half.weight) nodes.weight.push_back(0.5 * weight);
  nodes.density.insert(nodes.density.end(), half.density.begin(), half.density.end());
  nodes.schlick.insert(nodes.schlick.end(), half.schlick.begin(), half.schlick.end());
  return nodes;
}

LobeMoments Moments(const Nodes& upper) {
  LobeMoments moments;
  double x = 0.0, z = 0.0;
  for (std::size_t i = 0; i < upper.size(); ++i) {
    const double share = upper.weight[i] * upper.density[i];
    moments.albedo += share;
    moments.schlick += share * upper.schlick[i];
    x += share * upper.x[i];
    z += share * upper.z[i];
  }
  moments.mean = glm::normalize(glm::dvec3(x, 0.0, z));
  return moments;
}

LobeMoments SampledMoments(const View& view, int count) {
  LobeMoments moments;
  glm::dvec3 sum(0.0);
  const glm::dvec3 to_view = view.ToView();
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) {
      const double phi = glm::two_pi<double>() * (i + 0.5) / count, u = (j + 0.5) / count;
      const double tan_h = view.alpha * std::sqrt(u / (1.0 - u));
      const glm::dvec3 half = glm::normalize(glm::dvec3(tan_h * std::cos(phi), tan_h * std::sin(phi), 1.0));
      const double v_dot_h = glm::dot(to_view, half);
      const glm::dvec3 to_light = 2.0 * v_dot_h * half - to_view;
      if (to_light.z <= 0.0) continue;
      // ρ over the samples' density D h·n/(4 |v·h|).
      const double over_ggx =
          dual::BrdfOverGgx(view.brdf, view.cosine, to_light.z, std::abs(v_dot_h), tan_h * tan_h, view.alpha);
      const double share = over_ggx * to_light.z * 4.0 * std::abs(v_dot_h) / half.z;
      moments.albedo += share;
      moments.schlick += share * dual::SchlickWeight(v_dot_h);
      sum += share * to_light;
    }
  }
  moments.albedo /= count * count;
  moments.schlick /= count * count;
  moments.mean = glm::normalize(glm::dvec3(sum.x, 0.0, sum.z));
  return moments;
}

double ViewCosine(double x, double last_cosine) {
  return 1.0 - x * x * (1.0 - last_cosine);
}

double ViewPosition(double cosine, double last_cosine) {
  return std::min(1.0, std::sqrt(std::max(0.0, 1.0 - cosine) / (1.0 - last_cosine)));
}

}  // namespace arealab::fit
