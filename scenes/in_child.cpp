#include "scenes/in_child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <exception>
#include <string_view>

#include "scenes/error.h"

namespace arealab {
namespace {

enum ExitStatus { kDone = 0, kRefused = 3, kFailed = 4 };  // 1 is a sanitizer's

bool WriteAll(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

[[noreturn]] void RunChild(const std::function<std::string()>& work, int seconds, int file) {
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDERR_FILENO);
  dup2(nowhere, STDOUT_FILENO);
  const rlimit processor{static_cast<rlim_t>(seconds), static_cast<rlim_t>(seconds)}, no_core{0, 0};
  setrlimit(RLIMIT_CPU, &processor);
  setrlimit(RLIMIT_CORE, &no_core);
  for (const int number : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE}) signal(number, SIG_DFL);
  ExitStatus status = kDone;
  std::string result;
  try {
    result = work();
  } catch (const InputError& error) {
    status = kRefused;
    result = error.what();
  } catch (const std::exception&) {
    status = kFailed;
  }
  _exit(WriteAll(file, result) ? status : kFailed);
}

}  // namespace

std::string InChild(const std::function<std::string()>& work, int seconds, const std::string& what, const std::string& expected) {
  const int file = memfd_create("arealab", MFD_CLOEXEC);  // unlike a pipe it never fills
  const pid_t child = file < 0 ? -1 : fork();
  if (child < 0) {
    const std::string why = std::strerror(errno);
    if (file >= 0) close(file);
    throw InputError(fmt::format("no process to read in ({}); expected one", why));
  }
  if (child == 0) RunChild(work, seconds, file);
  int state = 0;
  while (waitpid(child, &state, 0) < 0 && errno == EINTR) {
  }
  struct stat size {};
  fstat(file, &size);
  std::string result(static_cast<std::size_t>(size.st_size), '\0');
  std::size_t done = 0;
  for (ssize_t n; (n = pread(file, result.data() + done, result.size() - done, static_cast<off_t>(done))) > 0;) done += static_cast<std::size_t>(n);
  close(file);
  if (WIFEXITED(state) && WEXITSTATUS(state) == kDone && done == result.size()) return result;
  if (WIFEXITED(state) && WEXITSTATUS(state) == kRefused) throw InputError(result);
  const int number = WIFSIGNALED(state) ? WTERMSIG(state) : 0;
  const bool slow = number == SIGXCPU || number == SIGKILL;
  throw InputError(fmt::format("{} ({}); expected {}", what,
                               slow ? fmt::format("its reader takes more than {} s", seconds)
                               : number != 0 ? fmt::format("its reader ends with signal {}", number) : "its reader fails", expected));
}

}  // namespace arealab
