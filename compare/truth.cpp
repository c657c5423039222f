#include "compare/truth.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <optional>
#include <thread>
#include <utility>

#include "compare/sky_integrals.h"
#include "compare/textured_sky.h"
#include "compare/textured_truth.h"
#include "compare/truth_bands.h"
#include "scenes/error.h"

namespace arealab {
namespace {

constexpr double kMinAlpha = 1e-4;  // as in glsl/surface.glsl

}  // namespace

std::optional<ShadedPixel> ShadedPixelAt(const Scene& scene, const SurfacePixels& pixels, std::size_t i) {
  if (!pixels.IsSurface(i)) return std::nullopt;
  ShadedPixel pixel;
  pixel.point.position = glm::dvec3(pixels.position[i]);
  pixel.point.normal = glm::normalize(glm::dvec3(pixels.normal[i]));
  pixel.point.to_view = glm::normalize(glm::dvec3(pixels.view_position) - pixel.point.position);
  double roughness = static_cast<double>(pixels.normal[i].w);
  pixel.point.alpha = std::max(roughness * roughness, kMinAlpha);
  pixel.point.brdf = scene.brdf;
  pixel.point.diffuse = scene.diffuse;
  pixel.point.roughness = roughness;
  if (!(glm::dot(pixel.point.normal, pixel.point.to_view) > 0.0)) return std::nullopt;
  glm::dvec3 base(pixels.base_color[i]);
  double metalness = std::max(static_cast<double>(pixels.base_color[i].w), 0.0);
  pixel.specular_weight = 1.0 + std::min(static_cast<double>(pixels.base_color[i].w), 0.0);
  pixel.albedo = base * (1.0 - metalness);
  pixel.f0 = glm::mix(glm::dvec3(0.04), base, metalness);
  return pixel;
}

namespace {

TruthBand ShadeBand(const Scene& scene, const SceneLights& lights, const SkyIntegrals& sky_integrals, const TexturedSky& textured_sky,
                    const SurfacePixels& pixels, int row_begin, int row_end, double tolerance) {
  TruthBand band;
  auto width = static_cast<std::size_t>(pixels.width);
  std::size_t begin = static_cast<std::size_t>(row_begin) * width,
              end = static_cast<std::size_t>(row_end) * width;
  band.diffuse.resize(end - begin, glm::vec3(0.0f));
  band.specular.resize(end - begin, glm::vec3(0.0f));
  band.relative_error.resize(end - begin, 0.0f);
  for (std::size_t i = begin; i < end; ++i) {
    const std::optional<ShadedPixel> pixel = ShadedPixelAt(scene, pixels, i);
    if (!pixel) continue;
    const glm::dvec3 &albedo = pixel->albedo, &f0 = pixel->f0;
    glm::dvec3 diffuse(0.0), specular(0.0), error(0.0);
    const auto add = [&](const glm::dvec3& radiance, const ColorIntegrals& s) {
      diffuse += albedo * radiance * s.form_factor;
      specular += pixel->specular_weight * radiance * (f0 * (s.specular - s.specular_grazing) + s.specular_grazing);
      error += glm::abs(radiance) * (albedo * s.form_factor_error +
                                     pixel->specular_weight * (f0 * s.specular_error + (1.0 - f0) * s.specular_grazing_error));
    };
    const glm::dvec3& sky = textured_sky.mean();  // a light stands before it
    for (std::size_t l = 0; l < scene.lights.size(); ++l) {
      const Light& light = scene.lights[l];
      const ColorIntegrals integrals = lights.Integrate(pixel->point, l, tolerance);
      if (!light.texture) {
        add(light.radiance - sky, integrals);
        continue;
      }
      add(light.radiance, integrals);
      if (scene.sky) add(-sky, ColorIntegrals(IntegrateLight(pixel->point, light, tolerance)));
    }
    if (scene.sky) add(sky, ColorIntegrals(sky_integrals.At(pixel->point)));
    if (textured_sky) {
      const TexturedSky::Rest rest = textured_sky.Integrate(*pixel);
      diffuse = glm::max(diffuse + rest.all.diffuse, 0.0);
      specular = glm::max(specular + rest.all.specular, 0.0);
      error += rest.error;
    }
    band.diffuse[i - begin] = glm::vec3(diffuse);
    band.specular[i - begin] = glm::vec3(specular);
    double total = diffuse.x + diffuse.y + diffuse.z + specular.x + specular.y + specular.z;
    if (total > 0.0) {
      band.relative_error[i - begin] = static_cast<float>((error.x + error.y + error.z) / total);
    }
  }
  return band;
}

}  // namespace

BandShader UnshadowedBands(const Scene& scene, const SurfacePixels& pixels, double tolerance) {
  if (const auto why = WhyNotDiffuse(scene)) throw InputError(fmt::format("{}; expected {}", *why, Name(Brdf::kLambert)));
  return [&scene, lights = SceneLights(scene), sky = SkyIntegrals(scene, pixels), textured_sky = std::make_shared<const TexturedSky>(scene), &pixels,
          tolerance](int row_begin, int row_end) {
    return ShadeBand(scene, lights, sky, *textured_sky, pixels, row_begin, row_end, tolerance);
  };
}

TruthBand JoinBands(std::vector<TruthBand> bands) {
  TruthBand whole;
  for (const TruthBand& band : bands) {
    auto append = [](auto& all, const auto& part) { all.insert(all.end(), part.begin(), part.end()); };
    append(whole.diffuse, band.diffuse);
    append(whole.specular, band.specular);
    append(whole.relative_error, band.relative_error);
    whole.seconds += band.seconds;
  }
  return whole;
}

double Quantile(std::vector<float> values, double share) {
  if (values.empty()) return 0.0;
  auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return static_cast<double>(values[static_cast<std::size_t>(rank)]);
}

Truth AssembleTruth(const SurfacePixels& pixels, TruthBand whole) {
  Truth truth;
  truth.radiance = {pixels.width, pixels.height, std::move(whole.diffuse), std::move(whole.specular)};
  truth.relative_error = std::move(whole.relative_error);
  truth.seconds = whole.seconds;
  std::vector<float> lit;
  for (std::size_t i = 0; i < truth.relative_error.size(); ++i) {
    if (truth.radiance.Total(i) != glm::vec3(0.0f)) {
      lit.push_back(truth.relative_error[i]);
    }
  }
  truth.worst_relative_error = Quantile(std::move(lit), 0.999);
  return truth;
}

Truth ComputeTruth(const Scene& scene, const SurfacePixels& pixels, const TruthOptions& options) {
  auto start = std::chrono::steady_clock::now();
  int band_count = (pixels.height + kTruthBandRows - 1) / kTruthBandRows;
  std::vector<TruthBand> bands(static_cast<std::size_t>(band_count));
  ShadeBands(pixels.height, UnshadowedBands(scene, pixels, options.tolerance), options.progress, bands,
             std::vector<bool>(bands.size(), true), {});
  Truth truth = AssembleTruth(pixels, JoinBands(std::move(bands)));
  truth.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return truth;
}

void ShadeBands(int height, const BandShader& shade, const std::function<void(double)>& progress,
                std::vector<TruthBand>& bands, const std::vector<bool>& wanted,
                const std::function<void(int, const TruthBand&)>& done) {
  // Progress comes from the calling thread alone: it looks at the count after each of its own bands.
  auto caller = std::this_thread::get_id();
  std::atomic<std::size_t> finished{0};
  auto total =
      static_cast<double>(std::max<std::ptrdiff_t>(std::count(wanted.begin(), wanted.end(), true), 1));
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, bands.size(), 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t b = range.begin(); b < range.end(); ++b) {
          if (!wanted[b]) {
            continue;
          }
          auto start = std::chrono::steady_clock::now();
          int row = static_cast<int>(b) * kTruthBandRows;
          bands[b] = shade(row, std::min(row + kTruthBandRows, height));
          bands[b].seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
          if (done) {
            done(static_cast<int>(b), bands[b]);
          }
          std::size_t count = ++finished;
          if (progress && std::this_thread::get_id() == caller) {
            progress(static_cast<double>(count) / total);
          }
        }
      },
      tbb::simple_partitioner());
  if (progress) {
    progress(1.0);
  }
}

}  // namespace arealab
