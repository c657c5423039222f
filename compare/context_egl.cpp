#include <EGL/egl.h>
#include <EGL/eglext.h>
// glad's header goes after EGL's.
#include <glad/gl.h>

#include <map>
#include <mutex>
#include <string_view>
#include <vector>

#include "compare/context_platforms.h"

namespace arealab::contexts {
namespace {

bool HasWord(const char* words, std::string_view word) {
  if (words == nullptr) return false;
  std::string_view rest = words;
  while (!rest.empty()) {
    const auto space = rest.find(' ');
    if (rest.substr(0, space) == word) return true;
    if (space == std::string_view::npos) return false;
    rest.remove_prefix(space + 1);
  }
  return false;
}

struct Functions {
  explicit Functions(const Library& library)
      : get_proc_address(library.Get<decltype(&eglGetProcAddress)>("eglGetProcAddress")),
        query_string(library.Get<decltype(&eglQueryString)>("eglQueryString")),
        initialize(library.Get<decltype(&eglInitialize)>("eglInitialize")),
        terminate(library.Get<decltype(&eglTerminate)>("eglTerminate")),
        bind_api(library.Get<decltype(&eglBindAPI)>("eglBindAPI")),
        create_context(library.Get<decltype(&eglCreateContext)>("eglCreateContext")),
        destroy_context(library.Get<decltype(&eglDestroyContext)>("eglDestroyContext")),
        make_current(library.Get<decltype(&eglMakeCurrent)>("eglMakeCurrent")) {}

  template <typename Function>
  Function Extension(const char* name) const {
    return reinterpret_cast<Function>(get_proc_address(name));
  }

  decltype(&eglGetProcAddress) get_proc_address;
  decltype(&eglQueryString) query_string;
  decltype(&eglInitialize) initialize;
  decltype(&eglTerminate) terminate;
  decltype(&eglBindAPI) bind_api;
  decltype(&eglCreateContext) create_context;
  decltype(&eglDestroyContext) destroy_context;
  decltype(&eglMakeCurrent) make_current;
};

// EGL hands the same display to everyone who asks for the same device and one eglTerminate ends it for all:
// the last user ends it.
class DisplayUse {
 public:
  // Throws Unavailable where the display does not start.
  DisplayUse(const Functions& functions, EGLDisplay display) : functions_(&functions), display_(display) {
    const std::lock_guard lock(mutex_);
    if (users_[display] == 0 && functions.initialize(display, nullptr, nullptr) != EGL_TRUE) {
      throw Unavailable("its display does not start");
    }
    ++users_[display];
  }
  ~DisplayUse() {
    const std::lock_guard lock(mutex_);
    if (--users_[display_] == 0) functions_->terminate(display_);
  }
  DisplayUse(const DisplayUse&) = delete;
  DisplayUse& operator=(const DisplayUse&) = delete;

  EGLDisplay get() const { return display_; }

 private:
  inline static std::mutex mutex_;
  inline static std::map<EGLDisplay, int> users_;

