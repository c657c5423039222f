// Shades points, each with a light of its own, with any technique on the GL: for tests of what a technique
// computes.
#pragma once

#include <glad/gl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "compare/context.h"
#include "compare/truth.h"
#include "glsl/program.h"
#include "glsl/table.h"
#include "glsl/variant.h"

namespace arealab {

// White albedo, F0 = f0 in every channel.
struct PointCase {
  LightShape shape = LightShape::kRectangle;
  glm::dvec3 position{0.0}, normal{0.0, 0.0, 1.0}, to_view{0.0, 0.0, 1.0};
  double roughness = 0.5, f0 = 1.0;
  glm::dvec3 center{0.0, 0.0, 1.0}, axis_x{1.0, 0.0, 0.0}, axis_y{0.0, -1.0, 0.0},
      light_normal{0.0, 0.0, -1.0};
  glm::dvec2 half_size{0.5};
  double radiance = 1.0;  // of the light; Truth() is for 1

  // As the GL gets it: rounded to float.
  PointCase Rounded() const {
    PointCase c = *this;
    for (glm::dvec3* v :
         {&c.position, &c.normal, &c.to_view, &c.center, &c.axis_x, &c.axis_y, &c.light_normal}) {
      *v = glm::dvec3(glm::vec3(*v));
    }
    c.half_size = glm::dvec2(glm::vec2(half_size));
    c.roughness = static_cast<float>(roughness);
    return c;
  }

  LightIntegrals Truth(double tolerance = 1e-4) const {
    Light light;
    light.shape = shape;
    light.center = center;
    light.axis_x = axis_x;
    light.axis_y = axis_y;
    light.normal = light_normal;
    light.half_size = half_size;
    return IntegrateLight({position, normal, to_view, std::max(roughness * roughness, 1e-4)}, light,
                          tolerance);
  }
};

struct Shaded {
  double diffuse = 0.0, specular = 0.0;
};

class PointRandom {
 public:
  explicit PointRandom(unsigned seed) : engine_(seed) {}
  double operator()(double from, double to) { return from + (to - from) * uniform_(engine_); }
  double Log(double from, double to) { return from * std::pow(to / from, uniform_(engine_)); }
  glm::dvec3 Direction() {
    const double z = (*this)(-1.0, 1.0), phi = (*this)(0.0, glm::two_pi<double>()),
                 r = std::sqrt(1.0 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }

 private:
  std::mt19937_64 engine_;
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
};

// A viewer above the surface, a light of 0.2 to 1 m half size whose centre is 1 to 4 m away and which faces
// the point.
inline PointCase RandomPoint(PointRandom& random, LightShape shape) {
  PointCase c;
  c.shape = shape;
  c.normal = random.Direction();
  c.to_view = random.Direction();
  if (glm::dot(c.normal, c.to_view) < 0.0) c.to_view = -c.to_view;
  c.roughness = random(0.1, 1.0);
  c.center = random(1.0, 4.0) * random.Direction();
  c.light_normal = random.Direction();
  if (glm::dot(c.light_normal, c.position - c.center) < 0.0) c.light_normal = -c.light_normal;
  c.axis_x = glm::normalize(glm::cross(random.Direction(), c.light_normal));
  c.axis_y = glm::cross(c.light_normal, c.axis_x);
  c.half_size = {random(0.2, 1.0), random(0.2, 1.0)};
  if (shape != LightShape::kRectangle) c.half_size.y = c.half_size.x;
  if (shape == LightShape::kSphere) c.half_size *= 0.9;  // the point stays outside
  return c.Rounded();
}

// Points at which a careless formula divides 0 by 0 or overflows, for every shape.
inline std::vector<PointCase> HardPoints() {
  std::vector<PointCase> cases;
  for (const LightShape shape : {LightShape::kRectangle, LightShape::kDisk, LightShape::kSphere}) {
    for (const double roughness : {0.0, 1e-3, 0.3, 1.0}) {
      for (const double n_dot_v : {1.0, 0.6, 1e-3}) {
        for (const double size : {1e-4, 1.0, 1e4}) {
          for (const double distance : {0.0, 1e-6, 1e-3, 0.5, 1.0, 1e4}) {
            // The light above the point, beside it, below the horizon, with the point in its plane or at its
            // edge.
            for (int place = 0; place < 5; ++place) {
              PointCase c;
              c.shape = shape;
              c.roughness = roughness;
              c.half_size = glm::dvec2(size);
              c.to_view = {std::sqrt(1.0 - n_dot_v * n_dot_v), 0.0, n_dot_v};
              c.center = {0.0, 0.0, distance};
              if (place == 1) c.center = {distance, 0.0, 0.0};
              if (place == 2) c.center = {0.0, 0.0, -distance};
              if (place == 3) c.center = {size, size, distance};
              if (place == 4) {
                c.light_normal = {1.0, 0.0, 0.0};
                c.axis_x = {0.0, 1.0, 0.0};
                c.axis_y = {0.0, 0.0, 1.0};
                c.center = {-distance, 0.0, 0.5 * size};
              }
              cases.push_back(c.Rounded());
            }
          }
        }
      }
    }
  }
  return cases;
}

class TechniquePoints {
 public:
  // The name keeps test programs that run at once apart.
  explicit TechniquePoints(const std::string& name) : folder_(MakeFolder(name)), library_(folder_) {
    techniques_ = LoadTechniques(library_);
  }
  TechniquePoints(const TechniquePoints&) = delete;
  TechniquePoints& operator=(const TechniquePoints&) = delete;
  ~TechniquePoints() { std::filesystem::remove_all(folder_); }

