#include "compare/cost.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <optional>
#include <sstream>
#include <string_view>
#include <thread>

#include "compare/cache_file.h"
#include "compare/content_hash.h"
#include "compare/spirv.h"
#include "compare/subprocess.h"
#include "glsl/effects.h"
#include "glsl/expand.h"
#include "scenes/error.h"
#include "scenes/shapes.h"

namespace arealab {
namespace {

namespace fs = std::filesystem;

// Changes whenever the harness, the compilers' options or the cache's layout change.
constexpr int kCostVersion = 3;

constexpr std::array kGpus = {"tahiti",   "pitcairn", "verde",  "bonaire", "hawaii", "tonga",  "fiji",    "polaris10",
                              "polaris11", "polaris12", "vega10", "vega12",  "vega20", "raven",  "renoir",  "navi10",
                              "navi12",   "navi14",   "navi21", "navi22",  "navi23", "vangogh", "gfx1100", "gfx1101", "gfx1102"};

// Paths of a text that branches on the horizon (glsl/path.glsl), on whether the light is near (glsl/near.glsl), or both: then
// the light is far where it is not said to be near, and a near one crosses the horizon, the dearest of all.
struct Path {
  const char* name;
  std::vector<std::string> defines;
};
std::vector<Path> PathsOf(const std::string& text) {
  const bool horizon = text.find("#if PATH_ABOVE") != std::string::npos;
  const bool near = text.find("#if PATH_FAR") != std::string::npos;
  if (horizon && near)
    return {{"above", {"PATH_ABOVE", "PATH_FAR"}},
            {"crossing", {"PATH_CROSSING", "PATH_FAR"}},
            {"below", {"PATH_BELOW", "PATH_FAR"}},
            {"near", {"PATH_CROSSING", "PATH_NEAR"}}};
  if (horizon) return {{"above", {"PATH_ABOVE"}}, {"crossing", {"PATH_CROSSING"}}, {"below", {"PATH_BELOW"}}};
  if (near) return {{"far", {"PATH_FAR"}}, {"near", {"PATH_NEAR"}}};
  return {};
}

std::string Or(const char* variable, std::string otherwise) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0' ? value : std::move(otherwise);
}

std::string FirstLine(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

// RADV's manifest where the Vulkan loader looks for it, or nothing.
std::string FindDriver() {
  for (const char* folder : {"/etc/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/usr/share/vulkan/icd.d"}) {
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder, none)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with("radeon_icd") && name.ends_with(".json")) return entry.path().string();
    }
  }
  return "";
}

std::string_view Bytes(std::span<const std::uint32_t> words) {
  return {reinterpret_cast<const char*>(words.data()), words.size_bytes()};
}

void Append(std::vector<char>& bytes, std::span<const std::uint32_t> words) {
  const std::string_view more = Bytes(words);
  bytes.insert(bytes.end(), more.begin(), more.end());
}

void Append(std::vector<char>& bytes, std::size_t count) {
  const auto word = static_cast<std::uint32_t>(count);
  Append(bytes, std::span(&word, 1));
}

// A line of the worker's.
bool Parse(const std::string& line, ShaderCost& cost) {
  std::istringstream in(line);
  in >> cost.instructions >> cost.cycles >> cost.vgprs >> cost.sgprs >> cost.spills >> cost.branches >> cost.bytes;
  return static_cast<bool>(in);
}

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

}  // namespace

// A shader to compile and what is found for it.
struct CostMeter::Text {
  ExpandedSource source;
  bool vertex = false;
  int targets = 1;
  std::string who;  // for messages
};

// A text with the places that its figures go to.
struct CostMeter::Entry {
  Text text;
  std::vector<std::uint32_t> words;
  std::vector<ShaderCost> costs;                   // by GPU
  std::vector<std::string> files, word_files;      // the costs under the text's name, and under the words'
  const std::vector<ShaderCost>* found = nullptr;  // by whoever has the same words
  std::vector<std::pair<std::size_t, std::string>> places;  // variant, "core", "full" or a path
};

