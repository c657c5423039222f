#include "compare/report.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <stdio.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "compare/claims.h"
#include "compare/image_files.h"
#include "compare/metrics.h"
#include "compare/page_data.h"
#include "compare/page_parts.h"
#include "compare/pareto.h"
#include "compare/results_json.h"
#include "glsl/shader_library.h"
#include "scenes/embedded.h"
#include "scenes/error.h"

namespace arealab {

namespace report_files {
extern const EmbeddedFile kFiles[];
extern const int kFileCount;
}  // namespace report_files
namespace plot_library {
extern const EmbeddedFile kFiles[];
}

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string_view ReportFile(std::string_view name) {
  for (int i = 0; i < report_files::kFileCount; ++i) {
    if (report_files::kFiles[i].name == name) return report_files::kFiles[i].bytes();
  }
  throw std::logic_error(fmt::format("compare/report/{} is not in the program; expected it embedded", name));
}

fs::path Normal(const fs::path& directory) {
  fs::path path = fs::absolute(directory).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();  // "out/"
  return path;
}

void WriteText(const fs::path& file, std::string_view text) {
  std::ofstream stream(file, std::ios::binary);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (!stream) throw InputError(fmt::format("{}: cannot write; expected a folder with room", file.string()));
}

std::string PartialPrefix(const fs::path& target) {
  return fmt::format(".{}.partial-", target.filename().string());
}

// Folders that an interrupted run left beside the target: those whose process is gone.
void RemoveStale(const fs::path& target) {
  const std::string prefix = PartialPrefix(target);
  std::error_code ignored;
  std::vector<fs::path> stale;
  for (const auto& entry : fs::directory_iterator(target.parent_path(), ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(prefix)) continue;
    const long process = std::strtol(name.c_str() + prefix.size(), nullptr, 10);
    if (process > 0 && kill(static_cast<pid_t>(process), 0) != 0 && errno == ESRCH)
      stale.push_back(entry.path());
  }
  for (const fs::path& folder : stale) fs::remove_all(folder, ignored);
}

// The folders that are being filled. Where a shader that never ends ends the program (glsl/shading_watch.h) they go too.
class PartialFolders {
 public:
  void Add(const fs::path& folder) {
    const std::lock_guard lock(mutex_);
    if (folders_.empty() && !registered_) registered_ = std::at_quick_exit([] { All().Remove(); }) == 0;
    folders_.insert(folder);
  }
  void Forget(const fs::path& folder) {
    const std::lock_guard lock(mutex_);
    folders_.erase(folder);
  }
  static PartialFolders& All() {
    static PartialFolders all;
    return all;
  }

 private:
  void Remove() {
    const std::lock_guard lock(mutex_);
    std::error_code ignored;
    for (const fs::path& folder : folders_) fs::remove_all(folder, ignored);
  }
  std::mutex mutex_;
  std::set<fs::path> folders_;
  bool registered_ = false;
};

// The folder that is being filled; removed again unless it was moved into place.
class PartialFolder {
 public:
  explicit PartialFolder(const fs::path& target)
      : target_(target), path_(target.parent_path() / fmt::format("{}{}", PartialPrefix(target), getpid())) {
    std::error_code error;
    fs::remove_all(path_, error);
    fs::create_directories(path_, error);
    if (error) {
      throw InputError(fmt::format("{}: cannot create ({}); expected a folder that may be written to",
                                   path_.string(), error.message()));
    }
    PartialFolders::All().Add(path_);
  }
  ~PartialFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
    PartialFolders::All().Forget(path_);
  }
  PartialFolder(const PartialFolder&) = delete;
  PartialFolder& operator=(const PartialFolder&) = delete;

  const fs::path& path() const { return path_; }

