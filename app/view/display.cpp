#include "app/view/display.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "app/view/ocio.h"
#include "scenes/embedded.h"

namespace arealab {
namespace view_files {
extern const EmbeddedFile kFiles[];
extern const int kFileCount;
}  // namespace view_files

namespace {

constexpr int kScaleSteps = 512;

glm::dvec3 LinearFromOklch(double lightness, double chroma, double hue) {
  const double a = chroma * std::cos(hue), b = chroma * std::sin(hue);
  const auto cube = [](double v) { return v * v * v; };
  const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
  const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
  const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
  return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

// Chroma is reduced until the colour exists. Hue in degrees.
glm::vec3 Oklch(double lightness, double chroma, double hue) {
  const double radians = hue * std::numbers::pi / 180.0;
  const auto fits = [&](double c) {
    const glm::dvec3 v = LinearFromOklch(lightness, c, radians);
    return glm::all(glm::greaterThanEqual(v, glm::dvec3(-1e-6))) && glm::all(glm::lessThanEqual(v, glm::dvec3(1.0 + 1e-6)));
  };
  double low = 0.0, high = chroma;
  if (fits(chroma)) low = chroma;
  for (int i = 0; low < chroma && i < 24; ++i) {
    const double middle = 0.5 * (low + high);
    (fits(middle) ? low : high) = middle;
  }
  glm::dvec3 v = glm::clamp(LinearFromOklch(lightness, low, radians), 0.0, 1.0);
  for (int c = 0; c < 3; ++c) v[c] = v[c] <= 0.0031308 ? 12.92 * v[c] : 1.055 * std::pow(v[c], 1.0 / 2.4) - 0.055;
  return glm::vec3(v);
}

std::string File(std::string_view name) {
  for (int i = 0; i < view_files::kFileCount; ++i) {
    const EmbeddedFile& file = view_files::kFiles[i];
    if (file.name == name) return std::string(file.begin, file.end);
  }
  throw std::logic_error("no embedded file " + std::string(name));
}

GlObject MakeProgram(const GladGLContext& gl, const std::string& defines) {
  GlObject program(gl, gl.CreateProgram(), [](const GladGLContext& table, GLuint name) { table.DeleteProgram(name); });
  const std::string vertex =
      "void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }\n";
  for (const auto& [stage, text] : {std::pair(GL_VERTEX_SHADER, vertex), std::pair(GL_FRAGMENT_SHADER, File("display.frag"))}) {
    const GlObject shader(gl, gl.CreateShader(static_cast<GLenum>(stage)),
                          [](const GladGLContext& table, GLuint name) { table.DeleteShader(name); });
    const std::string body = "#version 450 core\n" + defines + text;
    const char* source = body.c_str();
    gl.ShaderSource(shader.id(), 1, &source, nullptr);
    gl.CompileShader(shader.id());
    gl.AttachShader(program.id(), shader.id());
  }
  gl.LinkProgram(program.id());
  GLint linked = GL_FALSE;
  gl.GetProgramiv(program.id(), GL_LINK_STATUS, &linked);
  if (linked != GL_TRUE) throw std::runtime_error("the window's OpenGL refuses the display shader; expected OpenGL 4.5");
  return program;
}

GlObject MakeScale(const GladGLContext& gl, int low, glm::vec3 (*color)(double)) {
  std::vector<glm::vec4> codes;
  for (int i = low; i <= kScaleSteps; ++i) codes.emplace_back(color(static_cast<double>(i) / kScaleSteps), 1.0f);
  const auto width = static_cast<int>(codes.size());
  GlObject texture = MakeTexture(gl, GL_RGBA32F, 1, {width, 1});
  gl.TextureSubImage2D(texture.id(), 0, 0, 0, width, 1, GL_RGBA, GL_FLOAT, codes.data());
  return texture;
}

}  // namespace

glm::vec3 SignedColor(double t) {
  const double u = std::abs(t);
  const double chroma = 0.17 * std::pow(u, 0.55) * (1.0 - 0.4 * u * u);
  return Oklch(0.17 + 0.73 * u, chroma, t >= 0.0 ? 50.0 + 40.0 * u : 262.0 - 42.0 * u);
}

glm::vec3 MagnitudeColor(double t) {
  return Oklch(0.14 + 0.83 * t, 0.205 * std::sin(std::numbers::pi * (0.1 + 0.78 * t)), 288.0 + 174.0 * t);
}

Display::Display(const GladGLContext& gl)
    : gl_(gl),
      vertex_array_(MakeVertexArray(gl)),
      signed_scale_(MakeScale(gl, -kScaleSteps, SignedColor)),
      magnitude_scale_(MakeScale(gl, 0, MagnitudeColor)) {}

void Display::SetPicture(int index, const std::shared_ptr<const RadianceImage>& image,
                         const std::shared_ptr<const std::vector<glm::vec3>>& emission, Lobe lobe) {
  Slot& slot = slots_[static_cast<std::size_t>(index)];
  if (!image || (slot.image == image && slot.lobe == lobe)) return;
  const glm::ivec2 size{image->width, image->height};
  if (slot.texture.id() == 0 || slot.size != size) {
    slot.texture = MakeTexture(gl_, GL_RGBA32F, 1, size);
    slot.size = size;
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
      gl_.TextureParameteri(slot.texture.id(), filter, GL_LINEAR);
    }
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) {
      gl_.TextureParameteri(slot.texture.id(), wrap, GL_CLAMP_TO_EDGE);
    }
  }
  slot.image = image;
  slot.lobe = lobe;
  texels_.resize(image->size());
  for (std::size_t i = 0; i < texels_.size(); ++i) {
    const glm::vec3 reflected = lobe == Lobe::kTotal     ? image->Total(i)
                                : lobe == Lobe::kDiffuse ? image->diffuse[i]
                                                         : image->specular[i];
    const glm::vec3 emitted = (*emission)[i];
    texels_[i] = glm::vec4(reflected + emitted, emitted == glm::vec3(0.0f) ? 0.0f : 1.0f);
  }
  gl_.TextureSubImage2D(slot.texture.id(), 0, 0, 0, size.x, size.y, GL_RGBA, GL_FLOAT, texels_.data());
}

