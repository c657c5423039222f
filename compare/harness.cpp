#include "compare/harness.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <fstream>
#include <thread>

#include "compare/aperture_cache.h"
#include "compare/explain.h"
#include "compare/flip.h"
#include "compare/ltc_split.h"
#include "compare/metrics.h"
#include "compare/timing.h"
#include "compare/truth_cache.h"
#include "glsl/gbuffer.h"
#include "scenes/error.h"
#include "scenes/light_texture.h"
#include "scenes/sky.h"

namespace arealab {
namespace {

constexpr double kTruthMargin = 4.0;  // an error below this multiple of the truth's own is not ranked

// The value of the first "KEY: VALUE" or KEY="VALUE" line of a file of facts about the machine.
std::string Fact(const char* file, const std::string& key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind(key, 0) != 0) continue;
    const std::size_t separator = line.find_first_of(":=");
    if (separator == std::string::npos) continue;
    std::string value = line.substr(separator + 1);
    value.erase(std::remove(value.begin(), value.end(), '"'), value.end());
    return value.substr(std::min(value.find_first_not_of(" \t"), value.size()));
  }
  return "unknown";
}

std::map<std::string, std::string> Machine() {
  return {{"cpu", Fact("/proc/cpuinfo", "model name")},
          {"cores", std::to_string(std::thread::hardware_concurrency())},
          {"os", Fact("/etc/os-release", "PRETTY_NAME")},
          {"compiler", "g++ " __VERSION__}};
}

int CountLit(const RadianceImage& image) {
  int lit = 0;
  for (std::size_t i = 0; i < image.size(); ++i) lit += image.Total(i) != glm::vec3(0.0f);
  return lit;
}

VariantResult Describe(const Variant& variant, const Scene& scene) {
  VariantResult result;
  result.name = variant.Name();
  result.short_name = variant.ShortName();
  result.summary = variant.technique->summary;
  result.note = variant.technique->author_note;
  result.citation = variant.technique->citation;
  if (const auto reason = WhyUnsupported(variant, scene)) {
    result.supported = false;
    result.reason = *reason;
  }
  return result;
}

// Times the passes of the variants that have an image, on the scene that the renderer drew last.
void Time(const Context& context, Renderer& renderer, const std::vector<Variant>& variants, const Variant& point,
          int lit_pixels, std::vector<VariantResult>& results, TimingOptions options) {
  std::vector<Variant> timed;
  for (std::size_t v = 0; v < variants.size(); ++v) {
    if (results[v].image) timed.push_back(variants[v]);
  }
  const std::vector<Timing> timings = MeasureTimes(context, renderer, timed, point, lit_pixels, options);
  auto timing = timings.begin();
  for (VariantResult& result : results) {
    if (result.image) result.time = *timing++;
  }
}

// What every variant that has an image saves, on the scene that the renderer drew last.
void MeasureSavings(const Context& context, Renderer& renderer, const ShaderLibrary& library, const Scene& scene, const CompareOptions& options,
                    const std::function<void(double)>& progress, std::vector<VariantResult>& results) {
  ExplainOptions explain;
  explain.prices = false;
  explain.meter = options.cost.get();
  explain.seconds = options.saving_seconds;
  for (std::size_t v = 0; v < results.size(); ++v) {
    progress(static_cast<double>(v) / static_cast<double>(results.size()));
    if (!results[v].image) continue;
    results[v].saving = Explain(context, renderer, library, scene, options.variants[v], explain).saving;
  }
}

// Fills `isa`. What another compiler than the GL's refuses costs its own variant the figures, and leaves a reason.
void CountCycles(const CostMeter& meter, const ShaderLibrary& library, const std::vector<Variant>& variants, const Scene& scene,
                 std::vector<VariantResult>& results, std::string& reason) {
  try {
    const auto costs = meter.Measure(library, variants, scene);
    for (std::size_t v = 0; v < costs.size(); ++v) results[v].isa = costs[v];
  } catch (const InputError& error) {
    reason = error.what();
    for (std::size_t v = 0; variants.size() > 1 && v < variants.size(); ++v) {
      std::vector<VariantResult> one = {results[v]};
      CountCycles(meter, library, {variants[v]}, scene, one, reason);
      results[v].isa = one[0].isa;
    }
  }
}

