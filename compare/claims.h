// What the sources say, checked: each claim of a source's text as a sentence of ours, our figure, computed, and whether it holds.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "compare/context.h"
#include "compare/cost.h"
#include "compare/point_shader.h"
#include "compare/results.h"
#include "glsl/shader_library.h"
#include "glsl/technique.h"

namespace arealab {

enum class Verdict { kHolds, kPartly, kFails, kUnknown };

struct ClaimFigure {
  std::string name;
  double value = 0.0;
  std::string unit;  // "%", "ms", …; a share is given in percent
};

struct ClaimCurve {
  std::string name;
  std::vector<std::pair<double, double>> points;
};

struct ClaimPlot {  // no curves: none
  std::string x, y;  // titles with units
  std::vector<ClaimCurve> curves;
};

struct Finding {
  Verdict verdict = Verdict::kUnknown;
  std::vector<ClaimFigure> figures;
  ClaimPlot plot = {};
  std::string note = {};  // what else must be said
};

// What claims are computed with: the shader text of the library, on the GL.
class ClaimBench {
 public:
  // `cost` may be null: what needs it is then not measured. All outlive the bench.
  ClaimBench(Context& context, const ShaderLibrary& library, const CostMeter* cost);

  // Of the cases as `variant` shades them; in double where asked for.
  std::vector<Shaded> Shade(const std::string& variant, const std::vector<PointCase>& cases,
                            Precision precision = Precision::kFloat, Brdfs brdfs = {});
  bool has_cost() const { return cost_ != nullptr; }
  // On bonaire, a light of this shape, diffuse, specular and Fresnel; only where has_cost().
  GpuCost Cost(const std::string& variant, const std::string& shape = "rectangle") const;

 private:
  const ShaderLibrary& library_;
  std::vector<Technique> techniques_;
  PointShader shader_;
  const CostMeter* cost_;
};

struct Claim {
  std::string where;     // section or equation
  std::string sentence;  // what the text says, in our words
  std::string holds;     // when we say that it holds
  std::string command;   // shows the same by itself
  std::function<Finding(ClaimBench&)> compute;  // called only where what it needs is there
  bool needs_cost = false;                      // the compilers of `arealab cost`
};

struct ClaimSource {
  std::string name;      // "hill": what --source takes
  std::string citation;  // "Hill & Heitz 2016"
  std::string title;
  std::vector<Claim> claims;
};

// One file each in compare/claims/.
ClaimSource HillClaims();
ClaimSource DrobotClaims();
ClaimSource MayauxClaims();
ClaimSource LightFieldClaims();
ClaimSource OatClaims();

// In the order of the texts. A name chooses one; an unknown one throws InputError that lists them.
std::vector<ClaimSource> ClaimSources(const std::string& name = "");

// Whether the technique's header cites the source: an entry of `citation`, which are parted by "; ", begins with it.
bool IsFrom(const Technique& technique, const ClaimSource& source);

struct CheckedClaim {
  Claim claim;
  Finding finding;
};
std::vector<CheckedClaim> CheckClaims(const ClaimSource& source, ClaimBench& bench);

// The figures and the verdict, as lines of text.
std::string FindingText(const Finding& finding);
std::string VerdictText(Verdict verdict);

// The page of one source, as yet without links.
ClaimsPage MakeClaimsPage(const ClaimSource& source, const std::vector<CheckedClaim>& checked);

// Lets each page lead to the others and, where one is named, to the report.
void LinkClaimsPages(std::vector<ClaimsPage>& pages, const std::string& report = "");

// The sources' pages as yet without links, from the folder where this program left them before, else computed and
// stored. `bench` is called once at
// most, and only where a page is missing; its shader text is the program's own, its context and compilers are those of `platform`,
// any text that tells them from others.
std::vector<ClaimsPage> CachedClaimsPages(const std::vector<ClaimSource>& sources, const std::string& platform,
                                          const std::filesystem::path& cache, const std::function<std::unique_ptr<ClaimBench>()>& bench);

// Small tools for the files of claims.
std::vector<double> Steps(double first, double last, int count);  // evenly spaced, both ends
// Of y: the largest |second difference| over the largest |y|: what is seen as a kink.
double LargestKink(const std::vector<double>& y);
double Percentile(std::vector<double> values, double share);

}  // namespace arealab