  const Functions* functions_;
  EGLDisplay display_;
};

class EglContext : public Context {
 public:
  EglContext(const Functions& functions, EGLDisplay display, std::string platform)
      : functions_(functions), display_(functions_, display), platform_(std::move(platform)) {
    const char* extensions = functions_.query_string(display, EGL_EXTENSIONS);
    // We draw to textures only: neither a surface nor a configuration for one.
    if (!HasWord(extensions, "EGL_KHR_surfaceless_context") ||
        !(HasWord(extensions, "EGL_KHR_no_config_context") ||
          HasWord(extensions, "EGL_MESA_configless_context"))) {
      throw Unavailable("its contexts need a surface");
    }
    if (functions_.bind_api(EGL_OPENGL_API) != EGL_TRUE) throw Unavailable("it has no desktop OpenGL");
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 4,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 5,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_NONE};
    context_ = functions_.create_context(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    if (context_ == EGL_NO_CONTEXT) throw Unavailable("it makes no OpenGL 4.5 core context");
    try {
      Load(functions_.get_proc_address);
    } catch (...) {
      Destroy();
      throw;
    }
  }
  ~EglContext() override { Destroy(); }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  void MakeCurrent() override {
    if (current == this) return;
    ReleaseOther(this);
    functions_.bind_api(EGL_OPENGL_API);
    if (functions_.make_current(display_.get(), EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
      throw Unavailable("its context cannot be made current");
    }
    current = this;
  }

  void Release() override {
    if (current != this) return;
    functions_.make_current(display_.get(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    current = nullptr;
  }

  ContextKind kind() const override { return ContextKind::kEgl; }
  std::string platform() const override { return platform_; }

 private:
  void Destroy() {
    Release();
    functions_.destroy_context(display_.get(), context_);
  }

  Functions functions_;
  DisplayUse display_;
  std::string platform_;
  EGLContext context_ = EGL_NO_CONTEXT;
};

struct Device {
  EGLDeviceEXT handle;
  bool software;
};

// Hardware first; empty where the driver cannot list devices.
std::vector<Device> Devices(const Functions& functions, const char* client_extensions) {
  if (!HasWord(client_extensions, "EGL_EXT_platform_device") ||
      !(HasWord(client_extensions, "EGL_EXT_device_enumeration") ||
        HasWord(client_extensions, "EGL_EXT_device_base"))) {
    return {};
  }
  const auto query_devices = functions.Extension<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  const auto query_device_string =
      functions.Extension<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  if (query_devices == nullptr || query_device_string == nullptr) return {};
  EGLint count = 0;
  if (query_devices(0, nullptr, &count) != EGL_TRUE || count <= 0) return {};
  std::vector<EGLDeviceEXT> handles(static_cast<std::size_t>(count));
  if (query_devices(count, handles.data(), &count) != EGL_TRUE) return {};
  handles.resize(static_cast<std::size_t>(count));
  std::vector<Device> devices;
  for (const bool software : {false, true}) {
    for (EGLDeviceEXT handle : handles) {
      const bool is_software =
          HasWord(query_device_string(handle, EGL_EXTENSIONS), "EGL_MESA_device_software");
      if (is_software == software) devices.push_back({handle, software});
    }
  }
  return devices;
}

}  // namespace

std::unique_ptr<Context> CreateEgl(const std::string& library, bool hardware_only) {
  const Functions functions{Library(library)};
  const char* client_extensions = functions.query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const auto get_display = functions.Extension<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  if (get_display == nullptr || client_extensions == nullptr) throw Unavailable("it cannot name a platform");

  std::string why = "it finds no device";
  const auto attempt = [&](EGLenum platform, void* native, const char* name) -> std::unique_ptr<Context> {
    try {
      const EGLDisplay display = get_display(platform, native, nullptr);
      if (display == EGL_NO_DISPLAY) throw Unavailable("it has no display");
      auto context = std::make_unique<EglContext>(functions, display, name);
      if (hardware_only && context->software()) throw Unavailable("only a CPU would draw");
      return context;
    } catch (const Unavailable& error) {
      why = error.what();
      return nullptr;
    }
  };
  const std::vector<Device> devices = Devices(functions, client_extensions);
  for (const Device& device : devices) {
    if (hardware_only && device.software) continue;
    if (auto context = attempt(EGL_PLATFORM_DEVICE_EXT, device.handle, "EGL device")) return context;
  }
  // Where devices can be listed, surfaceless has none that the list lacks.
  const bool worth_it = devices.empty() || !hardware_only;
  if (worth_it && HasWord(client_extensions, "EGL_MESA_platform_surfaceless")) {
    if (auto context = attempt(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, "EGL surfaceless"))
      return context;
  }
  throw Unavailable(why);
}

}  // namespace arealab::contexts
