#include "app/view/worker.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <ranges>
#include <utility>

#include "app/view/background.h"
#include "app/view/truth_picture.h"
#include "compare/harness.h"
#include "compare/timing.h"
#include "glsl/renderer.h"
#include "glsl/variant.h"

namespace arealab {
namespace {

using Clock = std::chrono::steady_clock;

double Since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// While things move a picture may take this long: with the window's own share it stays below 100 ms from input to light.
constexpr double kMovingSeconds = 0.030;
// A strip of a full picture: the longest that a new job waits for an old one.
constexpr double kStripSeconds = 0.015;
// Things rest when no newer job has come for this long.
constexpr auto kRest = std::chrono::milliseconds(50);
constexpr int kMaxDivisor = 8;

// Seconds per pixel, followed as they change.
struct Rate {
  double value = 0.0;  // 0: not known
  void Add(double seconds, double pixels) {
    const double now = seconds / std::max(pixels, 1.0);
    value = value == 0.0 ? now : 0.5 * (value + now);
  }
};

struct Cancelled {};

}  // namespace

class Worker::Shading {
 public:
  Shading(Worker& worker, std::unique_ptr<Context> context)
      : worker_(worker), context_(std::move(context)), library_(MakeLibrary()) {}

  // One job, to its end or until a newer one comes.
  void Shade(const ViewJob& job, std::uint64_t number) {
    Prepare(job);
    if (!renderer_) return;
    TellImages(*job.scene);
    const int divisor = Divisor(job);
    if (divisor > 1) {
      DrawPicture(job, number, (job.size + divisor - 1) / divisor, false, false);
      std::unique_lock lock(worker_.mutex_);
      if (worker_.changed_.wait_for(lock, kRest, [&] { return worker_.stop_ || worker_.Overtaken(); })) return;
    }
    // What is quick enough for a hand is never dropped, or a hand that keeps moving would see nothing.
    DrawPicture(job, number, job.size, true, divisor > 1);
    RefineTruth(job, number);
    if (job.measure) worker_.progress_ = 0.0;
    worker_.Publish([](ViewState& state) { state.full = true; });
    if (job.measure) Measure(job, number);
  }

 private:
  ShaderLibrary MakeLibrary() const {
    return worker_.shader_folder_.empty() ? ShaderLibrary() : ShaderLibrary(worker_.shader_folder_);
  }

  // A new renderer where shader files have changed: it forgets every program of texts that nobody will see again.
  void Prepare(const ViewJob& job) {
    if (renderer_ && job.library == library_version_) return;
    library_version_ = job.library;
    auto techniques = std::make_shared<const std::vector<Technique>>(LoadTechniques(library_));
    auto renderer = std::make_unique<Renderer>(context_->gl(), library_);
    techniques_ = std::move(techniques);
    renderer_ = std::move(renderer);
    worker_.Publish([&](ViewState& state) { state.techniques = techniques_; });
  }

  // Says which images the next picture is the first to show: filtering them takes a while.
  void TellImages(const Scene& scene) {
    std::set<std::shared_ptr<const Image>> images;
    std::string names;
    const auto add = [&](const std::shared_ptr<const Image>& image, const std::string& path) {
      if (image && images.insert(image).second && !images_.contains(image)) names += (names.empty() ? "" : ", ") + path;
    };
    if (scene.sky) add(scene.sky->texture, scene.sky->texture_path);
    for (const Light& light : scene.lights) add(light.texture, light.texture_path);
    images_ = std::move(images);
    if (!names.empty()) worker_.Publish([&](ViewState& state) { state.reading = names; });
  }

  // By how much a picture is coarsened so that it keeps up with a hand.
  int Divisor(const ViewJob& job) const {
    const double pixels = static_cast<double>(job.size.x) * job.size.y;
    double per_pixel = scene_rate_.value;
    bool known = scene_rate_.value > 0.0;
    for (const ShownVariant& shown : job.variants) {
      const auto found = rates_.find(shown.name);
      known = known && found != rates_.end();
      if (found != rates_.end()) per_pixel += found->second.value;
    }
    if (!known) return 4;
    const double divisor = std::sqrt(per_pixel * pixels / kMovingSeconds);
    return std::clamp(static_cast<int>(std::ceil(divisor)), 1, kMaxDivisor);
  }

