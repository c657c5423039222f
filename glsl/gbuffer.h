// The G-buffer: a scene rasterised once into float textures, and the host's copy of them.
#pragma once

#include <glm/glm.hpp>
#include <map>
#include <memory>

#include "glsl/gl_objects.h"
#include "glsl/pixels.h"
#include "glsl/program.h"
#include "glsl/shader_library.h"
#include "scenes/scene.h"

namespace arealab {

class GBuffer {
 public:
  GBuffer(const GladGLContext& gl, const ShaderLibrary& library);

  // Rasterises surfaces and emitters and reads them back; texel row 0 is the top of the picture. Throws InputError where
  // the size is not positive or too large for the context.
  const SurfacePixels& Draw(const Scene& scene, glm::ivec2 size);

  const SurfacePixels& pixels() const { return pixels_; }
  GLuint position() const { return position_.id(); }  // textures, RGBA32F, as SurfacePixels has them
  GLuint normal() const { return normal_.id(); }
  GLuint base_color() const { return base_color_.id(); }

 private:
  void Allocate(glm::ivec2 size);
  void DrawMesh(const Mesh& mesh);
  void UseMaterial(const Material& material);
  void UseTexture(GLuint unit, const std::shared_ptr<const Image>& image, const char* flag);
  void DrawEmitter(const Light& light, std::size_t index, const glm::dvec3& camera);
  void ReadBack(glm::ivec2 size);

  const GladGLContext& gl_;
  Program program_;
  GlObject vertex_array_;
  GlObject framebuffer_;
  GlObject position_, normal_, base_color_, depth_;
  std::map<std::shared_ptr<const Image>, GlObject> textures_;  // of the scene drawn last
  SurfacePixels pixels_;
};

}  // namespace arealab
