// The program run as a person, a build server or an accident runs it.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace arealab {

struct Outcome {
  int status = -1;
  std::string out;  // standard output and error together
};

// Starts it; its output goes to `descriptor`. `prepare` runs in the child.
inline pid_t StartArealab(const std::string& arguments, int descriptor, const std::function<void()>& prepare = {}) {
  const std::string command = "exec " + std::string(AREALAB_PROGRAM) + " " + arguments;
  const pid_t child = fork();
  if (child != 0) return child;
  dup2(descriptor, STDOUT_FILENO);
  dup2(descriptor, STDERR_FILENO);
  if (prepare) prepare();
  execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
  _exit(127);
}

inline Outcome Arealab(const std::string& arguments, const std::function<void()>& prepare = {}) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return {};
  const pid_t child = StartArealab(arguments, ends[1], prepare);
  close(ends[1]);
  Outcome outcome;
  char buffer[4096];
  for (ssize_t n; (n = read(ends[0], buffer, sizeof buffer)) > 0;) outcome.out.append(buffer, static_cast<std::size_t>(n));
  close(ends[0]);
  int raw = 0;
  waitpid(child, &raw, 0);
  outcome.status = WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
  return outcome;
}

// One line, status 2, and it says `part`.
inline void ExpectRefused(const Outcome& outcome, const std::string& part) {
  EXPECT_EQ(outcome.status, 2) << outcome.out;
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 1) << outcome.out;
  EXPECT_NE(outcome.out.find(part), std::string::npos) << outcome.out;
}

// A folder for the test and what it reads there.
class ProgramTest : public testing::Test {
 protected:
  ProgramTest() {
    folder_ = std::filesystem::temp_directory_path() / ("arealab_program_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  ~ProgramTest() override { std::filesystem::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  std::string Cache() const { return " --cache " + Path("cache"); }

  std::string WriteFile(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
    return Path(name);
  }

  nlohmann::json ReadJson(const std::string& name) const {
    std::ifstream in(folder_ / name);
    return nlohmann::json::parse(in);
  }

  // The bytes of every file below, by its path from there.
  std::map<std::string, std::string> Files(const std::string& name) const {
    std::map<std::string, std::string> files;
    std::error_code none;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_ / name, none)) {
      if (!entry.is_regular_file()) continue;
      std::ifstream in(entry.path(), std::ios::binary);
      files[entry.path().lexically_relative(folder_ / name).string()] = std::string(std::istreambuf_iterator<char>(in), {});
    }
    return files;
  }

  // What lies directly in the test's folder.
  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

  std::filesystem::path folder_;
};

}  // namespace arealab
