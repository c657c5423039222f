#include "compare/cache_file.h"

#include <atomic>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>

#include "compare/content_hash.h"
#include "scenes/error.h"
#include "scenes/replace_file.h"

namespace arealab {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "ALCACHE1";  // of the layout: this, the checksum, the bytes

std::atomic<int> damaged{0};

std::uint64_t Checksum(const std::string& name, std::string_view bytes) {
  ContentHash hash;
  hash.Text(name);
  hash.Value(bytes.size());
  hash.Bytes(bytes.data(), bytes.size());
  return hash.low();
}

}  // namespace

std::optional<std::string> ReadCacheEntry(const fs::path& folder, const std::string& name) {
  std::error_code error;
  const auto size = fs::file_size(folder / name, error);
  if (error) return std::nullopt;
  std::uint64_t checksum = 0;
  constexpr std::size_t kHeader = kMagic.size() + sizeof checksum;
  char header[kHeader] = {};
  std::string bytes(size > kHeader ? size - kHeader : 0, '\0');
  std::ifstream in(folder / name, std::ios::binary);
  in.read(header, kHeader);
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  std::memcpy(&checksum, header + kMagic.size(), sizeof checksum);
  if (in && std::string_view(header, kMagic.size()) == kMagic && checksum == Checksum(name, bytes)) return bytes;
  ++damaged;
  fs::remove(folder / name, error);
  return std::nullopt;
}

void WriteCacheEntry(const fs::path& folder, const std::string& name, std::string_view bytes) {
  const std::uint64_t checksum = Checksum(name, bytes);
  std::string entry(kMagic);
  entry.append(reinterpret_cast<const char*>(&checksum), sizeof checksum);
  entry += bytes;
  try {
    ReplaceFile(folder / name, entry);
  } catch (const InputError&) {
    // As said in the header.
  }
}

int DamagedCacheEntries() { return damaged; }

}  // namespace arealab
