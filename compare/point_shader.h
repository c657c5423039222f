// Shades points, each with a viewer and a light of its own, with any technique on the GL: one pixel each,
// read from a texture.
#pragma once

#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/context.h"
#include "compare/truth.h"
#include "glsl/expand.h"
#include "glsl/shader_library.h"
#include "glsl/variant.h"
#include "scenes/scene.h"

namespace arealab {

// White albedo, reflectance f0 at normal incidence and the light's radiance the same in every channel.
struct PointCase {
  LightShape shape = LightShape::kRectangle;
  glm::dvec3 position{0.0}, normal{0.0, 0.0, 1.0}, to_view{0.0, 0.0, 1.0};
  double roughness = 0.5, f0 = 1.0;
  glm::dvec3 center{0.0, 0.0, 1.0}, axis_x{1.0, 0.0, 0.0}, axis_y{0.0, -1.0, 0.0},
      light_normal{0.0, 0.0, -1.0};
  glm::dvec2 half_size{0.5};
  double radiance = 1.0;
  std::vector<glm::dvec2> corners = {};  // of a polygon, as Light::corners

  PointCase Rounded() const;  // as the GL gets it: every number the nearest float
  // Every number the nearest half float (glsl/fp16_rewrite.h); nothing where these are another light: one is infinite, or a
  // size, the light's distance or its radiance becomes 0.
  std::optional<PointCase> AsHalves() const;
  arealab::Light Light() const;
  LightIntegrals Truth(double tolerance = 1e-4, Brdfs brdfs = {}) const;  // for radiance 1
};

struct Shaded {
  double diffuse = 0.0, specular = 0.0;
};

struct PointOptions {
  Precision precision = Precision::kFloat;
  std::map<std::string, double> knobs = {};  // override the header's initial values by name
  bool as_lighting_pass =
      false;  // black where the lighting pass shades nothing: behind the light, away from the viewer
  bool strict = false;       // min, max and clamp pass a NaN on (glsl/strict_order.glsl); in float alone
  bool half_tables = false;  // the tables' texels rounded to half floats
  Brdfs brdfs = {};
};

class PointShader {
 public:
  // Both outlive it; the context is current whenever a member runs.
  PointShader(Context& context, const ShaderLibrary& library);
  ~PointShader();
  PointShader(const PointShader&) = delete;
  PointShader& operator=(const PointShader&) = delete;

  // Red of both lobes. Throws InputError where the text does not compile or a table is missing.
  std::vector<Shaded> Shade(const Variant& variant, std::span<const PointCase> cases,
                            const PointOptions& options = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace arealab
