// The stored tables of the BRDFs beside the default: what the program makes, as good as the README says.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "glsl/fit.h"

namespace arealab::fit_brdfs_test {
namespace {

class FitOf : public testing::TestWithParam<std::pair<Brdf, FitKind>> {
 protected:
  LtcTables Stored() const {
    return ReadLtcTables(AREALAB_SOURCE_DIR "/glsl/tables", GetParam().first, GetParam().second);
  }
};

// One column: fit_test.cpp has more of ggx, and the same program.
TEST_P(FitOf, RefittedColumnsAreTheStoredOnes) {
  constexpr int kColumn = 27;
  const LtcTables stored = Stored(),
                  again = FitLtcColumns(GetParam().first, GetParam().second, {}, {kColumn});
  for (int row = 0; row < 64; ++row) {
    const auto texel = static_cast<std::size_t>(row * 64 + kColumn);
    for (int term = 0; term < 4; ++term) {
      // As in fit_test.cpp: the optimum's flat valley, and another libm.
      EXPECT_NEAR(again.matrix[texel][term], stored.matrix[texel][term], 1e-3) << row << " " << term;
      EXPECT_NEAR(again.terms[texel][term], stored.terms[texel][term], 1e-3) << row << " " << term;
    }
  }
}

// Two-sided bands about what `arealab fit --quality glsl/tables` gives, in the README: 0.019 to 0.045 on
// polygons, 0.058 to 0.091 as published.
TEST_P(FitOf, QualityIsInItsBand) {
  MeasureOptions options;
  options.rectangles = 300;
  options.nodes = 48;
  const FitQuality quality = MeasureFit(Stored(), options);
  RecordProperty("quality", QualityTable(quality));
  const auto [brdf, kind] = GetParam();
  const bool published = kind == FitKind::kPublished;
  EXPECT_GT(quality.all, published ? 0.045 : brdf == Brdf::kGgxSeparable ? 0.013 : 0.025);
  EXPECT_LT(quality.all, published ? 0.11 : brdf == Brdf::kGgxSeparable ? 0.025 : 0.055);
}

// Straight on: all of Phong's lobe, and none of any is lost in the table's corner.
TEST_P(FitOf, MagnitudeStraightOnIsTheAlbedo) {
  const LtcTables stored = Stored();
  if (GetParam().first == Brdf::kBlinnPhong) {
    // (n + 8)(n + 2^(−n/2))/((n + 2)(n + 4)) at alpha = (32/63)².
    const double alpha = 32.0 * 32.0 / (63.0 * 63.0), n = 2.0 / (alpha * alpha) - 2.0;
    EXPECT_NEAR(stored.terms[32].x, (n + 8.0) * (n + std::exp2(-0.5 * n)) / ((n + 2.0) * (n + 4.0)), 1e-4);
  } else if (GetParam().first == Brdf::kPhong) {
    EXPECT_NEAR(stored.terms[32].x, 1.0, 1e-4);
  } else {
    EXPECT_LT(stored.terms[32].x, 1.0 + 1e-4);
    EXPECT_GT(stored.terms[32].x, 0.9);
  }
}

std::vector<std::pair<Brdf, FitKind>> Fits() {
  std::vector<std::pair<Brdf, FitKind>> fits;
  for (const Brdf brdf : kBrdfs) {
    if (brdf == Brdf::kGgx) continue;
    for (const FitKind kind : KindsOf(brdf)) fits.emplace_back(brdf, kind);
  }
  return fits;
}
INSTANTIATE_TEST_SUITE_P(Brdfs, FitOf, testing::ValuesIn(Fits()), [](const auto& fit) {
  return std::string(Name(fit.param.first)) + (fit.param.second == FitKind::kPublished ? "_l3" : "_polygon");
});

}  // namespace
}  // namespace arealab::fit_brdfs_test
