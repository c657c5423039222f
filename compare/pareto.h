// Accuracy against cost as a static picture, for slides and papers; the report's page draws the same interactively.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "compare/results.h"

namespace arealab {

struct ParetoMark {
  std::string name;              // short: "ltc@published"
  double cost = kNotMeasured;    // positive
  double error = kNotMeasured;   // relative RMSE, positive
  Estimate interval;             // of the cost, where measured
};

struct ParetoPlot {
  std::string title, cost_title;
  std::vector<ParetoMark> marks;
};

// The marks that no other beats in both, from the cheapest on.
std::vector<std::size_t> Frontier(const std::vector<ParetoMark>& marks);

// Total relative RMSE over the measured time's ratio to `point`, or over core cycles on the first GPU where nothing was timed;
// of several scenes geometric means over those that all shown variants shade, without variants that shade fewer than half.
// What is within truth's error stands at it. No marks where no cost is known.
ParetoPlot MakeParetoPlot(std::span<const SceneResult> scenes, bool software);

// An SVG of 900 × 560 units, both axes logarithmic: dominated marks grey, the published form hollow and tied to ours.
std::string ParetoSvg(const ParetoPlot& plot);

}  // namespace arealab