  // After this path() holds what was there before, if anything, and the destructor removes that.
  void MoveIntoPlace() {
    if (rename(path_.c_str(), target_.c_str()) == 0) return;  // nothing there, or an empty folder
    if (renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) == 0) return;
    // A file system without exchange: the old report steps aside first.
    const fs::path old = path_.string() + "-old";
    std::error_code error;
    fs::rename(target_, old, error);
    if (!error) fs::rename(path_, target_, error);
    if (error) {
      throw InputError(fmt::format("{}: cannot be replaced ({}); expected a folder that may be renamed",
                                   target_.string(), error.message()));
    }
    fs::remove_all(old, error);
  }

 private:
  fs::path target_, path_;
};

// File names from names that people gave: unique within `taken`.
std::string FileName(const std::string& name, std::set<std::string>* taken) {
  std::string file;
  for (char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view("+=@,._-").find(c) != std::string_view::npos;
    file += plain ? c : '_';
  }
  if (file.empty() || file[0] == '.') file = "_" + file;
  if (file.size() > 120) file.resize(120);
  std::string unique = file;
  for (int n = 2; !taken->insert(unique).second; ++n) unique = fmt::format("{}-{}", file, n);
  return unique;
}

// How a scene's values are rounded for its files; `truth` as it is stored, empty where there is none.
struct Rounding {
  float coarse_below = 0.0f;
  HalfImage truth;
};

// Half floats are finer in the dark than any map shows: below a quarter of the truth's mean luminance m their
// step at m/4 is kept, an error of at most 2⁻¹³ m. Where the truth alone would then take more than 0.5 bytes
// a pixel on the page (fine texture all over) it is the step at 4 m, 2⁻⁹ m.
constexpr double kCoarseBelow = 1.0 / 4.0, kCoarsest = 4.0, kBytesPerPixel = 0.5;
constexpr int kTruthBits = 3;           // steps of 0.8 %: below what a picture shows; differences to it are kept finer
constexpr double kSmallFile = 65536.0;  // bytes; never worth it

Rounding ChooseRounding(const SceneResult& scene, double mean_luminance) {
  Rounding rounding;
  if (!scene.truth) return rounding;
  for (double below : {kCoarseBelow, kCoarsest}) {
    rounding.coarse_below = static_cast<float>(below * mean_luminance);
    rounding.truth = ToHalf(*scene.truth, rounding.coarse_below);
    DropBits(rounding.truth, kTruthBits);
    if (below == kCoarsest) break;
    const double bytes = static_cast<double>(EncodePageImage({}, rounding.truth).size());
    if (bytes <= std::max(kSmallFile, kBytesPerPixel * static_cast<double>(scene.truth->size()))) break;
  }
  return rounding;
}

// One picture's files.
struct Job {
  enum class Kind { kTruth, kShadowed, kVariant, kEmission };
  const SceneResult* scene;
  const Rounding* rounding;
  std::shared_ptr<const RadianceImage> image;
  std::string folder, stem;
  Kind kind;
  const VariantResult* variant;  // whose picture it is, if any's
};

// What is far off needs fewer digits: a variant's values are kept to at most 1/8 of its own relative RMSE,
// which moves them by a thirtieth of that (uniform: step/√12), and in steps of at most the truth's. Wider steps make larger
// files: what is left beside the truth is then less smooth.
int DroppedBits(const VariantResult& variant) {
  const double error = variant.total.rel_rmse;
  if (!(error > 0.0)) return 0;
  return std::clamp(static_cast<int>(std::floor(std::log2(std::min(error, 100.0) / 8.0 * 1024.0))), 0, kTruthBits);
}

constexpr int kThumbnailSide = 192;  // pixels at most: what the page gives it

// The picture averaged over squares of pixels until its width is a thumbnail's.
void WriteThumbnail(const fs::path& file, const std::vector<glm::vec3>& picture, int width, double exposure) {
  const int block = std::max(1, (width + kThumbnailSide - 1) / kThumbnailSide);
  const int height = static_cast<int>(picture.size()) / width;
  const int columns = width / block, rows = std::max(1, height / block);
  std::vector<glm::vec3> small;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      glm::vec3 sum(0.0f);
      int count = 0;
      for (int y = row * block; y < std::min((row + 1) * block, height); ++y) {
        for (int x = column * block; x < (column + 1) * block; ++x, ++count) {
          sum += picture[static_cast<std::size_t>(y * width + x)];
        }
      }
      small.push_back(sum / static_cast<float>(count));
    }
  }
  WritePng(file, small, columns, exposure);
}

