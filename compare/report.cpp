#include "compare/report.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <stdio.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "compare/image_files.h"
#include "compare/metrics.h"
#include "compare/page_data.h"
#include "compare/pareto.h"
#include "compare/results_json.h"
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
  }
  ~PartialFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
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
// step at m/4 is kept, an error of at most 2⁻¹³ m. Where the truth alone would still take more than 0.9 bytes
// a pixel on the page (fine texture all over) the step is doubled until it does not, at most to 2⁻⁸ m.
constexpr double kCoarseBelow = 1.0 / 4.0, kCoarsest = 4.0, kBytesPerPixel = 0.5;
constexpr int kTruthBits = 3;           // steps of 0.8 %: below what a picture shows; differences to it are kept finer
constexpr double kSmallFile = 65536.0;  // bytes; never worth it

Rounding ChooseRounding(const SceneResult& scene, double mean_luminance) {
  Rounding rounding;
  if (!scene.truth) return rounding;
  for (double below = kCoarseBelow; below <= kCoarsest; below *= 2.0) {
    rounding.coarse_below = static_cast<float>(below * mean_luminance);
    rounding.truth = ToHalf(*scene.truth, rounding.coarse_below);
    DropBits(rounding.truth, kTruthBits);
    const double bytes = static_cast<double>(EncodePageImage({}, rounding.truth).size());
    if (bytes <= std::max(kSmallFile, kBytesPerPixel * static_cast<double>(scene.truth->size()))) break;
  }
  return rounding;
}

// One picture's files.
struct Job {
  const SceneResult* scene;
  const Rounding* rounding;
  std::shared_ptr<const RadianceImage> image;
  std::string folder, stem;
  bool emission_only = false, shadowed = false;
  const VariantResult* variant = nullptr;  // whose picture it is, if any's
};

// What is far off needs fewer digits: a variant's values are kept to at most 1/8 of its own relative RMSE,
// which moves them by a thirtieth of that (uniform: step/√12), and in steps of at most 2^(most_bits − 10).
int DroppedBits(const VariantResult& variant, int most_bits) {
  const double error = variant.total.rel_rmse;
  if (!(error > 0.0)) return 0;
  return std::clamp(static_cast<int>(std::floor(std::log2(std::min(error, 100.0) / 8.0 * 1024.0))), 0,
                    most_bits);
}

// What the folder may take at 512×512, and the steps that are tried for it: 0.8 % is below what any map shows
// by default, 3 % is seen as bands.
constexpr double kMostBytes = 56e6;
constexpr int kFewestBits = 3, kMostBits = 5;
constexpr std::size_t kSampleStride = 12;

double BytesIn(const fs::path& folder) {
  double bytes = 0.0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
  }
  return bytes;
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

