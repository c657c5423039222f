#include "compare/point_shader.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <map>
#include <optional>

#include "glsl/effects.h"
#include "glsl/fp16_rewrite.h"
#include "glsl/gl_objects.h"
#include "glsl/light_block.h"
#include "glsl/program.h"
#include "glsl/shading_watch.h"
#include "glsl/table.h"
#include "scenes/error.h"

namespace arealab {
namespace {

constexpr int kColumns = 256;
constexpr int kMostRows = 512;             // of pixels at a time: 23 MB of texels
constexpr int kCaseRows = kLightRows + 3 + kCornerRows;  // CASE_ROWS of glsl/points.frag
constexpr GLuint kFirstTableUnit = 3, kCasesUnit = 15;

// Everything on but shapes that no case has, the other side of lights, the loop, apertures and the sky.
EffectDefines EffectsOf(std::span<const PointCase> cases) {
  std::map<std::string, bool> forced = {{"two_sided", false}, {"many_lights", false}, {"aperture", false}, {"textured", false}, {"sky", false}};
  for (const LightShape shape : kLightShapes) {
    forced[Name(shape)] = std::ranges::any_of(cases, [&](const PointCase& c) { return c.shape == shape; });
  }
  forced["disk"] = forced["disk"] || forced["ellipse"];
  for (const std::string& name : EffectNames()) forced.emplace(name, true);
  return Defines(SceneEffects(Scene{}), forced);
}

// A case's rows in order.
std::array<glm::vec4, kCaseRows> Texels(const PointCase& c) {
  std::array<glm::vec4, kCaseRows> texels;
  const std::vector<glm::vec4> rows = LightBlockRows({c.Light()});
  std::ranges::copy(rows, texels.begin());
  texels[kLightRows] = glm::vec4(c.position, c.roughness);
  texels[kLightRows + 1] = glm::vec4(c.normal, c.f0);
  texels[kLightRows + 2] = glm::vec4(c.to_view, 0.0);
  std::ranges::copy(CornerBlockRows({c.Light()}), texels.begin() + kLightRows + 3);
  return texels;
}

}  // namespace

namespace {

std::vector<double*> NumbersOf(PointCase& c) {
  std::vector<double*> numbers{&c.roughness, &c.f0, &c.radiance, &c.half_size.x, &c.half_size.y};
  for (glm::dvec3* v : {&c.position, &c.normal, &c.to_view, &c.center, &c.axis_x, &c.axis_y, &c.light_normal})
    numbers.insert(numbers.end(), {&v->x, &v->y, &v->z});
  for (glm::dvec2& corner : c.corners) numbers.insert(numbers.end(), {&corner.x, &corner.y});
  return numbers;
}

}  // namespace

PointCase PointCase::Rounded() const {
  PointCase c = *this;
  for (double* number : NumbersOf(c)) *number = static_cast<float>(*number);
  return c;
}

std::optional<PointCase> PointCase::AsHalves() const {
  PointCase c = *this;
  bool finite = true;
  for (double* number : NumbersOf(c)) {
    *number = RoundedToHalf(*number);
    finite = finite && std::isfinite(*number);
  }
  const bool lost = (c.half_size.x == 0.0) != (half_size.x == 0.0) || (c.half_size.y == 0.0) != (half_size.y == 0.0) ||
                    (c.center == c.position) != (center == position) || (c.radiance == 0.0) != (radiance == 0.0);
  return finite && !lost ? std::optional(c) : std::nullopt;
}

Light PointCase::Light() const {
  arealab::Light light;
  light.shape = shape;
  light.center = center;
  light.axis_x = axis_x;
  light.axis_y = axis_y;
  light.normal = light_normal;
  light.half_size = half_size;
  light.corners = corners;
  light.radiance = glm::dvec3(radiance);
  return light;
}

LightIntegrals PointCase::Truth(double tolerance, Brdfs brdfs) const {
  return IntegrateLight({position, glm::normalize(normal), glm::normalize(to_view), std::max(roughness * roughness, 1e-4), brdfs.specular,
                         brdfs.diffuse, roughness},
                        Light(), tolerance);
}

struct PointShader::Impl {
  Impl(Context& context, const ShaderLibrary& shader_library)
      : gl(context.gl()),
        library(shader_library),
        fullscreen(Expand(library, "fullscreen.vert", {}, {}, Precision::kFloat)),
        framebuffer(MakeFramebuffer(gl)),
        vertices(MakeVertexArray(gl)),
        cases(MakeTexture(gl, GL_RGBA32F, 1, {kColumns, kMostRows * kCaseRows})),
        diffuse(MakeTexture(gl, GL_RGBA32F, 1, {kColumns, kMostRows})),
        specular(MakeTexture(gl, GL_RGBA32F, 1, {kColumns, kMostRows})) {
    gl.NamedFramebufferTexture(framebuffer.id(), GL_COLOR_ATTACHMENT0, diffuse.id(), 0);
    gl.NamedFramebufferTexture(framebuffer.id(), GL_COLOR_ATTACHMENT1, specular.id(), 0);
    const std::array<GLenum, 2> targets{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    gl.NamedFramebufferDrawBuffers(framebuffer.id(), 2, targets.data());
  }

  GLuint LoadTable(const std::string& file, bool half) {
    GlObject& texture = tables[{file, half}];
    if (texture.id() != 0) return texture.id();
    const auto bytes = library.Find(file);
    if (!bytes) {
      throw InputError(fmt::format("{}: no such table; expected one that `arealab fit` writes",
                                   library.DisplayPath(file)));
    }
    TableTexels table = DecodeTable(*bytes, file);
    if (half) {
      for (glm::vec4& texel : table.texels) texel = glm::unpackHalf4x16(glm::packHalf4x16(texel));
    }
    texture = UploadTable(gl, table);
    return texture.id();
  }

  const Program& Prepare(const Variant& variant, std::span<const PointCase> all,
                         const PointOptions& options) {
    const ExpandedSource source = Expand(library, options.strict ? "strict_points.frag" : "points.frag",
                                         variant, EffectsOf(all), options.precision, options.brdfs);
    std::unique_ptr<Program>& program = programs[source.text];
    if (!program) program = std::make_unique<Program>(gl, fullscreen, source);
    for (const Knob& knob : variant.technique->knobs) {
      const auto set = options.knobs.find(knob.name);
      program->Set("knob_" + knob.name,
                   static_cast<float>(set == options.knobs.end() ? knob.initial : set->second));
    }
    program->Set("as_lighting_pass", static_cast<int>(options.as_lighting_pass));
    GLuint unit = kFirstTableUnit;
    for (const Table& table : TablesOf(variant, options.brdfs)) {
      gl.BindTextureUnit(unit, LoadTable(TableFile(variant, table, options.brdfs), options.half_tables));
      program->Set("table_" + table.name, static_cast<int>(unit++));
    }
    return *program;
  }

  void Upload(std::span<const PointCase> batch, int rows) {
    texels.resize(static_cast<std::size_t>(kColumns * rows * kCaseRows));
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const std::array<glm::vec4, kCaseRows> column = Texels(batch[i]);
      for (std::size_t row = 0; row < kCaseRows; ++row)
        texels[(i / kColumns * kCaseRows + row) * kColumns + i % kColumns] = column[row];
    }
    gl.TextureSubImage2D(cases.id(), 0, 0, 0, kColumns, rows * kCaseRows, GL_RGBA, GL_FLOAT, texels.data());
  }

