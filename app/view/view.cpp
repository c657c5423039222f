#include "app/view/view.h"

#include <glad/gl.h>
// After glad: GLFW brings no OpenGL header of its own where it sees one.
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <imgui.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <deque>
#include <fstream>
#include <functional>
#include <future>
#include <glm/gtc/constants.hpp>
#include <set>
#include <thread>

#include "app/view/background.h"
#include "app/view/camera.h"
#include "app/view/gizmo.h"
#include "app/view/inspector.h"
#include "app/view/ocio.h"
#include "app/view/panels.h"
#include "app/view/watch.h"
#include "app/view/widgets.h"
#include "compare/image_files.h"
#include "compare/stress_families.h"
#include "glsl/variant.h"
#include "scenes/error.h"
#include "scenes/replace_file.h"

namespace arealab {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double Seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

constexpr double kFrameSeconds = 1.0 / 60.0;
constexpr double kMessageSeconds = 6.0;
constexpr double kAutosaveSeconds = 3.0;
constexpr int kTurntableFrames = 72;
constexpr double kFlickerSeconds = 0.5;
constexpr std::size_t kHistory = 64;  // measurements that are remembered
constexpr float kPlainHeight = 1440.0f;  // px: of a monitor up to which type of 16 px is readable
constexpr int kMinType = 60, kMaxType = 300;
constexpr auto kFileClockStep = std::chrono::milliseconds(10);  // by which a file's time may lag behind the clock
constexpr double kClickReach = 4.0;  // px: a press that moves less is a click

// Since the process began, loading of libraries included.
double SinceProcessStart() {
  std::ifstream stat("/proc/self/stat");
  std::string text;
  std::getline(stat, text);
  // Field 22, counted behind the name in parentheses, is the start in ticks since boot [proc(5)].
  unsigned long long ticks = 0;
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string::npos ||
      std::sscanf(text.c_str() + name_end + 2, "%*c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %*u %*u %*d %*d %*d %*d %*d %*d %llu",
                  &ticks) != 1) {
    return 0.0;
  }
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec) -
         static_cast<double>(ticks) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

// What the next start remembers of this one: a text of "key value" lines in the user's configuration folder.
struct Remembered {
  glm::ivec2 size{1280, 720};
  int navigation = 0, layout = -1, type = 100;  // type: per cent of what the monitor asks for
  std::string scene;

  static Remembered Load() {
    Remembered remembered;
    std::ifstream stream(ConfigFolder() / "view.conf");
    for (std::string key; stream >> key;) {
      if (key == "size") stream >> remembered.size.x >> remembered.size.y;
      if (key == "navigation") stream >> remembered.navigation;
      if (key == "layout") stream >> remembered.layout;
      if (key == "type") stream >> remembered.type;
      if (key == "scene") std::getline(stream >> std::ws, remembered.scene);
    }
    remembered.size = glm::clamp(remembered.size, glm::ivec2(320, 240), glm::ivec2(16384, 16384));
    remembered.navigation = std::clamp(remembered.navigation, 0, 1);
    remembered.layout = std::clamp(remembered.layout, -1, static_cast<int>(Layout::kGrid));
    remembered.type = std::clamp(remembered.type, kMinType, kMaxType);
    return remembered;
  }

  void Save() const {
    const fs::path folder = ConfigFolder();
    if (folder.empty()) return;
    try {
      ReplaceFile(folder / "view.conf", fmt::format("size {} {}\nnavigation {}\nlayout {}\ntype {}\nscene {}\n", size.x, size.y, navigation, layout, type, scene));
    } catch (const InputError&) {
      // It is forgotten then.
    }
  }
};

// Standard error as the program was given it: while an image is read beside the window's work, the stream itself is silent
// (scenes/image.cpp).
std::FILE* Errors() {
  static std::FILE* const errors = [] {
    const int copy = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
    std::FILE* const stream = copy < 0 ? nullptr : fdopen(copy, "w");
    if (stream == nullptr) return stderr;
    std::setvbuf(stream, nullptr, _IONBF, 0);
    return stream;
  }();
  return errors;
}

std::string glfw_trouble;

struct GlfwLibrary {
  GlfwLibrary() {
    glfwSetErrorCallback([](int, const char* text) { glfw_trouble = text; });
    if (glfwInit() != GLFW_TRUE) {
      throw InputError(fmt::format("no display: {}; expected an X server or Wayland (DISPLAY, WAYLAND_DISPLAY), "
                                   "or `arealab render` where there is none", glfw_trouble));
    }
  }
  ~GlfwLibrary() { glfwTerminate(); }
};

struct GlfwWindow {
  GlfwWindow(glm::ivec2 size, const std::string& title) {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_SRGB_CAPABLE, GLFW_FALSE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    window = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
    if (window == nullptr) {
      throw InputError(fmt::format("no window: {}; expected a display with OpenGL 4.5", glfw_trouble));
    }
    glfwMakeContextCurrent(window);
    if (gladLoadGLContext(&gl, glfwGetProcAddress) == 0) throw InputError("the display's OpenGL does not load; expected OpenGL 4.5");
  }
  ~GlfwWindow() { glfwDestroyWindow(window); }

  GLFWwindow* window = nullptr;
  GladGLContext gl{};
};

struct ImGuiLibrary {
  explicit ImGuiLibrary(GLFWwindow* window) {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui_ImplGlfw_InitForOpenGL(window, false);  // its events come by View::Replay
    ImGui_ImplOpenGL3_Init("#version 450 core");
  }
  ~ImGuiLibrary() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
  }
};

// Times of a session, for --json.
struct Figures {
  double first_picture = 0.0, first_full = 0.0;  // s since the process began
  std::vector<double> latency;                   // s from an input to a picture that shows it
  std::vector<double> full_after;                // s from the last input to the picture at full size
  std::vector<double> frame;                     // s of the window's own work per frame

  static double Percentile(std::vector<double> values, double share) {
    if (values.empty()) return 0.0;
    const auto index = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(index), values.end());
    return values[index];
  }
  void Print(const std::string& more) const {
    fmt::print("{{\"first_picture_ms\": {:.0f}, \"first_full_ms\": {:.0f}, "
               "\"input_to_picture_ms\": {{\"median\": {:.1f}, \"p95\": {:.1f}, \"count\": {}}}, "
               "\"rest_to_full_ms\": {{\"median\": {:.1f}, \"max\": {:.1f}, \"count\": {}}}, "
               "\"frame_ms\": {{\"median\": {:.1f}, \"p95\": {:.1f}, \"count\": {}}}{}}}\n",
               1e3 * first_picture, 1e3 * first_full, 1e3 * Percentile(latency, 0.5), 1e3 * Percentile(latency, 0.95),
               latency.size(), 1e3 * Percentile(full_after, 0.5), 1e3 * Percentile(full_after, 1.0), full_after.size(),
               1e3 * Percentile(frame, 0.5), 1e3 * Percentile(frame, 0.95), frame.size(), more);
  }
};

