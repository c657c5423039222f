#include "compare/textured_sky.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <vector>

#include "compare/light_sampling.h"
#include "scenes/sky.h"
// clang-format off: the order matters
#include "glsl/dual_begin.h"
#include "glsl/brdf.glsl"
#include "glsl/brdf_choices.h"
#include "glsl/dual_end.h"
// clang-format on

namespace arealab {
namespace {

constexpr int kFirstSkyRows = 4, kMostSkyRows = 1024;  // of the levels that hold means
constexpr int kDeepestSkyLevel = 16;                     // α = 1e-4 asks for level 14
constexpr double kDiffuseRadius = 0.08;          // rad, of a cell: where the cosine's error is 1e-3 and less; see tests/compare/textured_sky_test.cpp
constexpr double kShadowRadius = 0.04;           // where rays find what hides the sky
constexpr double kLobeShare = 0.2;               // of the lobe's own scale, a cell's radius
constexpr double kEdgeShare = 5e-5;              // of a white surface's light: the most that a cell which a light's edge cuts may give

}  // namespace

TexturedSky::TexturedSky(const Scene& scene) : scene_(&scene) {
  if (!scene.sky) return;
  mean_ = scene.sky->radiance;
  if (!scene.sky->texture) return;
  const Image& image = *scene.sky->texture;
  mean_ *= MeanSkyTexel(image);
  int rows = kFirstSkyRows;
  while (rows < std::min(image.height, kMostSkyRows)) rows *= 2;
  for (int r = kFirstSkyRows; r <= rows; r *= 2) {
    Level& level = levels_.emplace_back(Level{r, {}, {}, {}, {}});
    level.radiance.resize(static_cast<std::size_t>(2 * r) * static_cast<std::size_t>(r));
    for (int x = 0; x < 2 * r; ++x) {
      const glm::dvec3 d = SkyDirection({(x + 0.5) / (2 * r), 0.5}, scene.sky->turn);
      level.across.emplace_back(d.x, d.y);
    }
    for (int y = 0; y < r; ++y) {
      const double polar = glm::pi<double>() * (y + 0.5) / r;
      level.down.emplace_back(std::sin(polar), std::cos(polar));
      level.solid_angle.push_back(glm::pi<double>() / r * (std::cos(glm::pi<double>() * y / r) - std::cos(glm::pi<double>() * (y + 1) / r)));
    }
  }
  Level& finest = levels_.back();
  const int across = std::max((image.height + rows - 1) / rows, 2);  // samples along a cell's side
  tbb::parallel_for(0, rows, [&](int y) {
    for (int x = 0; x < 2 * rows; ++x) {
      glm::dvec3 sum(0.0);
      for (int k = 0; k < across * across; ++k) {
        const glm::dvec2 inside = (glm::dvec2(k % across, k / across) + 0.5) / static_cast<double>(across);
        sum += SkyTexel(image, (glm::dvec2(x, y) + inside) / glm::dvec2(2 * rows, rows));
      }
      finest.radiance[static_cast<std::size_t>(y * 2 * rows + x)] = glm::vec3(scene.sky->radiance * sum / static_cast<double>(across * across) - mean_);
    }
  });
  for (std::size_t l = levels_.size() - 1; l > 0; --l) {
    const Level& fine = levels_[l];
    Level& coarse = levels_[l - 1];
    for (int y = 0; y < coarse.rows; ++y) {
      const auto upper = static_cast<float>(fine.solid_angle[static_cast<std::size_t>(2 * y)]), lower = static_cast<float>(fine.solid_angle[static_cast<std::size_t>(2 * y + 1)]);
      for (int x = 0; x < 2 * coarse.rows; ++x) {
        const auto at = [&](int i, int j) { return fine.radiance[static_cast<std::size_t>((2 * y + j) * 2 * fine.rows + 2 * x + i)]; };
        coarse.radiance[static_cast<std::size_t>(y * 2 * coarse.rows + x)] = ((at(0, 0) + at(1, 0)) * upper + (at(0, 1) + at(1, 1)) * lower) / (2.0f * (upper + lower));
      }
    }
  }
}

// One pixel's walk through the cells.
struct TexturedSky::Walk {
  // A cell that is not divided, and the kernels of its parent and of its own.
  struct Leaf {
    glm::dvec3 amount;  // radiance × solid angle
    std::size_t own, parent;
  };

