#include "scenes/replace_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <fstream>
#include <list>
#include <system_error>

#include "scenes/error.h"

namespace arealab {
namespace {

namespace fs = std::filesystem;

// A file's bytes under another name; that is gone with this object unless it was moved into place.
class Part {
 public:
  Part(const fs::path& file, std::string_view bytes) : file_(file) {
    static std::atomic<unsigned> serial{0};
    std::error_code error;
    if (file.has_parent_path()) fs::create_directories(file.parent_path(), error);
    part_ = file.parent_path() / fmt::format(".{}.{}-{}.tmp", file.filename().string(), getpid(), serial++);
    errno = 0;
    std::ofstream stream(part_, std::ios::binary | std::ios::trunc);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (stream) return;
    if (!error) error = std::error_code(errno, std::generic_category());
    Remove();
    Fail(error);
  }
  ~Part() { Remove(); }
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;

  void MoveIntoPlace() {
    std::error_code error;
    fs::rename(part_, file_, error);
    if (error) Fail(error);
    part_.clear();
  }

 private:
  [[noreturn]] void Fail(const std::error_code& error) const {
    throw InputError(fmt::format("{}: cannot be written ({}); expected a folder with room that may be written to", file_.string(),
                                 error.message()));
  }
  void Remove() const {
    std::error_code ignored;
    if (!part_.empty()) fs::remove(part_, ignored);
  }

  fs::path file_, part_;
};

}  // namespace

void ReplaceFile(const fs::path& file, std::string_view bytes) { Part(file, bytes).MoveIntoPlace(); }

void ReplaceFiles(const std::vector<std::pair<fs::path, std::string>>& files) {
  std::list<Part> parts;
  for (const auto& [file, bytes] : files) parts.emplace_back(file, bytes);
  for (Part& part : parts) part.MoveIntoPlace();
}

}  // namespace arealab