enum class Drag { kNone, kPending, kOrbit, kPan, kDolly, kWipe, kControls };

// A file that is read beside the window's own work, and what is done with it then.
struct Reading {
  std::string name;
  std::future<std::function<void()>> done;
};

// What the window's callbacks saw and no frame has taken yet, in its order.
struct Event {
  enum Kind { kMove, kButton, kKey, kCharacter, kWheel, kDrop };
  Kind kind;
  int code = 0, scancode = 0, action = 0, modifiers = 0;  // of a button or a key; the code is a character's too
  glm::dvec2 place{0.0};                                  // in the window, or what the wheel turned
  std::vector<std::string> files{};
};

const glm::dvec2 kNowhere(-FLT_MAX);  // as ImGui says it of a pointer outside the window

struct Inputs {
  std::optional<Clock::time_point> first;  // that no job has answered yet
  bool any = false;
  std::deque<Event> events;
};
Inputs inputs;
void Noticed() {
  inputs.any = true;
  if (!inputs.first) inputs.first = Clock::now();
}

class View {
 public:
  View(const ViewOptions& options, GlfwWindow& window, Worker& worker, Session& session, fs::file_time_type begun, int type)
      : options_(options), window_(window), worker_(worker), session_(session), display_(window.gl),
        watch_(options.shader_folder), type_(type), chrome_(options.bare ? Chrome::kNone : options.captions ? Chrome::kCaptions : Chrome::kAll) {
    watch_.Use(session.Files(), begun);
    Scale();
    ReadOcio();
    if (session.HasLeftBehind()) Say("an earlier session left unsaved edits of this scene: Ctrl + R brings them back");
    if (!options.turntable.empty()) StartTurntable(options.turntable);
  }

  void Run() {
    while (glfwWindowShouldClose(window_.window) == GLFW_FALSE && !done_) {
      Wait();
      Poll();
      if (redraw_ > 0) Frame();
    }
    if (options_.json) figures_.Print(CostsJson() + (session_.inspected && inspection_.surface ? ", " + Json(inspection_) : ""));
  }

  int type() const { return type_; }

 private:
  enum class Chrome { kAll, kCaptions, kNone };

  // ---------------------------------------------------------------------------------------------- the loop

  // Sleeps until something happens: a window that nobody touches costs nothing.
  void Wait() {
    const double since = Seconds(Clock::now() - last_frame_);
    if (redraw_ > 0) {
      if (since < kFrameSeconds) std::this_thread::sleep_for(std::chrono::duration<double>(kFrameSeconds - since));
      glfwPollEvents();
    } else {
      const bool lively = worker_.progress() < 1.0 || session_.layout == Layout::kFlicker || !message_.empty() || !readings_.empty();
      glfwWaitEventsTimeout(std::max(watch_.Rest(), 1e-3));  // a tenth of a second at most
      // Typing carets blink and tooltips appear without an event.
      if (lively || Seconds(Clock::now() - last_frame_) > 0.5) redraw_ = std::max(redraw_, 1);
    }
    if (std::exchange(inputs.any, false)) redraw_ = 3;  // ImGui settles one or two frames after an event
  }

  void Poll() {
    if (auto news = worker_.News()) {
      state_ = std::move(*news);
      std::string trouble = state_.error;
      for (const ShadedVariant& variant : state_.variants) {
        if (trouble.empty()) trouble = variant.error;
      }
      if (!trouble.empty() && trouble != told_) fmt::print(Errors(), "{}\n", trouble);
      told_ = trouble;
      redraw_ = std::max(redraw_, 1);
    }
    if (state_.costs_job != costs_job_) {
      costs_job_ = state_.costs_job;
      for (const auto& [name, cost] : state_.costs) {
        std::vector<float>& history = history_[name];
        if (history.size() == kHistory) history.erase(history.begin());
        history.push_back(static_cast<float>(cost.ns_per_pixel));
      }
    }
    if (counter_) {
      if (auto news = counter_->News()) {
        cycles_ = std::move(*news);
        redraw_ = std::max(redraw_, 1);
      }
    }
    if (inspector_) {
      if (auto news = inspector_->News()) {
        inspection_ = std::move(*news);
        redraw_ = std::max(redraw_, 1);
      }
    }
    watch_.Use(session_.Files(), begun_);
    const Watch::Change change = watch_.Poll();
    if (change.shaders) ++library_;
    changed_.insert(change.files.begin(), change.files.end());
    if (!changed_.empty() && readings_.empty()) ReadAgain(std::exchange(changed_, {}));
    if (change.shaders || !change.files.empty()) redraw_ = 3;
    while (!readings_.empty() && readings_.front().done.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
      Reading reading = std::move(readings_.front());
      readings_.pop_front();
      try {
        reading.done.get()();
      } catch (const std::exception& error) {
        Say(error.what(), true);
      }
      redraw_ = 3;
    }
    if (Seconds(Clock::now() - autosaved_) > kAutosaveSeconds) {
      autosaved_ = Clock::now();
      session_.Autosave();
    }
    if (!message_.empty() && Seconds(Clock::now() - said_) > (trouble_ ? 4.0 : 1.0) * kMessageSeconds) message_.clear();
  }

  // `read` runs in a thread of its own; what it returns, here. In the order in which they were asked for.
  void Read(const std::string& name, std::function<std::function<void()>()> read) {
    begun_ = fs::file_time_type::clock::now() - kFileClockStep;
    readings_.push_back({name, std::async(std::launch::async, [read = std::move(read)] {
      Yield(5);
      return read();
    })});
    redraw_ = std::max(redraw_, 1);
  }

  // What the scene is read from has changed. Where that is images and meshes alone, edits stay.
  void ReadAgain(const std::set<fs::path>& changed) {
    const fs::path file = session_.scene.file;
    const bool other_scene = changed.contains(file);
    if (other_scene && session_.Dirty()) return Say("the scene file has changed on disk; undo your edits or save over it");
    std::string text;
    try {
      if (!other_scene) text = session_.EditedSceneText();
    } catch (const std::exception& error) {
      return Say(error.what(), true);
    }
    const std::string first = (other_scene ? file : *changed.begin()).filename().string();
    const std::string name = changed.size() > 1 ? fmt::format("{} and {} more", first, changed.size() - 1) : first;
    Read(name, [this, name, file, text, cache = options_.cache]() -> std::function<void()> {
      auto files = std::make_shared<std::set<fs::path>>();
      try {
        auto scene = std::make_shared<Scene>(LoadWithApertures(file, cache, *files, text));
        return [this, name, scene, files, edited = !text.empty()] {
          session_.files = *files;
          if (!edited || !session_.Refresh(*scene)) {
            if (session_.Dirty()) throw InputError(fmt::format("the {} changed on disk; undo your edits or save over it", edited ? "materials of a mesh file have" : "scene file has"));
            session_.Replace(std::move(*scene));
          }
          Say(name + " read again");
        };
      } catch (const std::exception& error) {
        // What is wrong may be mended in a file that was not among the scene's before.
        return [this, files, what = std::string(error.what())] {
          session_.files.insert(files->begin(), files->end());
          Say(what, true);
        };
      }
    });
  }

