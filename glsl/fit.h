// Fits, writes, reads and measures the tables that the LTC techniques look up: `arealab fit`.
//
// All LTC tables are size × size RGBA float images. Column i is the artist's roughness i/(size − 1), linear,
// with alpha = max(roughness², 1e-4); row j (row 0 is the file's first scan line and, uploaded in that order,
// texture coordinate v = 0) is the view angle at x = j/(size − 1). Texel centres are the nodes: a position x
// in [0, 1] is looked up at (x·(size − 1) + ½)/size. The local frame is T1 = the view direction's unit
// projection on the surface, T2 = N × T1, N.
//
// The column of roughness 0 is fitted as any other, at alpha = 1e-4: m' is diag(c, 1, 2 alpha c) there to
// 2e-4.
//
// ltc_BRDF_FIT_LOBES_HORIZON_FRAME_NORM_AXIS.exr, BRDF a scene's choice, M⁻¹ = [[m0, 0, m2], [0, 1, 0], [m1, 0, m3]] (rows), from
// local directions to cosine space. What was fitted, once each (the stem that `arealab fit --table` takes):
//   polygon_one_lobe (ltc_ggx_polygon)    ours, on polygons
//   polygon_cosine_lobe (ltc_ggx_cosine)  the same beside a signed share of the plain cosine lobe
//   polygon_two_lobe (ltc_ggx_two)        two lobes with matrices of their own, the second's table below the first's
//   polygon_one_true (ltc_ggx_horizon)    the same as the first for a shader that clips at the surface's horizon too
//   l3_one_lobe (ltc_ggx_l3)              the published kind [Heitz et al. 2016]
// for ggx; the other BRDFs have the first and the last, under BRDF = disney_diffuse Disney's diffuse one too.
// and how the lobes are stored, which moves what lies between the nodes:
//   frame: mirror, m' of M⁻¹·R with m0' = m0 c + m2 s, m1' = m1 c + m3 s, m2' = m2 c − m0 s, m3' = m3 c − m1
//   s, c = cos θ
//     and s = sin θ of the node; after the look-up, with the pixel's own: m0 = m0' c − m2' s, m1 = m1' c −
//     m3' s, m2 = m2' c + m0' s, m3 = m3' c + m1' s. normal: m0 … m3 themselves.
//   norm: middle, as above. none, five terms: m · L, and L in the other table's A; with this scale M e_z, the
//   lobe's
//     axis, is a unit vector, as in the published fit. last, m0/m3, m1/m3, m2/m3, 1/m3.
//   axis: sqrt, x = √((1 − cos θ)/(1 − cos 89°)) clamped to 1, for l3 x = √(1 − cos θ) with its last row at θ
//   = 1.57.
//     cos, x = 1 − cos θ. theta, x = 2θ/π.
//   A lobe is fitted once, in its own storage (mirror, middle, sqrt; l3 and diffuse ones, which stay about the normal: normal, middle,
//   sqrt), and read from there.
// ltc_ggx_FIT_LOBES_HORIZON_AXIS_terms.exr: R, G, B, A = magnitude, Schlick term, cosine weight, L, so that
//     specular = (LTC + B · E) · (F0 · (R − G) + G) · radiance,
//   LTC the transformed polygon's form factor (clipped at z = 0 after M⁻¹) and E the polygon's own (clipped
//   at the true horizon; the diffuse integral), or of two lobes the second's. With b the LTC's share below the true horizon, b = ½(1 −
//   m0/√(m0² + m1²)): ours, R = albedo/(1 − b + B) and G = ∫ρ(1 − v·h)⁵/(1 − b + B): with F = 1 and a light
//   that covers the whole sky the result is the albedo; B = 0 but in the cosine table and, at most 1, in that of two lobes. There R = albedo (1 − s)/(1 − b),
//   B = s/(1 − s) and, in place of L, A = the second's Schlick term, s and b of the two together: specular = LTC · (F0 · (R − G) + G) +
//   E · (F0 · (R B − A) + A). l3, R = albedo, G =
//   ∫ρ(1 − v·h)⁵, B = 0.
// sphere.exr, one channel [Snyder 1996; Hill & Heitz 2016]: column i is y = 2i/(size − 1) − 1, the cosine of
// the angle
//   between normal and the sphere's centre; row j is l = |F| = sin²σ = j/(size − 1), σ the sphere's half
//   angle. The value is the form factor of the sphere's part above the horizon over sin²σ (in its limit
//   max(y, 0) for l = 0). The clipped form factor of a polygon with vector form factor F is about |F| ·
//   table(F.z/|F|, |F|).
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace arealab {

enum class FitKind { kPolygon, kCosine, kHorizon, kPublished, kTwo };

enum class LtcFrame { kMirror, kNormal };
enum class LtcNorm { kMiddle, kNone, kLast };
enum class LtcAxis { kSqrt, kCos, kTheta };
struct LtcStorage {
  LtcFrame frame = LtcFrame::kMirror;
  LtcNorm norm = LtcNorm::kMiddle;
  LtcAxis axis = LtcAxis::kSqrt;
  bool operator==(const LtcStorage&) const = default;
};
LtcStorage OwnStorage(Brdf brdf, FitKind kind);
// All that are written, its own first.
std::vector<LtcStorage> StoragesOf(Brdf brdf, FitKind kind);

struct LtcTables {
  Brdf brdf = Brdf::kGgx;
  FitKind kind = FitKind::kPolygon;
  LtcStorage storage;
  int size = 0;
  std::vector<glm::vec4> matrix;  // row-major, [row · size + column]; of two lobes the second's after the first's
  std::vector<glm::vec4> terms;
};

// What a shader gets from the two bilinear look-ups, unrotated: M⁻¹ in the local frame and the terms'
// channels.
struct LtcLookup {
  glm::dvec4 m;
  glm::dvec4 terms;
  glm::dvec4 second{1.0, 0.0, 0.0, 1.0};  // M⁻¹ of the lobe that terms.z weighs: the cosine's, or the second's
};
LtcLookup Look(const LtcTables& tables, double roughness, double n_dot_v);

// What a node holds, and its first M⁻¹.
LtcLookup NodeLookup(const LtcTables& tables, int row, int column);
glm::dvec4 NodeMatrix(const LtcTables& tables, int row, int column);

// The same lobes in another storage: at its nodes what Look finds.
LtcTables Restored(const LtcTables& tables, const LtcStorage& storage);

struct FitOptions {
  int size = 64;                    // nodes per axis, at least 2
  int rectangles = 400;             // of the polygon loss, per cell
  std::vector<std::string> tables;  // stems among TableNames(); empty: all
};

// All that have tables: a scene's choices but Lambert, who needs none.
constexpr Brdf kFittedBrdfs[] = {Brdf::kGgx, Brdf::kGgxSeparable, Brdf::kBeckmann, Brdf::kBlinnPhong, Brdf::kWard, Brdf::kPhong, Brdf::kDisney};

// What is fitted for each BRDF, once each.
std::vector<FitKind> KindsOf(Brdf brdf);

// "ltc_ggx_polygon", "ltc_ward_l3", "ltc_disney_diffuse_polygon": as `arealab fit --table` takes it.
std::string TableName(Brdf brdf, FitKind kind);

// All of them, and "sphere".
std::vector<std::string> TableNames();

// Fits one kind on all cores; the same numbers on any number of threads. `progress` (may be empty) gets the
// fraction done, one call at a time.
LtcTables FitLtc(Brdf brdf, FitKind kind, const FitOptions& options,
                 const std::function<void(double)>& progress = {});

// The nodes of `columns` alone, as FitLtc finds them (a view-angle chain per column): what the tests refit.
LtcTables FitLtcColumns(Brdf brdf, FitKind kind, const FitOptions& options, const std::vector<int>& columns);

// Row-major [row · size + column], as in sphere.exr.
std::vector<float> FitSphere(int size);

// Form factor of the part above the horizon of a sphere with sin²σ = l, its centre at elevation cosine y
// [Snyder 1996].
double ClippedSphere(double y, double l);

// Writes the tables' files, each lobe in all its storages, into `folder`, each complete or not at all, the
// same bytes for the same numbers. Throws InputError for an unknown table name or where the folder cannot be
// written.
void FitTables(const std::filesystem::path& folder, const FitOptions& options,
               const std::function<void(double)>& progress = {});

// Form factor of a quadrilateral (corners in order, either way round) after M⁻¹ = m, clipped exactly at z = 0
// of the lobe's space: the LTC of the docstring above. The identity (1, 0, 0, 1) gives the quadrilateral's
// own clipped form factor.
double LtcQuadIntegral(const glm::dvec4& m, const std::array<glm::dvec3, 4>& corners);

// ∫ρ over a quadrilateral, ρ = BRDF × n·l with Fresnel 1, in the local frame: the reference of
// MeasureFit.
double LobeQuadIntegral(double roughness, double n_dot_v, const std::array<glm::dvec3, 4>& corners,
                        int nodes = 96, Brdf brdf = Brdf::kGgx);

// How far a shader's integral with these tables (bilinear look-up, exact clip) is from the lobe's, over
// random rectangles.
struct MeasureOptions {
  int rectangles = 2000;
  int nodes = 128;                     // per axis and side of the reference's quadrature
  unsigned long long seed = 20261122;  // of the rectangles; another than the fit's
};

struct FitQuality {
  MeasureOptions options;
  std::vector<double> roughness;  // of `relative_rmse`'s rows
  std::vector<double> degrees;    // view angle of its columns
  // sqrt(Σ(a−b)²/Σb²) and Σ(a−b)/Σb over the rectangles, row-major [roughness][angle].
  std::vector<double> relative_rmse, bias;
  std::vector<double> by_roughness;  // root mean square over the angles
  double all = 0.0;                  // root mean square over roughness and angle
  // Relative RMSE at low roughness and grazing views (roughness 0.05–0.2, 60°–88°): root mean square and
  // largest of the points.
  double grazing = 0.0, grazing_max = 0.0;
  // The LTC's share below the true horizon, over all nodes of the table.
  double leak_mean = 0.0, leak_max = 0.0;
};

// References by quadrature that knows nothing of the tables. Same numbers on any number of threads.
FitQuality MeasureFit(const LtcTables& tables, const MeasureOptions& options = {},
                      const std::function<void(double)>& progress = {});

// The same as a Markdown table, in per cent, with the seed.
std::string QualityTable(const FitQuality& quality);

// The same over a finer grid, and what a lobe's picture shows: row-major [roughness][angle], none of them a node.
struct FitMap {
  std::string table;  // "ltc_ggx_polygon"
  std::string brdf;   // a scene's choice
  MeasureOptions options;
  std::vector<double> roughness, degrees;
  std::vector<double> polygon;  // relative RMSE over the rectangles
  std::vector<double> lobe;     // ∫|ρ − magnitude · LTC| over ∫ρ, above the surface's horizon
  std::vector<double> below;    // the LTC's share below it, which `horizon` tables never let reach the picture
};
FitMap MapFit(const LtcTables& tables, const MeasureOptions& options = {},
              const std::function<void(double)>& progress = {});
// One cell: polygon, lobe, below.
std::array<double, 3> MeasureFitAt(const LtcTables& tables, double roughness, double degrees, const MeasureOptions& options);

// The files' names, without the folder.
std::string MatrixFile(Brdf brdf, FitKind kind, const LtcStorage& storage);
std::string TermsFile(Brdf brdf, FitKind kind, LtcAxis axis);

// Reads both. Throws InputError.
LtcTables ReadLtcTables(const std::filesystem::path& folder, Brdf brdf, FitKind kind, const LtcStorage& storage);
LtcTables ReadLtcTables(const std::filesystem::path& folder, Brdf brdf, FitKind kind);  // in its own storage

}  // namespace arealab
