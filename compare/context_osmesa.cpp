// OSMesa's header goes after glad's.
#include <glad/gl.h>
#include <GL/osmesa.h>

#include <array>

#include "compare/context_platforms.h"

namespace arealab::contexts {
namespace {

struct Functions {
  explicit Functions(const Library& library)
      : create(library.Get<decltype(&OSMesaCreateContextAttribs)>("OSMesaCreateContextAttribs")),
        destroy(library.Get<decltype(&OSMesaDestroyContext)>("OSMesaDestroyContext")),
        make_current(library.Get<decltype(&OSMesaMakeCurrent)>("OSMesaMakeCurrent")),
        get_proc_address(library.Get<decltype(&OSMesaGetProcAddress)>("OSMesaGetProcAddress")) {}

  decltype(&OSMesaCreateContextAttribs) create;
  decltype(&OSMesaDestroyContext) destroy;
  decltype(&OSMesaMakeCurrent) make_current;
  decltype(&OSMesaGetProcAddress) get_proc_address;
};

class OsmesaContext : public Context {
 public:
  explicit OsmesaContext(const std::string& library) : functions_(Library(library)) {
    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              4,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              5,
                              0};
    context_ = functions_.create(attributes, nullptr);
    if (context_ == nullptr) throw Unavailable("it makes no OpenGL 4.5 core context");
    try {
      Load(functions_.get_proc_address);
    } catch (...) {
      Destroy();
      throw;
    }
  }
  ~OsmesaContext() override { Destroy(); }
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;

  void MakeCurrent() override {
    if (current == this) return;
    ReleaseOther(this);
    if (functions_.make_current(context_, pixel_.data(), GL_UNSIGNED_BYTE, 1, 1) != GL_TRUE) {
      throw Unavailable("its context cannot be made current");
    }
    current = this;
  }

  void Release() override {
    if (current != this) return;
    functions_.make_current(nullptr, nullptr, 0, 0, 0);
    current = nullptr;
  }

  ContextKind kind() const override { return ContextKind::kOsmesa; }
  std::string platform() const override { return "OSMesa"; }

 private:
  void Destroy() {
    Release();
    functions_.destroy(context_);
  }

  Functions functions_;
  OSMesaContext context_ = nullptr;
  std::array<GLubyte, 4> pixel_{};  // the default framebuffer, which nobody draws to
};

}  // namespace

std::unique_ptr<Context> CreateOsmesa(const std::string& library) {
  return std::make_unique<OsmesaContext>(library);
}

}  // namespace arealab::contexts
