// The G-buffer: a scene rasterised once into float textures, and the host's copy of them.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>

#include "glsl/gl_objects.h"
#include "glsl/pixels.h"
#include "glsl/program.h"
#include "glsl/shader_library.h"
#include "scenes/scene.h"

namespace arealab {

// What a camera sees through a picture.
struct CameraView {
  glm::dvec3 position;  // m, world: what float holds of the camera's, so that everyone means the same point
  glm::dvec3 right, up, forward;
  glm::dvec2 half_extent;  // of the picture at distance 1

  // The direction, unit, to a place of the picture; (0, 0) is its upper left corner, (1, 1) its lower right.
  glm::dvec3 Towards(const glm::dvec2& place) const;
};
CameraView ViewOf(const Camera& camera, glm::ivec2 size);

class GBuffer {
 public:
  GBuffer(const GladGLContext& gl, const ShaderLibrary& library);

  // Rasterises surfaces and emitters and reads them back; texel row 0 is the top of the picture. Throws
  // InputError where the size is not positive or too large for the context.
  const SurfacePixels& Draw(const Scene& scene, glm::ivec2 size);

  const SurfacePixels& pixels() const { return pixels_; }
  SurfacePixels TakePixels();
  GLuint position() const { return position_.id(); }  // textures, RGBA32F, as SurfacePixels has them
  GLuint normal() const { return normal_.id(); }
  GLuint base_color() const { return base_color_.id(); }
  // A cap's: 0 what is open, 1 and 2 its regions, 3 what is blocked; 0 where none was baked.
  GLuint aperture(std::size_t cap) const { return pixels_.aperture.empty() ? 0 : apertures_[cap].id(); }
  static constexpr std::size_t kCaps = 4;

 private:
  struct Geometry;  // the scene's triangles and what is drawn of them

  void Allocate(glm::ivec2 size);
  Geometry Gather(const Scene& scene, const glm::dvec3& camera);
  void DrawCoverage(const Geometry& geometry);
  const Program& ResolveProgram(bool apertures, bool normal_map);
  void Resolve(const Geometry& geometry);
  GLuint Upload(const std::shared_ptr<const Image>& image);
  void ReadBack();

  const GladGLContext& gl_;
  const ShaderLibrary& library_;
  Program coverage_program_;
  // By what a scene calls for, + 1 apertures, + 2 normal maps; each is compiled when a scene first does.
  std::array<std::optional<Program>, 4> resolve_programs_;
  GlObject vertex_array_;
  GlObject coverage_framebuffer_, framebuffer_;
  GlObject coverage_, depth_;
  GlObject position_, normal_, base_color_;
  std::array<GlObject, kCaps> apertures_;
  std::map<std::shared_ptr<const Image>, GlObject> textures_;  // of the scene drawn last
  SurfacePixels pixels_;
};

}  // namespace arealab