  void Frame() {
    const auto start = Clock::now();
    --redraw_;
    last_frame_ = start;
    glm::ivec2 framebuffer(0), window_size(0);
    glfwGetFramebufferSize(window_.window, &framebuffer.x, &framebuffer.y);
    glfwGetWindowSize(window_.window, &window_size.x, &window_size.y);
    if (framebuffer.x < 16 || framebuffer.y < 16) return;
    if (std::exchange(other_type_, false)) {
      ImGui_ImplOpenGL3_DestroyFontsTexture();
      Scale();
      ImGui_ImplOpenGL3_CreateFontsTexture();
    }
    // A picture that was asked for in the last frame is taken of this one, without what was said since.
    wanted_shot_ = std::exchange(asked_shot_, {});
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    Replay();
    ImGui::NewFrame();
    PanelContext context{session_, state_, worker_.progress(), unit_, wanted_shot_.empty() ? message_ : "", trouble_, inspection_, inspector_ && inspector_->busy(), cycles_, history_};
    for (const Reading& reading : readings_) context.reading += (context.reading.empty() ? "" : ", ") + reading.name;
    if (context.reading.empty()) context.reading = state_.reading;
    context.flicker_pane = FlickerPane();
    if (ocio_) context.ocio_views = &ocio_->views(), context.ocio_input = ocio_->input();
    const bool all = chrome_ == Chrome::kAll;
    const float bar = all ? BarHeight(context) : 0.0f, column = all ? ColumnWidth(context) : 0.0f;
    origin_ = {0.0, bar};
    size_ = glm::max(glm::dvec2(ImGui::GetIO().DisplaySize.x - column, ImGui::GetIO().DisplaySize.y - bar), glm::dvec2(16.0));

    Keys();
    Pointer(context);
    PanelRequests requests;
    if (chrome_ != Chrome::kNone) {
      DrawOverlay(context, glm::vec2(origin_), glm::vec2(size_));
      if (session_.inspected && session_.show_lobe && !help_) DrawLobe(context, glm::vec2(origin_), glm::vec2(size_));
      DrawStrip(context, glm::vec2(origin_), glm::vec2(size_));
    }
    if (all) {
      DrawBar(context, ImGui::GetIO().DisplaySize.x, requests);
      DrawColumn(context, {static_cast<float>(size_.x), bar}, {column, static_cast<float>(size_.y)}, requests);
    }
    if (help_) DrawHelp(context, glm::vec2(ImGui::GetIO().DisplaySize.x, ImGui::GetIO().DisplaySize.y));
    if (requests.toggle_help) help_ = !help_;
    if (requests.save) Save();
    if (requests.screenshot) asked_shot_ = Numbered(".png");
    if (requests.turntable) StartTurntable(session_.scene.name + "_turntable");
    if (requests.snapshot) KeepSnapshot();
    if (requests.copy) CopyCase();
    if (requests.exr) asked_shot_ = Numbered(".exr");
    for (const std::string& file : std::exchange(dropped_, {})) Drop(file);
    if (!ImGui::IsAnyItemActive() && !gizmo_.dragging()) session_.Commit();
    ImGui::Render();

    Submit();
    Count();
    Title();
    Composite(framebuffer);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    Leave();
    Turn();
    if (!wanted_shot_.empty()) Shoot(std::exchange(wanted_shot_, {}), framebuffer);
    glfwSwapBuffers(window_.window);
    Note(start);
  }

  // Hands on what was done since the last frame. ImGui 1.86 looks at keys, buttons and the pointer once a frame only, so a
  // frame takes no more than one change of a button and nothing after it, and no key that both goes down and comes up. A
  // tab must be under the pointer for a frame before it takes a click, so a move and a button are two frames. However
  // slow a frame was, a tap, a click and a drag are what the hand did, where the hand did it.
  void Replay() {
    std::vector<int> went_down;
    bool button = false, moved = false;
    while (!inputs.events.empty() && !button) {
      const Event& next = inputs.events.front();
      if (next.kind == Event::kKey && next.action == GLFW_RELEASE && std::ranges::find(went_down, next.code) != went_down.end()) break;
      if (next.kind == Event::kButton && moved) break;
      const Event event = std::move(inputs.events.front());
      inputs.events.pop_front();
      switch (event.kind) {
        case Event::kMove:
          moved = moved || event.place != cursor_;
          cursor_ = event.place;
          break;
        case Event::kButton:
          button = true;
          if (event.code < static_cast<int>(buttons_.size())) buttons_[static_cast<std::size_t>(event.code)] = event.action == GLFW_PRESS;
          if (event.action == GLFW_PRESS) shift_ = (event.modifiers & GLFW_MOD_SHIFT) != 0;
          break;
        case Event::kKey:
          ImGui_ImplGlfw_KeyCallback(window_.window, event.code, event.scancode, event.action, event.modifiers);
          if (event.action == GLFW_PRESS) {
            went_down.push_back(event.code);
            keys_.push_back(event);
          }
          break;
        case Event::kCharacter: ImGui_ImplGlfw_CharCallback(window_.window, static_cast<unsigned>(event.code)); break;
        case Event::kWheel: ImGui_ImplGlfw_ScrollCallback(window_.window, event.place.x, event.place.y); break;
        case Event::kDrop: dropped_.insert(dropped_.end(), event.files.begin(), event.files.end()); break;
      }
    }
    if (!inputs.events.empty() || button) redraw_ = std::max(redraw_, 3);
    // GLFW would tell the buttons and the pointer as they are by now.
    ImGuiIO& io = ImGui::GetIO();
    std::ranges::copy(buttons_, io.MouseDown);
    io.MousePos = {static_cast<float>(cursor_.x), static_cast<float>(cursor_.y)};
  }

