#include "scenes/write_image.h"

#include <OpenImageIO/filesystem.h>
#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "scenes/error.h"
#include "scenes/replace_file.h"

namespace arealab {

// Encoded in memory: OpenImageIO 2.4 closes a file without looking whether its last bytes found room.
void WriteImageFile(const std::filesystem::path& file, OIIO::ImageSpec spec, const void* pixels) {
  spec.attribute("DateTime", "");  // else the time of day
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto output = OIIO::ImageOutput::create(file.filename().string());
  if (output) output->threads(1);  // the caller may write many files at once
  if (!output || !output->set_ioproxy(&memory) || !output->open(file.filename().string(), spec) ||
      !output->write_image(spec.format, pixels) || !output->close()) {
    throw InputError(fmt::format("{}: cannot be encoded ({}); expected an image that its format holds", file.string(),
                                 output ? output->geterror() : OIIO::geterror()));
  }
  ReplaceFile(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace arealab