  const TexturedSky& sky;
  const ShadedPixel& pixel;
  double most_radius;
  struct Hider {
    LightDirections directions;
    glm::dvec3 middle;  // the direction to its centre
    double reach;       // rad, about it
  };
  std::vector<Hider> lights{};
  std::vector<Leaf> leaves{};
  std::vector<Kernel> kernels{};
  std::vector<RayQuery::ShadowRay> towards{};  // one per kernel

  Kernel At(double cos_l, const glm::dvec3& half, double cos_h) const {
    const ShadingPoint& point = pixel.point;
    if (!(cos_l > 0.0)) return {};
    const double cos_v = glm::dot(point.normal, point.to_view), h_dot_v = glm::dot(half, point.to_view);
    const double lobe = pixel.specular_weight == 0.0 ? 0.0
                                                     : dual::GgxDensity(std::min(cos_h, 1.0), point.alpha) * cos_l *
                                                           dual::BrdfOverGgx(point.brdf, cos_v, cos_l, h_dot_v, std::max(1.0 / (cos_h * cos_h) - 1.0, 0.0), point.alpha);
    return {cos_l / glm::pi<double>(), lobe, lobe * dual::SchlickWeight(h_dot_v)};
  }

  // How many lights hide a direction; whether any may within `radius` (rad); whether an edge of one runs through a cell.
  int Hiding(const glm::dvec3& l) const {
    return static_cast<int>(std::ranges::count_if(lights, [&](const Hider& light) { return light.directions.Towards(l).has_value(); }));
  }
  bool NearLight(const glm::dvec3& l, double radius) const {
    return std::ranges::any_of(lights, [&](const Hider& light) { return std::acos(std::clamp(glm::dot(l, light.middle), -1.0, 1.0)) < light.reach + radius; });
  }
  bool Cut(const Cell& cell, int rows, int hiding) const {
    for (int k = 0; k < 4; ++k) {
      if (Hiding(SkyDirection(glm::dvec2(cell.x + k % 2, cell.y + k / 2) / glm::dvec2(2 * rows, rows), sky.scene_->sky->turn)) != hiding) return true;
    }
    return false;
  }

