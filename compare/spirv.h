// SPIR-V of shader text, by glslang within this process: a process of its own would spend most of its time on the built-in
// functions' tables, which stay here.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace arealab {

enum class SpirvStage { kVertex, kFragment };

struct SpirvResult {
  std::vector<std::uint32_t> words;  // empty where the text does not compile
  std::string log;                   // lines "ERROR: 0:LINE: …"
};

// For Vulkan 1.1. Loose uniforms are gathered in a block; samplers keep the bindings 0 to 15, uniform blocks move to 16 and on,
// else they collide silently. From any thread.
SpirvResult TranslateToSpirv(const std::string& text, SpirvStage stage);

// "11:12.0.0": its generator's number and its version, as glslangValidator says it.
std::string GlslangVersion();

}  // namespace arealab