// Whose error it is, pixel by pixel: the largest of each square of pixels, on a logarithmic scale from 1e-7 to 1.
void WriteSplitMaps(const fs::path& images, const std::string& stem, const ErrorSplit& split, int width) {
  const int block = std::max(1, (width + kThumbnailSide - 1) / kThumbnailSide), columns = width / block;
  for (const ErrorSplit::Map& map : split.maps) {
    const int rows = static_cast<int>(map.magnitude.size()) / width / block;
    std::vector<Rgb> pixels;
    for (int i = 0; i < rows * columns; ++i) {
      float most = 0.0f;
      for (int y = i / columns * block; y < (i / columns + 1) * block; ++y) {
        for (int x = i % columns * block; x < (i % columns + 1) * block; ++x) {
          const float m = map.magnitude[static_cast<std::size_t>(y * width + x)];
          most = std::isfinite(m) && std::isfinite(most) ? std::max(most, m) : std::numeric_limits<float>::infinity();
        }
      }
      pixels.push_back(std::isfinite(most) ? Color(kMagnitude, 1.0 + std::log10(std::max(static_cast<double>(most), 1e-7)) / 7.0) : Rgb{255, 0, 255});
    }
    WriteText(images / fmt::format("{}-{}.png", stem, map.name), PngBytes(pixels, columns));
  }
  // By cause, signed: on each side of 0 logarithmic from 1e-6 to 1; of each square the pixel that is farthest from 0.
  for (const ErrorSplit::Cause& cause : split.causes) {
    const int rows = static_cast<int>(cause.relative.size()) / width / block;
    std::vector<Rgb> pixels;
    for (int i = 0; i < rows * columns; ++i) {
      double most = 0.0;
      bool finite = true;
      for (int y = i / columns * block; y < (i / columns + 1) * block; ++y) {
        for (int x = i % columns * block; x < (i % columns + 1) * block; ++x) {
          const auto e = static_cast<double>(cause.relative[static_cast<std::size_t>(y * width + x)]);
          finite = finite && std::isfinite(e);
          if (std::abs(e) > std::abs(most)) most = e;
        }
      }
      const double tone = std::clamp(1.0 + std::log10(std::max(std::abs(most), 1e-6)) / 6.0, 0.0, 1.0);
      pixels.push_back(finite ? Color(kSigned, 0.5 + std::copysign(0.5 * tone, most)) : Rgb{255, 0, 255});
    }
    WriteText(images / fmt::format("{}-cause-{}.png", stem, cause.name), PngBytes(pixels, columns));
  }
}

// Steps of sixteen in half bits between the shadowed truth and the unshadowed one: at most eight bits' error,
// 0.4 to 0.8 %, below the shadowed truth's own, and half of the bytes.
void Coarsen(HalfImage& shadowed, const HalfImage& truth) {
  if (shadowed.exponent != truth.exponent) return;
  for (std::size_t plane = 0; plane < shadowed.planes.size(); ++plane) {
    for (std::size_t i = 0; i < shadowed.planes[plane].size(); ++i) {
      std::uint16_t& value = shadowed.planes[plane][i];
      const int base = truth.planes[plane][i], lost = base - value;
      if (value != 0 && lost > 0)
        value = static_cast<std::uint16_t>(std::max(base - (lost + 8) / 16 * 16, 0));
    }
  }
}