// rel_rmse of every ordered pair of the variants that have an image.
std::vector<PairResult> MeasurePairs(const std::vector<VariantResult>& variants) {
  std::vector<const VariantResult*> shown;
  std::vector<std::vector<glm::vec3>> totals;
  for (const VariantResult& variant : variants) {
    if (!variant.image) continue;
    shown.push_back(&variant);
    totals.push_back(TotalRadiance(*variant.image));
  }
  const std::size_t count = shown.size();
  std::vector<double> differences(count * count, 0.0);  // of a and b, Σ(a−b)²; on the diagonal Σa²
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t a) {
    differences[a * count + a] = SquaredNorm(totals[a]);
    for (std::size_t b = 0; b < a; ++b) {
      differences[a * count + b] = differences[b * count + a] = SquaredDifference(totals[a], totals[b]);
    }
  });
  std::vector<PairResult> pairs;
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = 0; b < count; ++b) {
      if (a == b) continue;
      pairs.push_back({shown[a]->name, shown[b]->name, RelativeRmse(differences[a * count + b], differences[b * count + b])});
    }
  }
  return pairs;
}

// What the scene's variants err by, against the truth and one another.
void MeasureScene(const std::vector<Variant>& variants, SceneResult& scene) {
  const RadianceImage& truth = *scene.truth;
  const FlipReference flip(TotalRadiance(truth), truth.width);
  tbb::parallel_for(std::size_t{0}, scene.variants.size(), [&](std::size_t v) {
    VariantResult& row = scene.variants[v];
    if (!row.image) return;
    Measure(truth, &flip, &row);
    // A lobe that a technique does not claim has no figure, nor has the sum.
    const Technique& technique = *variants[v].technique;
    if (!technique.diffuse) row.diffuse = row.total = {};
    if (!technique.specular) row.specular = row.total = {};
    row.within_truth_error = row.total.rel_rmse < kTruthMargin * scene.truth_relative_error;
  });
  scene.pairs = MeasurePairs(scene.variants);
}

ShadowResult Describe(const ShadowedTruth& shadowed, const RadianceImage& unshadowed) {
  ShadowResult result;
  const std::vector<glm::vec3> with = TotalRadiance(shadowed.radiance), without = TotalRadiance(unshadowed);
  const ErrorMetrics missing = CompareImages(without, with, unshadowed.width);
  result.rel_rmse = missing.rel_rmse;
  result.bias = missing.bias;
  result.light_lost = missing.bias / (1.0 + missing.bias);
  result.mean_error = shadowed.mean_error;
  result.p99_error = shadowed.p99_error;
  result.seconds = shadowed.seconds;
  result.cached = shadowed.cached;
  if (result.Matters()) result.image = std::make_shared<const RadianceImage>(shadowed.radiance);
  return result;
}

}  // namespace

std::vector<glm::vec3> EmissionImage(const Scene& scene, const SurfacePixels& pixels) {
  std::vector<glm::vec3> emission(pixels.size(), glm::vec3(0.0f));
  const glm::ivec2 size(pixels.width, pixels.height);
  const CameraView view = ViewOf(scene.camera, size);
  tbb::parallel_for(std::size_t{0}, pixels.size(), [&](std::size_t i) {
    const int kind = static_cast<int>(pixels.position[i].w);
    if (kind == static_cast<int>(PixelKind::kBackground) && scene.sky) {
      const auto width = static_cast<std::size_t>(pixels.width);
      emission[i] = glm::vec3(SkyRadiance(*scene.sky, view.Towards((glm::dvec2(i % width, i / width) + 0.5) / glm::dvec2(size))));
    }
    if (kind < static_cast<int>(PixelKind::kEmitter)) return;
    const Light& light = scene.lights.at(static_cast<std::size_t>(kind - static_cast<int>(PixelKind::kEmitter)));
    emission[i] = glm::vec3(light.radiance);
    if (!light.texture) return;
    const bool back = glm::dot(glm::dvec3(pixels.view_position) - light.center, light.normal) < 0.0;
    const glm::dvec2 uv = TextureCoordinates(light, glm::dvec3(pixels.position[i]), back);
    emission[i] = glm::vec3(light.radiance * TextureAt(*light.texture, uv));
  });
  return emission;
}

