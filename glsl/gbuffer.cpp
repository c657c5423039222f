#include "glsl/gbuffer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "scenes/error.h"
#include "scenes/shapes.h"

namespace arealab {
namespace {

// The longer side of an 8K picture (7680 × 4320), rounded up to a power of two.
constexpr int kMaxSize = 8192;

// A disk's outline as a polygon: it lies at most 1 − cos(π/256) = 8e-5 radii inside.
constexpr int kDiskSegments = 256;

// gbuffer.frag reads vertices as 12 floats in this order.
static_assert(sizeof(Vertex) == 12 * sizeof(float));

struct View {
  glm::dvec3 position;  // m, world: what float holds of the camera's, so that everyone means the same point
  glm::dvec3 right, up, forward;
  glm::dvec2 half_extent;  // of the picture at distance 1
};

View MakeView(const Camera& camera, glm::ivec2 size) {
  View view;
  view.position = glm::dvec3(glm::vec3(camera.position));
  view.forward = glm::normalize(camera.target - camera.position);
  view.right = glm::cross(view.forward, camera.up);
  // A camera that looks along its own up direction has no upright picture; any will do.
  if (glm::length(view.right) < 1e-9 * glm::length(camera.up)) {
    view.right = glm::cross(view.forward, std::abs(view.forward.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0));
  }
  view.right = glm::normalize(view.right);
  view.up = glm::cross(view.right, view.forward);
  const double half_height = std::tan(0.5 * camera.vertical_fov);
  view.half_extent = {half_height * size.x / size.y, half_height};
  return view;
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
    case LightShape::kDisk:
      for (int i = 0; i < kDiskSegments; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / kDiskSegments;
        add(std::cos(angle), std::sin(angle));
      }
      for (std::uint32_t i = 1; i + 1 < kDiskSegments; ++i) mesh.indices.insert(mesh.indices.end(), {0, i, i + 1});
      break;
    case LightShape::kSphere:
      mesh = MakeSphere(light.half_size.x, {.position = light.center});
      break;
  }
  return mesh;
}

double FarthestDistance(const Scene& scene, const glm::dvec3& from) {
  double farthest = 0.0;
  for (const Mesh& mesh : scene.meshes) {
    for (const Vertex& vertex : mesh.vertices) {
      farthest = std::max(farthest, glm::distance(from, glm::dvec3(vertex.position)));
    }
  }
  for (const Light& light : scene.lights) {
    farthest = std::max(farthest, glm::distance(from, light.center) + glm::length(light.half_size));
  }
  return farthest;
}

}  // namespace

