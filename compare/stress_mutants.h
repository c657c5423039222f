// The checks' own test: wrong shader text, one change at a time, must be caught.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "compare/context.h"

namespace arealab {

// A slip that someone might make in a shader file.
struct Mutant {
  const char* technique;  // whose default form shows it
  const char* file;       // of glsl/
  const char* text;       // occurs in it exactly once
  const char* becomes;
  const char* what;
  const char* equivalent = nullptr;  // why nothing that can be drawn tells it from the right text, where so
};

// Chosen before the checks were tuned.
const std::vector<Mutant>& Mutants();

struct MutantResult {
  const Mutant* mutant = nullptr;
  std::string caught;  // by what: "stress: inside_sphere: 3 of 100 not finite", "golden: gloss: …"; empty: it
                       // survived
};

struct MutantOptions {
  std::filesystem::path golden;  // folder of the stored images; empty: hard cases alone
  int cases = 24000;             // of a mutant
  std::function<void(const std::string&, double)> progress;
};

// Runs each through the hard cases, then, where they pass, against the stored images. Throws InputError where
// a mutant's text is not in its file exactly once.
std::vector<MutantResult> RunMutants(Context& context, const MutantOptions& options);

}  // namespace arealab
