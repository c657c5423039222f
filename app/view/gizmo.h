// The handles by which a selected light is moved, turned and scaled in the picture, and the outlines of all lights.
#pragma once

#include <glm/glm.hpp>

#include "app/view/session.h"

namespace arealab {

class Gizmo {
 public:
  // Draws over the picture of `size` px whose top left corner is `origin`, and takes the pointer where `at` (px from there,
  // in the frame of a press its place) is on a handle. Returns whether it has the pointer.
  bool Run(Session& session, glm::dvec2 origin, glm::dvec2 size, glm::dvec2 at, bool pointer_free);
  bool dragging() const { return handle_ >= 0; }

 private:
  int handle_ = -1;        // held, or -1
  glm::dvec2 grabbed_{0};  // px, where
  Light before_;           // as it was then
};

}  // namespace arealab