  void Draw(const Program& program, int rows) {
    gl.BindTextureUnit(kCasesUnit, cases.id());
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
    gl.Viewport(0, 0, kColumns, rows);
    gl.BindVertexArray(vertices.id());
    gl.UseProgram(program.id());
    gl.DrawArrays(GL_TRIANGLES, 0, 3);
    gl.UseProgram(0);  // a program in use would outlive its object
    gl.BindVertexArray(0);
    gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
  }

  void ReadBack(const GlObject& texture, int rows, std::span<Shaded> result, double Shaded::*lobe) {
    out.resize(static_cast<std::size_t>(kColumns * rows));
    gl.GetTextureSubImage(texture.id(), 0, 0, 0, 0, kColumns, rows, 1, GL_RGBA, GL_FLOAT,
                          static_cast<GLsizei>(out.size() * sizeof(glm::vec4)), out.data());
    for (std::size_t i = 0; i < result.size(); ++i) result[i].*lobe = out[i].x;
  }

  const GladGLContext& gl;
  const ShaderLibrary& library;
  ExpandedSource fullscreen;
  GlObject framebuffer, vertices, cases, diffuse, specular;
  std::map<std::string, std::unique_ptr<Program>> programs;  // by text
  std::map<std::pair<std::string, bool>, GlObject> tables;   // by file, and whether rounded to halves
  std::vector<glm::vec4> texels, out;
};

PointShader::PointShader(Context& context, const ShaderLibrary& library)
    : impl_(std::make_unique<Impl>(context, library)) {}

PointShader::~PointShader() = default;

std::vector<Shaded> PointShader::Shade(const Variant& variant, std::span<const PointCase> cases,
                                       const PointOptions& options) {
  std::vector<Shaded> result(cases.size());
  if (cases.empty()) return result;
  const ShadingWatch watch(impl_->library.DisplayPath("techniques/" + variant.technique->name + ".glsl"), cases.size());
  const Program& program = impl_->Prepare(variant, cases, options);
  constexpr std::size_t kBatch = std::size_t{kColumns} * kMostRows;
  for (std::size_t first = 0; first < cases.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, cases.size() - first);
    const int rows = static_cast<int>((count + kColumns - 1) / kColumns);
    impl_->Upload(cases.subspan(first, count), rows);
    impl_->Draw(program, rows);
    const std::span<Shaded> part(result.data() + first, count);
    impl_->ReadBack(impl_->diffuse, rows, part, &Shaded::diffuse);
    impl_->ReadBack(impl_->specular, rows, part, &Shaded::specular);
  }
  return result;
}

}  // namespace arealab
