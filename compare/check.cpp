#include "compare/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "compare/harness.h"
#include "compare/image_files.h"
#include "compare/metrics.h"
#include "compare/shadowed_truth.h"
#include "compare/truth.h"
#include "glsl/renderer.h"
#include "scenes/bake.h"
#include "scenes/error.h"
#include "scenes/replace_file.h"

namespace arealab {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kSchema = 1;
const char* const kBandsFile = "bands.json";
const std::array<const char*, 3> kLobes{"total", "diffuse", "specular"};

// Of total, diffuse, specular.
using Bands = std::array<Band, 3>;
using BandsByScene = std::map<std::string, std::map<std::string, Bands>>;

// A figure as bands.json keeps it: 4 digits, and nothing below 1e-6, which is the rounding of float sums.
double Rounded(double value) {
  if (!std::isfinite(value)) return kNotMeasured;
  return std::stod(fmt::format("{:.4g}", std::round(value * 1e6) * 1e-6));
}

std::string Figure(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : "none";
}

int CountText(std::string_view text, std::size_t end) {
  return 1 +
         static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
}

struct BandsFile {
  std::string renderer;
  BandsByScene scenes;
};

Band ReadBand(const Json& json) {
  if (json.is_null()) return {};
  const auto figures = json.get<std::array<double, 3>>();
  return {figures[0], figures[1], figures[2]};
}

// Nothing where there is no file.
std::optional<BandsFile> ReadBands(const fs::path& folder, glm::ivec2 size, bool update) {
  const fs::path file = folder / kBandsFile;
  if (!fs::exists(file)) return std::nullopt;
  std::ifstream stream(file, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  BandsFile bands;
  try {
    const Json json = Json::parse(text.str());
    if (json.at("schema").get<int>() != kSchema) {
      throw InputError(
          fmt::format("{}:1: schema {}; expected {}", file.string(), json.at("schema").dump(), kSchema));
    }
    const glm::ivec2 stored(json.at("width").get<int>(), json.at("height").get<int>());
    if (stored != size && !update) {
      throw InputError(fmt::format("{}:1: goldens of {}x{}; expected {}x{}, which --update makes",
                                   file.string(), stored.x, stored.y, size.x, size.y));
    }
    bands.renderer = json.at("renderer").get<std::string>();
    for (const auto& [scene, variants] : json.at("scenes").items()) {
      for (const auto& [variant, lobes] : variants.items()) {
        Bands& entry = bands.scenes[scene][variant];
        for (std::size_t lobe = 0; lobe < kLobes.size(); ++lobe)
          entry[lobe] = ReadBand(lobes.at(kLobes[lobe]));
      }
    }
  } catch (const Json::parse_error& error) {
    throw InputError(fmt::format("{}:{}: not JSON; expected what `arealab check --update` writes",
                                 file.string(),
                                 CountText(text.str(), std::min(error.byte, text.str().size()))));
  } catch (const Json::exception& error) {
    throw InputError(
        fmt::format("{}:1: {}; expected what `arealab check --update` writes", file.string(), error.what()));
  }
  return bands;
}

// One line per variant, so that a change reads as one.
std::string BandsText(const BandsFile& bands, glm::ivec2 size) {
  std::string text = fmt::format(
      "{{\n  \"schema\": {},\n"
      "  \"about\": \"relative RMSE against the truth: [low, measured, high]; made by arealab check "
      "--update\",\n"
      "  \"width\": {},\n  \"height\": {},\n  \"renderer\": {},\n  \"scenes\": {{",
      kSchema, size.x, size.y, Json(bands.renderer).dump(-1, ' ', false, Json::error_handler_t::replace));
  const char* scene_comma = "\n";
  for (const auto& [scene, variants] : bands.scenes) {
    text += fmt::format("{}    {}: {{", scene_comma, Json(scene).dump());
    scene_comma = ",\n";
    const char* comma = "\n";
    for (const auto& [variant, lobes] : variants) {
      Json row;
      for (std::size_t lobe = 0; lobe < kLobes.size(); ++lobe) {
        const Band& band = lobes[lobe];
        row[kLobes[lobe]] =
            std::isfinite(band.measured) ? Json{band.low, band.measured, band.high} : Json(nullptr);
      }
      text += fmt::format("{}      {}: {}", comma, Json(variant).dump(), row.dump());
      comma = ",\n";
    }
    text += "\n    }";
  }
  return text + "\n  }\n}\n";
}

void MakeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw InputError(fmt::format("{}: cannot be made ({}); expected a folder that may be written to",
                                 folder.string(), error.message()));
  }
}

