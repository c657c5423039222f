#include "glsl/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <unordered_map>
#include <utility>
#include <vector>

#include "glsl/gbuffer.h"
#include "glsl/gl_objects.h"
#include "glsl/light_block.h"
#include "glsl/light_textures.h"
#include "glsl/per_pixel.h"
#include "glsl/program.h"
#include "glsl/shading_watch.h"
#include "glsl/sky_maps.h"
#include "glsl/table.h"
#include "scenes/error.h"

namespace arealab {
namespace {

constexpr GLuint kApertureUnits[] = {14, 13, 12, 11};  // see glsl/platform_inputs.glsl
constexpr GLuint kFirstTableUnit = 3;  // after the G-buffer's three, see glsl/platform_inputs.glsl

}  // namespace

struct Renderer::Impl {
  Impl(const GladGLContext& context, const ShaderLibrary& files)
      : gl(context),
        library(files),
        gbuffer(gl, library),
        vertex_array(MakeVertexArray(gl)),
        lights(MakeBuffer(gl, sizeof(glm::vec4) * kMaxLights * kLightRows, nullptr)),
        corners(MakeBuffer(gl, sizeof(glm::vec4) * kMaxLights * kCornerRows, nullptr)),
        light_textures(gl),
        sky_maps(gl),
        fullscreen(Expand(library, "fullscreen.vert", {}, {}, Precision::kFloat)),
        tile_points(Expand(library, "tiles.vert", {}, {{"TILE_SIZE", kTileSize}}, Precision::kFloat)),
        tile_vertices(MakeVertexArray(gl)) {
    gl.EnableVertexArrayAttrib(tile_vertices.id(), 0);
    gl.VertexArrayAttribFormat(tile_vertices.id(), 0, 2, GL_FLOAT, GL_FALSE, 0);
    gl.VertexArrayAttribBinding(tile_vertices.id(), 0, 0);
  }

  // A technique's table, decoded and uploaded again only where its bytes have changed.
  struct Table {
    std::string bytes;
    GlObject texture;
  };
  // A variant ready to draw.
  struct Pass {
    const Program* program = nullptr;
    std::vector<GLuint> tables;
    bool textured = false;      // reads the lights' textures
    bool sky_textured = false;  // reads the sky's
  };
  // What is drawn of a pass, and where.
  struct Part {
    GLuint framebuffer;
    glm::ivec2 size;              // of the viewport
    int first_row = 0, rows = 0;  // 0: all
    GLint first_tile = 0;
    GLsizei tiles = 0;            // of the list that is bound; 0: no tiles, a triangle over everything
  };
  // What the tiles need of a variant, and lists of those that need the same.
  struct Tiling {
    struct Class {
      int needs;
      GLint first;
      GLsizei count;
    };
    const Program* program = nullptr;  // that asks
    Needs needs;
    std::vector<Class> classes;  // but for what is black
    GlObject list;               // columns and rows of tiles
  };

  void Allocate(glm::ivec2 size);
  Pass MakePass(const Variant& variant, Precision precision);
  GLuint LoadTable(const Variant& variant, const arealab::Table& table);
  void SetKnobs(const Pass& pass, const Variant& variant, const std::map<std::string, double>& knobs) const;
  const Pass& KeptPass(const Variant& variant, Precision precision, bool anew = false);
  // Draws the variant's rows; `anew`: after a look at its files.
  void DrawRows(const Variant& variant, Precision precision, const std::map<std::string, double>& knobs, int first_row, int rows, bool anew);
  // Classified once for a scene; `anew`: after a look at the files.
  Tiling& TilingOf(const Variant& variant, bool anew);
  void Classify(Tiling& tiling);
  ShadingWatch Watch(const Variant& variant) const {
    return {library.DisplayPath("techniques/" + variant.technique->name + ".glsl"),
            static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y)};
  }
  void DrawPass(const Pass& pass, const Part& part);
  void Black() const;
  std::vector<glm::vec3> ReadBack(const GlObject& texture) const;
  void ReadBack(const GlObject& texture, int first_row, int row_count, std::vector<glm::vec3>& image) const;

  const GladGLContext& gl;
  const ShaderLibrary& library;
  GBuffer gbuffer;
  GlObject vertex_array;  // empty: core contexts draw with one only
  GlObject lights;
  GlObject corners;
  LightTextures light_textures;
  SkyMaps sky_maps;
  ExpandedSource fullscreen, tile_points;
  GlObject tile_vertices;