  std::vector<Variant> Variants(const std::string& technique) const {
    std::vector<Variant> variants;
    for (const Variant& variant : AllVariants(techniques_)) {
      if (variant.technique->name == technique) variants.push_back(variant);
    }
    return variants;
  }

  // `knobs` override the header's initial values by name.
  std::vector<Shaded> Shade(const std::string& variant_name, const std::vector<PointCase>& cases,
                            Precision precision = Precision::kFloat,
                            const std::map<std::string, double>& knobs = {}) {
    const GladGLContext& gl = context_->gl();
    const Variant variant = ParseVariant(techniques_, variant_name);
    std::vector<std::pair<std::string, int>> effects;
    for (const char* name : {"RECTANGLE", "DISK", "SPHERE", "DIFFUSE", "SPECULAR", "FRESNEL"}) {
      effects.emplace_back(std::string("EFFECT_") + name, 1);
    }
    for (const char* name : {"TWO_SIDED", "MANY_LIGHTS"})
      effects.emplace_back(std::string("EFFECT_") + name, 0);
    const Program program(gl, Expand(library_, "fullscreen.vert", variant, effects, Precision::kFloat),
                          Expand(library_, "points.frag", variant, effects, precision));
    for (const Knob& knob : variant.technique->knobs) {
      const auto set = knobs.find(knob.name);
      program.Set("knob_" + knob.name, static_cast<float>(set == knobs.end() ? knob.initial : set->second));
    }
    std::vector<GlObject> tables;
    for (const Table& table : variant.technique->tables) {
      const std::string file = TableFile(variant, table, Brdf::kGgx);
      const auto bytes = library_.Find(file);
      if (!bytes) throw std::runtime_error("no table " + file);
      const auto unit = static_cast<GLuint>(3 + tables.size());
      tables.push_back(UploadTable(gl, DecodeTable(*bytes, file)));
      gl.BindTextureUnit(unit, tables.back().id());
      program.Set("table_" + table.name, static_cast<int>(unit));
    }
    const int rows = static_cast<int>((cases.size() + kColumns - 1) / kColumns);
    const glm::ivec2 size(kColumns, rows);
    std::vector<glm::vec4> texels(static_cast<std::size_t>(kColumns * rows * kRowsPerCase));
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const PointCase& c = cases[i];
      const auto put = [&](std::size_t row, const glm::dvec3& v, double w) {
        texels[(i / kColumns * kRowsPerCase + row) * kColumns + i % kColumns] =
            glm::vec4(glm::vec3(v), static_cast<float>(w));
      };
      put(0, c.position, c.roughness);
      put(1, c.normal, c.f0);
      put(2, c.center, static_cast<double>(c.shape));
      put(3, c.axis_x, c.half_size.x);
      put(4, c.axis_y, c.half_size.y);
      put(5, c.light_normal, c.radiance);
      put(6, c.to_view, 0.0);
    }
    const GlObject input = MakeTexture(gl, GL_RGBA32F, 1, {kColumns, rows * kRowsPerCase});
    gl.TextureSubImage2D(input.id(), 0, 0, 0, kColumns, rows * kRowsPerCase, GL_RGBA, GL_FLOAT,
                         texels.data());
    gl.BindTextureUnit(15, input.id());
    const GlObject diffuse = MakeTexture(gl, GL_RGBA32F, 1, size),
                   specular = MakeTexture(gl, GL_RGBA32F, 1, size);
    const GlObject framebuffer = MakeFramebuffer(gl);
    gl.NamedFramebufferTexture(framebuffer.id(), GL_COLOR_ATTACHMENT0, diffuse.id(), 0);
    gl.NamedFramebufferTexture(framebuffer.id(), GL_COLOR_ATTACHMENT1, specular.id(), 0);
    const std::array<GLenum, 2> targets{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    gl.NamedFramebufferDrawBuffers(framebuffer.id(), 2, targets.data());
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
    gl.Viewport(0, 0, size.x, size.y);
    const GlObject vertices = MakeVertexArray(gl);
    gl.BindVertexArray(vertices.id());
    gl.UseProgram(program.id());
    gl.DrawArrays(GL_TRIANGLES, 0, 3);
    std::vector<glm::vec4> out(static_cast<std::size_t>(size.x * size.y));
    const auto bytes = static_cast<GLsizei>(out.size() * sizeof(glm::vec4));
    std::vector<Shaded> result(cases.size());
    gl.GetTextureImage(diffuse.id(), 0, GL_RGBA, GL_FLOAT, bytes, out.data());
    for (std::size_t i = 0; i < cases.size(); ++i) result[i].diffuse = out[i].x;
    gl.GetTextureImage(specular.id(), 0, GL_RGBA, GL_FLOAT, bytes, out.data());
    for (std::size_t i = 0; i < cases.size(); ++i) result[i].specular = out[i].x;
    gl.BindVertexArray(0);
    gl.UseProgram(0);
    gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
    EXPECT_EQ(gl.GetError(), static_cast<GLenum>(GL_NO_ERROR));
    return result;
  }

