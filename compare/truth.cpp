#include "compare/truth.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <thread>
#include <utility>

#include "compare/truth_bands.h"
#include "glsl/fit_lobe.h"

namespace arealab {
namespace {

constexpr double kMinAlpha = 1e-4;  // as in glsl/surface.glsl

// Points across and around the half-vector domain: against 96 of each relative errors are measured in tests/compare/sky_test.cpp.
constexpr int kSkyNodes = 32;
// Where both rules are this good, their difference is chance.
constexpr double kSkyRounding = 2e-8;

}  // namespace

LightIntegrals IntegrateSky(const ShadingPoint& point) {
  const double cosine = glm::dot(point.normal, point.to_view);
  LightIntegrals sky;
  if (!(cosine > 0.0)) return sky;
  fit::View view;
  view.brdf = point.brdf;
  view.alpha = point.alpha;
  view.cosine = std::min(cosine, 1.0);
  view.sine = std::sqrt(std::max(0.0, (1.0 - view.cosine) * (1.0 + view.cosine)));
  const fit::LobeMoments fine = fit::Moments(fit::UpperNodes(view, kSkyNodes, kSkyNodes));
  const fit::LobeMoments coarse = fit::Moments(fit::UpperNodes(view, kSkyNodes / 2, kSkyNodes / 2));
  sky.form_factor = 1.0;
  sky.specular = fine.albedo;
  sky.specular_grazing = fine.schlick;
  sky.form_factor_error = std::numeric_limits<double>::epsilon();
  sky.specular_error = std::abs(fine.albedo - coarse.albedo) + kSkyRounding;
  sky.specular_grazing_error = std::abs(fine.schlick - coarse.schlick) + kSkyRounding;
  return sky;
}

std::optional<ShadedPixel> ShadedPixelAt(const Scene& scene, const SurfacePixels& pixels, std::size_t i) {
  if (!pixels.IsSurface(i)) return std::nullopt;
  ShadedPixel pixel;
  pixel.point.position = glm::dvec3(pixels.position[i]);
  pixel.point.normal = glm::normalize(glm::dvec3(pixels.normal[i]));
  pixel.point.to_view = glm::normalize(glm::dvec3(pixels.view_position) - pixel.point.position);
  double roughness = static_cast<double>(pixels.normal[i].w);
  pixel.point.alpha = std::max(roughness * roughness, kMinAlpha);
  pixel.point.brdf = scene.brdf;
  if (!(glm::dot(pixel.point.normal, pixel.point.to_view) > 0.0)) return std::nullopt;
  glm::dvec3 base(pixels.base_color[i]);
  double metalness = std::max(static_cast<double>(pixels.base_color[i].w), 0.0);
  pixel.specular_weight = 1.0 + std::min(static_cast<double>(pixels.base_color[i].w), 0.0);
  pixel.albedo = base * (1.0 - metalness);
  pixel.f0 = glm::mix(glm::dvec3(0.04), base, metalness);
  return pixel;
}

namespace {

TruthBand ShadeBand(const Scene& scene, const SurfacePixels& pixels, int row_begin, int row_end,
                    double tolerance) {
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
    const auto add = [&](const glm::dvec3& radiance, const LightIntegrals& s) {
      diffuse += albedo * radiance * s.form_factor;
      specular += pixel->specular_weight * radiance * (f0 * (s.specular - s.specular_grazing) + s.specular_grazing);
      error += glm::abs(radiance) * (albedo * s.form_factor_error +
                                     pixel->specular_weight * (f0 * s.specular_error + (1.0 - f0) * s.specular_grazing_error));
    };
    const glm::dvec3 sky = scene.sky.value_or(glm::dvec3(0.0));
    for (const Light& light : scene.lights) add(light.radiance - sky, IntegrateLight(pixel->point, light, tolerance));
    if (scene.sky) add(sky, IntegrateSky(pixel->point));
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
  return [&scene, &pixels, tolerance](int row_begin, int row_end) {
    return ShadeBand(scene, pixels, row_begin, row_end, tolerance);
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