struct CostMeter::Job {
  const Text* text;
  const std::vector<std::uint32_t>* words;  // SPIR-V
  const std::vector<std::uint32_t>* vertex;
  ShaderCost* cost;
};

std::span<const char* const> GpuNames() {
  return kGpus;
}

void CheckGpuNames(const std::vector<std::string>& gpus) {
  for (const std::string& gpu : gpus) {
    if (std::find(kGpus.begin(), kGpus.end(), gpu) != kGpus.end()) continue;
    throw InputError(fmt::format("no GPU \"{}\"; expected of {} (others crash the driver's null device)", gpu,
                                 fmt::join(kGpus, ", ")));
  }
}

double MillisecondsAt1080p(const std::string& gpu, double cycles) {
  if (gpu != "bonaire") return kNotMeasured;
  constexpr double kWaves = 1920.0 * 1080.0 / 64.0, kSimds = 18.0 * 4.0, kHertz = 0.8e9;
  return 1e3 * cycles * kWaves / kSimds / kHertz;
}

CostTools CostTools::FromEnvironment() {
  const CostTools usual;
  return {Or("AREALAB_VULKAN", usual.vulkan), Or("AREALAB_RADV", FindDriver())};
}

CostMeter::CostMeter(std::vector<std::string> gpus, fs::path cache, CostTools tools)
    : gpus_(std::move(gpus)), cache_(std::move(cache)), tools_(std::move(tools)) {
  CheckGpuNames(gpus_);
  std::error_code none;
  if (tools_.driver.empty() || !fs::exists(tools_.driver, none)) {
    throw InputError(fmt::format("no AMD Vulkan driver ({}); expected Debian's package mesa-vulkan-drivers",
                                 tools_.driver.empty() ? "radeon_icd.*.json" : tools_.driver));
  }
  worker_ = (fs::read_symlink("/proc/self/exe", none).parent_path() / "arealab_isa").string();
  const ProcessResult driver = RunProcess({worker_}, WorkerEnvironment(kGpus.front()), {});
  if (!driver.started) throw InputError(fmt::format("{} does not run; expected it beside the program", worker_));
  if (driver.status != 0) {
    throw InputError(fmt::format("{}; expected Debian's packages libvulkan1 and mesa-vulkan-drivers",
                                 driver.signal != 0 ? fmt::format("the Vulkan driver ends with signal {}", driver.signal)
                                                    : FirstLine(driver.messages)));
  }
  compilers_ = fmt::format("{} by glslang {}", FirstLine(driver.data), GlslangVersion());
}

std::vector<std::pair<std::string, std::string>> CostMeter::WorkerEnvironment(const std::string& gpu) const {
  return {{"RADV_FORCE_FAMILY", gpu},       {"VK_ICD_FILENAMES", tools_.driver},
          {"VK_DRIVER_FILES", ""},          {"AREALAB_VULKAN", tools_.vulkan},
          {"VK_INSTANCE_LAYERS", ""},       {"MESA_SHADER_CACHE_DISABLE", "true"},
          {"RADV_DEBUG", ""},               {"RADV_PERFTEST", ""},
          {"ACO_DEBUG", ""},                {"NIR_DEBUG", ""}};
}

std::vector<std::uint32_t> CostMeter::Translate(const Text& text) {
  SpirvResult result = TranslateToSpirv(text.source.text, text.vertex ? SpirvStage::kVertex : SpirvStage::kFragment);
  if (!result.words.empty()) return std::move(result.words);
  for (const std::string& line : Lines(text.source.RewriteLog(result.log))) {
    if (line.find(": error: ") == std::string::npos) continue;
    throw InputError(fmt::format("{} ({}, as SPIR-V); expected text that glslang compiles", line, text.who));
  }
  throw InputError(fmt::format("{}: glslang says \"{}\"; expected SPIR-V", text.who, FirstLine(result.log)));
}