void WriteImages(const Job& job, const fs::path& root) {
  const SceneResult& scene = *job.scene;
  const Rounding& rounding = *job.rounding;
  const std::string key = job.folder + "/" + job.stem;
  HalfImage half;
  if (job.kind == Job::Kind::kTruth) {
    half = rounding.truth;
  } else if (scene.truth && job.kind != Job::Kind::kEmission) {
    half = ToHalf(*job.image, rounding.coarse_below, *scene.truth, rounding.truth);
    if (job.kind == Job::Kind::kShadowed) Coarsen(half, rounding.truth);
    if (job.variant) DropBits(half, DroppedBits(*job.variant));
  } else {
    half = ToHalf(*job.image);
  }
  const bool beside_truth = job.kind == Job::Kind::kShadowed || job.kind == Job::Kind::kVariant;
  WriteText(root / "data" / job.folder / (job.stem + ".js"),
            EncodePageImage(key, half, beside_truth && scene.truth ? &rounding.truth : nullptr));
  if (job.kind == Job::Kind::kEmission) return;
  const fs::path images = root / "images" / job.folder;
  WriteExr(images / (job.stem + ".exr"), half, ExrLoss::kForTheEye);
  const std::span<const glm::vec3> emission =
      scene.emission ? std::span<const glm::vec3>(*scene.emission) : std::span<const glm::vec3>();
  WriteThumbnail(images / (job.stem + ".png"), Picture(*job.image, emission), scene.width, scene.exposure);
}

// The luminance below which a relative difference is taken relative to this instead: 1 % of the truth's mean
// over the pixels that it lights.
double Floor(const std::vector<glm::vec3>& truth) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const glm::vec3& v : truth) {
    const double luminance = Luminance(v);
    if (!std::isfinite(luminance) || v == glm::vec3(0.0f)) continue;
    sum += luminance;
    ++count;
  }
  return count == 0 ? 0.0 : 0.01 * sum / static_cast<double>(count);
}

// One scale for all maps of a scene: the 1-2-5 step above the median, over the variants that are ranked, of
// the relative difference that 95 % of their lit pixels stay below.
double MapScale(const SceneResult& scene, const std::vector<glm::vec3>& truth, double floor) {
  std::vector<double> levels;
  for (const VariantResult& variant : scene.variants) {
    if (!variant.image || variant.within_truth_error) continue;
    std::vector<double> differences;
    for (std::size_t i = 0; i < truth.size(); i += 3) {
      const double b = Luminance(truth[i]), denominator = std::max(b, floor);
      if (denominator <= 0.0 || truth[i] == glm::vec3(0.0f)) continue;
      const double d = std::abs(Luminance(variant.image->Total(i)) - b) / denominator;
      if (std::isfinite(d)) differences.push_back(d);
    }
    if (differences.empty()) continue;
    const auto level = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() * 95 / 100);
    std::nth_element(differences.begin(), level, differences.end());
    levels.push_back(*level);
  }
  double typical = 0.1;
  if (!levels.empty()) {
    std::nth_element(levels.begin(), levels.begin() + static_cast<std::ptrdiff_t>(levels.size() / 2),
                     levels.end());
    typical = levels[levels.size() / 2];
  }
  const double exponent = std::floor(std::log10(std::clamp(typical, 1e-4, 1.0)));
  for (double step : {1.0, 2.0, 5.0}) {
    if (typical <= step * std::pow(10.0, exponent) * (1.0 + 1e-9)) return step * std::pow(10.0, exponent);
  }
  return std::min(std::pow(10.0, exponent + 1.0), 1.0);
}

// Nothing where fewer than two variants have both figures.
void WritePlot(const fs::path& file, std::span<const SceneResult> scenes, bool software) {
  const ParetoPlot plot = MakeParetoPlot(scenes, software);
  if (plot.marks.size() > 1) WriteText(file, ParetoSvg(plot));
}

std::string Substitute(std::string text, std::string_view mark, std::string_view value) {
  const std::size_t at = text.find(mark);
  if (at == std::string::npos)
    throw std::logic_error(fmt::format("index.html lacks {}; expected it once", mark));
  return text.replace(at, mark.size(), value);
}

}  // namespace

