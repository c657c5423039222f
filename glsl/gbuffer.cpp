#include "glsl/gbuffer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <utility>

#include "scenes/bake.h"
#include "scenes/error.h"

namespace arealab {
namespace {

// The longer side of an 8K picture (7680 × 4320), rounded up to a power of two.
constexpr int kMaxSize = 8192;

// A disk's outline as a polygon: it lies at most 1 − cos(π/256) = 8e-5 radii inside.
constexpr int kDiskSegments = 256;

// A sphere's rings and segments: its outline lies at most 1 − cos(π/128) = 3e-4 radii inside, a tenth of a
// pixel where the sphere fills a picture of 512 pixels.
constexpr int kSphereRings = 64;
constexpr int kSphereSegments = 128;

// gbuffer.frag reads vertices as 12 floats in this order.
static_assert(sizeof(Vertex) == 12 * sizeof(float));
static_assert(sizeof(Aperture) == GBuffer::kCaps * sizeof(glm::vec4));

}  // namespace

CameraView ViewOf(const Camera& camera, glm::ivec2 size) {
  CameraView view;
  view.position = glm::dvec3(glm::vec3(camera.position));
  view.forward = glm::normalize(camera.target - camera.position);
  view.right = glm::cross(view.forward, camera.up);
  // A camera that looks along its own up direction has no upright picture; any will do.
  if (glm::length(view.right) < 1e-9 * glm::length(camera.up)) {
    view.right =
        glm::cross(view.forward, std::abs(view.forward.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0));
  }
  view.right = glm::normalize(view.right);
  view.up = glm::cross(view.right, view.forward);
  const double half_height = std::tan(0.5 * camera.vertical_fov);
  view.half_extent = {half_height * size.x / size.y, half_height};
  return view;
}

glm::dvec3 CameraView::Towards(const glm::dvec2& place) const {
  return glm::normalize(forward + right * (half_extent.x * (2.0 * place.x - 1.0)) + up * (half_extent.y * (1.0 - 2.0 * place.y)));
}

namespace {

void AddSphere(const Light& light, Mesh& mesh) {
  for (int ring = 0; ring <= kSphereRings; ++ring) {
    const double polar = std::numbers::pi * ring / kSphereRings;
    for (int segment = 0; segment <= kSphereSegments; ++segment) {
      const double azimuth = 2.0 * std::numbers::pi * segment / kSphereSegments;
      const glm::dvec3 normal(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                              std::cos(polar));
      mesh.vertices.push_back({glm::vec3(light.center + light.half_size.x * normal), glm::vec3(normal),
                               glm::vec4(0.0f), glm::vec2(0.0f)});
    }
  }
  constexpr std::uint32_t kRow = kSphereSegments + 1;
  for (std::uint32_t ring = 0; ring < kSphereRings; ++ring) {
    for (std::uint32_t segment = 0; segment < kSphereSegments; ++segment) {
      const std::uint32_t upper = ring * kRow + segment;
      const std::uint32_t lower = upper + kRow;
      mesh.indices.insert(mesh.indices.end(), {upper, lower, lower + 1, upper, lower + 1, upper + 1});
    }
  }
}

// The strips of a tube's wall whose outside, or whose inside, faces the camera.
Mesh TubeWall(const Light& light, const glm::dvec3& camera, bool outside) {
  Mesh mesh;
  const auto normal_at = [&](double segment) {
    const double angle = 2.0 * std::numbers::pi * segment / kSphereSegments;
    return std::cos(angle) * light.axis_y + std::sin(angle) * light.normal;
  };
  for (int segment = 0; segment < kSphereSegments; ++segment) {
    const glm::dvec3 rim = light.center + light.half_size.y * normal_at(segment);
    if ((glm::dot(normal_at(segment + 0.5), camera - rim) > 0.0) != outside) continue;
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const int side : {segment, segment + 1}) {
      for (const double end : {-1.0, 1.0}) {
        const glm::dvec3 place = light.center + end * light.half_size.x * light.axis_x + light.half_size.y * normal_at(side);
        mesh.vertices.push_back({glm::vec3(place), glm::vec3(normal_at(side)), glm::vec4(0.0f), glm::vec2(0.0f)});
      }
    }
    mesh.indices.insert(mesh.indices.end(), {first, first + 2, first + 3, first, first + 3, first + 1});
  }
  return mesh;
}

Mesh EmitterMesh(const Light& light) {
  Mesh mesh;
  const auto add = [&](double x, double y) {
    mesh.vertices.push_back({glm::vec3(light.center + x * light.half_size.x * light.axis_x +
                                       y * light.half_size.y * light.axis_y),
                             glm::vec3(light.normal), glm::vec4(light.axis_x, 1.0f), glm::vec2(0.0f)});
  };
  switch (light.shape) {
    case LightShape::kRectangle:
      add(-1.0, -1.0);
      add(1.0, -1.0);
      add(1.0, 1.0);
      add(-1.0, 1.0);
      mesh.indices = {0, 1, 2, 0, 2, 3};
      break;
    case LightShape::kPolygon:
      for (const glm::dvec2& corner : light.corners) add(corner.x / light.half_size.x, corner.y / light.half_size.y);
      for (std::uint32_t i = 1; i + 1 < light.corners.size(); ++i) mesh.indices.insert(mesh.indices.end(), {0, i, i + 1});
      break;
    case LightShape::kDisk:
    case LightShape::kEllipse:
      for (int i = 0; i < kDiskSegments; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / kDiskSegments;
        add(std::cos(angle), std::sin(angle));
      }
      for (std::uint32_t i = 1; i + 1 < kDiskSegments; ++i)
        mesh.indices.insert(mesh.indices.end(), {0, i, i + 1});
      break;
    case LightShape::kTube:  // TubeWall's
      break;
    case LightShape::kSphere:
      AddSphere(light, mesh);
      break;
  }
  return mesh;
}

double DistanceToBox(const glm::dvec3& p, const glm::dvec3& low, const glm::dvec3& high) {
  return glm::length(glm::max(glm::max(low - p, p - high), glm::dvec3(0.0)));
}

// The distance from p to a triangle [Ericson 2005, §5.1.5, by its edges and its plane].
double DistanceToTriangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                          const glm::dvec3& c) {
  const auto to_edge = [&](const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 edge = to - from;
    const double length2 = glm::dot(edge, edge);
    const double t = length2 > 0.0 ? std::clamp(glm::dot(p - from, edge) / length2, 0.0, 1.0) : 0.0;
    return glm::distance(p, from + t * edge);
  };
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const auto inside = [&](const glm::dvec3& from, const glm::dvec3& to) {
    return glm::dot(glm::cross(to - from, p - from), normal) >= 0.0;
  };
  const double normal_length = glm::length(normal);
  if (normal_length > 0.0 && inside(a, b) && inside(b, c) && inside(c, a)) {
    return std::abs(glm::dot(p - a, normal)) / normal_length;
  }
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

// Where a triangle's plane passes close to the camera the rasteriser's depth loses digits in proportion to
// distance over near plane: the near plane is therefore as far as it may be without cutting anything. Where
// the camera touches a surface this share of the scene's size must do.
constexpr double kLeastNear = 1e-5;

// A Draw of gbuffer.frag, three texels of four floats.
struct DrawEntry {
  glm::vec4 base_color_metalness;  // w as in SurfacePixels::base_color
  glm::vec2 roughness;
  float normal_scale;
  float kind;
  glm::ivec4 textures;
};
static_assert(sizeof(DrawEntry) == 48);

}  // namespace