  // Figures of what is now on the screen.
  void Note(Clock::time_point start) {
    const auto now = Clock::now();
    figures_.frame.push_back(Seconds(now - start));
    const bool any = !state_.variants.empty() &&
                     std::all_of(state_.variants.begin(), state_.variants.end(),
                                 [&](const ShadedVariant& v) { return v.job >= shown_job_ && (v.image || !v.error.empty()); });
    if (!any) return;
    if (figures_.first_picture == 0.0) figures_.first_picture = SinceProcessStart();
    std::uint64_t oldest = state_.job;
    for (const ShadedVariant& variant : state_.variants) oldest = std::min(oldest, variant.job);
    while (!waiting_.empty() && waiting_.front().first <= oldest) {
      figures_.latency.push_back(Seconds(now - waiting_.front().second));
      waiting_.erase(waiting_.begin());
    }
    if (state_.full && state_.job == submitted_ && full_job_ != submitted_) {
      full_job_ = submitted_;
      if (figures_.first_full == 0.0) figures_.first_full = SinceProcessStart();
      else figures_.full_after.push_back(Seconds(now - submitted_at_));
    }
  }

  // What a window list and a script can see: the scene, and whether the picture is whole.
  void Title() {
    const bool looking = (inspector_ && inspector_->busy()) || (counter_ && counter_->busy());
    const bool whole = state_.full && state_.job == submitted_ && worker_.progress() >= 1.0 && !looking && readings_.empty();
    const std::string title = session_.scene.name + (whole ? "" : " …") + " – AreaLab";
    if (title != title_) glfwSetWindowTitle(window_.window, (title_ = title).c_str());
  }

  // ---------------------------------------------------------------------------------------------- shading

  glm::ivec2 PaneSize() const {
    const glm::dvec2 scale(ImGui::GetIO().DisplayFramebufferScale.x, ImGui::GetIO().DisplayFramebufferScale.y);
    const glm::ivec2 whole(glm::round(size_ * scale));
    if (session_.layout != Layout::kGrid) return whole;
    const glm::vec4 cell = GridCell(0, session_.grid_panes, glm::vec2(whole));
    return glm::ivec2(cell.z, cell.w);
  }

  void Submit() {
    ViewJob job;
    job.size = PaneSize();
    for (int i = 0; i < session_.PaneCount(); ++i) {
      const ShownVariant& pane = session_.panes[static_cast<std::size_t>(i)];
      if (!pane.name.starts_with('#')) job.variants.push_back(pane);
    }
    job.effects_off = session_.effects_off;
    job.geometry = session_.geometry;
    job.library = library_;
    job.measure = session_.measure;
    const Scene& scene = session_.scene;
    const bool same = last_.scene && job.size == last_.size && job.variants == last_.variants &&
                      job.effects_off == last_.effects_off && job.library == last_.library && job.measure == last_.measure &&
                      job.geometry == last_.geometry && Same(scene.camera, last_.scene->camera) &&
                      Same(Edits{scene.lights, scene.materials, 0.0, scene.sky}, {last_.scene->lights, last_.scene->materials, 0.0, last_.scene->sky});
    if (same) {
      inputs.first.reset();
      return;
    }
    job.scene = std::make_shared<const Scene>(scene);
    last_ = job;
    submitted_ = worker_.Submit(std::move(job));
    submitted_at_ = inputs.first.value_or(Clock::now());
    if (inputs.first) waiting_.emplace_back(submitted_, *inputs.first);
    inputs.first.reset();
  }

  // Cycles depend on what is shown, not on how it moves: asked for once things rest.
  void Count() {
    if (std::exchange(was_measuring_, session_.measure) != session_.measure) glfwSwapInterval(session_.measure ? 0 : 1);
    if (!session_.measure || !state_.full || state_.job != submitted_ || (counted_job_ == submitted_ && counted_gpu_ == session_.gpu)) return;
    counted_job_ = submitted_;
    counted_gpu_ = session_.gpu;
    if (!counter_) counter_.emplace([this] { return MakeCycleCounter(options_.shader_folder, options_.cache); }, glfwPostEmptyEvent);
    CyclesJob job{last_.scene, {}, last_.effects_off, session_.gpu};
    for (const ShownVariant& shown : last_.variants) {
      if (shown.name != kTruth) job.variants.push_back(shown.name);
    }
    counter_->Submit(std::move(job));
  }

  // What the cost panel says last.
  std::string CostsJson() const {
    std::string times, cycles, effects, history;
    const auto add = [](std::string& list, const std::string& name, double value) { list += fmt::format("{}\"{}\": {:.6g}", list.empty() ? "" : ", ", name, value); };
    for (const auto& [name, cost] : state_.costs) add(times, name, cost.ratio_to_point);
    for (const auto& [name, count] : cycles_.variants) add(cycles, name, count);
    for (const auto& [name, count] : cycles_.effects) add(effects, name, count);
    for (const auto& [name, values] : history_) history += fmt::format("{}\"{}\": [{:.6g}]", history.empty() ? "" : ", ", name, fmt::join(values, ", "));
    if (times.empty() && cycles.empty()) return "";
    return fmt::format(", \"cost\": {{\"ratio_to_point\": {{{}}}, \"gpu\": \"{}\", \"cycles\": {{{}}}, \"cycles_of_effects\": {{{}}}, \"history_ns_per_pixel\": {{{}}}}}", times, cycles_.gpu, cycles, effects, history);
  }

  int FlickerPane() const { return static_cast<int>(Seconds(Clock::now().time_since_epoch()) / kFlickerSeconds) % 2; }

  // A pane's snapshot, or its place among what the worker shades.
  const ShadedVariant* Shown(int pane) const {
    const auto count = static_cast<std::size_t>(pane);
    if (const Snapshot* snapshot = session_.SnapshotOf(session_.panes[count])) return &snapshot->picture;
    std::size_t place = 0;
    for (std::size_t i = 0; i < count; ++i) place += session_.panes[i].name.starts_with('#') ? 0 : 1;
    return place < state_.variants.size() ? &state_.variants[place] : nullptr;
  }

  void KeepSnapshot() {
    const ShadedVariant* shaded = Shown(0);
    if (shaded == nullptr || !shaded->image) return;
    session_.Keep(ShadedVariant(*shaded));
    Say(fmt::format("kept {}: click it to compare it with what comes", session_.snapshots.back().label));
  }

  // ---------------------------------------------------------------------------------------------- turntable

