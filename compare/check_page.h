// What a failed check leaves behind: one self-contained page.
#pragma once

#include <filesystem>
#include <string>

#include "compare/check.h"

namespace arealab {

// Writes, for every case that failed, its messages, the command that reruns it, and result, reference, signed
// difference and magnitude of total, diffuse and specular, against the golden on a scale of ±2 % and against
// the truth on ±50 %: both fixed, so that two pages compare by eye. `command` is put before each case's rerun
// arguments and `common` after. The file is replaced in one step. Throws InputError where it cannot be
// written.
void WriteCheckPage(const CheckResult& result, const std::string& command, const std::string& common,
                    const std::filesystem::path& file);

}  // namespace arealab