  void DrawPicture(const ViewJob& job, std::uint64_t number, glm::ivec2 size, bool full, bool may_stop) {
    const auto start = Clock::now();
    renderer_->DrawScene(*job.scene, size, job.effects_off);
    auto pixels = std::make_shared<const SurfacePixels>(renderer_->TakePixels());
    const auto emission = std::make_shared<const std::vector<glm::vec3>>(EmissionImage(*job.scene, *pixels));
    scene_rate_.Add(Since(start), static_cast<double>(size.x) * size.y);
    worker_.Publish([&](ViewState& state) {
      state.error.clear();
      state.variants.resize(job.variants.size());
    });
    for (std::size_t i = 0; i < job.variants.size(); ++i) {
      ShadedVariant shaded{job.variants[i], number, nullptr, emission, "", 0.0, ""};
      if (shaded.variant.name == kTruth) {
        // What is known of it stays; where it is about to be refined, its coarse stand-in is not drawn anew.
        const bool known = truth_.share() > 0.0 && truth_.Is(*job.scene, job.geometry, job.size);
        if (known) worker_.Publish([&](ViewState& state) { state.variants[i] = TruthNow(number); });
        if (known || (full && worker_.state_.variants[i].job == number)) continue;
      }
      try {
        shaded.image = ShadeVariant(job.variants[i], size, may_stop, shaded.seconds,
                                    static_cast<double>(i) / static_cast<double>(job.variants.size()),
                                    1.0 / static_cast<double>(job.variants.size()));
      } catch (const std::exception& error) {
        shaded.error = error.what();
      }
      worker_.Publish([&](ViewState& state) { state.variants[i] = std::move(shaded); });
    }
    worker_.Publish([&](ViewState& state) {
      state.pixels = std::move(pixels);
      state.reading.clear();
    });
  }

  bool Shows(const ViewJob& job, const char* name) const {
    return std::ranges::any_of(job.variants, [&](const ShownVariant& shown) { return shown.name == name; });
  }

  // From the coarse picture that stands in for it, in parts: a newer job has the processors after a few milliseconds.
  void RefineTruth(const ViewJob& job, std::uint64_t number) {
    if (!Shows(job, kTruth)) return;
    const std::shared_ptr<const SurfacePixels> pixels = worker_.state_.pixels;
    const auto stand_in = std::ranges::find(worker_.state_.variants, kTruth, [](const ShadedVariant& shaded) { return shaded.variant.name; });
    truth_.Begin(job.scene, job.geometry, *pixels, stand_in->image);
    truth_emission_ = std::make_shared<const std::vector<glm::vec3>>(EmissionImage(*job.scene, *pixels));
    while (true) {
      worker_.Publish([&](ViewState& state) {
        for (ShadedVariant& shaded : state.variants) {
          if (shaded.variant.name == kTruth) shaded = TruthNow(number);
        }
      });
      if (truth_.complete()) return;
      truth_.Refine([&](double fraction) {
        worker_.progress_ = fraction;
        if (worker_.stop_ || worker_.Overtaken()) throw Cancelled();
      });
    }
  }

  ShadedVariant TruthNow(std::uint64_t number) const {
    ShadedVariant shaded{{kTruth, {}}, number, truth_.image(), truth_emission_, "", 0.0, ""};
    if (truth_.share() > 0.0) shaded.note = fmt::format("±{:.1g} %", 100.0 * truth_.error());
    if (!truth_.complete()) shaded.note += fmt::format("{}{:.0f} % of it", shaded.note.empty() ? "" : ", ", 100.0 * truth_.share());
    return shaded;
  }

  // In strips where it may be dropped, so that a newer job need not wait for it.
  std::shared_ptr<const RadianceImage> ShadeVariant(const ShownVariant& shown, glm::ivec2 size, bool may_stop,
                                                    double& seconds, double progress, double share) {
    const Variant variant = ParseVariant(*techniques_, shown.name == kTruth ? "reference" : shown.name);
    auto image = std::make_shared<RadianceImage>();
    renderer_->ShadeRows(variant, shown.knobs, 0, 1, *image);  // compiles; what that takes is not the shading's rate
    Rate& rate = rates_[shown.name];
    for (int row = 1; row < size.y;) {
      int rows = size.y - row;
      if (rate.value == 0.0) rows = std::min(rows, 8);
      if (may_stop && rate.value > 0.0) {
        rows = std::clamp(static_cast<int>(kStripSeconds / (rate.value * size.x)), 1, rows);
        if (worker_.stop_ || worker_.Overtaken()) throw Cancelled();
      }
      const auto start = Clock::now();
      renderer_->ShadeRows(variant, shown.knobs, row, rows, *image);
      rate.Add(Since(start), static_cast<double>(rows) * size.x);
      seconds += Since(start);
      row += rows;
      if (may_stop) worker_.progress_ = progress + share * row / size.y;
    }
    return image;
  }

