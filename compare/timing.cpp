#include "compare/timing.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numeric>
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

// A wrong clock is wrong for long draws too; short ones a busy machine may stretch.
void CheckClock(const DrawClock& clock, Renderer& renderer, const Variant& point) {
  constexpr int kTries = 9;
  constexpr double kTolerance = 1.25;
  const auto seconds = [&](int draws) {
    return clock.Seconds([&] {
      for (int i = 0; i < draws; ++i) renderer.Draw(point);
    });
  };
  int draws = 1;
  double ratio = 0.0;
  for (const double span : {4e-3, 16e-3, 64e-3}) {  // s: of less, waking the rasteriser's threads is no small part
    while (draws < 1024 && seconds(draws) < span) draws *= 2;
    std::vector<double> ratios;
    for (int i = 0; i < kTries; ++i) {
      const double once = seconds(draws);
      ratios.push_back(seconds(2 * draws) / once);
    }
    ratio = Median(ratios);
    if (ratio > 2.0 / kTolerance && ratio < 2.0 * kTolerance) return;
  }
  throw InputError(fmt::format("the clock shows a draw repeated twice as {:.2f} times one draw; expected 2: times are refused", ratio));
}

}  // namespace

Estimate BootstrapMedian(const std::vector<double>& values) {
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

std::vector<Timing> TimingsOfRounds(const std::vector<std::vector<double>>& rounds, int lit_pixels) {
  const double ns = 1e9 / std::max(lit_pixels, 1);
  const auto over_rounds = [&](const auto& figure) {
    std::vector<double> values;
    for (const std::vector<double>& round : rounds) values.push_back(figure(round));
    return values;
  };
  const std::vector<double> net_point = over_rounds([](const auto& round) { return round[1] - round[0]; });
  const double typical = Median(net_point);
  std::vector<double> off;
  for (const double net : net_point) off.push_back(std::abs(net - typical));
  constexpr double kDeviation = 1.4826;  // of a normal distribution's median absolute deviation
  const double spread = kDeviation * Median(off);
  std::string refusal;
  if (!(typical > 3.0 * spread)) {
    refusal = fmt::format("point's net time, {:.2f} ns, is within 3 times its spread of {:.2f} ns", ns * typical, ns * spread);
  }
  std::vector<Timing> timings;
  for (std::size_t v = 2; v < rounds[0].size(); ++v) {
    Timing timing;
    timing.ns_per_pixel = BootstrapMedian(over_rounds([&](const auto& round) { return ns * round[v]; }));
    timing.ratio_to_point = BootstrapMedian(over_rounds([&](const auto& round) { return round[v] / round[1]; }));
    timing.net_ns_per_pixel = BootstrapMedian(over_rounds([&](const auto& round) { return ns * (round[v] - round[0]); }));
    if (refusal.empty()) {
      timing.net_ratio_to_point =
          BootstrapMedian(over_rounds([&](const auto& round) { return (round[v] - round[0]) / (round[1] - round[0]); }));
    }
    timing.refusal = refusal;
    timing.rounds = static_cast<int>(rounds.size());
    timings.push_back(timing);
  }
  return timings;
}

std::vector<Timing> MeasureTimes(const Context& context, Renderer& renderer, const std::vector<Variant>& variants,
                                 const Variant& point, int lit_pixels, const TimingOptions& options) {
  const DrawClock clock(context);
  renderer.DrawThrough();  // a first draw compiles
  renderer.Draw(point);
  for (const Variant& variant : variants) renderer.Draw(variant);
  CheckClock(clock, renderer, point);

  std::vector<std::vector<double>> rounds;
  const auto settled = [&](std::size_t v) {
    std::vector<double> ratios;
    for (const std::vector<double>& round : rounds) ratios.push_back(round[v] / round[1]);
    const Estimate ratio = BootstrapMedian(ratios);
    return ratio.high - ratio.low <= 2.0 * options.target * ratio.value;
  };
  std::vector<std::size_t> order(2 + variants.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937 random(1);
  double spent = 0.0;
  for (bool known = false; !known && static_cast<int>(rounds.size()) < options.max_rounds;) {
    const bool enough = static_cast<int>(rounds.size()) >= options.min_rounds;
    if (enough && spent >= options.seconds) break;
    std::shuffle(order.begin(), order.end(), random);  // so that none always follows the same one
    std::vector<double>& round = rounds.emplace_back(order.size());
    for (const std::size_t draw : order) {
      round[draw] = clock.Seconds([&] {
        if (draw == 0) renderer.DrawThrough();
        if (draw == 1) renderer.Draw(point);
        if (draw >= 2) renderer.Draw(variants[draw - 2]);
      });
      spent += round[draw];
    }
    if (options.progress) options.progress(static_cast<double>(rounds.size()) / options.max_rounds);
    known = static_cast<int>(rounds.size()) >= options.min_rounds;
    for (std::size_t v = 2; known && v < round.size(); ++v) known = settled(v);
  }
  return TimingsOfRounds(rounds, lit_pixels);
}

}  // namespace arealab
