// A shader that never ends holds the driver for ever, and OpenGL has no call that stops it.
#pragma once

#include <cstddef>
#include <list>
#include <string>

namespace arealab {

// While one lives, the shader of the file that it names has ten minutes for every 512 × 512 pixels (AREALAB_SHADER_SECONDS:
// another number of seconds), compiling included. One that takes longer ends the program with a line and status 2, by
// std::quick_exit: what must not stay half-written is removed by a handler of that (std::at_quick_exit).
class ShadingWatch {
 public:
  ShadingWatch(std::string file, std::size_t pixels);
  ~ShadingWatch();
  ShadingWatch(const ShadingWatch&) = delete;
  ShadingWatch& operator=(const ShadingWatch&) = delete;

  struct Watched;

 private:
  std::list<Watched>::iterator watched_;
};

}  // namespace arealab