struct GBuffer::Geometry {
  struct Range {
    std::size_t first_index, index_count;
  };
  using TextureSet = std::array<std::shared_ptr<const Image>, 3>;  // colour, metalness and roughness, normals

  std::vector<Vertex> vertices;
  std::vector<Aperture> apertures;     // one per vertex, or none at all
  std::vector<std::uint32_t> indices;  // into `vertices`
  std::vector<Range> ranges;           // one per draw
  std::vector<DrawEntry> draws;
  std::vector<TextureSet> texture_sets{TextureSet{}};  // the first: none
  CameraView view;
  double near = 0.0;  // m

  void Add(const Mesh& mesh, const Material& material, float kind) {
    const auto offset = static_cast<std::uint32_t>(vertices.size());
    ranges.push_back({indices.size(), mesh.indices.size()});
    vertices.insert(vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    std::transform(mesh.indices.begin(), mesh.indices.end(), std::back_inserter(indices),
                   [&](std::uint32_t index) { return index + offset; });

    const TextureSet textures{material.base_color_texture, material.metallic_roughness_texture,
                              material.normal_texture};
    auto known = std::find(texture_sets.begin(), texture_sets.end(), textures);
    if (known == texture_sets.end()) known = texture_sets.insert(known, textures);
    draws.push_back({.base_color_metalness = glm::vec4(material.base_color, material.metalness + (material.specular - 1.0f)),
                     .roughness = material.roughness,
                     .normal_scale = material.normal_scale,
                     .kind = kind,
                     .textures = {static_cast<int>(known - texture_sets.begin()), textures[0] ? 1 : 0,
                                  textures[1] ? 1 : 0, textures[2] ? 1 : 0}});
  }

  // The nearest and the farthest distance of any triangle from `from`, m.
  glm::dvec2 Distances(const glm::dvec3& from) const {
    double nearest = std::numeric_limits<double>::infinity();
    double farthest = 0.0;
    for (const Range& range : ranges) {
      glm::dvec3 low(std::numeric_limits<double>::infinity());
      glm::dvec3 high = -low;
      for (std::size_t i = 0; i < range.index_count; ++i) {
        const glm::dvec3 p(vertices[indices[range.first_index + i]].position);
        low = glm::min(low, p);
        high = glm::max(high, p);
      }
      farthest = std::max(farthest, glm::length(glm::max(glm::abs(low - from), glm::abs(high - from))));
      if (DistanceToBox(from, low, high) >= nearest) continue;
      for (std::size_t i = 0; i + 2 < range.index_count; i += 3) {
        const auto corner = [&](std::size_t k) {
          return glm::dvec3(vertices[indices[range.first_index + i + k]].position);
        };
        nearest = std::min(nearest, DistanceToTriangle(from, corner(0), corner(1), corner(2)));
      }
    }
    return {nearest, farthest};
  }
};

GBuffer::GBuffer(const GladGLContext& gl, const ShaderLibrary& library)
    : gl_(gl),
      library_(library),
      coverage_program_(gl, Expand(library, "coverage.vert", {}, {}, Precision::kFloat),
                        Expand(library, "coverage.frag", {}, {}, Precision::kFloat)),
      vertex_array_(MakeVertexArray(gl)) {
  gl.VertexArrayAttribFormat(vertex_array_.id(), 0, 3, GL_FLOAT, GL_FALSE, offsetof(Vertex, position));
  gl.VertexArrayAttribBinding(vertex_array_.id(), 0, 0);
}

const Program& GBuffer::ResolveProgram(bool apertures, bool normal_map) {
  std::optional<Program>& program = resolve_programs_[(apertures ? 1u : 0u) + (normal_map ? 2u : 0u)];
  if (!program) {
    program.emplace(gl_, Expand(library_, "fullscreen.vert", {}, {}, Precision::kFloat),
                    Expand(library_, "gbuffer.frag", {}, {{"EFFECT_APERTURE", apertures ? 1 : 0}, {"EFFECT_NORMAL_MAP", normal_map ? 1 : 0}},
                           Precision::kFloat));
  }
  return *program;
}

void GBuffer::Allocate(glm::ivec2 size) {
  GLint texture_limit = 0;
  std::array<GLint, 2> viewport_limit{};
  gl_.GetIntegerv(GL_MAX_TEXTURE_SIZE, &texture_limit);
  gl_.GetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport_limit.data());
  const int limit = std::min({kMaxSize, texture_limit, viewport_limit[0], viewport_limit[1]});
  if (size.x < 1 || size.y < 1 || size.x > limit || size.y > limit) {
    throw InputError(
        fmt::format("a picture of {}x{} pixels; expected 1 to {} on either side", size.x, size.y, limit));
  }
  if (position_.id() != 0 && size == glm::ivec2(pixels_.width, pixels_.height)) return;