  void StartTurntable(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) {
      const InputError trouble(fmt::format("{}: {}; expected a folder that may be made", folder.string(), error.message()));
      if (options_.frames > 0) throw trouble;
      return Say(trouble.what(), true);
    }
    turntable_ = folder;
    turn_ = 0;
    if (chrome_ == Chrome::kAll) chrome_ = Chrome::kNone;
  }

  // One step of it: the picture as it is seen, then the camera goes on, once round.
  void Turn() {
    if (turntable_.empty() || !state_.full || state_.job != submitted_) return;
    const int count = options_.turntable.empty() ? kTurntableFrames : options_.frames;
    wanted_shot_ = turntable_ / fmt::format("{:04}.png", turn_ + 1);
    Orbit(session_.scene.camera, 2.0 * glm::pi<double>() / count, 0.0);
    redraw_ = 2;
    if (++turn_ < count) return;
    turntable_.clear();
    if (!options_.bare && !options_.captions) chrome_ = Chrome::kAll;
    done_ = !options_.turntable.empty();
  }

  void Composite(glm::ivec2 framebuffer) {
    const GladGLContext& gl = window_.gl;
    gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl.Viewport(0, 0, framebuffer.x, framebuffer.y);
    gl.ClearColor(0.09f, 0.09f, 0.095f, 1.0f);
    gl.Clear(GL_COLOR_BUFFER_BIT);
    for (int i = 0; i < session_.PaneCount(); ++i) {
      // A variant that fails keeps the last picture that it had.
      if (const ShadedVariant* shaded = Shown(i); shaded != nullptr && shaded->image) {
        display_.SetPicture(i, shaded->image, shaded->emission, session_.lobe);
      }
    }
    BakeView();
    DisplaySettings settings = session_.display;
    settings.exposure = session_.scene.exposure + session_.exposure;
    const glm::dvec2 scale(ImGui::GetIO().DisplayFramebufferScale.x, ImGui::GetIO().DisplayFramebufferScale.y);
    const glm::ivec2 whole(glm::round(size_ * scale));
    const glm::ivec4 area(0, framebuffer.y - static_cast<int>(std::lround(origin_.y * scale.y)) - whole.y, whole.x, whole.y);
    const PictureKind plain = session_.false_color ? PictureKind::kFalseColor : PictureKind::kPlain;
    switch (session_.layout) {
      case Layout::kSingle:
        settings.kind = plain;
        display_.Draw(area, 0, 0, settings);
        break;
      case Layout::kFlicker:
        settings.kind = plain;
        display_.Draw(area, FlickerPane(), FlickerPane(), settings);
        break;
      case Layout::kWipe:
        settings.kind = plain;
        display_.Draw(area, 0, 0, settings, {0.0f, session_.wipe});
        display_.Draw(area, 1, 1, settings, {session_.wipe, 1.0f});
        break;
      case Layout::kDifference:
        settings.kind = session_.display.kind == PictureKind::kMagnitude ? PictureKind::kMagnitude : PictureKind::kSigned;
        settings.floor_luminance = Floor();
        display_.Draw(area, 0, 1, settings);
        break;
      case Layout::kGrid:
        settings.kind = plain;
        for (int i = 0; i < session_.grid_panes; ++i) {
          const glm::ivec4 cell(GridCell(i, session_.grid_panes, glm::vec2(whole)));
          display_.Draw({area.x + cell.x, area.y + whole.y - cell.y - cell.w, cell.z, cell.w}, i, i, settings);
        }
        break;
    }
    settings.kind = plain;
    if (chrome_ != Chrome::kNone) CompositeStrip(area, settings);
  }

  void CompositeStrip(const glm::ivec4& area, const DisplaySettings& settings) {
    const float unit = unit_ * static_cast<float>(area.z) / static_cast<float>(size_.x);
    for (std::size_t i = 0; i < session_.snapshots.size(); ++i) {
      const int slot = 4 + static_cast<int>(i);
      const ShadedVariant& kept = session_.snapshots[i].thumbnail;
      display_.SetPicture(slot, kept.image, kept.emission, session_.lobe);
      const glm::ivec4 cell(StripCell(i, glm::vec2(area.z, area.w), unit));
      display_.Draw({area.x + cell.x, area.y + area.w - cell.y - cell.w, cell.z, cell.w}, slot, slot, settings);
    }
  }

  // 1 % of the reference's mean luminance over what it lights, as in the report.
  double Floor() {
    const ShadedVariant* reference = Shown(1);
    if (reference == nullptr || !reference->image) return 0.0;
    if (reference->image != floor_of_) {
      floor_of_ = reference->image;
      floor_ = 0.01 * MeanLuminance(*reference->image);
    }
    return floor_;
  }

  // ---------------------------------------------------------------------------------------------- hands

  glm::dvec2 Mouse() const { return cursor_ - origin_; }

  bool Inside(glm::dvec2 p) const { return p.x >= 0.0 && p.y >= 0.0 && p.x < size_.x && p.y < size_.y; }

  // The pane under the pointer: its origin and size, of which every gesture is measured.
  std::pair<glm::dvec2, glm::dvec2> Pane(glm::dvec2 p) const {
    if (session_.layout != Layout::kGrid) return {glm::dvec2(0.0), size_};
    for (int i = 0; i < session_.grid_panes; ++i) {
      const glm::dvec4 cell(GridCell(i, session_.grid_panes, glm::vec2(size_)));
      if (p.x >= cell.x && p.y >= cell.y && p.x < cell.x + cell.z && p.y < cell.y + cell.w) return {glm::dvec2(cell), glm::dvec2(cell.z, cell.w)};
    }
    return {glm::dvec2(0.0), size_};
  }

  // What the last whole picture has at 0 … 1 across a pane; nothing where there is none.
  std::optional<std::size_t> PixelAt(glm::dvec2 p) const {
    if (!state_.pixels || p.x < 0.0 || p.y < 0.0 || p.x >= 1.0 || p.y >= 1.0) return std::nullopt;
    const auto x = static_cast<std::size_t>(p.x * state_.pixels->width), y = static_cast<std::size_t>(p.y * state_.pixels->height);
    return y * static_cast<std::size_t>(state_.pixels->width) + x;
  }

  void Pointer(PanelContext& context) {
    const ImGuiIO& io = ImGui::GetIO();
    const glm::dvec2 at = Mouse();
    const auto [pane_origin, pane_size] = Pane(drag_ == Drag::kNone ? at : pressed_);
    const bool free = drag_ == Drag::kNone && !io.WantCaptureMouse && Inside(at);
    Camera& camera = session_.scene.camera;

    const bool alt = io.KeyAlt;
    const bool maya = session_.navigation == Navigation::kMaya;
    const bool near_wipe = session_.layout == Layout::kWipe && std::abs(at.x - session_.wipe * size_.x) < 0.5 * unit_;
    const bool on_gizmo = chrome_ == Chrome::kAll && session_.layout != Layout::kGrid && drag_ != Drag::kOrbit && drag_ != Drag::kPan &&
                          gizmo_.Run(session_, origin_, size_, at, free && !near_wipe && !alt);
    context.over_wipe = drag_ == Drag::kWipe || (free && near_wipe && !gizmo_.dragging());
    if (context.over_wipe) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);

    if (free && !gizmo_.dragging()) {
      if (ImGui::IsMouseClicked(0) || ImGui::IsMouseClicked(1) || ImGui::IsMouseClicked(2)) pressed_ = dragged_ = at;
      if (ImGui::IsMouseClicked(0)) {
        if (near_wipe && !alt) drag_ = Drag::kWipe;
        else if (!on_gizmo) drag_ = maya && alt ? Drag::kOrbit : Drag::kPending;
      } else if (ImGui::IsMouseClicked(2)) {
        drag_ = maya ? (alt ? Drag::kPan : Drag::kNone) : io.KeyShift ? Drag::kPan : io.KeyCtrl ? Drag::kDolly : Drag::kOrbit;
      } else if (ImGui::IsMouseClicked(1) && (maya && alt)) {
        drag_ = Drag::kDolly;
      }
      if (io.MouseWheel != 0.0f) Dolly(camera, std::pow(0.9, io.MouseWheel));
    }
    if (drag_ == Drag::kPending && glm::distance(at, pressed_) > kClickReach && !maya) {
      drag_ = shift_ ? Drag::kPan : Drag::kOrbit;
    }
    const glm::dvec2 moved = at - std::exchange(dragged_, at);
    const double per_pixel = 2.0 / std::max(pane_size.y, 1.0);  // rad: half a turn for a drag of 1.6 heights
    if (drag_ == Drag::kOrbit) Orbit(camera, -moved.x * per_pixel, moved.y * per_pixel);
    if (drag_ == Drag::kPan) Pan(camera, moved, pane_size);
    if (drag_ == Drag::kDolly) Dolly(camera, std::exp((moved.y - moved.x) * per_pixel));
    if (drag_ == Drag::kWipe) session_.wipe = static_cast<float>(std::clamp(at.x / size_.x, 0.0, 1.0));
    if (drag_ != Drag::kNone && !ImGui::IsMouseDown(0) && !ImGui::IsMouseDown(1) && !ImGui::IsMouseDown(2)) {
      if (drag_ == Drag::kPending) Click((pressed_ - pane_origin) / pane_size);
      drag_ = Drag::kNone;
    }
    if (session_.inspected) Inspect();
  }

  void Click(glm::dvec2 at) {
    const auto pixel = PixelAt(at);
    if (!pixel) return;
    if (shift_) {
      session_.inspected = at;
      return;
    }
    const int kind = static_cast<int>(std::abs(state_.pixels->position[*pixel].w));
    session_.light = kind >= 2 ? kind - 2 : -1;
    if (kind < 2) session_.inspected.reset();
  }

  // Asks once per whole picture: what is coarse is not worth a look.
  void Inspect() {
    const glm::ivec2 pixel = glm::clamp(glm::ivec2(*session_.inspected * glm::dvec2(last_.size)), glm::ivec2(0), last_.size - 1);
    if (!state_.full || state_.job != submitted_ || (inspected_job_ == submitted_ && inspected_pixel_ == pixel)) return;
    inspected_job_ = submitted_;
    inspected_pixel_ = pixel;
    if (!inspector_) inspector_.emplace([this] { return MakeInspector(options_.context, options_.shader_folder); }, glfwPostEmptyEvent);
    inspector_->Submit({last_.scene, last_.size, pixel, last_.variants, last_.effects_off, last_.library});
  }

  void CopyCase() {
    const LightAtPixel* light = CaseLight(session_, inspection_);
    if (light == nullptr) return;
    const std::string line = CaseLine(light->test_case);
    glfwSetClipboardString(window_.window, line.c_str());
    Say(fmt::format("copied for `arealab stress --case`: {}", line));
  }

  void Keys() {
    const ImGuiIO& io = ImGui::GetIO();
    const std::vector<Event> keys = std::exchange(keys_, {});
    if (io.WantTextInput) return;
    for (const ImWchar c : io.InputQueueCharacters) {
      if (c == '?') help_ = !help_;
      if (c == '[') session_.exposure -= 1.0 / 3.0;
      if (c == ']') session_.exposure += 1.0 / 3.0;
    }
    for (const Event& key : keys) {
      (key.modifiers & GLFW_MOD_CONTROL) != 0 ? Command(key.code, (key.modifiers & GLFW_MOD_SHIFT) != 0) : Key(key.code);
    }
  }

  void Command(int key, bool shift) {
    switch (key) {
      case GLFW_KEY_Z: return shift ? session_.Redo() : session_.Undo();
      case GLFW_KEY_Y: return session_.Redo();
      case GLFW_KEY_S: return Save();
      case GLFW_KEY_R: return Restore();
      case GLFW_KEY_C:
        if (session_.inspected && inspection_.surface) CopyCase();
        return;
      case GLFW_KEY_EQUAL:
      case GLFW_KEY_KP_ADD: return Type(type_ + 10);
      case GLFW_KEY_MINUS:
      case GLFW_KEY_KP_SUBTRACT: return Type(type_ - 10);
      case GLFW_KEY_Q: return glfwSetWindowShouldClose(window_.window, GLFW_TRUE);
      default: return;
    }
  }

  void Key(int key) {
    if (key >= GLFW_KEY_1 && key <= GLFW_KEY_5) session_.layout = static_cast<Layout>(key - GLFW_KEY_1);
    switch (key) {
      case GLFW_KEY_ESCAPE: help_ = false, session_.light = -1; break;
      case GLFW_KEY_TAB: chrome_ = static_cast<Chrome>((static_cast<int>(chrome_) + 1) % 3); break;
      case GLFW_KEY_F12: asked_shot_ = Numbered(".png"); break;
      case GLFW_KEY_F11: asked_shot_ = Numbered(".exr"); break;
      case GLFW_KEY_HOME: session_.exposure = 0.0; break;
      case GLFW_KEY_G: session_.gizmo = GizmoMode::kMove; break;
      case GLFW_KEY_R: session_.gizmo = GizmoMode::kTurn; break;
      case GLFW_KEY_S: session_.gizmo = GizmoMode::kScale; break;
      case GLFW_KEY_X: std::swap(session_.panes[0], session_.panes[1]); break;
      case GLFW_KEY_A: ExposeAutomatically(); break;
      case GLFW_KEY_K: KeepSnapshot(); break;
      case GLFW_KEY_F: {
        const auto [pane_origin, pane_size] = Pane(Mouse());
        const auto pixel = PixelAt((Mouse() - pane_origin) / pane_size);
        if (pixel && state_.pixels->position[*pixel].w != 0.0f) Focus(session_.scene.camera, glm::dvec3(state_.pixels->position[*pixel]));
        break;
      }
      default: break;
    }
  }

  // The brightest twentieth of what is shaded just below white.
  void ExposeAutomatically() {
    const ShadedVariant* shaded = Shown(0);
    if (shaded == nullptr || !shaded->image) return;
    const double bright = LuminancePercentile(*shaded->image, 0.95);
    if (bright > 0.0) session_.exposure = std::log2(0.8 / bright) - session_.scene.exposure;
  }

  // ---------------------------------------------------------------------------------------------- files

  // On the picture, and where the program was started from.
  void Say(const std::string& text, bool trouble = false) {
    fmt::print(Errors(), "{}\n", text);
    message_ = text;
    trouble_ = trouble;
    said_ = Clock::now();
    redraw_ = std::max(redraw_, 2);
  }

  void Drop(const fs::path& file) {
    const glm::dvec2 at = Mouse();
    const auto [pane_origin, pane_size] = Pane(at);
    const auto pixel = PixelAt((at - pane_origin) / pane_size);
    const int kind = pixel ? static_cast<int>(std::abs(state_.pixels->position[*pixel].w)) : 1;
    const int light = kind == 0 ? -1 : kind >= 2 ? kind - 2 : session_.light;
    try {
      if (kind != 0 && light < 0) throw InputError(fmt::format("{}: dropped on no light; expected one under it, or one that is selected", file.string()));
      const std::string name = light < 0 ? "" : session_.scene.lights[static_cast<std::size_t>(light)].name, path = session_.ImagePath(name, file);
      Read(file.filename().string(), [this, name, path, file]() -> std::function<void()> {
        return [this, name, path, file, image = LoadShownImage(file, name.empty())] {
          session_.ShowImage(name, path, image);
          Say(fmt::format("{} shows {}", name.empty() ? "the sky" : fmt::format("the light '{}'", name), file.filename().string()));
        };
      });
    } catch (const std::exception& error) {
      Say(error.what(), true);
    }
  }

  // What is broken is said once; the transforms that are built in remain.
  void ReadOcio() {
    try {
      ocio_ = OcioConfig::FromEnvironment();
      if (!ocio_ && options_.transform == "ocio") throw InputError("--transform ocio: no configuration; expected one that the environment variable OCIO names");
      if (ocio_ && options_.transform == "ocio") {
        session_.display.transform = ViewTransform::kOcio;
        session_.ocio_view = ocio_->views().front();
      }
    } catch (const InputError& error) {
      if (options_.frames > 0 && options_.transform == "ocio") throw;
      Say(error.what(), true);
    }
  }

  void BakeView() {
    if (session_.display.transform != ViewTransform::kOcio || session_.ocio_view == baked_view_) return;
    try {
      display_.SetViewTable(ocio_->Bake(session_.ocio_view));
      baked_view_ = session_.ocio_view;
    } catch (const std::exception& error) {
      session_.display.transform = ViewTransform::kSrgb;
      Say(error.what(), true);
    }
  }

  void Save() {
    try {
      session_.Save();
      watch_.Wrote(session_.scene.file);
      Say("saved " + session_.scene.file.string());
    } catch (const std::exception& error) {
      Say(error.what(), true);
    }
  }

  void Restore() {
    if (!session_.HasLeftBehind()) return Say("no earlier session left unsaved edits of this scene");
    try {
      session_.Restore();
      Say("unsaved edits brought back; Ctrl + Z undoes that");
    } catch (const std::exception& error) {
      Say(error.what(), true);
    }
  }

  // The first name that is free: gloss_0001.png.
  fs::path Numbered(const std::string& extension) const {
    for (int i = 1;; ++i) {
      fs::path name = fmt::format("{}_{:04}{}", session_.scene.name, i, extension);
      if (!fs::exists(name)) return name;
    }
  }

  void Shoot(const fs::path& file, glm::ivec2 framebuffer) {
    try {
      if (file.extension() == ".exr") {
        const ShadedVariant* shaded = Shown(0);
        if (shaded == nullptr || !shaded->image) throw InputError(fmt::format("{}: no picture; expected pane A to be shaded", file.string()));
        WriteExr(file, *shaded->image);
      } else {
        const auto width = static_cast<std::size_t>(framebuffer.x), height = static_cast<std::size_t>(framebuffer.y);
        std::vector<std::uint8_t> rows(3 * width * height), picture(rows.size());
        const GladGLContext& gl = window_.gl;
        gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
        gl.ReadBuffer(GL_BACK);
        gl.ReadPixels(0, 0, framebuffer.x, framebuffer.y, GL_RGB, GL_UNSIGNED_BYTE, rows.data());
        for (std::size_t y = 0; y < height; ++y) {
          std::copy_n(&rows[3 * width * (height - 1 - y)], 3 * width, &picture[3 * width * y]);
        }
        WritePngCodes(file, picture, framebuffer.x);
      }
      if (turntable_.empty()) Say("wrote " + file.string());
    } catch (const std::exception& error) {
      if (options_.frames > 0) throw;
      Say(error.what(), true);
    }
  }

  // For scripts: so many frames of the whole picture, the screenshot, and out.
  void Leave() {
    if (options_.frames <= 0 || !state_.full || state_.job != submitted_ || done_) return;
    if (!turntable_.empty()) return;
    redraw_ = std::max(redraw_, 1);
    if (++drawn_ < options_.frames) return;
    done_ = true;
    if (!options_.screenshot.empty()) wanted_shot_ = options_.screenshot;
    for (const ShadedVariant& variant : state_.variants) {
      if (!variant.error.empty()) throw InputError(variant.error);
    }
    if (!state_.error.empty()) throw InputError(state_.error);
  }

  void Type(int percent) {
    type_ = std::clamp(percent, kMinType, kMaxType);
    other_type_ = true;
  }

  // Type at the monitor's scale, as it says or, where it says nothing, by its height.
  void Scale() {
    float x = 1.0f, y = 1.0f;
    glfwGetWindowContentScale(window_.window, &x, &y);
    GLFWmonitor* monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode* mode = monitor == nullptr ? nullptr : glfwGetVideoMode(monitor);
    const float by_height = mode == nullptr ? 1.0f : static_cast<float>(mode->height) / kPlainHeight;
    unit_ = std::round(0.16f * static_cast<float>(type_) * std::clamp(std::max({x, y, by_height}), 0.5f, 4.0f));
    widgets::ApplyStyle(unit_);
  }

  const ViewOptions& options_;
  GlfwWindow& window_;
  Worker& worker_;
  Session& session_;
  Display display_;
  Watch watch_;
  Gizmo gizmo_;
  ViewState state_;
  std::unique_ptr<const OcioConfig> ocio_;  // null: none
  std::string baked_view_;
  std::optional<Inspector> inspector_;  // once a pixel was asked for
  Inspection inspection_;
  std::optional<CycleCounter> counter_;  // once cycles were asked for
  Cycles cycles_;
  std::map<std::string, std::vector<float>> history_;
  std::string counted_gpu_;
  std::uint64_t inspected_job_ = 0, counted_job_ = 0, costs_job_ = 0;
  glm::ivec2 inspected_pixel_{-1};
  std::deque<Reading> readings_;
  std::set<fs::path> changed_;      // on disk, and not read again yet
  fs::file_time_type begun_{};      // to be read: the last of the scene's files

  ViewJob last_;
  std::uint64_t submitted_ = 0, full_job_ = 0, shown_job_ = 0, library_ = 0;
  Clock::time_point submitted_at_{}, last_frame_{}, said_{}, autosaved_ = Clock::now();
  std::vector<std::pair<std::uint64_t, Clock::time_point>> waiting_;  // jobs whose picture is not yet seen, and their input
  Figures figures_;

  glm::dvec2 origin_{0.0}, size_{16.0};  // of the picture, in the window's units
  Drag drag_ = Drag::kNone;
  glm::dvec2 pressed_{0.0}, dragged_{0.0};
  std::string message_, told_;
  fs::path asked_shot_, wanted_shot_, turntable_;
  std::string title_;
  std::shared_ptr<const RadianceImage> floor_of_;
  double floor_ = 0.0;
  float unit_ = 16.0f;
  int redraw_ = 3, drawn_ = 0, turn_ = 0;
  int type_ = 100;
  // As the frames have taken them from the events.
  glm::dvec2 cursor_ = kNowhere;
  std::array<bool, 3> buttons_{};
  std::vector<Event> keys_;
  std::vector<std::string> dropped_;  // files
  bool shift_ = false;                // as a button went down last
  Chrome chrome_ = Chrome::kAll;
  bool was_measuring_ = false, other_type_ = false, help_ = false, trouble_ = false, done_ = false;
};

