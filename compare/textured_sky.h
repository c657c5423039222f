// Truth of a sky that shows an image: what it gives beyond its mean, which is integrated as an even sky. Product integration over cells of
// latitude and longitude, each the mean radiance there × the BRDF, cosine and solid angle of its middle, divided until they are small
// against the lobes; so the kernel's smoothness alone says how far to divide, and a small sun is not missed.
#pragma once

#include <vector>

#include "compare/truth_bands.h"
#include "scenes/ray_query.h"
#include "scenes/scene.h"

namespace arealab {

class TexturedSky {
 public:
  // Empty where the scene's sky shows no texture; then Integrate is not to be called.
  explicit TexturedSky(const Scene& scene);

  explicit operator bool() const { return !levels_.empty(); }
  // Of the sky, over all directions; of one without a texture its radiance, of none 0.
  const glm::dvec3& mean() const { return mean_; }

  // Reflected radiance of the sky less its mean, where no light hides it: each hides it from its lit side, as it hides an even sky.
  struct Part {
    glm::dvec3 diffuse{0.0}, specular{0.0};
  };
  struct Rest {
    Part all, free;  // free: what surfaces hide left out, where rays are given; else the same
    glm::dvec3 error{0.0};  // of both lobes together: what it changes where every cell has its parent's kernel
  };
  Rest Integrate(const ShadedPixel& pixel, const RayQuery* rays = nullptr, const glm::dvec3& origin = {}) const;

 private:
  struct Level {  // of twice as many columns as rows
    int rows = 0;
    std::vector<glm::vec3> radiance;       // less the mean; none in levels finer than the image
    std::vector<glm::dvec2> across, down;  // sine and cosine of the azimuths and polar angles of the cells' middles
    std::vector<double> solid_angle;       // sr, of a cell of each row
  };
  struct Cell {
    int level, x, y;
  };
  struct Kernel {
    double diffuse = 0.0, specular = 0.0, grazing = 0.0;  // radiance per radiance and sr: of albedo 1, of Fresnel 1, × Schlick's weight
  };
  struct Walk;

  const Scene* scene_;
  glm::dvec3 mean_{0.0};
  std::vector<Level> levels_;  // from 8 × 4 cells on
};

}  // namespace arealab
