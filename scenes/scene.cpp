#include "scenes/scene.h"

namespace arealab {

const char* Name(LightShape shape) {
  switch (shape) {
    case LightShape::kRectangle:
      return "rectangle";
    case LightShape::kDisk:
      return "disk";
    case LightShape::kSphere:
      return "sphere";
  }
  return "";
}

}  // namespace arealab
