#include "compare/truth.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "compare/truth_bands.h"

namespace arealab {
namespace {

constexpr double kMinAlpha = 1e-4;  // as in glsl/surface.glsl

}  // namespace

TruthBand ShadeBand(const Scene& scene, const SurfacePixels& pixels, int row_begin, int row_end,
                    double tolerance) {
  TruthBand band;
  auto width = static_cast<std::size_t>(pixels.width);
  std::size_t begin = static_cast<std::size_t>(row_begin) * width,
              end = static_cast<std::size_t>(row_end) * width;
  band.diffuse.resize(end - begin, glm::vec3(0.0f));
  band.specular.resize(end - begin, glm::vec3(0.0f));
  band.relative_error.resize(end - begin, 0.0f);
  glm::dvec3 camera(pixels.view_position);
  for (std::size_t i = begin; i < end; ++i) {
    if (!pixels.IsSurface(i)) {
      continue;
    }
    ShadingPoint point;
    point.position = glm::dvec3(pixels.position[i]);
    point.normal = glm::normalize(glm::dvec3(pixels.normal[i]));
    point.to_view = glm::normalize(camera - point.position);
    double roughness = static_cast<double>(pixels.normal[i].w);
    point.alpha = std::max(roughness * roughness, kMinAlpha);
    if (!(glm::dot(point.normal, point.to_view) > 0.0)) {
      continue;  // faces turned away from the viewer shade black
    }
    glm::dvec3 base(pixels.base_color[i]);
    double metalness = static_cast<double>(pixels.base_color[i].w);
    glm::dvec3 albedo = base * (1.0 - metalness), f0 = glm::mix(glm::dvec3(0.04), base, metalness);
    glm::dvec3 diffuse(0.0), specular(0.0), error(0.0);
    for (const Light& light : scene.lights) {
      LightIntegrals s = IntegrateLight(point, light, tolerance);
      diffuse += albedo * light.radiance * s.form_factor;
      specular += light.radiance * (f0 * (s.specular - s.specular_grazing) + s.specular_grazing);
      error += light.radiance *
               (albedo * s.form_factor_error + f0 * s.specular_error + (1.0 - f0) * s.specular_grazing_error);
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

Truth AssembleTruth(const SurfacePixels& pixels, std::vector<TruthBand> bands) {
  Truth truth;
  truth.radiance.width = pixels.width;
  truth.radiance.height = pixels.height;
  for (TruthBand& band : bands) {
    auto append = [](auto& all, const auto& part) { all.insert(all.end(), part.begin(), part.end()); };
    append(truth.radiance.diffuse, band.diffuse);
    append(truth.radiance.specular, band.specular);
    append(truth.relative_error, band.relative_error);
    truth.seconds += band.seconds;
  }
  std::vector<float> lit;
  for (std::size_t i = 0; i < truth.relative_error.size(); ++i) {
    if (truth.radiance.Total(i) != glm::vec3(0.0f)) {
      lit.push_back(truth.relative_error[i]);
    }
  }
  if (!lit.empty()) {
    auto rank = static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(lit.size() - 1) + 0.5);
    std::nth_element(lit.begin(), lit.begin() + rank, lit.end());
    truth.worst_relative_error = static_cast<double>(lit[static_cast<std::size_t>(rank)]);
  }
  return truth;
}

Truth ComputeTruth(const Scene& scene, const SurfacePixels& pixels, const TruthOptions& options) {
  auto start = std::chrono::steady_clock::now();
  int band_count = (pixels.height + kTruthBandRows - 1) / kTruthBandRows;
  std::vector<TruthBand> bands(static_cast<std::size_t>(band_count));
  ShadeBands(scene, pixels, options, bands, std::vector<bool>(bands.size(), true), {});
  Truth truth = AssembleTruth(pixels, std::move(bands));
  truth.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return truth;
}

void ShadeBands(const Scene& scene, const SurfacePixels& pixels, const TruthOptions& options,
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
          bands[b] =
              ShadeBand(scene, pixels, row, std::min(row + kTruthBandRows, pixels.height), options.tolerance);
          bands[b].seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
          if (done) {
            done(static_cast<int>(b), bands[b]);
          }
          std::size_t count = ++finished;
          if (options.progress && std::this_thread::get_id() == caller) {
            options.progress(static_cast<double>(count) / total);
          }
        }
      },
      tbb::simple_partitioner());
  if (options.progress) {
    options.progress(1.0);
  }
}

}  // namespace arealab