 private:
  static constexpr int kColumns = 256;
  static constexpr int kRowsPerCase = 8;
  // Reads what lighting.frag reads of the scene from a texture, one row of texels per quantity.
  static constexpr const char* kShader = R"(#include "surface.glsl"
#include "platform"
#include "technique"
layout(binding = 15) uniform sampler2D cases;
void main() {
  ivec2 at = ivec2(int(gl_FragCoord.x), int(gl_FragCoord.y) * 8);
  vec4 row0 = texelFetch(cases, at, 0);
  vec4 row1 = texelFetch(cases, at + ivec2(0, 1), 0);
  vec4 row2 = texelFetch(cases, at + ivec2(0, 2), 0);
  vec4 row3 = texelFetch(cases, at + ivec2(0, 3), 0);
  vec4 row4 = texelFetch(cases, at + ivec2(0, 4), 0);
  vec4 row5 = texelFetch(cases, at + ivec2(0, 5), 0);
  vec4 row6 = texelFetch(cases, at + ivec2(0, 6), 0);
  Surface surface;
  surface.position = row0.xyz;
  surface.roughness = row0.w;
  surface.alpha = max(row0.w * row0.w, kMinAlpha);
  surface.normal = row1.xyz;
  surface.diffuse_albedo = vec3(1.0);
  surface.f0 = vec3(row1.w);
  Light light;
  light.shape = int(row2.w);
  light.two_sided = false;
  light.center = row2.xyz;
  light.half_size = vec2(row3.w, row4.w);
  light.axis_x = row3.xyz;
  light.axis_y = row4.xyz;
  light.normal = row5.xyz;
  light.half_axis_x = light.axis_x * light.half_size.x;
  light.half_axis_y = light.axis_y * light.half_size.y;
  light.area = light.shape == SHAPE_RECTANGLE ? 4.0 * light.half_size.x * light.half_size.y
                                              : kPi * light.half_size.x * light.half_size.x;
  light.radiance = vec3(row5.w);
  light.products = vec3(light.half_size.x * light.half_size.x, light.half_size.y * light.half_size.y,
                        2.0 * light.half_size.x * light.half_size.y);
  Radiance radiance = ShadeLight(surface, light, row6.xyz);
  WriteRadiance(radiance.diffuse, radiance.specular);
}
)";

  static std::filesystem::path MakeFolder(const std::string& name) {
    const auto folder =
        std::filesystem::temp_directory_path() / ("arealab_" + name + "_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "points.frag") << kShader;
    return folder;
  }

  std::filesystem::path folder_;
  std::unique_ptr<Context> context_ = CreateContext(ContextKind::kOsmesa);
  ShaderLibrary library_;
  std::vector<Technique> techniques_;
};

// sqrt(Σ(a−b)²/Σb²) of one lobe.
inline double RelativeRmse(const std::vector<Shaded>& a, const std::vector<Shaded>& b, double Shaded::*lobe) {
  double squares = 0.0, reference = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    squares += (a[i].*lobe - b[i].*lobe) * (a[i].*lobe - b[i].*lobe);
    reference += b[i].*lobe * b[i].*lobe;
  }
  return std::sqrt(squares / reference);
}

}  // namespace arealab
