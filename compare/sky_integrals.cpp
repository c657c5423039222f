#include "compare/sky_integrals.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "compare/truth_bands.h"
#include "glsl/fit_lobe.h"

namespace arealab {
namespace {

// Points across and around the half-vector domain: against 96 of each relative errors are measured in tests/compare/sky_test.cpp.
constexpr int kSkyNodes = 32;
// Where both rules are this good, their difference is chance.
constexpr double kSkyRounding = 2e-8;

// A table's nodes, even in √(n·v) from where a mirror's lobe too is smooth on their scale; below, directly.
constexpr double kFirstRoot = 0.1;
constexpr std::size_t kIntervals = 256, kTableNodes = kIntervals + 1;
constexpr std::size_t kStencil = 6;

// Lagrange's weights at t of `count` nodes 0, 1, …, from the first on.
std::array<double, kStencil> LagrangeWeights(double t, std::size_t first, std::size_t count) {
  std::array<double, kStencil> weights{};
  for (std::size_t j = first; j < first + count; ++j) {
    weights[j] = 1.0;
    for (std::size_t m = first; m < first + count; ++m) {
      if (m != j) weights[j] *= (t - static_cast<double>(m)) / (static_cast<double>(j) - static_cast<double>(m));
    }
  }
  return weights;
}

}  // namespace

LightIntegrals IntegrateSky(const ShadingPoint& point) {
  const double cosine = glm::dot(point.normal, point.to_view);
  LightIntegrals sky;
  if (!(cosine > 0.0)) return sky;
  fit::View view;
  view.brdf = point.brdf;
  view.alpha = point.alpha;
  view.cosine = std::min(cosine, 1.0);
  view.sine = std::sqrt(std::max(0.0, (1.0 - view.cosine) * (1.0 + view.cosine)));
  const fit::LobeMoments fine = fit::Moments(fit::UpperNodes(view, kSkyNodes, kSkyNodes));
  const fit::LobeMoments coarse = fit::Moments(fit::UpperNodes(view, kSkyNodes / 2, kSkyNodes / 2));
  sky.form_factor = 1.0;
  sky.specular = fine.albedo;
  sky.specular_grazing = fine.schlick;
  sky.form_factor_error = std::numeric_limits<double>::epsilon();
  sky.specular_error = std::abs(fine.albedo - coarse.albedo) + kSkyRounding;
  sky.specular_grazing_error = std::abs(fine.schlick - coarse.schlick) + kSkyRounding;
  return sky;
}

SkyIntegrals::SkyIntegrals(const Scene& scene, const SurfacePixels& pixels) {
  if (!scene.sky) return;
  std::map<double, std::size_t> pixels_of;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (const std::optional<ShadedPixel> pixel = ShadedPixelAt(scene, pixels, i)) ++pixels_of[pixel->point.alpha];
  }
  for (const auto& [alpha, count] : pixels_of) {
    if (count <= kTableNodes) continue;
    std::vector<LightIntegrals>& table = tables_[alpha];
    table.resize(kTableNodes);
    tbb::parallel_for(std::size_t{0}, kTableNodes, [&, alpha = alpha](std::size_t k) {
      const double root = kFirstRoot + (1.0 - kFirstRoot) * static_cast<double>(k) / static_cast<double>(kIntervals);
      const double cosine = std::min(root * root, 1.0);
      table[k] = IntegrateSky({glm::dvec3(0.0), {0.0, 0.0, 1.0}, {std::sqrt(1.0 - cosine * cosine), 0.0, cosine}, alpha, scene.brdf});
    });
  }
}

LightIntegrals SkyIntegrals::At(const ShadingPoint& point) const {
  const auto table = tables_.find(point.alpha);
  const double root = std::sqrt(std::clamp(glm::dot(point.normal, point.to_view), 0.0, 1.0));
  if (table == tables_.end() || root < kFirstRoot) return IntegrateSky(point);
  const double place = (root - kFirstRoot) / (1.0 - kFirstRoot) * static_cast<double>(kIntervals);
  const auto cell = static_cast<std::size_t>(place);
  const std::size_t first = std::min(std::max(cell, kStencil / 2 - 1) - (kStencil / 2 - 1), kTableNodes - kStencil);
  const double t = place - static_cast<double>(first);
  const std::array<double, kStencil> fifth = LagrangeWeights(t, 0, kStencil), third = LagrangeWeights(t, 1, kStencil - 2);
  LightIntegrals sky;
  sky.form_factor = 1.0;
  sky.form_factor_error = std::numeric_limits<double>::epsilon();
  double specular_step = 0.0, grazing_step = 0.0;
  for (std::size_t j = 0; j < kStencil; ++j) {
    const LightIntegrals& node = table->second[first + j];
    sky.specular += fifth[j] * node.specular;
    sky.specular_grazing += fifth[j] * node.specular_grazing;
    specular_step += (fifth[j] - third[j]) * node.specular;
    grazing_step += (fifth[j] - third[j]) * node.specular_grazing;
    sky.specular_error = std::max(sky.specular_error, node.specular_error);
    sky.specular_grazing_error = std::max(sky.specular_grazing_error, node.specular_grazing_error);
  }
  sky.specular_error += std::abs(specular_step);
  sky.specular_grazing_error += std::abs(grazing_step);
  return sky;
}

}  // namespace arealab
