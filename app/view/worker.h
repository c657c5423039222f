// The shading thread of the window: an offscreen context of its own, in which the newest job is shaded coarsely while
// things move and in full once they rest. The window only composites what comes out.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "compare/context.h"
#include "glsl/pixels.h"
#include "glsl/technique.h"
#include "scenes/scene.h"

namespace arealab {

// What stands for the truth among the variants: it is no technique.
constexpr const char* kTruth = "truth";

// A variant by its name and its knobs, or kTruth: the registry that the name refers to is the worker's, and changes with the files.
struct ShownVariant {
  std::string name;
  std::map<std::string, double> knobs;
  bool operator==(const ShownVariant& other) const = default;
};

struct ViewJob {
  std::shared_ptr<const Scene> scene;
  glm::ivec2 size{0};  // pixels, of the whole picture
  std::vector<ShownVariant> variants;
  std::set<std::string> effects_off;
  std::uint64_t geometry = 0;  // another number: other meshes
  std::uint64_t library = 0;  // another number: shader files have changed, read them again
  bool measure = false;       // time the variants once the picture is whole
};

// What became of one variant of a job.
struct ShadedVariant {
  ShownVariant variant;
  std::uint64_t job = 0;                       // that it belongs to
  std::shared_ptr<const RadianceImage> image;  // smaller than the job's size while things move; null where it failed
  std::shared_ptr<const std::vector<glm::vec3>> emission;  // of the lights that are seen, per pixel of `image`
  std::string error;                                       // why it failed: one line
  double seconds = 0.0;                                    // wall time of shading and reading back; of the truth 0
  std::string note;                                        // of the truth: how far it is, and its own error
};

struct Cost {
  double milliseconds = 0.0;  // of the lighting pass for this view
  double ns_per_pixel = 0.0, net_ns_per_pixel = 0.0;  // of a lit pixel; less a pass that only reads and writes
  double ratio_to_point = 0.0;
};

// Everything that the worker has found out, whole at all times: parts are replaced as they come.
struct ViewState {
  std::uint64_t job = 0;                          // begun last
  bool full = false;                              // every variant of that job at its full size, the truth complete
  std::vector<ShadedVariant> variants;            // in the job's order
  std::shared_ptr<const SurfacePixels> pixels;    // of the last picture, coarse or whole
  std::shared_ptr<const std::vector<Technique>> techniques;  // null before the first job
  std::string error;                                         // of the scene or the registry as a whole
  std::string reading;                                       // images that are being filtered; empty: none
  std::map<std::string, Cost> costs;                         // by variant, of `costs_job`
  std::uint64_t costs_job = 0;
  std::string platform, renderer;
  bool software = true;
};

class Worker {
 public:
  // `wake` is called from the worker's thread when there is news. The context is made in that thread.
  Worker(std::optional<ContextKind> kind, std::filesystem::path shader_folder, std::function<void()> wake);
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  // Returns the job's number. The newest job replaces those that wait; a picture at full size that is under way for an
  // older one is dropped at the end of its strip.
  std::uint64_t Submit(ViewJob job);
  // The state where it has changed since the last call.
  std::optional<ViewState> News();
  // Of the picture under way, in [0, 1]; 1 where nothing is.
  double progress() const { return progress_; }

 private:
  class Shading;  // lives in the thread

  void Run(std::optional<ContextKind> kind);
  bool Overtaken() const { return newest_ != running_; }
  void Publish(const std::function<void(ViewState&)>& change);

  std::filesystem::path shader_folder_;
  std::function<void()> wake_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<ViewJob> next_;
  ViewState state_;
  bool news_ = false;
  std::atomic<bool> stop_{false};
  std::atomic<std::uint64_t> newest_{0};
  std::atomic<std::uint64_t> running_{0};
  std::atomic<double> progress_{1.0};
  std::thread thread_;
};

}  // namespace arealab
