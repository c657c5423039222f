// What shading costs: the lighting pass of each variant against `point`, in interleaved rounds on one clock.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "compare/context.h"
#include "compare/results.h"
#include "glsl/renderer.h"

namespace arealab {

struct TimingOptions {
  double target = 0.02;    // half width of the ratio's 95 % interval over the ratio, at which rounds end
  int min_rounds = 7;      // fewer give no interval worth printing
  int max_rounds = 60;
  double seconds = 20.0;   // of the clock, over all variants; then rounds end too
  std::function<void(double)> progress;  // fraction of max_rounds; may be empty
};

// One Timing per variant, of the scene that `renderer` drew last. `point` is the variant that ratios refer to;
// lit_pixels is what times are divided by. A round draws a pass that only reads the G-buffer and writes it through,
// `point` and every variant, in an order that a fixed seed shuffles. The clock is process CPU time where a CPU draws, else a timer query.
// Throws InputError where the clock does not show a draw repeated twice as twice as long (within a factor of 1.25).
std::vector<Timing> MeasureTimes(const Context& context, Renderer& renderer, const std::vector<Variant>& variants,
                                 const Variant& point, int lit_pixels, const TimingOptions& options = {});

// From one list per round: seconds of the pass-through, of `point` and of each variant.
std::vector<Timing> TimingsOfRounds(const std::vector<std::vector<double>>& rounds, int lit_pixels);

// Median and its 95 % bootstrap interval, 1000 resamples from a fixed seed.
Estimate BootstrapMedian(const std::vector<double>& values);

}  // namespace arealab