  pixels_ = {};
  coverage_framebuffer_ = MakeFramebuffer(gl_);
  coverage_ = MakeTexture(gl_, GL_RG32UI, 1, size);
  depth_ = MakeTexture(gl_, GL_DEPTH_COMPONENT32F, 1, size);
  // Integer textures know no linear filter, and are incomplete with the one that they are born with.
  gl_.TextureParameteri(coverage_.id(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl_.TextureParameteri(coverage_.id(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  gl_.NamedFramebufferTexture(coverage_framebuffer_.id(), GL_COLOR_ATTACHMENT0, coverage_.id(), 0);
  gl_.NamedFramebufferTexture(coverage_framebuffer_.id(), GL_DEPTH_ATTACHMENT, depth_.id(), 0);

  framebuffer_ = MakeFramebuffer(gl_);
  position_ = MakeTexture(gl_, GL_RGBA32F, 1, size);
  normal_ = MakeTexture(gl_, GL_RGBA32F, 1, size);
  base_color_ = MakeTexture(gl_, GL_RGBA32F, 1, size);
  apertures_ = {};
  const GLuint fbo = framebuffer_.id();
  gl_.NamedFramebufferTexture(fbo, GL_COLOR_ATTACHMENT0, position_.id(), 0);
  gl_.NamedFramebufferTexture(fbo, GL_COLOR_ATTACHMENT1, normal_.id(), 0);
  gl_.NamedFramebufferTexture(fbo, GL_COLOR_ATTACHMENT2, base_color_.id(), 0);
  const std::array<GLenum, 3> targets{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};
  gl_.NamedFramebufferDrawBuffers(fbo, static_cast<GLsizei>(targets.size()), targets.data());

  const auto complete = [&](const GlObject& framebuffer) {
    return gl_.CheckNamedFramebufferStatus(framebuffer.id(), GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  };
  if (gl_.GetError() == GL_OUT_OF_MEMORY || !complete(coverage_framebuffer_) || !complete(framebuffer_)) {
    position_ = {};
    throw InputError(
        fmt::format("a picture of {}x{} pixels does not fit; expected a smaller one", size.x, size.y));
  }
  pixels_.width = size.x;
  pixels_.height = size.y;
}

GBuffer::Geometry GBuffer::Gather(const Scene& scene, const glm::dvec3& camera) {
  Geometry geometry;
  if (HasApertures(scene)) {
    for (const Mesh& mesh : scene.meshes) {
      geometry.apertures.insert(geometry.apertures.end(), mesh.apertures.begin(), mesh.apertures.end());
    }
  }
  for (const Mesh& mesh : scene.meshes) {
    geometry.Add(mesh, scene.materials.at(static_cast<std::size_t>(mesh.material)), 1.0f);
  }
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    const bool lit = light.two_sided || !IsFlat(light.shape) ||
                     glm::dot(light.normal, camera - light.center) > 0.0;
    const float number = 2.0f + static_cast<float>(i);
    if (light.shape != LightShape::kTube) {
      geometry.Add(EmitterMesh(light), {}, lit ? number : -number);
      continue;
    }
    for (const bool outside : {true, false}) {  // from within none of the outside is seen
      const Mesh wall = TubeWall(light, camera, outside);
      if (!wall.indices.empty()) geometry.Add(wall, {}, outside ? number : -number);
    }
  }
  if (!geometry.apertures.empty()) geometry.apertures.resize(geometry.vertices.size());  // emitters have none
  return geometry;
}

SurfacePixels GBuffer::TakePixels() {
  SurfacePixels taken{pixels_.width, pixels_.height, pixels_.view_position, std::move(pixels_.position), std::move(pixels_.normal),
                      std::move(pixels_.base_color), pixels_.aperture};  // a cap's texture is known by it
  pixels_.position.clear(), pixels_.normal.clear(), pixels_.base_color.clear();
  return taken;
}

const SurfacePixels& GBuffer::Draw(const Scene& scene, glm::ivec2 size) {
  Allocate(size);
  const CameraView view = ViewOf(scene.camera, size);
  Geometry geometry = Gather(scene, view.position);
  const glm::dvec2 distances = geometry.Distances(view.position);
  // The nearest point may be seen in the picture's corner, at a depth of its distance × the cosine of that
  // ray.
  const double corner_cosine = 1.0 / std::sqrt(1.0 + glm::dot(view.half_extent, view.half_extent));
  const double least = kLeastNear * distances.y;
  geometry.near = geometry.ranges.empty() ? 1.0 : std::max(0.99 * corner_cosine * distances.x, least);
  geometry.view = view;

  for (const GLenum capability : {GL_BLEND, GL_CULL_FACE, GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_DEPTH_CLAMP}) {
    gl_.Disable(capability);
  }
  gl_.PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl_.Viewport(0, 0, size.x, size.y);
  gl_.BindVertexArray(vertex_array_.id());
  const GlObject vertices =
      MakeBuffer(gl_, std::max<std::size_t>(geometry.vertices.size(), 1) * sizeof(Vertex),
                 geometry.vertices.empty() ? nullptr : geometry.vertices.data());
  const GlObject indices =
      MakeBuffer(gl_, std::max<std::size_t>(geometry.indices.size(), 1) * sizeof(std::uint32_t),
                 geometry.indices.empty() ? nullptr : geometry.indices.data());
  const GlObject apertures =
      MakeBuffer(gl_, std::max<std::size_t>(geometry.apertures.size(), 1) * sizeof(Aperture),
                 geometry.apertures.empty() ? nullptr : geometry.apertures.data());
  const GlObject draws = MakeBuffer(gl_, std::max<std::size_t>(geometry.draws.size(), 1) * sizeof(DrawEntry),
                                    geometry.draws.empty() ? nullptr : geometry.draws.data());
  gl_.VertexArrayVertexBuffer(vertex_array_.id(), 0, vertices.id(), 0, sizeof(Vertex));
  gl_.VertexArrayElementBuffer(vertex_array_.id(), indices.id());
  const GlObject vertex_texels = MakeBufferTexture(gl_, GL_RGBA32F, vertices);
  const GlObject index_texels = MakeBufferTexture(gl_, GL_R32UI, indices);
  const GlObject draw_texels = MakeBufferTexture(gl_, GL_RGBA32F, draws);
  gl_.BindTextureUnit(4, vertex_texels.id());
  gl_.BindTextureUnit(5, index_texels.id());
  gl_.BindTextureUnit(6, draw_texels.id());
  const GlObject aperture_texels = MakeBufferTexture(gl_, GL_RGBA32F, apertures);
  gl_.BindTextureUnit(7, aperture_texels.id());
  DrawCoverage(geometry);
  Resolve(geometry);
  gl_.UseProgram(0);  // a program in use would outlive its object
  gl_.BindVertexArray(0);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);

  pixels_.view_position = glm::vec3(view.position);
  pixels_.aperture.assign(geometry.apertures.empty() ? 0 : 1, glm::vec4(0.0f));
  ReadBack();
  return pixels_;
}

void GBuffer::DrawCoverage(const Geometry& geometry) {
  const CameraView& view = geometry.view;
  const Program& program = coverage_program_;
  program.Set("view_position", glm::vec3(view.position));
  program.Set("view_from_world", glm::mat3(glm::transpose(glm::dmat3(view.right, view.up, view.forward))));
  program.Set("focal", glm::vec2(1.0 / view.half_extent));
  program.Set("near", static_cast<float>(geometry.near));

  const GLuint fbo = coverage_framebuffer_.id();
  gl_.BindFramebuffer(GL_FRAMEBUFFER, fbo);
  gl_.UseProgram(program.id());
  // The upper left puts the picture's top into texel row 0 and keeps counter-clockwise faces front faces.
  gl_.ClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthMask(GL_TRUE);
  gl_.DepthFunc(GL_GREATER);
  const std::array<GLuint, 4> background{};
  const float infinitely_far = 0.0f;
  gl_.ClearNamedFramebufferuiv(fbo, GL_COLOR, 0, background.data());
  gl_.ClearNamedFramebufferfv(fbo, GL_DEPTH, 0, &infinitely_far);
  gl_.EnableVertexArrayAttrib(vertex_array_.id(), 0);
  for (std::size_t i = 0; i < geometry.ranges.size(); ++i) {
    const Geometry::Range& range = geometry.ranges[i];
    program.Set("draw", static_cast<int>(i));
    program.Set("first_triangle", static_cast<int>(range.first_index / 3));
    gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(range.index_count), GL_UNSIGNED_INT,
                     reinterpret_cast<const void*>(range.first_index * sizeof(std::uint32_t)));
  }
  gl_.DisableVertexArrayAttrib(vertex_array_.id(), 0);
  gl_.ClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  gl_.DepthFunc(GL_LESS);
  gl_.Disable(GL_DEPTH_TEST);
}

void GBuffer::Resolve(const Geometry& geometry) {
  std::map<std::shared_ptr<const Image>, GlObject> earlier = std::exchange(textures_, {});
  for (const Geometry::TextureSet& set : geometry.texture_sets) {
    for (const auto& image : set) {
      if (const auto known = earlier.find(image); known != earlier.end())
        textures_.insert(earlier.extract(known));
    }
  }
  earlier.clear();

  const bool apertures = !geometry.apertures.empty();
  if (apertures && apertures_[0].id() == 0) {
    for (GlObject& cap : apertures_) cap = MakeTexture(gl_, GL_RGBA32F, 1, {pixels_.width, pixels_.height});
  }
  std::array<GLenum, 3 + kCaps> targets;
  for (std::size_t i = 0; i < targets.size(); ++i) targets[i] = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i);
  const GLint target_count = apertures ? static_cast<GLint>(targets.size()) : 3;
  for (std::size_t i = 0; i < kCaps; ++i) {
    gl_.NamedFramebufferTexture(framebuffer_.id(), targets[3 + i], apertures ? apertures_[i].id() : 0, 0);
  }
  gl_.NamedFramebufferDrawBuffers(framebuffer_.id(), target_count, targets.data());
  const bool normal_map = std::ranges::any_of(geometry.texture_sets, [](const Geometry::TextureSet& set) { return set[2] != nullptr; });
  const Program& program = ResolveProgram(apertures, normal_map);
  const CameraView& view = geometry.view;
  program.Set("view_position", view.position);
  program.Set("ray_forward", view.forward);
  program.Set("ray_right", view.right * view.half_extent.x);
  program.Set("ray_up", view.up * view.half_extent.y);
  program.Set("size", glm::vec2(pixels_.width, pixels_.height));
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  gl_.UseProgram(program.id());
  const std::array<float, 4> background{};
  for (GLint i = 0; i < target_count; ++i)
    gl_.ClearNamedFramebufferfv(framebuffer_.id(), GL_COLOR, i, background.data());
  gl_.BindTextureUnit(0, coverage_.id());
  for (std::size_t i = 0; i < geometry.texture_sets.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& image = geometry.texture_sets[i][k];
      gl_.BindTextureUnit(static_cast<GLuint>(1 + k), image ? Upload(image) : 0);
    }
    program.Set("texture_set", static_cast<int>(i));
    gl_.DrawArrays(GL_TRIANGLES, 0, 3);
  }
}