GBuffer::GBuffer(const GladGLContext& gl, const ShaderLibrary& library)
    : gl_(gl),
      program_(gl, Expand(library, "gbuffer.vert", {}, {}, Precision::kFloat),
               Expand(library, "gbuffer.frag", {}, {}, Precision::kFloat)),
      vertex_array_(MakeVertexArray(gl)) {
  gl.EnableVertexArrayAttrib(vertex_array_.id(), 0);
  gl.VertexArrayAttribFormat(vertex_array_.id(), 0, 3, GL_FLOAT, GL_FALSE, offsetof(Vertex, position));
  gl.VertexArrayAttribBinding(vertex_array_.id(), 0, 0);
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
  framebuffer_ = MakeFramebuffer(gl_);
  position_ = MakeTexture(gl_, GL_RGBA32F, 1, size);
  normal_ = MakeTexture(gl_, GL_RGBA32F, 1, size);
  base_color_ = MakeTexture(gl_, GL_RGBA32F, 1, size);
  depth_ = MakeTexture(gl_, GL_DEPTH_COMPONENT32F, 1, size);
  const GLuint fbo = framebuffer_.id();
  gl_.NamedFramebufferTexture(fbo, GL_COLOR_ATTACHMENT0, position_.id(), 0);
  gl_.NamedFramebufferTexture(fbo, GL_COLOR_ATTACHMENT1, normal_.id(), 0);
  gl_.NamedFramebufferTexture(fbo, GL_COLOR_ATTACHMENT2, base_color_.id(), 0);
  gl_.NamedFramebufferTexture(fbo, GL_DEPTH_ATTACHMENT, depth_.id(), 0);
  const std::array<GLenum, 3> targets{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};
  gl_.NamedFramebufferDrawBuffers(fbo, static_cast<GLsizei>(targets.size()), targets.data());
  if (gl_.GetError() == GL_OUT_OF_MEMORY ||
      gl_.CheckNamedFramebufferStatus(fbo, GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    position_ = {};
    throw InputError(fmt::format("a picture of {}x{} pixels does not fit; expected a smaller one", size.x, size.y));
  }
}

const SurfacePixels& GBuffer::Draw(const Scene& scene, glm::ivec2 size) {
  Allocate(size);

  const View view = MakeView(scene.camera, size);
  program_.Set("view_from_world",
               glm::mat3(glm::transpose(glm::dmat3(view.right, view.up, view.forward))));
  program_.Set("focal", glm::vec2(1.0 / view.half_extent));
  // gbuffer.vert has it as vec3, gbuffer.frag as dvec3: two uniforms of one name would not link.
  program_.Set("camera_position", glm::vec3(view.position));
  program_.Set("view_position", view.position);
  program_.Set("ray_forward", view.forward);
  program_.Set("ray_right", view.right * view.half_extent.x);
  program_.Set("ray_up", view.up * view.half_extent.y);
  program_.Set("size", glm::vec2(size));
  // Reversed float depth, written by the fragment shader, is as sharp near as far: the near plane may be close, and hides
  // only what is a hundred thousand times nearer than the scene is large.
  program_.Set("near", static_cast<float>(1e-5 * std::max(FarthestDistance(scene, view.position), 1e-3)));

  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  gl_.Viewport(0, 0, size.x, size.y);
  for (const GLenum capability : {GL_BLEND, GL_CULL_FACE, GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_DEPTH_CLAMP}) {
    gl_.Disable(capability);
  }
  gl_.PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  // The upper left puts the picture's top into texel row 0 and keeps counter-clockwise faces front faces.
  gl_.ClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthMask(GL_TRUE);
  gl_.DepthFunc(GL_GREATER);
  const std::array<float, 4> black{};
  const float farthest = 0.0f;
  for (GLint i = 0; i < 3; ++i) gl_.ClearNamedFramebufferfv(framebuffer_.id(), GL_COLOR, i, black.data());
  gl_.ClearNamedFramebufferfv(framebuffer_.id(), GL_DEPTH, 0, &farthest);
  gl_.UseProgram(program_.id());
  gl_.BindVertexArray(vertex_array_.id());

  std::map<std::shared_ptr<const Image>, GlObject> earlier = std::move(textures_);
  textures_.clear();
  for (const Material& material : scene.materials) {
    for (const auto& image :
         {material.base_color_texture, material.metallic_roughness_texture, material.normal_texture}) {
      if (const auto known = earlier.find(image); known != earlier.end()) textures_.insert(earlier.extract(known));
    }
  }
  earlier.clear();

  program_.Set("kind", 1.0f);
  for (const Mesh& mesh : scene.meshes) {
    UseMaterial(scene.materials.at(static_cast<std::size_t>(mesh.material)));
    DrawMesh(mesh);
  }
  UseMaterial({});
  for (std::size_t i = 0; i < scene.lights.size(); ++i) DrawEmitter(scene.lights[i], i, view.position);

  gl_.ClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  gl_.DepthFunc(GL_LESS);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.BindVertexArray(0);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
  pixels_.view_position = glm::vec3(view.position);
  ReadBack(size);
  return pixels_;
}

void GBuffer::UseMaterial(const Material& material) {
  program_.Set("base_color", material.base_color);
  program_.Set("roughness", material.roughness);
  program_.Set("metalness", material.metalness);
  program_.Set("normal_scale", material.normal_scale);
  UseTexture(0, material.base_color_texture, "has_base_color_texture");
  UseTexture(1, material.metallic_roughness_texture, "has_metallic_roughness_texture");
  UseTexture(2, material.normal_texture, "has_normal_texture");
}

void GBuffer::UseTexture(GLuint unit, const std::shared_ptr<const Image>& image, const char* flag) {
  program_.Set(flag, image ? 1 : 0);
  if (!image) return;
  GlObject& texture = textures_[image];
  if (texture.id() == 0) {
    const glm::ivec2 size{image->width, image->height};
    const int levels = 1 + static_cast<int>(std::floor(std::log2(std::max(size.x, size.y))));
    texture = MakeTexture(gl_, GL_RGBA32F, levels, size);
    gl_.TextureSubImage2D(texture.id(), 0, 0, 0, size.x, size.y, GL_RGBA, GL_FLOAT, image->pixels.data());
    gl_.TextureParameteri(texture.id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    gl_.TextureParameteri(texture.id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    gl_.TextureParameteri(texture.id(), GL_TEXTURE_WRAP_S, GL_REPEAT);
    gl_.TextureParameteri(texture.id(), GL_TEXTURE_WRAP_T, GL_REPEAT);
    gl_.GenerateTextureMipmap(texture.id());
  }
  gl_.BindTextureUnit(unit, texture.id());
}

void GBuffer::DrawMesh(const Mesh& mesh) {
  if (mesh.indices.empty()) return;
  const GlObject vertices = MakeBuffer(gl_, mesh.vertices.size() * sizeof(Vertex), mesh.vertices.data());
  const GlObject indices = MakeBuffer(gl_, mesh.indices.size() * sizeof(std::uint32_t), mesh.indices.data());
  gl_.VertexArrayVertexBuffer(vertex_array_.id(), 0, vertices.id(), 0, sizeof(Vertex));
  gl_.VertexArrayElementBuffer(vertex_array_.id(), indices.id());
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, vertices.id());
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, indices.id());
  gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(mesh.indices.size()), GL_UNSIGNED_INT, nullptr);
}

void GBuffer::DrawEmitter(const Light& light, std::size_t index, const glm::dvec3& camera) {
  const bool lit = light.two_sided || light.shape == LightShape::kSphere ||
                   glm::dot(light.normal, camera - light.center) > 0.0;
  const float number = 2.0f + static_cast<float>(index);
  program_.Set("kind", lit ? number : -number);
  DrawMesh(EmitterMesh(light));
}

void GBuffer::ReadBack(glm::ivec2 size) {
  pixels_.width = size.x;
  pixels_.height = size.y;
  const auto count = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
  const auto read = [&](const GlObject& texture, std::vector<glm::vec4>& texels) {
    texels.resize(count);
    // The size in bytes is an int in OpenGL, which a picture of 8192 × 8192 × 16 bytes exceeds: read it in bands.
    const int band = std::max(1, (1 << 26) / size.x);
    for (int y = 0; y < size.y; y += band) {
      const int rows = std::min(band, size.y - y);
      const auto first = static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x);
      const auto bytes = static_cast<std::size_t>(rows) * static_cast<std::size_t>(size.x) * sizeof(glm::vec4);
      gl_.GetTextureSubImage(texture.id(), 0, 0, y, 0, size.x, rows, 1, GL_RGBA, GL_FLOAT,
                             static_cast<GLsizei>(bytes), &texels[first]);
    }
  };
  read(position_, pixels_.position);
  read(normal_, pixels_.normal);
  read(base_color_, pixels_.base_color);
}

}  // namespace arealab