void WriteBands(const fs::path& folder, const BandsFile& bands, glm::ivec2 size) {
  ReplaceFile(folder / kBandsFile, BandsText(bands, size));
}

bool SameBits(const RadianceImage& a, const RadianceImage& b) {
  return a.width == b.width && a.height == b.height && a.diffuse == b.diffuse && a.specular == b.specular;
}

std::optional<CheckFailure> TestFinite(const RadianceImage& image, const char* which) {
  const int count = CountNonfinitePixels(image);
  if (count == 0) return std::nullopt;
  std::size_t first = 0;
  const auto finite = [](const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  };
  while (finite(image.diffuse[first]) && finite(image.specular[first])) ++first;
  const std::size_t width = static_cast<std::size_t>(image.width);
  return CheckFailure{CheckKind::kNonfinite,
                      fmt::format("{} {} of {} NaN or Inf, the first at ({}, {})", count,
                                  count == 1 ? "pixel" : "pixels", which, first % width, first / width)};
}

// One lobe of an image against its golden's.
struct LobeScale {
  double floor, peak;
};

LobeScale ScaleOf(const std::vector<glm::vec3>& golden, double relative_floor, int exponent) {
  double sum = 0.0, peak = 0.0;
  std::size_t count = 0;
  for (const glm::vec3& v : golden) {
    for (int c = 0; c < 3; ++c) {
      const double value = std::abs(static_cast<double>(v[c]));
      if (value == 0.0) continue;
      sum += value;
      peak = std::max(peak, value);
      ++count;
    }
  }
  const double mean = count == 0 ? 0.0 : sum / static_cast<double>(count);
  // Below the smallest normal half, 2⁻¹⁴, the stored value has no relative precision.
  const double floor = std::max(relative_floor * mean, std::ldexp(1.0, exponent - 14));
  return {floor, std::max(peak, floor)};
}

struct GoldenDifference {
  int over = 0, lit = 0;
  double worst = 0.0, hardest = 0.0;  // relative to the value; to the lobe's peak
  std::size_t worst_pixel = 0, hardest_pixel = 0;
};

GoldenDifference Difference(const RadianceImage& image, const RadianceImage& golden,
                            const GoldenTolerance& tolerance) {
  const int exponent = ToHalf(golden).exponent;
  const std::array<LobeScale, 2> scales{ScaleOf(golden.diffuse, tolerance.floor, exponent),
                                        ScaleOf(golden.specular, tolerance.floor, exponent)};
  GoldenDifference found;
  for (std::size_t i = 0; i < golden.size(); ++i) {
    double relative = 0.0, hard = 0.0;
    bool lit = false;
    for (std::size_t lobe = 0; lobe < 2; ++lobe) {
      const glm::dvec3 a = lobe == 0 ? image.diffuse[i] : image.specular[i];
      const glm::dvec3 b = lobe == 0 ? golden.diffuse[i] : golden.specular[i];
      lit = lit || a != glm::dvec3(0.0) || b != glm::dvec3(0.0);
      for (int c = 0; c < 3; ++c) {
        const double difference = std::abs(a[c] - b[c]);
        relative = std::max(relative, difference / std::max(std::abs(b[c]), scales[lobe].floor));
        hard = std::max(hard, difference / scales[lobe].peak);
      }
    }
    found.lit += lit;
    found.over += relative > tolerance.threshold;
    if (relative > found.worst) {
      found.worst = relative;
      found.worst_pixel = i;
    }
    if (hard > found.hardest) {
      found.hardest = hard;
      found.hardest_pixel = i;
    }
  }
  return found;
}

