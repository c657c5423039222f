// Where linked programs are kept between runs, as the driver gives them.
#pragma once

#include <memory>
#include <optional>
#include <string>

namespace arealab {

// Called from any thread that links.
class ProgramStore {
 public:
  virtual ~ProgramStore() = default;
  // `content`: all that a program depends on: its texts, the driver's names. Bytes that the driver refuses are as good as none.
  virtual std::optional<std::string> Find(const std::string& content) = 0;
  virtual void Keep(const std::string& content, const std::string& bytes) = 0;
};

// From now on every Program of a driver that gives its binaries goes there; null: nowhere.
void KeepProgramsIn(std::shared_ptr<ProgramStore> store);

}  // namespace arealab