void WriteImages(const Job& job, int most_bits, const fs::path& root) {
  const SceneResult& scene = *job.scene;
  const Rounding& rounding = *job.rounding;
  const std::string key = job.folder + "/" + job.stem;
  const fs::path script = root / "data" / job.folder / (job.stem + ".js");
  if (job.emission_only) {
    WriteText(script, EncodePageImage(key, ToHalf(*job.image)));
    return;
  }
  HalfImage half;
  if (job.image == scene.truth) {
    half = rounding.truth;
    WriteText(script, EncodePageImage(key, half));
  } else if (scene.truth) {
    half = ToHalf(*job.image, rounding.coarse_below, *scene.truth, rounding.truth);
    if (job.shadowed) Coarsen(half, rounding.truth);
    if (job.variant) DropBits(half, DroppedBits(*job.variant, most_bits));
    WriteText(script, EncodePageImage(key, half, &rounding.truth));
  } else {
    half = ToHalf(*job.image);
    WriteText(script, EncodePageImage(key, half));
  }
  const fs::path images = root / "images" / job.folder;
  WriteExr(images / (job.stem + ".exr"), half, ExrLoss::kForTheEye);
  const std::span<const glm::vec3> emission =
      scene.emission ? std::span<const glm::vec3>(*scene.emission) : std::span<const glm::vec3>();
  WriteThumbnail(images / (job.stem + ".png"), Picture(FromHalf(half), emission), scene.width,
                 scene.exposure);
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

void WriteReport(const Results& results, const fs::path& directory,
                 const std::function<void(double)>& progress) {
  CheckReportDirectory(directory);
  const fs::path target = Normal(directory);
  RemoveStale(target);
  PartialFolder partial(target);

  Json page = ResultsObject(results);
  std::vector<Job> jobs;
  std::set<std::string> folders;
  std::vector<Rounding> roundings(results.scenes.size());
  tbb::parallel_for(std::size_t{0}, results.scenes.size(), [&](std::size_t s) {
    const SceneResult& scene = results.scenes[s];
    if (scene.truth) roundings[s] = ChooseRounding(scene, 100.0 * Floor(TotalRadiance(*scene.truth)));
  });
  for (std::size_t s = 0; s < results.scenes.size(); ++s) {
    const SceneResult& scene = results.scenes[s];
    Json& scene_json = page["scenes"][s];
    const std::string folder = FileName(scene.name, &folders);
    scene_json["folder"] = folder;
    fs::create_directories(partial.path() / "images" / folder);
    fs::create_directories(partial.path() / "data" / folder);
    std::set<std::string> stems = {"truth", "truth-shadowed", "emission"};
    if (scene.truth) jobs.push_back({&scene, &roundings[s], scene.truth, folder, "truth"});
    scene_json["truth"]["stem"] = scene.truth ? Json("truth") : Json(nullptr);
    if (scene.shadow) {
      const bool present = scene.truth && scene.shadow->image;
      scene_json["truth"]["shadow"]["stem"] = present ? Json("truth-shadowed") : Json(nullptr);
      if (present) {
        jobs.push_back({&scene, &roundings[s], scene.shadow->image, folder, "truth-shadowed", false, true});
      }
    }
    for (std::size_t v = 0; v < scene.variants.size(); ++v) {
      const VariantResult& variant = scene.variants[v];
      const std::string stem = FileName(variant.name, &stems);
      scene_json["variants"][v]["stem"] = variant.image ? Json(stem) : Json(nullptr);
      if (variant.image) {
        jobs.push_back({&scene, &roundings[s], variant.image, folder, stem, false, false, &variant});
      }
    }
    scene_json["emission"] = scene.emission != nullptr;
    if (scene.emission) {
      auto image = std::make_shared<RadianceImage>();
      image->width = scene.width;
      image->height = scene.height;
      image->diffuse = *scene.emission;
      image->specular.assign(scene.emission->size(), glm::vec3(0.0f));
      jobs.push_back({&scene, &roundings[s], image, folder, "emission", true});
    }
    if (scene.truth) {
      const std::vector<glm::vec3> total = TotalRadiance(*scene.truth);
      const double floor = Floor(total);
      scene_json["floor"] = {{"total", floor},
                             {"diffuse", Floor(scene.truth->diffuse)},
                             {"specular", Floor(scene.truth->specular)}};
      scene_json["scale"] = MapScale(scene, total, floor);
      // What the files' rounding may amount to where the picture is darker than that.
      scene_json["coarse_below"] = static_cast<double>(roundings[s].coarse_below);
    } else {
      scene_json["floor"] = {{"total", 0.0}, {"diffuse", 0.0}, {"specular", 0.0}};
      scene_json["scale"] = 0.1;
    }
  }

  std::mutex mutex;
  std::size_t done = 0;
  double most_bytes = 0.0;
  for (const SceneResult& scene : results.scenes) {
    most_bytes = std::max(most_bytes, kMostBytes * scene.width * scene.height / (512.0 * 512.0));
  }
  // Every twelfth picture tells how many bits to spare before all are written.
  const auto write = [&](std::size_t stride, int most_bits) {
    tbb::parallel_for(std::size_t{0}, (jobs.size() + stride - 1) / stride, [&](std::size_t i) {
      WriteImages(jobs[stride * i], most_bits, partial.path());
      const std::lock_guard lock(mutex);
      ++done;
      if (progress && stride == 1) progress(static_cast<double>(done) / static_cast<double>(jobs.size()));
    });
  };
  int most_bits = kFewestBits;
  for (; most_bits < kMostBits; ++most_bits) {
    write(kSampleStride, most_bits);
    if (static_cast<double>(kSampleStride) * BytesIn(partial.path()) <= most_bytes) break;
  }
  done = 0;
  write(1, most_bits);

  fs::create_directories(partial.path() / "plots");
  for (std::size_t s = 0; s < results.scenes.size(); ++s) {
    WritePlot(partial.path() / "plots" / (page["scenes"][s]["folder"].get<std::string>() + ".svg"),
              std::span(results.scenes).subspan(s, 1), results.software);
  }
  // No scene's folder has a blank.
  if (results.scenes.size() > 1) WritePlot(partial.path() / "plots" / "all scenes.svg", results.scenes, results.software);

  WriteText(partial.path() / "results.json", ResultsJson(results));
  WriteText(partial.path() / "results.csv", ResultsCsv(results));
  std::string html(ReportFile("index.html"));
  html = Substitute(std::move(html), "/*arealab:css*/", ReportFile("report.css"));
  html = Substitute(std::move(html), "/*arealab:d3*/", plot_library::kFiles[0].bytes());
  html = Substitute(std::move(html), "/*arealab:pareto*/", ReportFile("pareto.js"));
  html = Substitute(std::move(html), "/*arealab:js*/", ReportFile("report.js"));
  html = Substitute(std::move(html), "{\"arealab\": \"results\"}",
                    ScriptSafe(page.dump(-1, ' ', false, Json::error_handler_t::replace)));
  WriteText(partial.path() / "index.html", html);
  partial.MoveIntoPlace();
}

std::string SweepPage(const std::string& results) {
  std::string html(ReportFile("sweep.html"));
  html = Substitute(std::move(html), "/*arealab:css*/", ReportFile("report.css"));
  html = Substitute(std::move(html), "/*arealab:d3*/", plot_library::kFiles[0].bytes());
  html = Substitute(std::move(html), "/*arealab:js*/", ReportFile("sweep.js"));
  return Substitute(std::move(html), "{\"arealab\": \"results\"}", results);
}

}  // namespace arealab
