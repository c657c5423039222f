// Files that are never seen half-written.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace arealab {

// Writes `bytes` under another name beside `file`, then renames: who reads sees the former file or this one. Makes the
// folder. Where it cannot, what was there stays, nothing else is left, and an InputError says why.
void ReplaceFile(const std::filesystem::path& file, std::string_view bytes);

// The same for files that belong together: all are written before the first is renamed.
void ReplaceFiles(const std::vector<std::pair<std::filesystem::path, std::string>>& files);

}  // namespace arealab