std::string CostMeter::CacheName(std::string_view vertex, std::string_view fragment, int targets, const std::string& gpu) const {
  ContentHash hash;
  hash.Value(kCostVersion);
  hash.Text(compilers_);
  hash.Text(gpu);
  hash.Value(targets);
  hash.Text(std::string(vertex));
  hash.Text(std::string(fragment));
  return hash.Name() + ".isa";
}

void CostMeter::Compile(std::span<const Job> jobs, const std::string& gpu) const {
  if (jobs.empty()) return;
  std::vector<char> input;
  for (const Job& job : jobs) {
    Append(input, static_cast<std::size_t>(job.text->targets));
    Append(input, job.vertex->size());
    Append(input, job.words->size());
    Append(input, *job.vertex);
    Append(input, *job.words);
  }
  const ProcessResult result = RunProcess({worker_}, WorkerEnvironment(gpu), input);
  const std::vector<std::string> lines = Lines(result.data);
  std::size_t done = 0;
  while (done < jobs.size() && done + 1 < lines.size() && Parse(lines[done + 1], *jobs[done].cost)) ++done;
  if (done == jobs.size() && result.status == 0) return;
  const std::string what = result.signal != 0 ? fmt::format("the driver ends with signal {} ({})", result.signal,
                                                            strsignal(result.signal))
                                              : FirstLine(result.messages);
  throw InputError(fmt::format("{}, {}: {}; expected figures for it", gpu, jobs[std::min(done, jobs.size() - 1)].text->who, what));
}

void CostMeter::Find(const ShaderLibrary& library, std::vector<Entry>& entries, const std::function<void(double)>& progress) const {
  const Text vertex{Expand(library, "core.vert", {}, {}, Precision::kFloat), true, 0, "core.vert"};
  const auto load = [&](Entry& entry, std::vector<std::string>& files, std::string_view vertex_key, std::string_view key) {
    entry.costs.resize(gpus_.size());
    bool known = true;
    for (std::size_t g = 0; g < gpus_.size(); ++g) {
      files.push_back(CacheName(vertex_key, key, entry.text.targets, gpus_[g]));
      const std::optional<std::string> line = ReadCacheEntry(cache_, files.back());
      known = line && Parse(*line, entry.costs[g]) && known;
    }
    return known;
  };
  std::vector<Entry*> missing;
  for (Entry& entry : entries) {
    if (!load(entry, entry.files, vertex.source.text, entry.text.source.text)) missing.push_back(&entry);
  }
  if (!missing.empty()) {
    std::mutex mutex;
    std::size_t done = 0;
    const std::size_t all = missing.size() * (1 + gpus_.size());
    const auto report = [&](std::size_t count) {
      const std::lock_guard lock(mutex);
      done += count;
      if (progress) progress(static_cast<double>(done) / static_cast<double>(all));
    };
    const std::vector<std::uint32_t> vertex_words = Translate(vertex);
    tbb::parallel_for(std::size_t{0}, missing.size(), [&](std::size_t i) {
      missing[i]->words = Translate(missing[i]->text);
      report(1);
    });
    // Half of the texts differ in what no function of theirs asks for, an effect or the scene's other shapes.
    std::vector<Entry*> compiled;
    std::map<std::string, const Entry*> by_words;
    for (Entry* entry : missing) {
      const bool known = load(*entry, entry->word_files, Bytes(vertex_words), Bytes(entry->words));
      const auto [first, added] = by_words.emplace(entry->word_files.front(), entry);
      entry->found = &first->second->costs;
      if (added && !known) compiled.push_back(entry);
    }
    report((missing.size() - compiled.size()) * gpus_.size());
    // A batch is a process, which costs a fifth of a second to start: as few as keep all cores busy.
    constexpr std::size_t kLeast = 12;
    const std::size_t cores = std::max(std::thread::hardware_concurrency(), 1u);
    const std::size_t batches = std::clamp((cores + gpus_.size() - 1) / gpus_.size(), std::size_t{1}, compiled.size() / kLeast + 1);
    tbb::parallel_for(std::size_t{0}, batches * gpus_.size(), [&](std::size_t i) {
      const std::size_t g = i / batches, first = i % batches * compiled.size() / batches,
                        last = (i % batches + 1) * compiled.size() / batches;
      std::vector<Job> jobs;
      for (std::size_t m = first; m < last; ++m) {
        jobs.push_back({&compiled[m]->text, &compiled[m]->words, &vertex_words, &compiled[m]->costs[g]});
      }
      Compile(jobs, gpus_[g]);
      for (std::size_t m = first; m < last; ++m) Store(compiled[m]->word_files[g], compiled[m]->costs[g]);
      report(last - first);
    });
    for (Entry* entry : missing) {
      if (entry->found != &entry->costs) entry->costs = *entry->found;
      for (std::size_t g = 0; g < gpus_.size(); ++g) Store(entry->files[g], entry->costs[g]);
    }
  }
}

