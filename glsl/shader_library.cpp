#include "glsl/shader_library.h"

#include "scenes/embedded.h"

namespace arealab {

namespace glsl_files {
extern const EmbeddedFile kFiles[];
extern const int kFileCount;
}  // namespace glsl_files

}  // namespace arealab
