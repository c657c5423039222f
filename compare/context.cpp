#include "compare/context.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <glad/gl.h>

#include <cstdlib>

#include "compare/context_platforms.h"
#include "scenes/error.h"

namespace arealab {

namespace contexts {

thread_local Context* current = nullptr;

void ReleaseOther(const Context* next) {
  // An EGL context left current while another platform's is made current kills the process on some drivers.
  if (current != nullptr && current != next) current->Release();
}

// RTLD_LOCAL: OSMesa and libglvnd export the same gl* names, which must not find one another.
Library::Library(const std::string& name)
    : name_(name), handle_(dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL)) {
  if (handle_ == nullptr) throw Unavailable(fmt::format("{} does not load", name));
}

void* Library::Symbol(const char* name) const {
  void* symbol = dlsym(handle_, name);
  if (symbol == nullptr) throw Unavailable(fmt::format("{} has no {}", name_, name));
  return symbol;
}

}  // namespace contexts

Context::Context() : gl_(std::make_unique<GladGLContext>()) {}
Context::~Context() = default;

void Context::Load(void (*(*get_proc_address)(const char*))()) {
  MakeCurrent();
  if (gladLoadGLContext(gl_.get(), get_proc_address) == 0) {
    throw contexts::Unavailable("its functions do not load");
  }
  renderer_ = reinterpret_cast<const char*>(gl_->GetString(GL_RENDERER));
  version_ = reinterpret_cast<const char*>(gl_->GetString(GL_VERSION));
}

bool Context::software() const {
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "SWR", "Software"}) {
    if (renderer_.find(name) != std::string::npos) return true;
  }
  return false;
}

ContextLibraries ContextLibraries::FromEnvironment() {
  ContextLibraries libraries;
  if (const char* osmesa = std::getenv("AREALAB_OSMESA")) libraries.osmesa = osmesa;
  if (const char* egl = std::getenv("AREALAB_EGL")) libraries.egl = egl;
  return libraries;
}

std::unique_ptr<Context> CreateContext(std::optional<ContextKind> kind, const ContextLibraries& libraries) {
  std::string why;
  const auto attempt = [&](const char* platform, auto create) -> std::unique_ptr<Context> {
    try {
      return create();
    } catch (const contexts::Unavailable& error) {
      why += fmt::format("{}{}: {}", why.empty() ? "" : "; ", platform, error.what());
      return nullptr;
    }
  };
  const auto osmesa = [&] { return contexts::CreateOsmesa(libraries.osmesa); };
  const auto egl = [&] { return contexts::CreateEgl(libraries.egl, false); };

  if (kind == ContextKind::kOsmesa) {
    if (auto context = attempt("OSMesa", osmesa)) return context;
    throw InputError(
        fmt::format("no OSMesa context ({}); expected Debian's package libosmesa6, or --context egl", why));
  }
  if (kind == ContextKind::kEgl) {
    if (auto context = attempt("EGL", egl)) return context;
    throw InputError(
        fmt::format("no EGL context ({}); expected a driver with OpenGL 4.5 core, or --context osmesa", why));
  }
  const auto gpu = [&] { return contexts::CreateEgl(libraries.egl, true); };
  if (auto context = attempt("EGL", gpu)) return context;
  why.clear();  // that there is no GPU is no failure
  if (auto context = attempt("OSMesa", osmesa)) return context;
  if (auto context = attempt("EGL", egl)) return context;
  throw InputError(fmt::format(
      "no OpenGL context ({}); expected OpenGL 4.5 core from EGL or from Debian's package libosmesa6", why));
}

}  // namespace arealab
