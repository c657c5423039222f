// In builds with a sanitizer alone: keeps Mesa's driver for EGL and GLX loaded to the end. What it leaks has no name in leak.txt once it is gone.
#include <dlfcn.h>

[[maybe_unused]] static void* const kDriver = dlopen(AREALAB_GL_DRIVER, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
