// Writes results.json, results.csv, the images and the page that shows them, as one folder that moves into place whole.
#pragma once

#include <filesystem>
#include <functional>

#include "compare/results.h"

namespace arealab {

// Writes to a temporary folder beside `directory`, then renames; an earlier report there is replaced only then.
// Throws InputError where the folder cannot be written.
void WriteReport(const Results& results, const std::filesystem::path& directory,
                 const std::function<void(double)>& progress = {});

}  // namespace arealab
