// Truth of lights that show a texture: per channel, by product integration. The integrand is the texture × a kernel (the BRDF,
// cosine and solid angle). Squares of a quadtree over the light hold the weights that integrate the texture itself, as it is,
// against any polynomial through the square's Gauss nodes; so the kernel's smoothness alone says how far to divide.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "compare/truth.h"
#include "scenes/scene.h"
#include "scenes/texture_weights.h"

namespace arealab {

// LightIntegrals for each channel, × the texture.
struct ColorIntegrals {
  glm::dvec3 form_factor{0.0}, specular{0.0}, specular_grazing{0.0};
  glm::dvec3 form_factor_error{0.0}, specular_error{0.0}, specular_grazing_error{0.0};

  explicit ColorIntegrals(const LightIntegrals& white, const glm::dvec3& texel = glm::dvec3(1.0));
  ColorIntegrals() = default;
};

class TexturedLight {
 public:
  static constexpr std::size_t kNodes = 6;  // along a side of a square

  explicit TexturedLight(std::shared_ptr<const Image> texture);

  // Of a textured rectangle. Its error is the last division's change, for each integral relative to its brightest channel.
  ColorIntegrals Integrate(const ShadingPoint& point, const Light& light, double tolerance) const;

  // TextureWeights::Of at any depth: below the last level stored the texture is taken at the nodes.
  void Weights(int level, int x, int y, std::span<glm::dvec3, kNodes * kNodes> weights) const;

 private:
  std::shared_ptr<const Image> texture_;
  std::optional<glm::dvec3> constant_;     // every texel, where all are the same
  std::optional<TextureWeights> weights_;  // else
};

// What one light of a scene does to a point, textured or not; weights are made once.
class SceneLights {
 public:
  explicit SceneLights(const Scene& scene);
  ColorIntegrals Integrate(const ShadingPoint& point, std::size_t light, double tolerance) const;

 private:
  const Scene* scene_;
  std::vector<std::shared_ptr<const TexturedLight>> weights_;  // one per light; none where it has no texture
};

}  // namespace arealab
