#include "glsl/fitted_lobe.h"

#include <algorithm>
#include <vector>

#include "glsl/fit.h"
#include "glsl/fit_cell.h"
#include "glsl/table.h"
#include "scenes/error.h"

namespace arealab {

double FittedLobe::Density(const glm::dvec3& direction) const {
  const auto density = [&](const glm::dvec4& n) { return fit::LtcDensity({n.x, n.y, n.z, n.w}, direction, 1.0, nullptr); };
  return magnitude * (density(m) + other * density(second));
}

std::optional<FittedLobe> FindFittedLobe(const ShaderLibrary& library, const Variant& variant, Brdf brdf, double roughness,
                                         double n_dot_v) {
  std::vector<std::string> files;
  for (const Table& table : variant.technique->tables) files.push_back(TableFile(variant, table, brdf));
  const auto reads = [&](const std::string& name) { return std::ranges::find(files, "tables/" + name) != files.end(); };
  const auto decoded = [&](const std::string& name) {
    const auto bytes = library.Find("tables/" + name);
    if (!bytes) throw InputError(library.DisplayPath("tables/" + name) + ": no such table; expected one that `arealab fit` writes");
    return DecodeTable(*bytes, library.DisplayPath("tables/" + name));
  };
  for (const FitKind kind : KindsOf(brdf)) {
    for (const LtcStorage& storage : StoragesOf(brdf, kind)) {
      const std::string matrix = MatrixFile(brdf, kind, storage);
      if (!reads(matrix)) continue;
      TableTexels texels = decoded(matrix);
      const LtcTables tables{brdf, kind, storage, texels.size.x, std::move(texels.texels), decoded(TermsFile(brdf, kind, storage.axis)).texels};
      const LtcLookup look = Look(tables, roughness, n_dot_v);
      return FittedLobe{look.m, look.terms.x, look.terms.z, look.second};
    }
  }
  return std::nullopt;
}

}  // namespace arealab
