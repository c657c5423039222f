// Product integration over a texture: on squares of a quadtree over it, the weights that integrate texture × polynomial exactly for
// every polynomial through the square's Gauss nodes. With one node they are the texture's means over the squares.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scenes/scene.h"

namespace arealab {

struct GaussRuleOnUnit {
  std::vector<double> place, weight;  // on [0, 1]
};
const GaussRuleOnUnit& GaussOnUnit(std::size_t nodes);  // Gauss–Legendre, 1, 3 or 6 points

class TextureWeights {
 public:
  // `nodes` along a square's side.
  TextureWeights(const Image& texture, std::size_t nodes, int levels);

  // As many as tell texels apart, at most `most`.
  static int LevelsFor(const Image& texture, int most);

  int levels() const { return static_cast<int>(levels_.size()); }  // level l has 2^l × 2^l squares
  // Of square (x, y), from the texture's upper left: weights in the mean over the square, nodes row by row.
  std::span<const glm::vec3> Of(int level, int x, int y) const;

 private:
  std::size_t nodes_;
  std::vector<std::vector<glm::vec3>> levels_;
};

}  // namespace arealab
