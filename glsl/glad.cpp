// The one place where glad's loader is compiled.
#define GLAD_GL_IMPLEMENTATION
#include <glad/gl.h>