std::vector<std::map<std::string, ShaderCost>> CostMeter::MeasurePasses(const ShaderLibrary& library, const std::vector<ExpandedSource>& passes) const {
  std::vector<Entry> entries;
  for (const ExpandedSource& pass : passes) entries.push_back({{pass, false, 2, "a pass"}, {}, {}, {}, {}, nullptr, {}});
  Find(library, entries, {});
  std::vector<std::map<std::string, ShaderCost>> found(passes.size());
  for (std::size_t i = 0; i < passes.size(); ++i) {
    for (std::size_t g = 0; g < gpus_.size(); ++g) found[i][gpus_[g]] = entries[i].costs[g];
  }
  return found;
}

std::vector<std::map<std::string, GpuCost>> CostMeter::Measure(const ShaderLibrary& library,
                                                               const std::vector<Variant>& variants, const Scene& scene,
                                                               const std::function<void(double)>& progress) const {
  const std::vector<Effect> effects = SceneEffects(scene);
  std::vector<Entry> entries;  // every text once
  std::map<std::string, std::size_t> index;  // by text
  const auto add = [&](std::size_t v, const std::string& place, const std::string& main, int targets,
                       const std::vector<std::pair<std::string, int>>& defines) -> const std::string& {
    Text text{Expand(library, main, variants[v], defines, Precision::kFloat, scene.brdfs()), false, targets,
              fmt::format("{} ({})", variants[v].ShortName(), place)};
    const auto [at, added] = index.emplace(text.source.text, entries.size());
    if (added) entries.push_back({std::move(text), {}, {}, {}, {}, nullptr, {}});
    entries[at->second].places.emplace_back(v, place);
    return at->first;
  };
  for (std::size_t v = 0; v < variants.size(); ++v) {
    if (WhyUnsupported(variants[v], scene, effects)) continue;
    if (variants[v].per_pixel != PerPixel::kNo) {
      throw InputError(fmt::format("{}: several programs, or two in one; expected one program, without per_pixel", variants[v].ShortName()));
    }
    EffectDefines lit = Defines(effects, variants[v].effects);
    lit.emplace_back("PATH_LIT", 1);
    add(v, "full", "lighting.frag", 2, lit);
    const std::string core = add(v, "core", "core.frag", 1, lit);
    for (const Path& path : PathsOf(core)) {
      auto defines = lit;
      for (const std::string& define : path.defines) defines.emplace_back(define, 1);
      add(v, path.name, "core.frag", 1, defines);
    }
  }

  Find(library, entries, progress);
  std::vector<std::map<std::string, GpuCost>> found(variants.size());
  for (const Entry& entry : entries) {
    for (const auto& [v, place] : entry.places) {
      for (std::size_t g = 0; g < gpus_.size(); ++g) {
        GpuCost& cost = found[v][gpus_[g]];
        (place == "core" ? cost.core : place == "full" ? cost.full : cost.paths[place]) = entry.costs[g];
      }
    }
  }
  for (auto& costs : found) {
    for (auto& on_gpu : costs) {
      GpuCost& cost = on_gpu.second;
      // The text may ask and the shape of the light not.
      const auto same = [&](const char* a, const ShaderCost& b) { return !cost.paths.contains(a) || cost.paths.at(a) == b; };
      if (cost.paths.contains("above") && same("crossing", cost.paths.at("above")) && same("below", cost.paths.at("above"))) {
        cost.paths["far"] = cost.paths.at("above");
        for (const char* path : {"above", "crossing", "below"}) cost.paths.erase(path);
      }
      if (cost.paths.contains("crossing") && same("near", cost.paths.at("crossing"))) cost.paths.erase("near");
      if (same("near", cost.core) && same("far", cost.core)) cost.paths.erase("near"), cost.paths.erase("far");
    }
  }
  return found;
}

