#include "compare/subprocess.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>

#include "scenes/error.h"

extern char** environ;

namespace arealab {
namespace {

// A file in memory: unlike a pipe it never fills, so neither side waits for the other.
class MemoryFile {
 public:
  MemoryFile() {
    constexpr int kLeast = 10;  // above the descriptors that the program gets, so that none takes another's place
    const int low = memfd_create("arealab", MFD_CLOEXEC);
    descriptor_ = low < 0 ? -1 : fcntl(low, F_DUPFD_CLOEXEC, kLeast);
    if (low >= 0) close(low);
    if (descriptor_ < 0) throw InputError(fmt::format("no file in memory ({}); expected one", std::strerror(errno)));
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  int descriptor() const { return descriptor_; }

  void Write(std::span<const char> bytes) const {
    for (std::size_t done = 0; done < bytes.size();) {
      const ssize_t written = write(descriptor_, bytes.data() + done, bytes.size() - done);
      if (written <= 0) throw InputError(fmt::format("a file in memory is full ({}); expected room", std::strerror(errno)));
      done += static_cast<std::size_t>(written);
    }
    lseek(descriptor_, 0, SEEK_SET);
  }

  std::string Read() const {
    std::string bytes;
    std::array<char, 65536> buffer;
    for (;;) {
      const ssize_t count = pread(descriptor_, buffer.data(), buffer.size(), static_cast<off_t>(bytes.size()));
      if (count <= 0) return bytes;
      bytes.append(buffer.data(), static_cast<std::size_t>(count));
    }
  }

 private:
  int descriptor_ = -1;
};

std::vector<std::string> Environment(const std::vector<std::pair<std::string, std::string>>& changes) {
  std::vector<std::string> lines;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view line(*entry);
    const std::string_view name = line.substr(0, line.find('='));
    bool changed = false;
    for (const auto& change : changes) changed = changed || change.first == name;
    if (!changed) lines.emplace_back(line);
  }
  for (const auto& [name, value] : changes) {
    if (!value.empty()) lines.push_back(name + "=" + value);
  }
  return lines;
}

std::vector<char*> Pointers(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

}  // namespace

ProcessResult RunProcess(const std::vector<std::string>& command,
                         const std::vector<std::pair<std::string, std::string>>& environment,
                         std::span<const char> input) {
  const MemoryFile in, messages, data;
  in.Write(input);
  std::vector<std::string> words = command, lines = Environment(environment);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in.descriptor(), 0);
  posix_spawn_file_actions_adddup2(&actions, messages.descriptor(), 1);
  posix_spawn_file_actions_adddup2(&actions, messages.descriptor(), 2);
  posix_spawn_file_actions_adddup2(&actions, data.descriptor(), 3);
  pid_t process = 0;
  const int error = posix_spawnp(&process, words[0].c_str(), &actions, nullptr, Pointers(words).data(), Pointers(lines).data());
  posix_spawn_file_actions_destroy(&actions);
  ProcessResult result;
  if (error != 0) return result;
  int state = 0;
  while (waitpid(process, &state, 0) < 0 && errno == EINTR) {
  }
  result.started = true;
  if (WIFEXITED(state)) result.status = WEXITSTATUS(state);
  if (WIFSIGNALED(state)) result.signal = WTERMSIG(state);
  result.messages = messages.Read();
  result.data = data.Read();
  return result;
}

}  // namespace arealab