  glm::ivec2 size{0};
  Scene scene;  // drawn last, without its meshes
  int light_count = 0;
  std::vector<Effect> effects;
  GlObject framebuffer, diffuse, specular;
  std::unordered_map<std::string, std::unique_ptr<Program>> programs;  // by their whole text
  std::map<std::string, Table> tables;                                 // by their name in the library
  std::unique_ptr<Program> through;
  std::map<std::pair<std::string, Precision>, Pass> passes;            // of this scene, by the variant's name
  std::map<std::string, Tiling> tilings;                               // of this scene, by the variant's name
};

void Renderer::Impl::Allocate(glm::ivec2 new_size) {
  if (size == new_size) return;
  size = glm::ivec2(0);
  framebuffer = MakeFramebuffer(gl);
  diffuse = MakeTexture(gl, GL_RGBA32F, 1, new_size);
  specular = MakeTexture(gl, GL_RGBA32F, 1, new_size);
  gl.NamedFramebufferTexture(framebuffer.id(), GL_COLOR_ATTACHMENT0, diffuse.id(), 0);
  gl.NamedFramebufferTexture(framebuffer.id(), GL_COLOR_ATTACHMENT1, specular.id(), 0);
  const std::array<GLenum, 2> targets{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  gl.NamedFramebufferDrawBuffers(framebuffer.id(), static_cast<GLsizei>(targets.size()), targets.data());
  if (gl.GetError() == GL_OUT_OF_MEMORY ||
      gl.CheckNamedFramebufferStatus(framebuffer.id(), GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw InputError(fmt::format("a picture of {}x{} pixels does not fit; expected a smaller one", new_size.x,
                                 new_size.y));
  }
  size = new_size;
}

GLuint Renderer::Impl::LoadTable(const Variant& variant, const arealab::Table& table) {
  const std::string name = TableFile(variant, table, scene.brdfs());
  std::optional<std::string> bytes = library.Find(name);
  if (!bytes) {
    throw InputError(
        fmt::format("{}:1: table_{} is {}, which does not exist; expected a file that `arealab fit` wrote",
                    library.DisplayPath("techniques/" + variant.technique->name + ".glsl"), table.name,
                    library.DisplayPath(name)));
  }
  Table& entry = tables[name];
  if (entry.texture.id() == 0 || entry.bytes != *bytes) {
    entry.texture = UploadTable(gl, DecodeTable(*bytes, library.DisplayPath(name)));
    entry.bytes = std::move(*bytes);
    passes.clear();  // they may name the texture that this one replaces
  }
  return entry.texture.id();
}

Renderer::Impl::Pass Renderer::Impl::MakePass(const Variant& variant, Precision precision) {
  if (const std::optional<std::string> why = WhyUnsupported(variant, scene, effects)) {
    throw InputError(fmt::format("{}; expected a variant that supports the scene", *why));
  }
  const EffectDefines defines = Defines(effects, variant.effects);
  const ExpandedSource source = variant.per_pixel == PerPixel::kBranch
                                    ? BranchSource(library, variant, effects, precision, scene.brdfs())
                                    : Expand(library, "lighting.frag", variant, defines, precision, scene.brdfs());
  const ExpandedSource& vertex = variant.per_pixel == PerPixel::kTiles ? tile_points : fullscreen;
  std::unique_ptr<Program>& program = programs[vertex.text + source.text];
  if (!program) program = std::make_unique<Program>(gl, vertex, source);
  Pass pass{program.get(), {}, false, false};
  const auto has = [&](const char* define) { return std::ranges::find(defines, std::pair<std::string, int>(define, 1)) != defines.end(); };
  pass.textured = has("EFFECT_TEXTURED");
  pass.sky_textured = has("EFFECT_SKY_TEXTURE");
  GLuint unit = kFirstTableUnit;
  for (const arealab::Table& table : TablesOf(variant, scene.brdfs())) {
    program->Set("table_" + table.name, static_cast<int>(unit++));
    pass.tables.push_back(LoadTable(variant, table));
  }
  return pass;
}

void Renderer::Impl::SetKnobs(const Pass& pass, const Variant& variant,
                              const std::map<std::string, double>& knobs) const {
  const auto& known = variant.technique->knobs;
  for (const auto& set : knobs) {
    const std::string& name = set.first;
    if (std::none_of(known.begin(), known.end(), [&](const Knob& knob) { return knob.name == name; })) {
      std::string names;
      for (const Knob& knob : known) names += (names.empty() ? "" : ", ") + knob.name;
      throw InputError(fmt::format("{} has no knob {}; expected {}", variant.technique->name, name,
                                   names.empty() ? "none" : "one of " + names));
    }
  }
  for (const Knob& knob : known) {
    const auto set = knobs.find(knob.name);
    pass.program->Set("knob_" + knob.name,
                      static_cast<float>(set == knobs.end() ? knob.initial : set->second));
  }
}

void Renderer::Impl::Black() const {
  const std::array<float, 4> black{};
  for (GLint i = 0; i < 2; ++i) gl.ClearNamedFramebufferfv(framebuffer.id(), GL_COLOR, i, black.data());
}

const Renderer::Impl::Pass& Renderer::Impl::KeptPass(const Variant& variant, Precision precision, bool anew) {
  const std::pair key{variant.Name(), precision};
  if (const auto found = passes.find(key); !anew && found != passes.end()) return found->second;
  Pass pass = MakePass(variant, precision);  // before it has a place: making one may clear the others
  return passes[key] = std::move(pass);
}

Renderer::Impl::Tiling& Renderer::Impl::TilingOf(const Variant& variant, bool anew) {
  Tiling& tiling = tilings[variant.technique ? variant.Name() : ""];
  if (tiling.program && !anew) return tiling;
  tiling.needs.asked = NeedsToAsk(library, variant, effects, scene);
  const ExpandedSource source = NeedsSource(library, variant, effects, tiling.needs.asked, kTileSize);
  std::unique_ptr<Program>& program = programs[source.text];
  if (!program) program = std::make_unique<Program>(gl, fullscreen, source);
  tiling.program = program.get();
  Classify(tiling);
  return tiling;
}

void Renderer::Impl::Classify(Tiling& tiling) {
  const glm::ivec2 tiles = (size + kTileSize - 1) / kTileSize;
  tiling.needs.tiles = tiles;
  const GlObject target = MakeTexture(gl, GL_R32F, 1, tiles);
  const GlObject needs_framebuffer = MakeFramebuffer(gl);
  gl.NamedFramebufferTexture(needs_framebuffer.id(), GL_COLOR_ATTACHMENT0, target.id(), 0);
  DrawPass({tiling.program, {}, false, false}, {.framebuffer = needs_framebuffer.id(), .size = tiles});
  std::vector<float> texels(static_cast<std::size_t>(tiles.x) * static_cast<std::size_t>(tiles.y));
  gl.GetTextureImage(target.id(), 0, GL_RED, GL_FLOAT, static_cast<GLsizei>(texels.size() * sizeof(float)), texels.data());
  std::vector<int>& needs = tiling.needs.of_tile;
  needs.assign(texels.begin(), texels.end());

  std::map<int, std::vector<glm::vec2>> classes;  // a tile is drawn once, by the program that has what it needs
  for (std::size_t i = 0; i < needs.size(); ++i) {
    if (!(needs[i] & kNeedsLight)) continue;
    const int x = static_cast<int>(i) % tiles.x, y = static_cast<int>(i) / tiles.x;
    classes[needs[i] & tiling.needs.asked].emplace_back(x, y);
  }
  tiling.classes.clear();
  std::vector<glm::vec2> list;
  for (const auto& [needed, members] : classes) {
    tiling.classes.push_back({needed, static_cast<GLint>(list.size()), static_cast<GLsizei>(members.size())});
    list.insert(list.end(), members.begin(), members.end());
  }
  if (!list.empty()) tiling.list = MakeBuffer(gl, list.size() * sizeof(glm::vec2), list.data());
}

void Renderer::Impl::DrawRows(const Variant& variant, Precision precision, const std::map<std::string, double>& knobs, int first_row, int rows,
                              bool anew) {
  const Part whole{.framebuffer = framebuffer.id(), .size = size, .first_row = first_row, .rows = rows};
  if (variant.per_pixel != PerPixel::kTiles) {
    const Pass& pass = KeptPass(variant, precision, anew);
    SetKnobs(pass, variant, knobs);
    DrawPass(pass, whole);
    return;
  }
  const Tiling& tiling = TilingOf(variant, anew);
  Black();
  gl.VertexArrayVertexBuffer(tile_vertices.id(), 0, tiling.list.id(), 0, sizeof(glm::vec2));
  for (const Tiling::Class& tiles : tiling.classes) {
    const Variant needed = VariantFor(variant, tiles.needs, tiling.needs.asked);
    const Pass& pass = KeptPass(needed, precision, anew);
    SetKnobs(pass, needed, knobs);
    pass.program->Set("tile_count", glm::vec2(tiling.needs.tiles));
    Part part = whole;
    part.size = tiling.needs.tiles * kTileSize;
    part.first_tile = tiles.first;
    part.tiles = tiles.count;
    DrawPass(pass, part);
  }
}

void Renderer::Impl::DrawPass(const Pass& pass, const Part& part) {
  pass.program->Set("view_position", gbuffer.pixels().view_position);
  pass.program->Set("light_count", light_count);
  const Sky sky = scene.sky.value_or(Sky());
  pass.program->Set("sky_radiance", glm::vec3(sky.radiance));
  pass.program->Set("sky_turn", static_cast<float>(sky.turn / (2.0 * std::numbers::pi)));
  gl.BindFramebuffer(GL_FRAMEBUFFER, part.framebuffer);
  gl.Viewport(0, 0, part.size.x, part.size.y);
  for (const GLenum capability : {GL_BLEND, GL_CULL_FACE, GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_DEPTH_TEST}) {
    gl.Disable(capability);
  }
  gl.PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl.UseProgram(pass.program->id());
  gl.BindTextureUnit(0, gbuffer.position());
  gl.BindTextureUnit(1, gbuffer.normal());
  gl.BindTextureUnit(2, gbuffer.base_color());
  for (std::size_t cap = 0; cap < GBuffer::kCaps; ++cap) gl.BindTextureUnit(kApertureUnits[cap], gbuffer.aperture(cap));
  for (std::size_t i = 0; i < pass.tables.size(); ++i) {
    gl.BindTextureUnit(kFirstTableUnit + static_cast<GLuint>(i), pass.tables[i]);
  }
  if (pass.textured) light_textures.Bind(*pass.program);
  if (pass.sky_textured) sky_maps.Bind(*pass.program);
  gl.BindBufferBase(GL_UNIFORM_BUFFER, 0, lights.id());
  gl.BindBufferBase(GL_UNIFORM_BUFFER, 1, corners.id());
  if (part.rows > 0) {
    gl.Enable(GL_SCISSOR_TEST);
    gl.Scissor(0, part.first_row, part.size.x, part.rows);
  }
  if (part.tiles > 0) {
    gl.Enable(GL_PROGRAM_POINT_SIZE);
    gl.BindVertexArray(tile_vertices.id());
    gl.DrawArrays(GL_POINTS, part.first_tile, part.tiles);
    gl.Disable(GL_PROGRAM_POINT_SIZE);
  } else {
    gl.BindVertexArray(vertex_array.id());
    gl.DrawArrays(GL_TRIANGLES, 0, 3);
  }
  if (part.rows > 0) gl.Disable(GL_SCISSOR_TEST);
  gl.UseProgram(0);  // a program in use would outlive its object
  gl.BindVertexArray(0);
  gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
}

std::vector<glm::vec3> Renderer::Impl::ReadBack(const GlObject& texture) const {
  std::vector<glm::vec3> image(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
  ReadBack(texture, 0, size.y, image);
  return image;
}

void Renderer::Impl::ReadBack(const GlObject& texture, int first_row, int row_count, std::vector<glm::vec3>& image) const {
  const auto width = static_cast<std::size_t>(size.x);
  // RGBA is what drivers copy without thinking; a band at a time keeps the detour small.
  const int band = std::max(1, (1 << 20) / size.x);
  std::vector<glm::vec4> texels(width * static_cast<std::size_t>(std::min(band, row_count)));
  const int end = first_row + row_count;
  for (int y = first_row; y < end; y += band) {
    const int rows = std::min(band, end - y);
    gl.GetTextureSubImage(texture.id(), 0, 0, y, 0, size.x, rows, 1, GL_RGBA, GL_FLOAT,
                          static_cast<GLsizei>(texels.size() * sizeof(glm::vec4)), texels.data());
    const std::size_t count = width * static_cast<std::size_t>(rows);
    const std::size_t first = width * static_cast<std::size_t>(y);
    for (std::size_t i = 0; i < count; ++i) image[first + i] = glm::vec3(texels[i]);
  }
}

Renderer::Renderer(const GladGLContext& gl, const ShaderLibrary& library)
    : impl_(std::make_unique<Impl>(gl, library)) {}

Renderer::~Renderer() = default;

const SurfacePixels& Renderer::DrawScene(const Scene& scene, glm::ivec2 size,
                                         const std::set<std::string>& effects_off) {
  const std::vector<Light> lights = EmittingLights(scene);
  const std::vector<glm::vec4> rows = LightBlockRows(lights);
  impl_->gbuffer.Draw(scene, size);
  impl_->light_textures.Take(lights);
  impl_->sky_maps.Take(scene.sky ? scene.sky->texture : nullptr);
  impl_->Allocate(size);
  impl_->light_count = static_cast<int>(lights.size());
  impl_->scene.name = scene.name;
  impl_->scene.brdf = scene.brdf;
  impl_->scene.diffuse = scene.diffuse;
  impl_->scene.sky = scene.sky;
  impl_->scene.lights = scene.lights;
  impl_->scene.materials = scene.materials;
  impl_->effects = SceneEffects(scene);
  for (Effect& effect : impl_->effects) effect.on = effect.on && !effects_off.contains(effect.name);
  impl_->passes.clear();
  impl_->tilings.clear();
  impl_->gl.NamedBufferSubData(impl_->lights.id(), 0,
                               static_cast<GLsizeiptr>(rows.size() * sizeof(glm::vec4)), rows.data());
  const std::vector<glm::vec4> corners = CornerBlockRows(lights);
  impl_->gl.NamedBufferSubData(impl_->corners.id(), 0, static_cast<GLsizeiptr>(corners.size() * sizeof(glm::vec4)), corners.data());
  return impl_->gbuffer.pixels();
}

SurfacePixels Renderer::TakePixels() { return impl_->gbuffer.TakePixels(); }

RadianceImage Renderer::Shade(const Variant& variant, Precision precision,
                              const std::map<std::string, double>& knobs) {
  const ShadingWatch watch = impl_->Watch(variant);
  if (impl_->light_count == 0) {
    impl_->Black();
  } else {
    impl_->DrawRows(variant, precision, knobs, 0, 0, true);
  }
  return {impl_->size.x, impl_->size.y, impl_->ReadBack(impl_->diffuse), impl_->ReadBack(impl_->specular)};
}

void Renderer::ShadeRows(const Variant& variant, const std::map<std::string, double>& knobs, int first, int count,
                         RadianceImage& image, Precision precision) {
  if (image.width != impl_->size.x || image.height != impl_->size.y) {
    const auto pixels = static_cast<std::size_t>(impl_->size.x) * static_cast<std::size_t>(impl_->size.y);
    image = {impl_->size.x, impl_->size.y, std::vector<glm::vec3>(pixels, glm::vec3(0.0f)),
             std::vector<glm::vec3>(pixels, glm::vec3(0.0f))};
  }
  if (impl_->light_count == 0) return;
  const ShadingWatch watch = impl_->Watch(variant);
  impl_->DrawRows(variant, precision, knobs, first, count, false);
  impl_->ReadBack(impl_->diffuse, first, count, image.diffuse);
  impl_->ReadBack(impl_->specular, first, count, image.specular);
}

void Renderer::Draw(const Variant& variant, Precision precision, const std::map<std::string, double>& knobs) {
  const ShadingWatch watch = impl_->Watch(variant);
  if (impl_->light_count == 0) {
    impl_->Black();
  } else {
    if (variant.per_pixel == PerPixel::kTiles) impl_->Classify(impl_->TilingOf(variant, false));
    impl_->DrawRows(variant, precision, knobs, 0, 0, false);
  }
  impl_->gl.Finish();
}

void Renderer::DrawThrough() {
  if (!impl_->through) {
    const ExpandedSource source = Expand(impl_->library, "through.frag", {}, Defines(impl_->effects), Precision::kFloat);
    impl_->through = std::make_unique<Program>(impl_->gl, impl_->fullscreen, source);
  }
  impl_->DrawPass({impl_->through.get(), {}, false, false}, {.framebuffer = impl_->framebuffer.id(), .size = impl_->size});
  impl_->gl.Finish();
}

Renderer::Needs Renderer::TileNeeds(const Variant& variant) {
  if (impl_->light_count == 0) return {};
  return impl_->TilingOf(variant, false).needs;
}

}  // namespace arealab
