// The page "hard cases": techniques by families, each cell opening its worst case.
#pragma once

#include <filesystem>

#include "compare/stress.h"

namespace arealab {

// Writes folder/stress.html, self-contained, and each failing or worst case as
// folder/cases/VARIANT/FAMILY.toml, a scene. Files are replaced in one step. Throws InputError where they
// cannot be written.
void WriteStressPage(const StressResult& result, const std::filesystem::path& folder);

}  // namespace arealab
