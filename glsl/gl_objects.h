// OpenGL objects that delete themselves. Every one keeps the table of functions of the context that it lives
// in; that context must be current when it is made and when it ends.
#pragma once

#include <glad/gl.h>

#include <glm/glm.hpp>
#include <utility>

namespace arealab {

class GlObject {
 public:
  using Delete = void (*)(const GladGLContext& gl, GLuint id);

  GlObject() = default;
  GlObject(const GladGLContext& gl, GLuint id, Delete del) : gl_(&gl), id_(id), delete_(del) {}
  GlObject(GlObject&& other) noexcept
      : gl_(other.gl_), id_(std::exchange(other.id_, 0)), delete_(other.delete_) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(gl_, other.gl_);
    std::swap(id_, other.id_);
    std::swap(delete_, other.delete_);
    return *this;
  }
  ~GlObject() {
    if (id_ != 0) delete_(*gl_, id_);
  }

  GLuint id() const { return id_; }

 private:
  const GladGLContext* gl_ = nullptr;
  GLuint id_ = 0;
  Delete delete_ = nullptr;
};

inline GlObject MakeTexture(const GladGLContext& gl, GLenum internal_format, int levels, glm::ivec2 size) {
  GLuint id = 0;
  gl.CreateTextures(GL_TEXTURE_2D, 1, &id);
  GlObject texture(gl, id, [](const GladGLContext& table, GLuint name) { table.DeleteTextures(1, &name); });
  gl.TextureStorage2D(id, levels, internal_format, size.x, size.y);
  return texture;
}

// size.z: layers. Trilinear, clamped to the edge.
inline GlObject MakeTextureArray(const GladGLContext& gl, GLenum internal_format, int levels, glm::ivec3 size) {
  GLuint id = 0;
  gl.CreateTextures(GL_TEXTURE_2D_ARRAY, 1, &id);
  GlObject texture(gl, id, [](const GladGLContext& table, GLuint name) { table.DeleteTextures(1, &name); });
  gl.TextureStorage3D(id, levels, internal_format, size.x, size.y, size.z);
  gl.TextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl.TextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.TextureParameteri(id, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TextureParameteri(id, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

inline GlObject MakeBuffer(const GladGLContext& gl, std::size_t bytes, const void* data) {
  GLuint id = 0;
  gl.CreateBuffers(1, &id);
  GlObject buffer(gl, id, [](const GladGLContext& table, GLuint name) { table.DeleteBuffers(1, &name); });
  gl.NamedBufferStorage(id, static_cast<GLsizeiptr>(bytes), data,
                        data == nullptr ? GL_DYNAMIC_STORAGE_BIT : 0);
  return buffer;
}

// A view of the whole buffer, which it keeps alive, as a one-dimensional texture.
inline GlObject MakeBufferTexture(const GladGLContext& gl, GLenum internal_format, const GlObject& buffer) {
  GLuint id = 0;
  gl.CreateTextures(GL_TEXTURE_BUFFER, 1, &id);
  GlObject texture(gl, id, [](const GladGLContext& table, GLuint name) { table.DeleteTextures(1, &name); });
  gl.TextureBuffer(id, internal_format, buffer.id());
  return texture;
}

inline GlObject MakeFramebuffer(const GladGLContext& gl) {
  GLuint id = 0;
  gl.CreateFramebuffers(1, &id);
  return {gl, id, [](const GladGLContext& table, GLuint name) { table.DeleteFramebuffers(1, &name); }};
}

inline GlObject MakeVertexArray(const GladGLContext& gl) {
  GLuint id = 0;
  gl.CreateVertexArrays(1, &id);
  return {gl, id, [](const GladGLContext& table, GLuint name) { table.DeleteVertexArrays(1, &name); }};
}

}  // namespace arealab