void Happened(Event event) {
  inputs.events.push_back(std::move(event));
  Noticed();
}

void WatchInputs(GLFWwindow* window) {
  glfwSetCursorPosCallback(window, [](GLFWwindow*, double x, double y) { Happened({.kind = Event::kMove, .place = {x, y}}); });
  glfwSetMouseButtonCallback(window, [](GLFWwindow*, int button, int action, int modifiers) {
    Happened({.kind = Event::kButton, .code = button, .action = action, .modifiers = modifiers});
  });
  glfwSetScrollCallback(window, [](GLFWwindow*, double x, double y) { Happened({.kind = Event::kWheel, .place = {x, y}}); });
  glfwSetKeyCallback(window, [](GLFWwindow*, int key, int scancode, int action, int modifiers) {
    Happened({.kind = Event::kKey, .code = key, .scancode = scancode, .action = action, .modifiers = modifiers});
  });
  glfwSetCharCallback(window, [](GLFWwindow*, unsigned character) { Happened({.kind = Event::kCharacter, .code = static_cast<int>(character)}); });
  glfwSetDropCallback(window, [](GLFWwindow*, int count, const char** files) {
    Happened({.kind = Event::kDrop, .files = {files, files + count}});
  });
  glfwSetCursorEnterCallback(window, [](GLFWwindow*, int entered) {
    if (entered == GLFW_FALSE) Happened({.kind = Event::kMove, .place = kNowhere});
  });
  glfwSetFramebufferSizeCallback(window, [](GLFWwindow*, int, int) { Noticed(); });
  glfwSetWindowRefreshCallback(window, [](GLFWwindow*) { inputs.any = true; });
  glfwSetWindowFocusCallback(window, [](GLFWwindow* focused, int focus) {
    ImGui_ImplGlfw_WindowFocusCallback(focused, focus);
    inputs.any = true;
  });
}