void CostMeter::Store(const std::string& name, const ShaderCost& cost) const {
  WriteCacheEntry(cache_, name, fmt::format("{} {} {} {} {} {} {}\n", cost.instructions, cost.cycles, cost.vgprs, cost.sgprs,
                                            cost.spills, cost.branches, cost.bytes));
}

Scene SceneOfEffects(const std::vector<std::string>& effects) {
  constexpr std::array kNames = {"rectangle", "disk", "sphere", "polygon", "ellipse", "tube", "two_sided", "diffuse", "specular", "fresnel", "textured", "many_lights"};
  for (const std::string& effect : effects) {
    if (std::find(kNames.begin(), kNames.end(), effect) == kNames.end()) {
      throw InputError(fmt::format("no effect \"{}\"; expected of {}", effect, fmt::join(kNames, ", ")));
    }
  }
  const auto has = [&](const char* effect) { return std::find(effects.begin(), effects.end(), effect) != effects.end(); };
  Scene scene;
  for (const LightShape shape : kLightShapes) {
    if (!has(Name(shape)) || (shape == LightShape::kDisk && has("ellipse"))) continue;  // an ellipse is shaded as a disk
    Light& light = scene.lights.emplace_back();
    light.shape = shape;
    if (shape == LightShape::kEllipse) light.half_size.y = 0.3;
    if (shape == LightShape::kTube) light.half_size.y = 0.05;
    if (shape == LightShape::kPolygon) SetCorners(light, {{-0.5, -0.4}, {0.5, -0.4}, {0.6, 0.2}, {0.0, 0.6}, {-0.6, 0.2}});
  }
  if (!scene.lights.empty()) {
    if (has("many_lights") && scene.lights.size() == 1) scene.lights.push_back(scene.lights[0]);
    scene.lights[0].two_sided = has("two_sided");
    scene.lights[0].radiance = {1.0, 0.9, 0.8};
    if (has("textured")) scene.lights[0].texture = std::make_shared<Image>(Image{1, 1, {glm::vec4(1.0f)}});
  }
  Material material;
  material.metalness = has("diffuse") ? 0.0f : 1.0f;
  material.base_color = has("fresnel") ? glm::vec3(0.8f, 0.7f, 0.6f) : glm::vec3(1.0f);
  // Across the lights' planes, its normals anywhere: every effect of the geometry is on.
  material.normal_texture = std::make_shared<Image>(Image{1, 1, {glm::vec4(0.5f, 0.5f, 1.0f, 1.0f)}});
  scene.materials.push_back(material);
  scene.meshes.push_back(MakePlane({2.0, 2.0}, {{0.0, 0.0, 0.0}, RotationFromDegrees({30.0, 0.0, 0.0})}));
  // The scene may call for more than was asked for: a second shape is a second light.
  for (const char* name : kNames) {
    if (const bool on = SceneEffect(scene, name).on; on != has(name)) {
      throw InputError(fmt::format("--effects {}: no scene has these {} {}; expected e.g. rectangle,diffuse,specular,fresnel",
                                   fmt::join(effects, ","), on ? "without" : "with", name));
    }
  }
  return scene;
}

}  // namespace arealab
