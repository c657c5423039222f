// Linked programs in the cache, by content.
#pragma once

#include <filesystem>

#include "glsl/program_store.h"

namespace arealab {

std::shared_ptr<ProgramStore> ProgramsInFolder(std::filesystem::path folder);

}  // namespace arealab
