// What compare/context.cpp chooses from: one function per platform. Internal to the room.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "compare/context.h"

namespace arealab::contexts {

// A platform that is not there, in words that fit behind its name; CreateContext makes an InputError of it.
class Unavailable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A library kept loaded until the program ends: drivers do not survive being unloaded. Throws Unavailable.
class Library {
 public:
  explicit Library(const std::string& name);

  // The function called `name`; throws Unavailable where the library has none.
  template <typename Function>
  Function Get(const char* name) const {
    return reinterpret_cast<Function>(Symbol(name));
  }

 private:
  void* Symbol(const char* name) const;

  std::string name_;
  void* handle_ = nullptr;
};

// The context that is current on this thread, of either platform.
extern thread_local Context* current;

// Releases the current context if it is another one than `next`.
void ReleaseOther(const Context* next);

// Both leave the new context current. Both throw Unavailable.
std::unique_ptr<Context> CreateOsmesa(const std::string& library);
// hardware_only: Unavailable where only a CPU would draw; found without making a context where EGL can tell.
std::unique_ptr<Context> CreateEgl(const std::string& library, bool hardware_only);

}  // namespace arealab::contexts
