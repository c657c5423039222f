// What a check leaves behind: a page of what failed, for people, and its outcome for build servers.
#pragma once

#include <filesystem>
#include <string>

#include "compare/check.h"

namespace arealab {

// Writes folder/check.html: for every case that failed its messages, the command that reruns it, and result, reference, signed
// difference and magnitude of total, diffuse and specular, against the golden on a scale of ±2 % and against the truth on ±50 %: both
// fixed, so that two pages compare by eye; of hard cases the surroundings of the worst. Result, reference and difference lie beside it
// too, pictures/SCENE-VARIANT-result.png and so on, which take the place of an earlier run's; where nothing failed, nothing stays.
// folder/junit.xml: JUnit's form, as build servers read it: a suite per scene, a case per variant; and one suite of the hard cases.
// Files are replaced in one step. Throws InputError where they cannot be written.
void WriteCheckReport(const CheckResult& result, const std::filesystem::path& folder);

}  // namespace arealab