GLuint GBuffer::Upload(const std::shared_ptr<const Image>& image) {
  GlObject& texture = textures_[image];
  if (texture.id() != 0) return texture.id();
  const glm::ivec2 size{image->width, image->height};
  const int levels = 1 + static_cast<int>(std::floor(std::log2(std::max(size.x, size.y))));
  texture = MakeTexture(gl_, GL_RGBA32F, levels, size);
  gl_.TextureSubImage2D(texture.id(), 0, 0, 0, size.x, size.y, GL_RGBA, GL_FLOAT, image->pixels.data());
  gl_.TextureParameteri(texture.id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl_.TextureParameteri(texture.id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.TextureParameteri(texture.id(), GL_TEXTURE_WRAP_S, GL_REPEAT);
  gl_.TextureParameteri(texture.id(), GL_TEXTURE_WRAP_T, GL_REPEAT);
  gl_.GenerateTextureMipmap(texture.id());
  return texture.id();
}

void GBuffer::ReadBack() {
  const auto width = static_cast<std::size_t>(pixels_.width);
  const auto count = width * static_cast<std::size_t>(pixels_.height);
  const auto read = [&](const GlObject& texture, std::vector<glm::vec4>& texels) {
    texels.resize(count);
    // A size in bytes is an int in OpenGL, which a picture of 8192 × 8192 × 16 bytes exceeds: read it in
    // bands of 1 GiB.
    const int band = std::max(1, (1 << 26) / pixels_.width);
    for (int y = 0; y < pixels_.height; y += band) {
      const int rows = std::min(band, pixels_.height - y);
      const auto bytes = static_cast<std::size_t>(rows) * width * sizeof(glm::vec4);
      gl_.GetTextureSubImage(texture.id(), 0, 0, y, 0, pixels_.width, rows, 1, GL_RGBA, GL_FLOAT,
                             static_cast<GLsizei>(bytes), &texels[static_cast<std::size_t>(y) * width]);
    }
  };
  read(position_, pixels_.position);
  read(normal_, pixels_.normal);
  read(base_color_, pixels_.base_color);
  if (!pixels_.aperture.empty()) read(apertures_[0], pixels_.aperture);
}

}  // namespace arealab
