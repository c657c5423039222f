// The entry that libFuzzer calls, once per target: AREALAB_FUZZ_TARGET is its name.
#include <cstddef>
#include <cstring>

#include "tests/fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (const auto& target : arealab::fuzz::kTargets) {
    if (std::strcmp(target.name, AREALAB_FUZZ_TARGET) == 0) target.run({data, size});
  }
  return 0;
}