// The panes to begin with: those that were asked for, else LTC beside the truth.
void ChoosePanes(const ViewOptions& options, Session& session) {
  const ShaderLibrary library = options.shader_folder.empty() ? ShaderLibrary() : ShaderLibrary(options.shader_folder);
  const std::vector<Technique> techniques = LoadTechniques(library);
  for (const std::string& name : options.techniques) {
    if (name == kTruth) continue;
    const Variant variant = ParseVariant(techniques, name);
    if (const auto why = WhyUnsupported(variant, session.scene)) {
      throw InputError(fmt::format("{}: {}; expected a technique that supports the scene", session.scene.file.string(), *why));
    }
  }
  const char* const others[] = {"ltc", kTruth, "hill", "point"};
  std::vector<std::string> names = options.techniques;
  for (const char* other : others) {
    if (names.size() < 4 && std::find(names.begin(), names.end(), other) == names.end()) names.emplace_back(other);
  }
  for (std::size_t i = 0; i < 4; ++i) session.panes[i].name = names[std::min(i, names.size() - 1)];
  const std::vector<std::string> layouts{"single", "wipe", "difference", "flicker", "grid"};
  const std::size_t given = options.techniques.size();
  const std::string layout = !options.layout.empty() ? options.layout : given == 1 ? "single" : given > 2 ? "grid" : "wipe";
  session.layout = static_cast<Layout>(std::find(layouts.begin(), layouts.end(), layout) - layouts.begin());
  if (given > 2) session.grid_panes = static_cast<int>(std::min<std::size_t>(given, 4));
}

}  // namespace