std::array<double, 3> ErrorsAgainst(const RadianceImage& truth, const RadianceImage& image) {
  return {CompareImages(TotalRadiance(image), TotalRadiance(truth), truth.width).rel_rmse,
          CompareImages(image.diffuse, truth.diffuse, truth.width).rel_rmse,
          CompareImages(image.specular, truth.specular, truth.width).rel_rmse};
}

void TestBands(const std::array<double, 3>& errors, const Bands* bands, std::vector<CheckFailure>& failures) {
  if (bands == nullptr) {
    failures.push_back(
        {CheckKind::kMissingBand, "no band for its error against the truth; `--update` stores one"});
    return;
  }
  for (std::size_t lobe = 0; lobe < kLobes.size(); ++lobe) {
    const Band& band = (*bands)[lobe];
    const double error = errors[lobe];
    if (band.Holds(error)) continue;
    const char* verdict = !std::isfinite(error) || !std::isfinite(band.measured)
                              ? "measurable on one side only"
                          : error > band.high ? "worse"
                                              : "better: a defect or news";
    failures.push_back({CheckKind::kBand,
                        fmt::format("{}: rel_rmse {} against the truth is outside [{}, {}], {}", kLobes[lobe],
                                    Figure(error), Figure(band.low), Figure(band.high), verdict)});
  }
}