namespace {

// At least over this, relative errors in a picture: 1 % of the mean of what is lit.
double RelativeFloor(const std::vector<glm::vec3>& truth) {
  double mean = 0.0;
  std::size_t count = 0;
  for (const glm::vec3& v : truth) {
    mean += Luminance(v);
    count += v != glm::vec3(0.0f);
  }
  return std::max(0.01 * mean / static_cast<double>(std::max<std::size_t>(count, 1)), 1e-30);
}

std::vector<ErrorSplit::Cause> DescribeCauses(const std::vector<CausePicture>& pictures, const RadianceImage& truth) {
  const std::vector<glm::vec3> reference = TotalRadiance(truth);
  const double floor = RelativeFloor(reference);
  double sum = 0.0, squares = 0.0;
  for (const glm::vec3& t : reference) {
    sum += static_cast<double>(t.x + t.y + t.z);
    squares += static_cast<double>(glm::dot(t, t));
  }
  std::vector<ErrorSplit::Cause> causes;
  for (const CausePicture& picture : pictures) {
    ErrorSplit::Cause& cause = causes.emplace_back(ErrorSplit::Cause{picture.name, 0.0, 0.0, {}});
    for (std::size_t i = 0; i < reference.size(); ++i) {
      const glm::dvec3& e = picture.error[i];
      cause.rel_rmse += glm::dot(e, e);
      cause.bias += e.x + e.y + e.z;
      cause.relative.push_back(static_cast<float>(Luminance(glm::vec3(e)) / std::max(static_cast<double>(Luminance(reference[i])), floor)));
    }
    cause.rel_rmse = std::sqrt(cause.rel_rmse / squares);
    cause.bias /= sum;
  }
  return causes;
}

ErrorSplit SplitError(Renderer& renderer, const Variant& variant, Brdfs brdfs, const RadianceImage& image, const RadianceImage& truth) {
  const RadianceImage in_double = renderer.Shade(variant, Precision::kDouble),
                      ideal = renderer.Shade(IdealVariant(variant, brdfs), Precision::kDouble);
  const double floor = RelativeFloor(TotalRadiance(truth));
  ErrorSplit split;
  const auto part = [&](const char* name, const RadianceImage& a, const RadianceImage& b) {
    const std::vector<glm::vec3> first = TotalRadiance(a), second = TotalRadiance(b);
    ErrorSplit::Map map{name, {}};
    for (std::size_t i = 0; i < first.size(); ++i) {
      const double reference = Luminance(second[i]);
      map.magnitude.push_back(static_cast<float>(std::abs(Luminance(first[i]) - reference) / std::max(reference, floor)));
    }
    split.maps.push_back(std::move(map));
    return CompareImages(first, second, truth.width).rel_rmse;
  };
  split.model = part("model", ideal, truth);
  split.approximation = part("approximation", in_double, ideal);
  split.rounding = part("rounding", image, in_double);
  return split;
}

}  // namespace