void CheckReportDirectory(const fs::path& directory) {
  const fs::path target = Normal(directory);
  std::error_code error;
  if (fs::exists(target, error)) {
    if (!fs::is_directory(target, error)) {
      throw InputError(
          fmt::format("{}: is a file; expected a new folder or an earlier report", target.string()));
    }
    if (!fs::is_empty(target, error) &&
        !(fs::exists(target / "results.json", error) && fs::exists(target / "index.html", error))) {
      throw InputError(fmt::format("{}: holds something else; expected a new folder or an earlier report",
                                   target.string()));
    }
    if (error) throw InputError(fmt::format("{}: {}; expected a folder", target.string(), error.message()));
  }
  fs::create_directories(target.parent_path(), error);
  if (error || access(target.parent_path().c_str(), W_OK) != 0) {
    throw InputError(fmt::format("{}: cannot be written to; expected a folder for the report {}",
                                 target.parent_path().string(), target.filename().string()));
  }
}

// What the page must know of a scene's pictures.
struct ReportWriter::Pictures {
  std::string folder;
  bool truth = false, shadowed = false, emission = false;
  std::vector<std::optional<std::string>> stems;  // of the variants' files
  double floor_total = 0.0, floor_diffuse = 0.0, floor_specular = 0.0;
  double scale = 0.1, coarse_below = 0.0;

  void Describe(Json& scene) const {
    const auto stem = [](bool present, const char* name) { return present ? Json(name) : Json(nullptr); };
    scene["folder"] = folder;
    scene["truth"]["stem"] = stem(truth, "truth");
    if (!scene["truth"]["shadow"].is_null()) scene["truth"]["shadow"]["stem"] = stem(shadowed, "truth-shadowed");
    for (std::size_t v = 0; v < stems.size(); ++v) {
      scene["variants"][v]["stem"] = stems[v] ? Json(*stems[v]) : Json(nullptr);
    }
    scene["emission"] = emission;
    scene["floor"] = {{"total", floor_total}, {"diffuse", floor_diffuse}, {"specular", floor_specular}};
    scene["scale"] = scale;
    // What the files' rounding may amount to where the picture is darker than that.
    if (truth) scene["coarse_below"] = coarse_below;
  }
};

struct ReportWriter::State {
  explicit State(const fs::path& directory) : partial(Normal(directory)) {}

  PartialFolder partial;
  std::set<std::string> folders;
  std::vector<Pictures> scenes;
};

ReportWriter::ReportWriter(const fs::path& directory) {
  CheckReportDirectory(directory);
  RemoveStale(Normal(directory));
  state_ = std::make_unique<State>(directory);
}

ReportWriter::~ReportWriter() = default;