// As a word of a shell command.
std::string Quoted(const std::string& word) {
  const bool plain = std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("+=@,._-/:").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (plain && !word.empty()) return word;
  std::string quoted = "'";
  for (char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

class Checker {
 public:
  Checker(Context& context, const ShaderLibrary& library, const CheckOptions& options)
      : context_(context), library_(library), options_(options), renderer_(context.gl(), library) {
    result_.renderer = context.renderer();
    OpenGoldens();
  }

  CheckResult Run() {
    std::set<std::string> names;
    for (std::size_t s = 0; s < options_.scenes.size(); ++s) {
      Scene scene = LoadScene(options_.scenes[s]);
      if (scene.aperture) BakeApertures(scene);
      if (!names.insert(scene.name).second) {
        throw InputError(fmt::format("{}: a second scene of the name \"{}\"; expected names that differ",
                                     options_.scenes[s].string(), scene.name));
      }
      share_ = static_cast<double>(s) / static_cast<double>(options_.scenes.size());
      RunScene(scene, options_.scenes[s]);
    }
    if (result_.checked == 0) {
      throw InputError("nothing to check: no chosen variant supports a chosen scene; expected one that does");
    }
    FindStale(names);
    if (!options_.update && options_.hard_cases > 0) RunHardCases();
    if (options_.update) {
      if (options_.all_scenes && options_.all_variants) bands_.renderer = result_.renderer;
      WriteBands(options_.golden, bands_, options_.size);
    }
    return std::move(result_);
  }

 private:
  void OpenGoldens() {
    if (!options_.update && !fs::is_directory(options_.golden)) {
      throw InputError(fmt::format("{}: no such folder; expected goldens, which --update makes",
                                   options_.golden.string()));
    }
    if (options_.update) MakeFolder(options_.golden);
    auto bands = ReadBands(options_.golden, options_.size, options_.update);
    if (options_.update && !bands) {
      if (!fs::is_empty(options_.golden)) {  // what an update removes must be an earlier update's
        throw InputError(
            fmt::format("{}: holds something else; expected a new folder or one of goldens with {}",
                        options_.golden.string(), kBandsFile));
      }
      bands_.renderer = result_.renderer;
      WriteBands(options_.golden, bands_, options_.size);  // so that an interrupted update may be repeated
    }
    if (bands) bands_ = std::move(*bands);
    result_.golden_renderer = bands_.renderer;
  }

  fs::path GoldenFile(const std::string& scene, const std::string& variant) const {
    return options_.golden / scene / (variant + ".exr");
  }

  void Report(const Scene& scene, const std::string& what, double fraction) const {
    if (!options_.progress) return;
    options_.progress(scene.name + ": " + what,
                      share_ + fraction / static_cast<double>(options_.scenes.size()));
  }

  void RunScene(const Scene& scene, const fs::path& file) {
    std::vector<Variant> variants;
    for (const Variant& variant : options_.variants) {
      if (WhyUnsupported(variant, scene)) {
        ++result_.unsupported;
      } else {
        variants.push_back(variant);
      }
    }
    if (variants.empty()) return;
    Report(scene, "truth", 0.0);
    const SurfacePixels& pixels = renderer_.DrawScene(scene, options_.size);
    RadianceImage unshadowed = ComputeTruth(scene, pixels).radiance;
    const auto truth = std::make_shared<const RadianceImage>(
        scene.aperture ? ComputeShadowedTruth(scene, pixels, unshadowed, {}).radiance : std::move(unshadowed));
    const auto emission = std::make_shared<const std::vector<glm::vec3>>(EmissionImage(scene, pixels));
    const std::vector<fs::path> built_in = BuiltInScenes();
    const bool is_built_in = std::find(built_in.begin(), built_in.end(), file) != built_in.end();
    for (std::size_t v = 0; v < variants.size(); ++v) {
      Report(scene, variants[v].ShortName(),
             0.5 + 0.5 * static_cast<double>(v) / static_cast<double>(variants.size()));
      CheckCase row;
      row.scene = scene.name;
      row.variant = variants[v].Name();
      row.rerun = fmt::format("arealab check {} --technique {}{}{}", Quoted(is_built_in ? scene.name : file.string()),
                              Quoted(variants[v].ShortName()), options_.repeated_of_images, options_.repeated);
      row.exposure = scene.exposure;
      row.truth = truth;
      row.emission = emission;
      RunVariant(variants[v], row);
      seen_[scene.name].insert(row.variant);
      ++result_.checked;
      result_.cases.push_back(std::move(row));
    }
  }

  void RunVariant(const Variant& variant, CheckCase& row) {
    const fs::path file = GoldenFile(row.scene, row.variant);
    const bool have_golden = fs::exists(file);
    try {
      if (have_golden) row.golden = std::make_shared<const RadianceImage>(ReadExr(file));
    } catch (const InputError& error) {
      if (!options_.update) row.failures.push_back({CheckKind::kUnreadableGolden, error.what()});
    }
    try {
      row.image = std::make_shared<const RadianceImage>(renderer_.Shade(variant));
    } catch (const InputError& error) {
      row.failures.push_back({CheckKind::kShader, error.what()});
      return;
    }
    if (const auto failure = TestFinite(*row.image, "the image are")) {
      row.failures.push_back(*failure);
      return;
    }
    if (options_.update) {
      Update(file, row);
      return;
    }
    if (!have_golden) {
      row.failures.push_back(
          {CheckKind::kMissingGolden, fmt::format("{} does not exist; `--update` makes it", file.string())});
    } else if (row.golden) {
      if (const auto failure = TestGolden(*row.image, *row.golden)) row.failures.push_back(*failure);
    }
    const auto scene = bands_.scenes.find(row.scene);
    const Bands* bands = nullptr;
    if (scene != bands_.scenes.end()) {
      if (const auto found = scene->second.find(row.variant); found != scene->second.end())
        bands = &found->second;
    }
    TestBands(ErrorsAgainst(*row.truth, *row.image), bands, row.failures);
  }

  void Update(const fs::path& file, CheckCase& row) {
    const HalfImage half = ToHalf(*row.image);
    std::string change;
    if (!row.golden) {
      change = "golden made";
    } else if (!SameBits(*row.golden, FromHalf(half))) {
      const auto failure = TestGolden(*row.image, *row.golden);
      change = failure ? fmt::format("golden changed ({})", failure->message)
                       : "golden changed within its tolerance";
    }
    if (!change.empty()) WriteExr(file, half);

    const std::array<double, 3> errors = ErrorsAgainst(*row.truth, *row.image);
    std::map<std::string, Bands>& scene = bands_.scenes[row.scene];
    const Bands old = scene[row.variant];
    Bands& bands = scene[row.variant];
    std::string figures;
    bool moved = false;
    for (std::size_t lobe = 0; lobe < kLobes.size(); ++lobe) {
      bands[lobe] = BandAround(errors[lobe]);
      const std::string before = Figure(old[lobe].measured), after = Figure(bands[lobe].measured);
      moved = moved || before != after;
      figures += fmt::format("{}{} {} -> {}", lobe == 0 ? "" : ", ", kLobes[lobe], before, after);
    }
    if (change.empty() && !moved) return;
    row.changes.push_back(fmt::format("{}; rel_rmse {}", change.empty() ? "band moved" : change, figures));
  }

  void RunHardCases() {
    for (const Variant& variant : options_.variants) {
      if (!(variant == DefaultVariant(*variant.technique))) continue;
      StressOptions stress;
      stress.variants = {variant};
      stress.judged = {true};
      stress.cases = options_.hard_cases;
      if (options_.progress) options_.progress("hard cases: " + variant.ShortName(), 1.0);
      const auto add = [&](const std::string& hard, const std::vector<std::string>& failures) -> CheckCase& {
        CheckCase row;
        row.scene = "hard cases";
        row.variant = variant.Name();
        row.hard = hard;
        for (const std::string& failure : failures) row.failures.push_back({CheckKind::kHardCase, failure});
        ++result_.hard;
        result_.cases.push_back(std::move(row));
        return result_.cases.back();
      };
      const std::string command = "arealab stress --technique " + Quoted(variant.ShortName());
      try {
        const VariantStress found = Stress(context_, library_, stress).variants[0];
        for (const FamilyResult& family : found.families) {
          CheckCase& row = add(family.family->name, family.failures);
          row.rerun = fmt::format("{} --case '{}'{}", command, CaseLine(family.worst_case), options_.repeated);
          if (!family.failures.empty()) row.family = std::make_shared<const FamilyResult>(family);
        }
        for (const StressPath& path : StressPaths()) {
          std::vector<std::string> failures;
          for (const PathResult& lobe : found.paths) {
            if (lobe.path == &path) failures.insert(failures.end(), lobe.failures.begin(), lobe.failures.end());
          }
          add(fmt::format("path {}", path.name), failures).rerun = command + options_.repeated;
        }
      } catch (const InputError& error) {
        CheckCase& row = add("all", {});
        row.failures.push_back({CheckKind::kShader, error.what()});
        row.rerun = command + options_.repeated;
      }
    }
  }

  // Stored files and bands of the scenes and variants that were run in full, but that no variant asked for.
  void FindStale(const std::set<std::string>& names) {
    const auto covered = [&](const std::string& scene) {
      return options_.all_variants && (names.contains(scene) || options_.all_scenes);
    };
    const auto wanted = [&](const std::string& scene, const std::string& variant) {
      const auto found = seen_.find(scene);
      return found != seen_.end() && found->second.contains(variant);
    };
    std::map<std::pair<std::string, std::string>, CheckCase> stale;
    const auto at = [&](const std::string& scene, const std::string& variant) -> CheckCase& {
      CheckCase& row = stale[{scene, variant}];
      row.scene = scene;
      row.variant = variant;
      return row;
    };
    for (const auto& folder : fs::directory_iterator(options_.golden)) {
      if (!folder.is_directory()) continue;
      const std::string scene = folder.path().filename().string();
      if (!covered(scene)) continue;
      std::vector<fs::path> files;
      for (const auto& entry : fs::directory_iterator(folder.path())) files.push_back(entry.path());
      for (const fs::path& file : files) {
        if (file.extension() != ".exr") continue;
        if (file.filename().string().starts_with('.')) {  // an interrupted update's
          if (options_.update) fs::remove(file);
          continue;
        }
        if (wanted(scene, file.stem().string())) continue;
        CheckCase& row = at(scene, file.stem().string());
        if (options_.update) {
          fs::remove(file);
          row.changes.push_back("golden removed: no such variant of this scene");
        } else {
          row.failures.push_back(
              {CheckKind::kStaleGolden, fmt::format("{} belongs to no variant of this scene; "
                                                    "`--update` removes it",
                                                    file.string())});
        }
      }
      if (options_.update && fs::is_empty(folder.path())) fs::remove(folder.path());
    }
    const BandsByScene stored = bands_.scenes;
    for (const auto& [scene, variants] : stored) {
      if (!covered(scene)) continue;
      for (const auto& [variant, bands] : variants) {
        if (wanted(scene, variant)) continue;
        if (options_.update) {
          at(scene, variant).changes.push_back("band removed: no such variant of this scene");
          bands_.scenes[scene].erase(variant);
          if (bands_.scenes[scene].empty()) bands_.scenes.erase(scene);
        } else {
          at(scene, variant)
              .failures.push_back(
                  {CheckKind::kStaleBand,
                   fmt::format("its band in {} belongs to no variant of this scene; `--update` "
                               "removes it",
                               (options_.golden / kBandsFile).string())});
        }
      }
    }
    for (auto& [key, row] : stale) result_.cases.push_back(std::move(row));
  }

  Context& context_;
  const ShaderLibrary& library_;
  const CheckOptions& options_;
  Renderer renderer_;
  CheckResult result_;
  BandsFile bands_;
  std::map<std::string, std::set<std::string>> seen_;  // variants by scene
  double share_ = 0.0;
};

}  // namespace

bool Band::Holds(double rel_rmse) const {
  if (!std::isfinite(measured)) return !std::isfinite(rel_rmse);
  return rel_rmse >= low && rel_rmse <= high;
}

Band BandAround(double rel_rmse) {
  constexpr double kTruthTolerance = 1e-4;  // TruthOptions' own
  if (!std::isfinite(rel_rmse)) return {};
  const double measured = Rounded(rel_rmse);
  return {Rounded(std::max(0.8 * measured - kTruthTolerance, 0.0)), measured,
          Rounded(1.25 * measured + kTruthTolerance)};
}

const char* Name(CheckKind kind) {
  switch (kind) {
    case CheckKind::kShader:
      return "shader";
    case CheckKind::kNonfinite:
      return "not finite";
    case CheckKind::kMissingGolden:
      return "missing golden";
    case CheckKind::kUnreadableGolden:
      return "unreadable golden";
    case CheckKind::kSize:
      return "size";
    case CheckKind::kGolden:
      return "golden";
    case CheckKind::kStaleGolden:
      return "stale golden";
    case CheckKind::kMissingBand:
      return "missing band";
    case CheckKind::kBand:
      return "band";
    case CheckKind::kStaleBand:
      return "stale band";
    case CheckKind::kHardCase:
      return "hard case";
  }
  return "unknown";
}

std::optional<CheckFailure> TestGolden(const RadianceImage& image, const RadianceImage& golden,
                                       const GoldenTolerance& tolerance) {
  if (image.width != golden.width || image.height != golden.height) {
    return CheckFailure{CheckKind::kSize, fmt::format("{}x{} pixels, the golden has {}x{}", image.width,
                                                      image.height, golden.width, golden.height)};
  }
  if (auto failure = TestFinite(image, "the image are")) return failure;
  if (auto failure = TestFinite(golden, "the golden are")) return failure;
  const GoldenDifference found = Difference(image, golden, tolerance);
  const bool too_many = found.over > tolerance.fraction * found.lit;
  const bool too_far = found.hardest > tolerance.hard;
  if (!too_many && !too_far) return std::nullopt;
  const std::size_t width = static_cast<std::size_t>(image.width);
  std::string message = fmt::format(
      "{} of {} lit pixels differ by more than {} % (allowed: {} %), at most by {:.3g} % at ({}, {})",
      found.over, found.lit, 100.0 * tolerance.threshold, 100.0 * tolerance.fraction, 100.0 * found.worst,
      found.worst_pixel % width, found.worst_pixel / width);
  if (too_far) {
    message +=
        fmt::format("; one by {:.3g} of the golden's peak at ({}, {}), above the hard limit {}",
                    found.hardest, found.hardest_pixel % width, found.hardest_pixel / width, tolerance.hard);
  }
  return CheckFailure{CheckKind::kGolden, message};
}

std::string CheckCase::Title() const {
  return fmt::format("{}: {}{}", scene, variant, hard.empty() ? "" : ": " + hard);
}

int CheckResult::failures() const {
  int count = 0;
  for (const CheckCase& row : cases) count += static_cast<int>(row.failures.size());
  return count;
}

CheckResult Check(Context& context, const ShaderLibrary& library, const CheckOptions& options) {
  return Checker(context, library, options).Run();
}

}  // namespace arealab