Results Compare(Context& context, const ShaderLibrary& library, const CompareOptions& options) {
  Results results;
  results.machine = Machine();
  results.platform = context.platform();
  results.renderer = context.renderer();
  results.gl_version = context.version();
  results.software = context.software();
  if (options.cost) results.compilers = options.cost->compilers();

  Renderer renderer(context.gl(), library);
  results.scenes.reserve(options.scenes.size());  // they stay in place while they are measured
  tbb::task_group measuring;  // rethrows what a task threw
  const double scene_share = 1.0 / static_cast<double>(std::max<std::size_t>(options.scenes.size(), 1));
  for (std::size_t s = 0; s < options.scenes.size(); ++s) {
    Scene scene = LoadScene(options.scenes[s]);
    const auto report = [&](const std::string& what, double fraction) {
      if (options.progress) options.progress(scene.name + ": " + what, (static_cast<double>(s) + fraction) * scene_share);
    };
    CachedApertures(scene, options.cache, [&](double fraction) { report("apertures", 0.1 * fraction); });
    report("G-buffer", 0.0);
    const SurfacePixels& pixels = renderer.DrawScene(scene, options.size);

    TruthOptions truth_options = options.truth;
    truth_options.progress = [&](double fraction) { report("truth", 0.35 * fraction); };
    const Truth truth = CachedTruth(scene, pixels, truth_options, options.cache);
    ShadowOptions shadow_options = options.shadow;
    shadow_options.progress = [&](double fraction) { report("truth with shadows", 0.35 + 0.15 * fraction); };
    const ShadowedTruth shadowed =
        CachedShadowedTruth(scene, pixels, truth.radiance, truth_options, shadow_options, options.cache);

    SceneResult result;
    result.name = scene.name;
    result.question = scene.question;
    result.file = scene.file.filename().string();
    result.unit = scene.units == Units::kRadiometric ? "W/(m² sr)" : "cd/m²";
    result.width = pixels.width;
    result.height = pixels.height;
    result.exposure = scene.exposure;
    for (const Effect& effect : SceneEffects(scene)) {
      if (effect.on) result.effects.push_back(effect.name);
    }
    result.truth_relative_error = truth.worst_relative_error;
    result.truth_seconds = truth.seconds;
    result.truth_cached = truth.cached;
    result.truth = std::make_shared<const RadianceImage>(truth.radiance);
    if (scene.aperture) {
      // Every variant takes its visibility from the apertures: they are ranked against truth that has it too.
      result.truth_shadowed = true;
      result.truth = std::make_shared<const RadianceImage>(shadowed.radiance);
      result.truth_relative_error = shadowed.p99_error;
      result.truth_seconds = truth.seconds + shadowed.seconds;
      result.truth_cached = truth.cached && shadowed.cached;
    } else {
      result.shadow = Describe(shadowed, truth.radiance);
    }
    result.lit_pixels = CountLit(*result.truth);
    result.emission = std::make_shared<const std::vector<glm::vec3>>(EmissionImage(scene, pixels));

    // Other programs compile for other GPUs while this one draws.
    std::vector<VariantResult> counted(options.variants.size());
    std::string no_isa;
    tbb::task_group counting;
    if (options.cost) {
      counting.run([&] { CountCycles(*options.cost, library, options.variants, scene, counted, no_isa); });
    }
    for (std::size_t v = 0; v < options.variants.size(); ++v) {
      const Variant& variant = options.variants[v];
      report(variant.ShortName(), 0.5 + 0.2 * static_cast<double>(v) / static_cast<double>(options.variants.size()));
      VariantResult row = Describe(variant, scene);
      if (row.supported) row.image = std::make_shared<const RadianceImage>(renderer.Shade(variant));
      if (row.supported && options.split) row.split = SplitError(renderer, variant, scene.brdfs(), *row.image, truth.radiance);
      if (row.supported && options.split && !WhyNoCauses(variant, scene)) {
        row.split.causes = DescribeCauses(SplitByCause(renderer, library, variant, scene, options.size, *row.image, truth.radiance, options.truth, options.cache), truth.radiance);
      }
      result.variants.push_back(std::move(row));
    }
    if (options.cost) report("cycles", 0.7);
    counting.wait();
    for (std::size_t v = 0; v < counted.size(); ++v) result.variants[v].isa = std::move(counted[v].isa);
    if (!no_isa.empty()) results.no_isa = no_isa;
    if (options.timed_against) {
      measuring.wait();  // the clock is this process's, on every core
      TimingOptions timing = options.timing;
      timing.progress = [&](double fraction) { report("times", 0.7 + 0.2 * fraction); };
      Time(context, renderer, options.variants, *options.timed_against, result.lit_pixels, result.variants, timing);
    }
    if (options.saving_seconds > 0.0) {
      measuring.wait();
      Renderer::Needs needs = renderer.TileNeeds();
      result.tile_columns = needs.tiles.x;
      result.tile_needs = std::move(needs.of_tile);
      MeasureSavings(context, renderer, library, scene, options, [&](double fraction) { report("savings", 0.7 + 0.2 * fraction); },
                     result.variants);
    }
    report("errors", 0.9);
    measuring.wait();  // the scene before: at most one is measured while another is shaded
    results.scenes.push_back(std::move(result));
    measuring.run([&scene_result = results.scenes.back(), &options] {
      MeasureScene(options.variants, scene_result);
      if (options.done) options.done(scene_result);
    });
  }
  measuring.wait();
  return results;
}

double MetricByName(const ErrorMetrics& metrics, const std::string& name) {
  const std::map<std::string, double> figures = {
      {"rel_rmse", metrics.rel_rmse}, {"bias", std::abs(metrics.bias)}, {"relmse", metrics.relmse}, {"mae", metrics.mae},
      {"p99", metrics.p99},           {"max", metrics.max},             {"flip", metrics.flip}};
  const auto found = figures.find(name);
  if (found != figures.end()) return found->second;
  std::string known;
  for (const auto& figure : figures) known += (known.empty() ? "" : ", ") + figure.first;
  throw InputError(fmt::format("no metric \"{}\"; expected one of {}", name, known));
}

}  // namespace arealab
