// Offscreen OpenGL 4.5 core contexts: OSMesa (loaded at run time) and EGL (device, then surfaceless).
#pragma once

#include <memory>
#include <optional>
#include <string>

struct GladGLContext;

namespace arealab {

enum class ContextKind { kOsmesa, kEgl };

class Context {
 public:
  virtual ~Context() = default;
  virtual void MakeCurrent() = 0;
  virtual void Release() = 0;  // makes no context current on this thread
  virtual ContextKind kind() const = 0;
  virtual const GladGLContext& gl() const = 0;

  // "OSMesa" or "EGL device" or "EGL surfaceless"; GL_RENDERER; GL_VERSION; whether a CPU draws (llvmpipe, softpipe, swrast).
  virtual std::string platform() const = 0;
  std::string renderer() const;
  std::string version() const;
  bool software() const;
};

// Makes a context of that kind and makes it current; nullopt: EGL where a hardware GPU answers, else OSMesa, else EGL.
// Throws InputError with one line where there is none.
std::unique_ptr<Context> CreateContext(std::optional<ContextKind> kind = std::nullopt);

}  // namespace arealab