  void Measure(const ViewJob& job, std::uint64_t number) {
    std::vector<Variant> variants;
    for (const ShownVariant& shown : job.variants) {
      if (shown.name != kTruth) variants.push_back(ParseVariant(*techniques_, shown.name));
    }
    std::erase_if(variants, [&](const Variant& v) { return WhyUnsupported(v, *job.scene).has_value(); });
    const Variant point = ParseVariant(*techniques_, "point");
    if (variants.empty() || WhyUnsupported(point, *job.scene)) return;
    const std::shared_ptr<const SurfacePixels> pixels = worker_.state_.pixels;
    const auto lit = std::ranges::count_if(pixels->position, [](glm::vec4 p) { return p.w == 1.0f; });
    TimingOptions options;
    options.target = 0.03;
    options.max_rounds = 15;
    options.seconds = 4.0;
    options.progress = [&](double fraction) {
      worker_.progress_ = std::min(fraction, 0.99);  // it is done where its figures are there
      if (worker_.stop_ || worker_.Overtaken()) throw Cancelled();
    };
    const std::vector<Timing> times =
        MeasureTimes(*context_, *renderer_, variants, point, static_cast<int>(lit), options);
    worker_.Publish([&](ViewState& state) {
      state.costs.clear();
      for (std::size_t i = 0; i < variants.size(); ++i) {
        const double ns = times[i].ns_per_pixel.value;
        state.costs[variants[i].Name()] = {1e-6 * ns * static_cast<double>(lit), ns, times[i].net_ns_per_pixel.value, times[i].ratio_to_point.value};
      }
      state.costs_job = number;
    });
  }

  Worker& worker_;
  std::unique_ptr<Context> context_;
  ShaderLibrary library_;
  std::uint64_t library_version_ = 0;
  std::shared_ptr<const std::vector<Technique>> techniques_;
  std::unique_ptr<Renderer> renderer_;
  Rate scene_rate_;
  std::map<std::string, Rate> rates_;
  std::set<std::shared_ptr<const Image>> images_;  // of the lights and the sky that were shown last
  TruthPicture truth_;
  std::shared_ptr<const std::vector<glm::vec3>> truth_emission_;

  friend class Worker;
};

void Yield(int steps) {
  const auto thread = static_cast<id_t>(syscall(SYS_gettid));
  setpriority(PRIO_PROCESS, thread, getpriority(PRIO_PROCESS, thread) + steps);
}

Worker::Worker(std::optional<ContextKind> kind, std::filesystem::path shader_folder, std::function<void()> wake)
    : shader_folder_(std::move(shader_folder)), wake_(std::move(wake)), thread_([this, kind] { Run(kind); }) {}

Worker::~Worker() {
  stop_ = true;
  changed_.notify_all();
  thread_.join();
}

std::uint64_t Worker::Submit(ViewJob job) {
  const std::lock_guard lock(mutex_);
  next_ = std::move(job);
  ++newest_;
  changed_.notify_all();
  return newest_;
}

std::optional<ViewState> Worker::News() {
  const std::lock_guard lock(mutex_);
  if (!std::exchange(news_, false)) return std::nullopt;
  return state_;
}

void Worker::Publish(const std::function<void(ViewState&)>& change) {
  {
    const std::lock_guard lock(mutex_);
    change(state_);
    news_ = true;
  }
  wake_();
}

void Worker::Run(std::optional<ContextKind> kind) {
  // Threads of a rasteriser inherit this: where processors are few, the window's own thread goes first.
  Yield(5);
  std::unique_ptr<Shading> shading;
  while (true) {
    ViewJob job;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return stop_ || next_.has_value(); });
      if (stop_) break;
      job = std::move(*next_);
      next_.reset();
      running_ = newest_.load();
      state_.job = running_;
      state_.full = false;
    }
    try {
      if (!shading) {
        shading = std::make_unique<Shading>(*this, CreateContext(kind));
        Publish([&](ViewState& state) {
          state.platform = shading->context_->platform();
          state.renderer = shading->context_->renderer();
          state.software = shading->context_->software();
        });
      }
      progress_ = 0.0;
      shading->Shade(job, running_);
    } catch (const Cancelled&) {
    } catch (const std::exception& error) {
      Publish([&](ViewState& state) {
        state.error = error.what();
        state.reading.clear();
      });
    }
    progress_ = 1.0;
  }
  shading.reset();
}

}  // namespace arealab
