// Draws a scene's G-buffer once and shades it with any variant, in one GL context.
#pragma once

#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "glsl/effects.h"
#include "glsl/expand.h"
#include "glsl/pixels.h"
#include "glsl/variant.h"
#include "scenes/scene.h"

struct GladGLContext;

namespace arealab {

class Renderer {
 public:
  // `gl` is the current context's table of functions and, like `library`, outlives the renderer. The context
  // must be current whenever a member runs.
  Renderer(const GladGLContext& gl, const ShaderLibrary& library);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // Rasterises the scene into the float G-buffer; it stays the one that Shade reads until the next call.
  // Throws InputError where the size is not positive or too large, or the scene has too many lights.
  // `effects_off` are shaded as if the scene did not call for them: names from SceneEffects.
  const SurfacePixels& DrawScene(const Scene& scene, glm::ivec2 size, const std::set<std::string>& effects_off = {});

  // The host's copy of what DrawScene drew last, without copying it: what that returned is empty then. Shading goes on as before.
  SurfacePixels TakePixels();

  // Compiles (once per content) and runs the lighting pass, in tiles where the variant says so. Throws InputError with the author's file and line
  // where the text does not compile, where a table or a knob does not exist, and where the variant does not
  // support the scene. `knobs` override the header's initial values by name.
  RadianceImage Shade(const Variant& variant, Precision precision = Precision::kFloat,
                      const std::map<std::string, double>& knobs = {});

  // Shade's rows [first, first + count) alone, for work that must be able to stop: fills them in `image`, which is made
  // black and as large as the scene's picture where it is not. Like Draw it looks at a variant's files once after
  // DrawScene.
  void ShadeRows(const Variant& variant, const std::map<std::string, double>& knobs, int first, int count,
                 RadianceImage& image, Precision precision = Precision::kFloat);

  // Draws the pass for `variant` once more without reading it back, for a clock; ends with glFinish. After a
  // Shade of the same variant since DrawScene it uses that program without looking at the files again, so
  // that only drawing is timed; tiles are classified anew, since that is part of what they cost.
  void Draw(const Variant& variant, Precision precision = Precision::kFloat,
            const std::map<std::string, double>& knobs = {});

  // What the tiles of the picture need (glsl/per_pixel.h), a row of tiles after the other from the top: of all that is worth asking for a
  // variant, or for any.
  struct Needs {
    glm::ivec2 tiles{0};
    int asked = 0;
    std::vector<int> of_tile;
  };
  Needs TileNeeds(const Variant& variant = {});

  // Draws a pass that reads the G-buffer and writes it through, for a clock: what every lighting pass pays beside shading.
  void DrawThrough();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace arealab
