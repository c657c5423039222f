// The page "hard cases": techniques by families, each cell opening its worst case.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "compare/page_parts.h"
#include "compare/results.h"
#include "compare/stress.h"

namespace arealab {

// Of the surroundings of a family's worst case, kPatch pixels wide: "result", "reference", "difference".
struct HardPicture {
  std::string name, caption;
  std::vector<Rgb> pixels;
};
std::vector<HardPicture> HardPictures(const FamilyResult& family);

// The page, self-contained: pictures and the worst cases' scenes are in it. `report`: the page that it goes back to; empty: none.
std::string StressPage(const StressResult& result, const std::string& report);

// Writes folder/stress.html and each worst case as folder/cases/VARIANT/FAMILY.toml, a scene. Files are replaced in one step. Throws
// InputError where they cannot be written.
void WriteStressPage(const StressResult& result, const std::filesystem::path& folder);

// The page of the variants, from the cache where this program on this context has made it before; a cache that cannot be written to
// costs the storing, not the page.
HardCasesPage CachedStressPage(Context& context, const ShaderLibrary& library, const StressOptions& options, const std::string& report,
                               const std::filesystem::path& cache);

}  // namespace arealab
