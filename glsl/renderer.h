// Draws a scene's G-buffer once and shades it with any variant, in one GL context.
#pragma once

#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "glsl/expand.h"
#include "glsl/pixels.h"
#include "glsl/variant.h"
#include "scenes/scene.h"

struct GladGLContext;

namespace arealab {

// All EFFECT_* with 0 or 1, as the scene calls for them.
std::vector<std::pair<std::string, int>> SceneEffects(const Scene& scene);

class Renderer {
 public:
  // `gl` is the current context's table of functions and, like `library`, outlives the renderer.
  Renderer(const GladGLContext& gl, const ShaderLibrary& library);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // Rasterises the scene into the float G-buffer; it stays the one that Shade reads until the next call.
  const SurfacePixels& DrawScene(const Scene& scene, glm::ivec2 size);

  // Compiles (once per content) and runs the lighting pass. Throws InputError with the author's file and line where the
  // text does not compile. `knobs` override the header's initial values by name.
  RadianceImage Shade(const Variant& variant, Precision precision = Precision::kFloat,
                      const std::map<std::string, double>& knobs = {});

  // Draws the pass for `variant` once more without reading it back, for a clock; ends with glFinish.
  void Draw(const Variant& variant, Precision precision = Precision::kFloat);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace arealab