void Display::SetViewTable(const std::vector<glm::vec4>& nodes) {
  GLuint id = 0;
  gl_.CreateTextures(GL_TEXTURE_3D, 1, &id);
  view_table_ = GlObject(gl_, id, [](const GladGLContext& table, GLuint name) { table.DeleteTextures(1, &name); });
  gl_.TextureStorage3D(id, 1, GL_RGBA32F, kViewTableSize, kViewTableSize, kViewTableSize);
  gl_.TextureSubImage3D(id, 0, 0, 0, 0, kViewTableSize, kViewTableSize, kViewTableSize, GL_RGBA, GL_FLOAT, nodes.data());
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) gl_.TextureParameteri(id, filter, GL_LINEAR);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R}) gl_.TextureParameteri(id, wrap, GL_CLAMP_TO_EDGE);
}

const GlObject& Display::Program(PictureKind kind, ViewTransform transform, bool exact) {
  GlObject& program = programs_[{kind, transform, exact}];
  if (program.id() == 0) {
    program = MakeProgram(gl_, fmt::format("#define KIND {}\n#define TRANSFORM {}\n#define EXACT {}\n#define VIEW_TABLE_LOW {:.1f}\n#define VIEW_TABLE_HIGH {:.1f}\n",
                                           static_cast<int>(kind), static_cast<int>(transform), exact ? 1 : 0, kViewTableLow, kViewTableHigh));
  }
  return program;
}

void Display::Draw(const glm::ivec4& area, int slot_a, int slot_b, const DisplaySettings& settings, glm::vec2 part) {
  if (!HasPicture(slot_b)) slot_b = slot_a;
  if (area.z < 1 || area.w < 1 || !HasPicture(slot_a)) return;
  const Slot& a = slots_[static_cast<std::size_t>(slot_a)];
  const Slot& b = slots_[static_cast<std::size_t>(slot_b)];
  const bool exact = a.size == glm::ivec2(area.z, area.w) && b.size == a.size;
  const bool map = settings.kind == PictureKind::kSigned || settings.kind == PictureKind::kMagnitude;
  const GLuint program = Program(settings.kind, map ? ViewTransform::kSrgb : settings.transform, exact).id();
  for (const GLenum capability : {GL_BLEND, GL_DEPTH_TEST, GL_CULL_FACE, GL_FRAMEBUFFER_SRGB}) gl_.Disable(capability);
  gl_.PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  gl_.Viewport(area.x, area.y, area.z, area.w);
  const auto edge = [&](float share) { return area.x + static_cast<int>(std::lround(share * static_cast<float>(area.z))); };
  gl_.Enable(GL_SCISSOR_TEST);
  gl_.Scissor(edge(part.x), area.y, edge(part.y) - edge(part.x), area.w);
  gl_.UseProgram(program);
  gl_.BindVertexArray(vertex_array_.id());
  for (GLuint unit = 0; unit < 4; ++unit) gl_.BindSampler(unit, 0);
  gl_.BindTextureUnit(0, a.texture.id());
  gl_.BindTextureUnit(1, b.texture.id());
  gl_.BindTextureUnit(2, (settings.kind == PictureKind::kSigned ? signed_scale_ : magnitude_scale_).id());
  if (settings.transform == ViewTransform::kOcio) gl_.BindTextureUnit(3, view_table_.id());
  const auto place = [&](const char* name) { return gl_.GetUniformLocation(program, name); };
  gl_.Uniform4f(place("area"), static_cast<float>(area.x), static_cast<float>(area.y), static_cast<float>(area.z),
                static_cast<float>(area.w));
  gl_.Uniform1f(place("gain"), static_cast<float>(std::exp2(settings.exposure)));
  gl_.Uniform1f(place("range"), static_cast<float>(settings.range));
  gl_.Uniform1i(place("logarithmic"), settings.logarithmic ? 1 : 0);
  gl_.Uniform1f(place("floor_luminance"), static_cast<float>(settings.floor_luminance));
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
  gl_.Disable(GL_SCISSOR_TEST);
  gl_.BindVertexArray(0);
  gl_.UseProgram(0);
}

}  // namespace arealab
