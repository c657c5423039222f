// The stored tables of the BRDFs beside the default: what the program makes, as good as the README says.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "glsl/fit.h"
#include "glsl/fit_lobe.h"

namespace arealab::fit_brdfs_test {
namespace {

// ∫ of Disney's BRDF × n·l over the hemisphere, from its polynomial in n·l and v·l: with F90 − 1 = A + r v·l, A = r − ½, the means over
// azimuth of v·l and its square are c z and c² z² + s² (1 − z²)/2, and ∫ zⁿ (1 − z)⁵ dz = n! 5!/(n + 6)!.
double DisneyAlbedo(double c, double r) {
  const double a = r - 0.5, b = std::pow(1.0 - c, 5), s2 = 1.0 - c * c;
  const double once = a / 42.0 + r * c / 168.0, twice = a * a / 42.0 + 2.0 * a * r * c / 168.0 + r * r * (c * c / 504.0 + 0.5 * s2 * (1.0 / 42.0 - 1.0 / 504.0));
  return 2.0 * (0.5 + b * (a / 2.0 + r * c / 3.0) + once + b * twice);
}

// The quadrature that the diffuse table is fitted by.
TEST(FitOfDisney, AlbedoIsTheClosedForm) {
  for (const double roughness : {0.0, 0.3, 0.5, 1.0}) {
    for (const double cosine : {1.0, 0.7, 0.2, 0.01}) {
      const fit::View view = fit::MakeView(Brdf::kDisney, roughness, cosine);
      EXPECT_NEAR(fit::Moments(fit::UpperNodes(view, 24, 24)).albedo, DisneyAlbedo(cosine, roughness), 1e-13);
      EXPECT_NEAR(fit::Moments(fit::UpperNodes(fit::MakeView(Brdf::kLambert, roughness, cosine), 24, 24)).albedo, 1.0, 1e-13);
    }
  }
}

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
// polygons, 0.058 to 0.091 as published; of the diffuse lobe 0.0045 and 0.0084.
TEST_P(FitOf, QualityIsInItsBand) {
  MeasureOptions options;
  options.rectangles = 300;
  options.nodes = 48;
  const FitQuality quality = MeasureFit(Stored(), options);
  RecordProperty("quality", QualityTable(quality));
  const auto [brdf, kind] = GetParam();
  const bool published = kind == FitKind::kPublished;
  if (brdf == Brdf::kDisney) {
    EXPECT_GT(quality.all, published ? 0.007 : 0.0035);
    EXPECT_LT(quality.all, published ? 0.0105 : 0.0055);
    return;
  }
  EXPECT_GT(quality.all, published ? 0.045 : brdf == Brdf::kGgxSeparable ? 0.013 : 0.025);
  EXPECT_LT(quality.all, published ? 0.11 : brdf == Brdf::kGgxSeparable ? 0.025 : 0.055);
}

// What the report shows of the fit is what the stored tables give: three cells of each, two of them where it is worst.
TEST(FitMaps, StoredFiguresAreTheTables) {
  std::ifstream file(AREALAB_SOURCE_DIR "/glsl/tables/quality.json");
  const nlohmann::json maps = nlohmann::json::parse(file);
  std::size_t map = 0;
  for (const Brdf brdf : kFittedBrdfs) {
    for (const FitKind kind : KindsOf(brdf)) {
      ASSERT_LT(map, maps.size());
      const nlohmann::json& stored = maps[map++];
      EXPECT_EQ(stored["table"], TableName(brdf, kind));
      EXPECT_EQ(stored["brdf"], Name(brdf));
      MeasureOptions options;
      EXPECT_EQ(stored["rectangles"], options.rectangles);
      EXPECT_EQ(stored["seed"], options.seed);
      const LtcTables tables = ReadLtcTables(AREALAB_SOURCE_DIR "/glsl/tables", brdf, kind);
      const std::size_t columns = stored["degrees"].size();
      for (const auto& [row, column] : {std::pair<std::size_t, std::size_t>{1, 11}, {6, 9}, {10, 2}}) {
        const auto found = MeasureFitAt(tables, stored["roughness"][row], stored["degrees"][column], options);
        const char* const names[] = {"polygon", "lobe", "below"};
        for (std::size_t k = 0; k < 3; ++k) {
          const double expected = stored[names[k]][row * columns + column];
          EXPECT_NEAR(found[k], expected, 1e-3 * expected + 1e-9) << TableName(brdf, kind) << " " << names[k] << " " << row << " " << column;
        }
      }
    }
  }
  EXPECT_EQ(map, maps.size());
}

// The relative L1 distance against a sum over a fine grid of directions, by the tables' own look-up.
TEST(FitMaps, LobeDistanceByAnotherRule) {
  const LtcTables tables = ReadLtcTables(AREALAB_SOURCE_DIR "/glsl/tables", Brdf::kGgx, FitKind::kPublished);
  constexpr double kRoughness = 0.6, kDegrees = 65.0, kPi = 3.14159265358979323846;
  const fit::View view = fit::MakeView(Brdf::kGgx, kRoughness, std::cos(kDegrees * kPi / 180.0));
  const LtcLookup look = Look(tables, kRoughness, view.cosine);
  const glm::dmat3 inverse = glm::transpose(glm::dmat3(look.m.x, 0.0, look.m.z, 0.0, 1.0, 0.0, look.m.y, 0.0, look.m.w));
  double difference = 0.0, total = 0.0, share_below = 0.0;
  constexpr int kSteps = 1000;
  for (int i = 0; i < kSteps; ++i) {
    const double z = -1.0 + 2.0 * (i + 0.5) / kSteps, s = std::sqrt(1.0 - z * z);
    for (int j = 0; j < kSteps; ++j) {
      const double phi = 2.0 * kPi * (j + 0.5) / kSteps, solid_angle = 4.0 * kPi / (kSteps * kSteps);
      const glm::dvec3 direction(s * std::cos(phi), s * std::sin(phi), z), u = inverse * direction;
      const double length = glm::length(u), lobe = std::max(u.z / length, 0.0) / kPi * glm::determinant(inverse) / (length * length * length);
      if (z < 0.0) {
        share_below += lobe * solid_angle;
        continue;
      }
      const double density = fit::LobeDensity(view, direction);
      difference += std::abs(density - look.terms.x * lobe) * solid_angle;
      total += density * solid_angle;
    }
  }
  MeasureOptions options;
  options.rectangles = 1;
  const auto found = MeasureFitAt(tables, kRoughness, kDegrees, options);
  EXPECT_GT(found[1], 0.05);
  EXPECT_NEAR(found[1], difference / total, 1e-3);
  EXPECT_NEAR(found[2], share_below, 1e-4);
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
  } else if (GetParam().first == Brdf::kDisney) {
    EXPECT_NEAR(stored.terms[32].x, DisneyAlbedo(1.0, 32.0 / 63.0), 1e-4);
  } else {
    EXPECT_LT(stored.terms[32].x, 1.0 + 1e-4);
    EXPECT_GT(stored.terms[32].x, 0.9);
  }
}

std::vector<std::pair<Brdf, FitKind>> Fits() {
  std::vector<std::pair<Brdf, FitKind>> fits;
  for (const Brdf brdf : kFittedBrdfs) {
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
