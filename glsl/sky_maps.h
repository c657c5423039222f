// The image that a sky shows, on the GL, in the forms that shading text looks up. Each goes around with a margin at both sides, so that
// clamped look-ups have no seam: a width of 0.1 … 0.9 is the sky's own. Level l is half as wide as level l − 1.
//   sky_image   the image itself, at most 2048 across, then means over solid angles
//   sky_lobes   what the GGX lobe sees along its axis: D(h) G1(l)/4 about the direction, for a view along the normal [Walter 2007],
//               normalised. Layer i of level l has α = kFirstSkyAlpha · 2^(l + i/4): two texels, a fifth of a lobe's width and less.
//   sky_cosine  irradiance over π of a normal in the direction, normalised: ∫ L cosθ dω / ∫ cosθ dω
// The first and last rows of these two are the poles, so that a floor has its own; those of sky_image are the outermost texels.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "glsl/gl_objects.h"
#include "glsl/light_textures.h"
#include "glsl/program.h"
#include "scenes/scene.h"

namespace arealab {

// One form's layers, by the names above.
std::vector<TextureLevels> MakeSkyLevels(const std::string& name, const Image& image);

class SkyMaps {
 public:
  explicit SkyMaps(const GladGLContext& gl) : gl_(gl) {}

  // The image of a scene's sky from now on, or none; forms stay where it is the same.
  void Take(std::shared_ptr<const Image> image);

  // Binds the forms that the program reads.
  void Bind(const Program& program);

 private:
  const GladGLContext& gl_;
  std::shared_ptr<const Image> image_;
  std::map<std::string, GlObject> forms_;
};

}  // namespace arealab