  void Visit(const Cell& cell, std::size_t parent) {
    const bool held = static_cast<std::size_t>(cell.level) < sky.levels_.size();
    const int rows = kFirstSkyRows << cell.level;
    glm::dvec3 l;
    double solid_angle, sine;
    if (held) {
      const Level& level = sky.levels_[static_cast<std::size_t>(cell.level)];
      const glm::dvec2& down = level.down[static_cast<std::size_t>(cell.y)];
      sine = down.x;
      l = glm::dvec3(down.x * level.across[static_cast<std::size_t>(cell.x)], down.y);
      solid_angle = level.solid_angle[static_cast<std::size_t>(cell.y)];
    } else {
      l = SkyDirection({(cell.x + 0.5) / (2 * rows), (cell.y + 0.5) / rows}, sky.scene_->sky->turn);
      const double step = glm::pi<double>() / rows;
      sine = std::sin(step * (cell.y + 0.5));
      solid_angle = 2.0 * std::sin(0.5 * step) * sine * step;  // the difference of cosines
    }
    const double side = glm::pi<double>() / rows, radius = 0.5 * side * std::sqrt(1.0 + std::min((sine + 0.5 * side) * (sine + 0.5 * side), 1.0));
    const ShadingPoint& point = pixel.point;
    const double cos_l = glm::dot(point.normal, l);
    if (cos_l < -radius) return;
    glm::dvec3 half = l + point.to_view;
    half /= std::max(glm::length(half), 1e-9);
    const double cos_h = glm::dot(point.normal, half);
    bool divide = radius > most_radius;
    if (!divide && pixel.specular_weight > 0.0 && cell.level < kDeepestSkyLevel) {
      // A step of l turns h by half of it over l·h; the lobe's scale there is √(α² + tan²θh), at the cell's nearest.
      const double spread = 2.0 * std::max(glm::dot(half, l), 0.05), tan_h = std::sqrt(std::max(1.0 - cos_h * cos_h, 0.0)) / std::max(cos_h, 1e-9);
      const double nearest = std::max(tan_h - radius / spread, 0.0);
      divide = radius > kLobeShare * spread * std::sqrt(point.alpha * point.alpha + nearest * nearest);
    }
    const Sky& shown = *sky.scene_->sky;
    const glm::dvec3 radiance = held ? glm::dvec3(sky.levels_[static_cast<std::size_t>(cell.level)].radiance[static_cast<std::size_t>(cell.y * 2 * rows + cell.x)])
                                     : SkyRadiance(shown, l) - sky.mean_;
    Kernel kernel = At(cos_l, half, cos_h);
    if (!lights.empty() && NearLight(l, radius)) {
      const int hiding = Hiding(l);
      if (!divide && cell.level < kDeepestSkyLevel && solid_angle * Luminance(glm::abs(radiance)) * (kernel.diffuse + kernel.specular) > kEdgeShare * Luminance(sky.mean_)) {
        divide = Cut(cell, rows, hiding);
      }
      kernel = {kernel.diffuse * (1 - hiding), kernel.specular * (1 - hiding), kernel.grazing * (1 - hiding)};
    }
    const std::size_t own = kernels.size();
    kernels.push_back(kernel);
    towards.push_back({glm::vec3(l), std::numeric_limits<float>::infinity()});
    if (divide) {
      for (int k = 0; k < 4; ++k) Visit({cell.level + 1, 2 * cell.x + k % 2, 2 * cell.y + k / 2}, own);
      return;
    }
    leaves.push_back({radiance * solid_angle, own, parent});
  }
};

TexturedSky::Rest TexturedSky::Integrate(const ShadedPixel& pixel, const RayQuery* rays, const glm::dvec3& origin) const {
  Walk walk{*this, pixel, rays ? kShadowRadius : kDiffuseRadius};
  for (const Light& light : scene_->lights) {
    const auto directions = LightDirections::From(pixel.point.position, pixel.point.normal, light);
    if (!directions) continue;
    const glm::dvec3 to_light = light.center - pixel.point.position;
    const double distance = glm::length(to_light), reach = glm::length(light.half_size);
    walk.lights.push_back({*directions, to_light / distance, reach < distance ? std::asin(reach / distance) : glm::pi<double>()});
  }
  for (int y = 0; y < kFirstSkyRows; ++y) {
    for (int x = 0; x < 2 * kFirstSkyRows; ++x) walk.Visit({0, x, y}, 0);
  }
  std::vector<std::uint8_t> occluded(walk.towards.size(), 0);
  if (rays) rays->Occluded(origin, walk.towards, occluded);

  const auto reflected = [&](const glm::dvec3& diffuse, const glm::dvec3& specular, const glm::dvec3& grazing) {
    return Part{pixel.albedo * diffuse, pixel.specular_weight * (pixel.f0 * (specular - grazing) + grazing)};
  };
  // The sum of the leaves' amounts, each × the kernel that is asked for; without those that are hidden, where that is asked.
  const auto sum = [&](std::size_t Walk::Leaf::*kernel, bool shadows) {
    glm::dvec3 diffuse(0.0), specular(0.0), grazing(0.0);
    for (const Walk::Leaf& leaf : walk.leaves) {
      if (shadows && occluded[leaf.*kernel] != 0) continue;
      const Kernel& k = walk.kernels[leaf.*kernel];
      diffuse += leaf.amount * k.diffuse;
      specular += leaf.amount * k.specular;
      grazing += leaf.amount * k.grazing;
    }
    return reflected(diffuse, specular, grazing);
  };
  Rest rest;
  rest.all = sum(&Walk::Leaf::own, false);
  rest.free = rays ? sum(&Walk::Leaf::own, true) : rest.all;
  const Part coarse = sum(&Walk::Leaf::parent, rays != nullptr);
  rest.error = glm::abs(rest.free.diffuse - coarse.diffuse) + glm::abs(rest.free.specular - coarse.specular);
  return rest;
}

}  // namespace arealab
