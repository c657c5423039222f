// The host's copy of a scene's G-buffer: what every technique and the truth shade. Row 0 is the top of the picture.
#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace arealab {

// What a pixel shows.
enum class PixelKind { kBackground = 0, kSurface = 1, kEmitter = 2 };

struct SurfacePixels {
  int width = 0;
  int height = 0;
  glm::vec3 view_position{0.0f};     // m, world: the camera
  std::vector<glm::vec4> position;   // m, world; w: 0 background, 1 surface, 2 + i emitter i's lit side, −2 − i its dark side
  std::vector<glm::vec4> normal;     // unit shading normal (its plane is the horizon); w: artist's roughness
  std::vector<glm::vec4> base_color; // linear sRGB; w: metalness, or below 0 a non-metal whose specular lobe weighs 1 + w

  std::vector<glm::vec4> aperture;   // of what is open: unit axis, versine, see scenes/bake.h; empty where none was baked

  std::size_t size() const { return position.size(); }
  bool IsSurface(std::size_t i) const { return position[i].w == 1.0f; }
};

// What a technique or the truth makes of them, in the scene's radiance unit, one entry per pixel; 0 off the surfaces.
struct RadianceImage {
  int width = 0;
  int height = 0;
  std::vector<glm::vec3> diffuse;
  std::vector<glm::vec3> specular;

  std::size_t size() const { return diffuse.size(); }
  glm::vec3 Total(std::size_t i) const { return diffuse[i] + specular[i]; }
};

}  // namespace arealab
