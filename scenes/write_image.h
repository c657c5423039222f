// Images to files, through OpenImageIO.
#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>

namespace arealab {

// `pixels` in the spec's format, interleaved, row 0 the top; the file's suffix names the format. The same image gives the
// same bytes. As ReplaceFile: whole or not at all. Throws InputError where it cannot be written.
void WriteImageFile(const std::filesystem::path& file, OIIO::ImageSpec spec, const void* pixels);

}  // namespace arealab
