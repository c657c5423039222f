// Reading a scene together with the names of the files that it is read from.
#pragma once

#include <filesystem>
#include <set>
#include <string>

#include "scenes/scene.h"

namespace arealab {

// As ParseScene. Adds to `files` those that the text calls for: images, meshes, and what meshes refer to; also where it throws, and
// also those that are not there.
Scene ParseScene(const std::filesystem::path& file, const std::string& text, std::set<std::filesystem::path>& files);

// Where a scene file's images and meshes are looked for: "." for one without a folder.
std::filesystem::path FolderOf(const std::filesystem::path& file);

}  // namespace arealab
