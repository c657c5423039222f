// Hard cases through a variant, in float and as the same text in double: is it finite, is it not negative,
// how much does rounding move it, and how far is it from its own mathematics.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compare/context.h"
#include "compare/point_shader.h"
#include "compare/stress_families.h"
#include "glsl/shader_library.h"
#include "glsl/variant.h"

namespace arealab {

// The most that a light of its size and distance gives at the point, however surface and light were turned:
// its radiance times F, respectively min(1, F / (4 α² n·v)). F = A/(A + πd²) is the form factor of a disk of
// the light's area A that faces, at the distance d of the light's nearest point; of a sphere R²/D², D its
// centre's distance, and 1 inside. The second is GGX's peak, D(0)/(4 n·v) with D(0) = 1/(πα²), times πF sr,
// as if the light stood where the highlight is; no lobe returns more than the light's radiance. Errors are
// relative to this or the value, whichever is larger: a hundred- thousandth of what the light would give if
// it were turned is black beside its other pixels, and may have any digits.
struct MaximalContribution {
  double diffuse = 0.0, specular = 0.0;
};
MaximalContribution MaximalContributionOf(const PointCase& c);

// What is allowed: of |float − double| over the larger of |double| and the maximal contribution, at worst and
// at 99.9 % of the cases; of the backward error, in ulps. A float result that is as good as its inputs has a
// backward error of about 1.
struct StressBounds {
  double worst = 1e-3, p999 = 2e-5, backward = 8.0;
  double approximation = 1e-3;  // of |double − ideal form in double|, relative alike, at worst
};

// A looser bound, and the cause that was measured. `shape`: of one shape alone.
struct StressAllowance {
  const char* technique;
  const char* family;  // or "*"
  StressBounds bounds;
  const char* cause;
};

// Of a picture about the worst case: kPatch × kPatch points of its surface's plane, the case in the middle,
// half as far to each side as the light is.
constexpr int kPatch = 48;

struct FamilyResult {
  const StressFamily* family = nullptr;
  std::int64_t cases = 0, nonfinite = 0, negative = 0;
  // Not finite where min, max and clamp pass a NaN on, as GLSL leaves them to; over the first kIdealCases of
  // each shape.
  std::int64_t hidden = 0;
  double p999 = 0.0, worst = 0.0;  // rounding error, relative as above
  // Over the cases whose rounding error is above the bound of `worst` (the worst kMostProbed of each shape):
  // what is above it over what one ulp of every input does. Inputs are moved 48 times, each component of a
  // vector by −1 or 1, then by −8 or 8 ulps of the vector's largest (a step is not seen by going one); of
  // what the double form does then, per ulp, the most is taken.
  double backward = 0.0;
  std::int64_t probed = 0;
  // |double − ideal form in double|, relative as above, at worst and its case; over the first kIdealCases
  double approximation = 0.0;
  PointCase approximation_case;
  double half_tables =
      0.0;  // of float with tables of half floats against float, at 99.9 %; over the same cases
  // The same text in half floats, inputs too, against float on these inputs; of the same cases those that half floats hold.
  // Not judged: which technique bears it, and by how much.
  std::int64_t fp16_cases = 0, fp16_nonfinite = 0;
  double fp16_median = 0.0, fp16_p999 = 0.0;  // of the finite ones
  PointCase
      worst_case;  // the first that is not finite, else the first negative one, else that of the worst error
  // Around the worst case, where asked for or something fails: both lobes over the radiance, in float and in double; rounding error.
  std::vector<float> patch_value, patch_double, patch_error;
  StressBounds bounds;
  std::string cause;                  // why they are looser than the general ones; empty where they are not
  std::vector<std::string> failures;  // one line each: what is exceeded

  std::vector<std::string> Judge() const;
};

// A lobe along a path of kPathPoints cases, in float against the ideal form in double. Relative to the
// ideal's value there, at least a thousandth of its greatest on the path.
constexpr int kPathPoints = 2048;
struct PathResult {
  const StressPath* path = nullptr;
  LightShape shape = LightShape::kRectangle;
  const char* lobe = "diffuse";
  // By how much more than the ideal's the value steps from one point to the next, at most.
  double step = 0.0;
  // Banding, ringing: the second difference over 1/128 of the path, less the ideal's, at most. What an eye
  // sees as a band is a change of slope.
  double bend = 0.0;
  std::vector<float> value, ideal;
  std::vector<std::string> failures;
};

// What is allowed of both. A step is rounding; a bend is what the variant's shortcuts do.
constexpr double kMostStep = 5e-3, kMostBend = 1e-2;

struct VariantStress {
  std::string name;    // short
  std::string ideal;   // the ideal form's name; empty where the technique has none
  bool judged = true;  // counts for the exit status
  double seconds = 0.0;
  std::vector<FamilyResult> families;
  std::vector<PathResult> paths;

  std::int64_t cases() const;
  // Of all families together, what half floats' arithmetic makes not finite.
  std::int64_t fp16_cases() const, fp16_nonfinite() const;
};

struct StressOptions {
  std::vector<Variant> variants;
  std::vector<bool> judged;     // parallel; published forms are shown, and may fail
  std::int64_t cases = 240000;  // of a variant, over all families and shapes
  std::uint64_t seed = 1;
  std::optional<LightShape> shape;  // one alone
  Brdfs brdfs = {};
  bool pictures = false;            // fill the patches where nothing fails too
  bool fp16 = false;                // fill what is of half floats' arithmetic: a program more
  std::function<void(const std::string&, double)> progress;
};

struct StressResult {
  std::string renderer;
  std::int64_t cases = 0;
  std::uint64_t seed = 0;
  std::vector<VariantStress> variants;

  int failures() const;  // of judged variants
};

StressResult Stress(Context& context, const ShaderLibrary& library, const StressOptions& options);

// One case through a variant.
struct CaseValues {
  std::string variant;
  Shaded in_float, in_double, ideal;
  double rounding = 0.0, backward = 0.0;
};
std::vector<CaseValues> ShadeCase(Context& context, const ShaderLibrary& library,
                                  const std::vector<Variant>& variants, const PointCase& c, Brdfs brdfs = {});

}  // namespace arealab
