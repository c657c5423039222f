// Offscreen OpenGL 4.5 core contexts: OSMesa (loaded at run time) and EGL (device, then surfaceless).
#pragma once

#include <memory>
#include <optional>
#include <string>

struct GladGLContext;

namespace arealab {

enum class ContextKind { kOsmesa, kEgl };

// Not for use by two threads at once; a context is current on one thread at a time.
class Context {
 public:
  virtual ~Context();
  virtual void MakeCurrent() = 0;  // releases whichever Context is current on this thread first
  virtual void Release() = 0;      // makes no context current on this thread
  virtual ContextKind kind() const = 0;
  const GladGLContext& gl() const { return *gl_; }

  // "OSMesa" or "EGL device" or "EGL surfaceless"; GL_RENDERER; GL_VERSION; whether a CPU draws (llvmpipe,
  // softpipe, swrast). renderer() and version() are remembered from creation: the context need not be
  // current.
  virtual std::string platform() const = 0;
  std::string renderer() const { return renderer_; }
  std::string version() const { return version_; }
  bool software() const;

 protected:
  Context();
  // Makes the context current, loads its functions by `get_proc_address` and remembers its names. Throws
  // where that fails; the platform's own part is then still to be destroyed.
  void Load(void (*(*get_proc_address)(const char*))());

 private:
  std::unique_ptr<GladGLContext> gl_;
  std::string renderer_;
  std::string version_;
};

// The libraries that contexts are loaded from, as dlopen takes them: a name or a path.
struct ContextLibraries {
  std::string osmesa = "libOSMesa.so.8";
  std::string egl = "libEGL.so.1";

  // The names above, or what the environment variables AREALAB_OSMESA and AREALAB_EGL say instead.
  static ContextLibraries FromEnvironment();
};

// Makes a context of that kind and makes it current; nullopt: EGL where a hardware GPU answers, else OSMesa,
// else EGL. Throws InputError with one line where there is none.
std::unique_ptr<Context> CreateContext(
    std::optional<ContextKind> kind = std::nullopt,
    const ContextLibraries& libraries = ContextLibraries::FromEnvironment());

}  // namespace arealab
