#include "compare/program_cache.h"

#include "compare/cache_file.h"
#include "compare/content_hash.h"

namespace arealab {
namespace {

class FolderOfPrograms : public ProgramStore {
 public:
  explicit FolderOfPrograms(std::filesystem::path folder) : folder_(std::move(folder)) {}

  std::optional<std::string> Find(const std::string& content) override { return ReadCacheEntry(folder_, Name(content)); }
  void Keep(const std::string& content, const std::string& bytes) override { WriteCacheEntry(folder_, Name(content), bytes); }

 private:
  static std::string Name(const std::string& content) {
    ContentHash hash;
    hash.Text(content);
    return hash.Name() + ".program";
  }

  std::filesystem::path folder_;
};

}  // namespace

std::shared_ptr<ProgramStore> ProgramsInFolder(std::filesystem::path folder) { return std::make_shared<FolderOfPrograms>(std::move(folder)); }

}  // namespace arealab