void RunView(const ViewOptions& given) {
  Errors();  // before anything is read
  Remembered remembered = Remembered::Load();
  ViewOptions options = given;
  if (options.scene.empty()) options.scene = remembered.scene;
  if (options.scene.empty()) throw InputError("no scene; expected a built-in name, a scene file or a mesh, since none was open before");
  Opened opened = OpenScene(options.scene, options.cache);
  const fs::file_time_type begun = opened.begun;
  const GlfwLibrary glfw;
  Worker worker(options.context, options.shader_folder, [] { glfwPostEmptyEvent(); });
  Session session(std::move(opened));
  session.light = 0;  // its handles say what can be done; Escape puts them away
  session.navigation = static_cast<Navigation>(remembered.navigation);
  ChoosePanes(options, session);
  if (options.layout.empty() && options.techniques.empty() && remembered.layout >= 0) session.layout = static_cast<Layout>(remembered.layout);
  const std::string transforms[] = {"srgb", "aces", "neutral", "agx"};
  const auto transform = std::ranges::find(transforms, options.transform);
  if (transform != std::end(transforms)) session.display.transform = static_cast<ViewTransform>(transform - transforms);
  session.false_color = options.transform == "false";
  GlfwWindow window(options.size.value_or(remembered.size), session.scene.name + " … – AreaLab");
  WatchInputs(window.window);
  const ImGuiLibrary imgui(window.window);
  View view(options, window, worker, session, begun, remembered.type);
  view.Run();
  session.Autosave();  // what is unsaved now is offered at the next start
  if (options.frames > 0) return;  // a script's window is no habit of its user
  if (!options.size) glfwGetWindowSize(window.window, &remembered.size.x, &remembered.size.y);
  remembered.navigation = static_cast<int>(session.navigation);
  remembered.layout = static_cast<int>(session.layout);
  remembered.type = view.type();
  std::error_code error;
  remembered.scene = fs::exists(options.scene, error) ? fs::absolute(options.scene, error).string() : options.scene;
  remembered.Save();
}

}  // namespace arealab
