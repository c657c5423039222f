#include "compare/timing.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include <algorithm>
#include <ctime>
#include <random>

#include "scenes/error.h"

namespace arealab {
namespace {

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double CpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// A timer query around a draw sees a CPU rasteriser's last tile only, hence the two clocks.
class DrawClock {
 public:
  explicit DrawClock(const Context& context) : gl_(context.gl()), software_(context.software()) {
    if (!software_) gl_.GenQueries(1, &query_);
  }
  ~DrawClock() {
    if (!software_) gl_.DeleteQueries(1, &query_);
  }
  DrawClock(const DrawClock&) = delete;
  DrawClock& operator=(const DrawClock&) = delete;

  double Seconds(const std::function<void()>& draw) const {
    if (software_) {
      const double start = CpuSeconds();
      draw();
      return CpuSeconds() - start;
    }
    gl_.Finish();
    gl_.BeginQuery(GL_TIME_ELAPSED, query_);
    draw();
    gl_.EndQuery(GL_TIME_ELAPSED);
    GLuint64 nanoseconds = 0;
    gl_.GetQueryObjectui64v(query_, GL_QUERY_RESULT, &nanoseconds);
    return 1e-9 * static_cast<double>(nanoseconds);
  }

 private:
  const GladGLContext& gl_;
  bool software_;
  GLuint query_ = 0;
};

void CheckClock(const DrawClock& clock, Renderer& renderer, const Variant& point) {
  constexpr int kTries = 9;
  constexpr double kTolerance = 1.25;
  std::vector<double> ratios;
  for (int i = 0; i < kTries; ++i) {
    const double once = clock.Seconds([&] { renderer.Draw(point); });
    const double twice = clock.Seconds([&] {
      renderer.Draw(point);
      renderer.Draw(point);
    });
    ratios.push_back(twice / once);
  }
  const double ratio = Median(ratios);
  if (ratio < 2.0 / kTolerance || ratio > 2.0 * kTolerance) {
    throw InputError(fmt::format("the clock shows a draw repeated twice as {:.2f} times one draw; expected 2: times are refused",
                                 ratio));
  }
}

}  // namespace

Interval BootstrapMedian(const std::vector<double>& values) {
  constexpr int kResamples = 1000;
  constexpr unsigned kSeed = 1;
  std::mt19937 random(kSeed);
  std::vector<double> medians, sample(values.size());
  for (int r = 0; r < kResamples; ++r) {
    for (double& value : sample) value = values[random() % values.size()];
    medians.push_back(Median(sample));
  }
  std::sort(medians.begin(), medians.end());
  return {Median(values), medians[kResamples / 40], medians[kResamples - 1 - kResamples / 40]};
}

std::vector<Timing> MeasureTimes(const Context& context, Renderer& renderer, const std::vector<Variant>& variants,
                                 const Variant& point, int shaded_pixels, const TimingOptions& options) {
  const DrawClock clock(context);
  renderer.Draw(point);  // a first draw compiles
  for (const Variant& variant : variants) renderer.Draw(variant);
  CheckClock(clock, renderer, point);

  std::vector<std::vector<double>> seconds(variants.size()), ratios(variants.size());
  double spent = 0.0;
  int rounds = 0;
  bool settled = false;
  while (!settled && rounds < options.max_rounds && (rounds < options.min_rounds || spent < options.seconds)) {
    const double reference = clock.Seconds([&] { renderer.Draw(point); });
    spent += reference;
    for (std::size_t v = 0; v < variants.size(); ++v) {
      const double time = clock.Seconds([&] { renderer.Draw(variants[v]); });
      spent += time;
      seconds[v].push_back(time);
      ratios[v].push_back(time / reference);
    }
    ++rounds;
    if (options.progress) options.progress(static_cast<double>(rounds) / options.max_rounds);
    settled = rounds >= options.min_rounds && std::all_of(ratios.begin(), ratios.end(), [&](const auto& values) {
                const Interval interval = BootstrapMedian(values);
                return interval.high - interval.low <= 2.0 * options.target * interval.median;
              });
  }

  std::vector<Timing> timings(variants.size());
  for (std::size_t v = 0; v < variants.size(); ++v) {
    const Interval ratio = BootstrapMedian(ratios[v]);
    timings[v] = {1e9 * Median(seconds[v]) / std::max(shaded_pixels, 1), ratio.median, ratio.low, ratio.high, rounds};
  }
  return timings;
}

}  // namespace arealab