void ReportWriter::Add(const SceneResult& scene) {
  const fs::path& root = state_->partial.path();
  Pictures pictures;
  pictures.folder = FileName(scene.name, &state_->folders);
  fs::create_directories(root / "images" / pictures.folder);
  fs::create_directories(root / "data" / pictures.folder);
  Rounding rounding;
  if (scene.truth) {
    const std::vector<glm::vec3> total = TotalRadiance(*scene.truth);
    pictures.floor_total = Floor(total);
    pictures.floor_diffuse = Floor(scene.truth->diffuse);
    pictures.floor_specular = Floor(scene.truth->specular);
    pictures.scale = MapScale(scene, total, pictures.floor_total);
    rounding = ChooseRounding(scene, 100.0 * pictures.floor_total);
    pictures.coarse_below = static_cast<double>(rounding.coarse_below);
  }
  std::vector<Job> jobs;
  const auto add = [&](std::shared_ptr<const RadianceImage> image, const std::string& stem, Job::Kind kind,
                       const VariantResult* variant = nullptr) {
    jobs.push_back({&scene, &rounding, std::move(image), pictures.folder, stem, kind, variant});
  };
  std::set<std::string> taken = {"truth", "truth-shadowed", "emission"};
  pictures.truth = scene.truth != nullptr;
  if (pictures.truth) add(scene.truth, "truth", Job::Kind::kTruth);
  pictures.shadowed = pictures.truth && scene.shadow && scene.shadow->image;
  if (pictures.shadowed) add(scene.shadow->image, "truth-shadowed", Job::Kind::kShadowed);
  for (const VariantResult& variant : scene.variants) {
    const std::string stem = FileName(variant.name, &taken);
    pictures.stems.push_back(variant.image ? std::optional(stem) : std::nullopt);
    if (variant.image) add(variant.image, stem, Job::Kind::kVariant, &variant);
    WriteSplitMaps(root / "images" / pictures.folder, stem, variant.split, scene.width);
  }
  pictures.emission = scene.emission != nullptr;
  if (pictures.emission) {
    auto image = std::make_shared<RadianceImage>();
    image->width = scene.width;
    image->height = scene.height;
    image->diffuse = *scene.emission;
    image->specular.assign(scene.emission->size(), glm::vec3(0.0f));
    add(image, "emission", Job::Kind::kEmission);
  }

  tbb::parallel_for(std::size_t{0}, jobs.size(), [&](std::size_t i) { WriteImages(jobs[i], root); });
  state_->scenes.push_back(std::move(pictures));
}

void ReportWriter::Finish(const Results& results) {
  const fs::path& root = state_->partial.path();
  Json page = ResultsObject(results);
  page["sources"] = Json::array();
  for (const ClaimSource& source : ClaimSources()) page["sources"].push_back(source.citation);
  page["fit"] = Json::parse(ShaderLibrary().Find("tables/quality.json").value());
  for (const ClaimsPage& claims : results.claims) WriteText(root / fmt::format("claims-{}.html", claims.name), claims.html);
  if (!results.hard_cases.html.empty()) WriteText(root / "hard-cases.html", results.hard_cases.html);
  fs::create_directories(root / "plots");
  for (std::size_t s = 0; s < state_->scenes.size(); ++s) {
    const Pictures& pictures = state_->scenes[s];
    pictures.Describe(page["scenes"][s]);
    WritePlot(root / "plots" / (pictures.folder + ".svg"), std::span(results.scenes).subspan(s, 1), results.software);
  }
  // No scene's folder has a blank.
  if (results.scenes.size() > 1) WritePlot(root / "plots" / "all scenes.svg", results.scenes, results.software);

  WriteText(root / "results.json", ResultsJson(results));
  WriteText(root / "results.csv", ResultsCsv(results));
  std::string html(ReportFile("index.html"));
  html = Substitute(std::move(html), "/*arealab:css*/", ReportFile("report.css"));
  html = Substitute(std::move(html), "/*arealab:d3*/", plot_library::kFiles[0].bytes());
  html = Substitute(std::move(html), "/*arealab:pareto*/", ReportFile("pareto.js"));
  html = Substitute(std::move(html), "/*arealab:js*/", ReportFile("report.js"));
  html = Substitute(std::move(html), "{\"arealab\": \"results\"}",
                    ScriptSafe(page.dump(-1, ' ', false, Json::error_handler_t::replace)));
  WriteText(root / "index.html", html);
  state_->partial.MoveIntoPlace();
}

void WriteReport(const Results& results, const fs::path& directory) {
  ReportWriter writer(directory);
  for (const SceneResult& scene : results.scenes) writer.Add(scene);
  writer.Finish(results);
}

std::string SweepPage(const std::string& results) {
  std::string html(ReportFile("sweep.html"));
  html = Substitute(std::move(html), "/*arealab:css*/", ReportFile("report.css"));
  html = Substitute(std::move(html), "/*arealab:d3*/", plot_library::kFiles[0].bytes());
  html = Substitute(std::move(html), "/*arealab:js*/", ReportFile("sweep.js"));
  return Substitute(std::move(html), "{\"arealab\": \"results\"}", results);
}

}  // namespace arealab
