// An entry of the cache: bytes under a name that is a hash of all that they depend on.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace arealab {

// What WriteCacheEntry wrote under this name, a path in the folder; nothing where there is none. A file that is cut short,
// damaged, of another layout or moved from another name is noted and deleted: what it held is made anew.
std::optional<std::string> ReadCacheEntry(const std::filesystem::path& folder, const std::string& name);

// As ReplaceFile. A folder that cannot be written to, or that is full, costs the storing alone.
void WriteCacheEntry(const std::filesystem::path& folder, const std::string& name, std::string_view bytes);

// How many entries were noted since the program began.
int DamagedCacheEntries();

}  // namespace arealab
