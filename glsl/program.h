// A linked program of a vertex and a fragment shader, and its uniforms by name.
#pragma once

#include <glm/glm.hpp>
#include <string>

#include "glsl/expand.h"
#include "glsl/gl_objects.h"

namespace arealab {

class Program {
 public:
  // Throws InputError, one line that begins with the author's file and line, where a text does not compile or
  // link.
  Program(const GladGLContext& gl, const ExpandedSource& vertex, const ExpandedSource& fragment);

  GLuint id() const { return program_.id(); }

  // Whether what the compiler left of the text reads a uniform of this name.
  bool Reads(const std::string& name) const { return Location(name) >= 0; }

  // Setters of uniforms; a name that the compiler dropped or that never was is no error.
  void Set(const std::string& name, int value) const;
  void Set(const std::string& name, float value) const;
  void Set(const std::string& name, const glm::vec2& value) const;
  void Set(const std::string& name, const glm::vec3& value) const;
  void Set(const std::string& name, const glm::dvec3& value) const;
  void Set(const std::string& name, const glm::mat3& value) const;

 private:
  GLint Location(const std::string& name) const;

  const GladGLContext* gl_;
  GlObject program_;
};

}  // namespace arealab
