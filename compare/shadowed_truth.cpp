#include "compare/shadowed_truth.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>

#include "compare/light_sampling.h"
#include "compare/sky_integrals.h"
#include "compare/textured_sky.h"
#include "compare/textured_truth.h"
#include "compare/truth_bands.h"
#include "compare/truth_cache.h"
#include "scenes/light_texture.h"
#include "scenes/ray_query.h"
// clang-format off: the order matters
#include "glsl/dual_begin.h"
#include "glsl/brdf.glsl"
#include "glsl/brdf_choices.h"
#include "glsl/dual_end.h"
// clang-format on

namespace arealab {
namespace {

constexpr std::size_t kGroups = 16;
constexpr std::uint32_t kFirst = 32, kMost = 512;  // directions of one strategy
constexpr std::uint32_t kFirstOfSky = 256;  // what is left of a sky behind windows may be little, and is all there is
constexpr std::uint64_t kSeed = 0xa4ea1ab;          // of everything; any other gives as good a picture
constexpr double kLightShare = 0.05;  // of the tolerance: how well the lights are integrated one by one
constexpr double kFarShare = 1.0 - 0x1p-17;  // rays end before the light: a wall may touch it

enum Integral : std::size_t { kDiffuse, kSpecular, kGrazing, kIntegrals };
constexpr std::size_t kSums = 3 * kIntegrals;  // one of each channel

// The four planes that join the light to the point, the horizon, and the light's plane unless `through` it.
Shaft ShaftTo(const ShadingPoint& point, const LightDirections& light, bool through = false) {
  Shaft shaft;
  shaft.apex = point.position;
  const std::array<glm::dvec3, 4> corners = light.Corners();
  const glm::dvec3 middle = corners[0] + corners[1] + corners[2] + corners[3];
  for (std::size_t k = 0; k < 4; ++k) {
    glm::dvec3 normal = glm::cross(corners[k], corners[(k + 1) % 4]);
    const double length = glm::length(normal);
    if (length == 0.0) continue;
    normal /= glm::dot(normal, middle) < 0.0 ? -length : length;
    shaft.Add(normal, 0.0);
  }
  if (!through) shaft.Add(light.back_normal(), -light.back_distance());
  shaft.Add(point.normal, 0.0);
  return shaft;
}

// What one light that something may hide gives to one point.
class SampledLight {
 public:
  // Radiance of the diffuse lobe, and of the specular one with F0 and with 1 − F0: all unshadowed.
  std::array<glm::dvec3, kIntegrals> unshadowed;

  // `textured` is the light where it has a texture, and outlives this. `through`: what lies behind the light hides it too, since
  // it is the sky there.
  SampledLight(const ShadedPixel& pixel, const glm::dvec3& radiance, const Light* textured, const ColorIntegrals& integrals,
               const LightDirections& directions, std::uint64_t seed, bool through = false)
      : unshadowed{pixel.albedo * radiance * integrals.form_factor,
                   pixel.specular_weight * pixel.f0 * radiance * integrals.specular,
                   pixel.specular_weight * (1.0 - pixel.f0) * radiance * integrals.specular_grazing},
        point_(&pixel.point),
        light_(textured),
        channels_(textured ? 3 : 1),
        directions_(directions),
        through_(through),
        seed_(seed) {
    std::array<double, kIntegrals> sum;
    for (std::size_t k = 0; k < kIntegrals; ++k) {
      const glm::dvec3 size = glm::abs(unshadowed[k]);  // a light that is dimmer than the sky takes away
      sum[k] = size.x + size.y + size.z;
      for (std::size_t c = 0; c < channels_; ++c) shares_[k * channels_ + c] = light_ ? size[static_cast<int>(c)] : sum[k];
    }
    const glm::dvec3 &n = point_->normal, &v = point_->to_view;
    z_ = n;
    y_ = glm::cross(n, v);
    const double sine = glm::length(y_);
    y_ = sine > 1e-12 ? y_ / sine
                      : glm::normalize(glm::cross(
                            n, std::abs(n.x) < 0.5 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0)));
    x_ = glm::cross(y_, n);
    cos_v_ = glm::dot(n, v);
    view_ = glm::dvec3(sine, 0.0, cos_v_);
    // Where the light covers more than a quarter of the lobe's middle, 4πα² cosθ sr of the density's peak,
    // the lobe's own directions serve better; unless the highlight hardly counts here.
    const double lobe = 4.0 * std::numbers::pi * point_->alpha * point_->alpha * cos_v_;
    const double specular = sum[kSpecular] + sum[kGrazing];
    by_lobe_ = directions_.solid_angle() > 0.25 * lobe && specular > 0.02 * (specular + sum[kDiffuse]);
  }

  std::uint32_t count() const { return count_; }
  double variance() const { return variance_; }

  // Twice as many directions, or the `first` ones; rays begin at `origin`.
  void Refine(const RayQuery& rays, const glm::dvec3& origin, std::uint32_t first = kFirst) {
    const std::uint32_t begin = count_, end = count_ == 0 ? first : 2 * count_;
    static thread_local Scratch scratch;  // keeps its memory
    scratch.rays.clear();
    scratch.weighted.clear();
    const std::uint64_t light_seed = Mix(seed_, 0), lobe_seed = Mix(seed_, 1);
    for (std::uint32_t i = begin; i < end; ++i) {
      const std::size_t group = kGroups * (i - begin) / (end - begin);
      Add(group, directions_.At(ScrambledSobol(i, light_seed)), scratch);
      if (!by_lobe_) continue;
      const glm::dvec3 local = SampleVisibleGgx(view_, point_->alpha, ScrambledSobol(i, lobe_seed));
      const auto sample = directions_.Towards(x_ * local.x + y_ * local.y + z_ * local.z);
      if (sample) Add(group, *sample, scratch);
    }
    count_ = end;
    scratch.occluded.resize(scratch.rays.size());
    rays.Occluded(origin, scratch.rays, scratch.occluded);
    for (std::size_t i = 0; i < scratch.weighted.size(); ++i) {
      const Weighted& w = scratch.weighted[i];
      for (std::size_t k = 0; k < kIntegrals * channels_; ++k) {
        weight_[k][w.group] += w.weight[k];
        if (scratch.occluded[i] == 0) free_[k][w.group] += w.weight[k];
        square_[k] += w.weight[k] * w.weight[k];
      }
    }
    Estimate();
  }

  // The share of an integral that arrives, of each channel.
  glm::dvec3 Visible(Integral k) const {
    const auto of = [&](std::size_t c) { return visible_[k * channels_ + std::min(c, channels_ - 1)]; };
    return {of(0), of(1), of(2)};
  }
  bool AllVisible() const {
    return std::all_of(visible_.begin(), visible_.begin() + kIntegrals * channels_, [](double v) { return v == 1.0; });
  }

 private:
  struct Weighted {
    std::size_t group;
    std::array<double, kSums> weight;
  };
  struct Scratch {
    std::vector<RayQuery::ShadowRay> rays;
    std::vector<Weighted> weighted;
    std::vector<std::uint8_t> occluded;
  };

  void Add(std::size_t group, const LightDirections::Sample& sample, Scratch& scratch) const {
    const double cos_l = glm::dot(z_, sample.direction);
    if (!(cos_l > 0.0) || !(sample.density > 0.0)) return;
    glm::dvec3 half = sample.direction + point_->to_view;
    half /= glm::length(half);
    const double density_h = dual::GgxDensity(std::min(glm::dot(z_, half), 1.0), point_->alpha);
    double density = sample.density;
    if (by_lobe_) density += density_h * dual::SmithG1(cos_v_, point_->alpha) / (4.0 * cos_v_);
    Weighted w;
    w.group = group;
    std::array<double, kIntegrals> weight;
    const double cos_h = glm::dot(z_, half), tan2_h = std::max(1.0 / (cos_h * cos_h) - 1.0, 0.0);
    weight[kSpecular] = density_h * cos_l / density *
                          dual::BrdfOverGgx(point_->brdf, cos_v_, cos_l, glm::dot(half, point_->to_view), tan2_h,
                                            point_->alpha);
    weight[kDiffuse] = cos_l / density * dual::BrdfOverGgx(point_->diffuse, cos_v_, cos_l, glm::dot(half, point_->to_view), tan2_h, 1.0, point_->roughness);
    weight[kGrazing] = weight[kSpecular] * dual::SchlickWeight(glm::dot(half, point_->to_view));
    if (!std::isfinite(weight[kDiffuse]) || !std::isfinite(weight[kSpecular])) return;
    glm::dvec3 texel(1.0);
    if (light_) {
      const bool back = glm::dot(sample.direction, light_->normal) > 0.0;
      texel = TextureAt(*light_->texture, TextureCoordinates(*light_, point_->position + sample.distance * sample.direction, back));
    }
    for (std::size_t k = 0; k < kIntegrals * channels_; ++k) w.weight[k] = weight[k / channels_] * texel[static_cast<int>(k % channels_)];
    scratch.weighted.push_back(w);
    scratch.rays.push_back({glm::vec3(sample.direction), through_ ? std::numeric_limits<float>::infinity() : static_cast<float>(sample.distance * kFarShare)});
  }

  void Estimate() {
    std::array<double, kGroups> residual{};
    double unseen = 0.0;  // what a ray that fell between could change
    for (std::size_t k = 0; k < kIntegrals * channels_; ++k) {
      double weight = 0.0, free = 0.0;
      for (std::size_t r = 0; r < kGroups; ++r) {
        weight += weight_[k][r];
        free += free_[k][r];
      }
      if (weight == 0.0) {  // the lobe lies where no direction fell
        visible_[k] = k < channels_ ? 1.0 : visible_[k % channels_];
        unseen += shares_[k];
        continue;
      }
      visible_[k] = free / weight;
      const double scale = shares_[k] * static_cast<double>(kGroups) / weight;
      for (std::size_t r = 0; r < kGroups; ++r) {
        residual[r] += scale * (free_[k][r] - visible_[k] * weight_[k][r]);
      }
      const double effective = weight * weight / square_[k];  // as many rays of equal weight
      unseen += shares_[k] * 0.5 / (effective + 1.0);
    }
    double sum = 0.0;
    for (double r : residual) sum += r * r;
    variance_ = sum / static_cast<double>(kGroups * (kGroups - 1)) + unseen * unseen;
  }

  const ShadingPoint* point_;
  const Light* light_;    // where it has a texture; then each channel has sums of its own
  std::size_t channels_;
  LightDirections directions_;
  bool through_;
  std::uint64_t seed_;
  glm::dvec3 x_, y_, z_, view_;  // the frame of the lobe, and the viewer in it
  double cos_v_ = 0.0;
  bool by_lobe_ = false;
  std::array<double, kSums> shares_{}, square_{}, visible_{};
  std::array<std::array<double, kGroups>, kSums> weight_{}, free_{};
  std::uint32_t count_ = 0;
  double variance_ = 0.0;
};

double Sum(const glm::dvec3& v) {
  return v.x + v.y + v.z;
}

struct ShadowBands {
  const Scene& scene;
  SceneLights integrator;
  SkyIntegrals sky_integrals;
  std::shared_ptr<const TexturedSky> textured_sky;
  const SurfacePixels& pixels;
  const RadianceImage& unshadowed;
  double light_tolerance, tolerance;
  std::shared_ptr<const RayQuery> rays;

  TruthBand operator()(int row_begin, int row_end) const {
    const auto width = static_cast<std::size_t>(pixels.width);
    const std::size_t begin = static_cast<std::size_t>(row_begin) * width,
                      end = static_cast<std::size_t>(row_end) * width;
    TruthBand band;
    const auto part = [&](const std::vector<glm::vec3>& all) {
      return std::vector<glm::vec3>(all.begin() + static_cast<std::ptrdiff_t>(begin),
                                    all.begin() + static_cast<std::ptrdiff_t>(end));
    };
    band.diffuse = part(unshadowed.diffuse);
    band.specular = part(unshadowed.specular);
    band.relative_error.resize(end - begin, 0.0f);
    std::vector<SampledLight> lights;
    for (std::size_t i = begin; i < end; ++i) {
      Shade(i, lights, band.diffuse[i - begin], band.specular[i - begin], band.relative_error[i - begin]);
    }
    return band;
  }

 private:
  // Takes the unshadowed radiance of pixel i and leaves the shadowed one.
  void Shade(std::size_t i, std::vector<SampledLight>& lights, glm::vec3& diffuse, glm::vec3& specular,
             float& relative_error) const {
    const std::optional<ShadedPixel> pixel = *textured_sky ? ShadedPixelAt(scene, pixels, i) : std::nullopt;
    if (!pixel) return ShadeEven(i, lights, diffuse, specular, relative_error);
    const double total = Sum(glm::dvec3(diffuse)) + Sum(glm::dvec3(specular));
    Shaft above;
    above.apex = pixel->point.position;
    above.Add(pixel->point.normal, 0.0);
    const bool hidden = rays->MayBlock(above);
    const TexturedSky::Rest rest = textured_sky->Integrate(*pixel, hidden ? rays.get() : nullptr, rays->Origin(pixel->point.position, glm::dvec3(pixels.view_position)));
    diffuse -= glm::vec3(rest.all.diffuse);
    specular -= glm::vec3(rest.all.specular);
    ShadeEven(i, lights, diffuse, specular, relative_error);
    diffuse = glm::max(diffuse + glm::vec3(rest.free.diffuse), 0.0f);
    specular = glm::max(specular + glm::vec3(rest.free.specular), 0.0f);
    if (total > 0.0 && hidden) relative_error += static_cast<float>(Sum(rest.error) / total);
  }

  // The same of what lights and an even sky give.
  void ShadeEven(std::size_t i, std::vector<SampledLight>& lights, glm::vec3& diffuse, glm::vec3& specular,
                 float& relative_error) const {
    const double total = Sum(glm::dvec3(diffuse)) + Sum(glm::dvec3(specular));
    const std::optional<ShadedPixel> pixel = ShadedPixelAt(scene, pixels, i);
    if (!pixel || !(total > 0.0)) return;
    lights.clear();
    bool others = false;  // lights that are free
    bool sky_last = false;  // among those to be sampled
    const glm::dvec3& sky = textured_sky->mean();
    for (std::size_t l = 0; l < scene.lights.size(); ++l) {
      const Light& light = scene.lights[l];
      const auto directions = LightDirections::From(pixel->point.position, pixel->point.normal, light);
      if (!directions) continue;
      const std::uint64_t seed = Mix(Mix(kSeed, i), l);
      const bool hidden = rays->MayBlock(ShaftTo(pixel->point, *directions));
      if (!hidden) others = true;
      if (hidden) {
        const ColorIntegrals integrals = integrator.Integrate(pixel->point, l, light_tolerance);
        if (integrals.form_factor == glm::dvec3(0.0) && integrals.specular == glm::dvec3(0.0)) continue;
        lights.emplace_back(*pixel, light.radiance, light.texture ? &light : nullptr, integrals, *directions, seed);
      }
      // The light hides the sky behind it, unless something else does already.
      if (!scene.sky || !rays->MayBlock(ShaftTo(pixel->point, *directions, true))) continue;
      lights.emplace_back(*pixel, -sky, nullptr, ColorIntegrals(IntegrateLight(pixel->point, light, light_tolerance)), *directions, seed, true);
    }
    if (scene.sky) {
      Shaft above;
      above.apex = pixel->point.position;
      above.Add(pixel->point.normal, 0.0);
      if (rays->MayBlock(above)) {
        lights.emplace_back(*pixel, sky, nullptr, ColorIntegrals(sky_integrals.At(pixel->point)), LightDirections::Sky(pixel->point.normal),
                            Mix(Mix(kSeed, i), scene.lights.size()));
        sky_last = true;
      } else {
        others = true;
      }
    }
    if (lights.empty()) return;
    const glm::dvec3 origin = rays->Origin(pixel->point.position, glm::dvec3(pixels.view_position));
    const SampledLight* sky_light = sky_last ? &lights.back() : nullptr;
    double variance = 0.0;
    for (SampledLight& light : lights) {
      light.Refine(*rays, origin, &light == sky_light ? kFirstOfSky : kFirst);
      variance += light.variance();
    }
    const double goal = tolerance * total * tolerance * total;
    while (variance > goal) {
      SampledLight* worst = nullptr;
      for (SampledLight& light : lights) {
        if (light.count() < kMost && (worst == nullptr || light.variance() > worst->variance()))
          worst = &light;
      }
      if (worst == nullptr || worst->variance() == 0.0) break;
      worst->Refine(*rays, origin);
      variance = 0.0;
      for (const SampledLight& light : lights) variance += light.variance();
    }
    relative_error = static_cast<float>(std::sqrt(variance) / total);
    if (std::all_of(lights.begin(), lights.end(), [](const SampledLight& l) { return l.AllVisible(); }))
      return;
    glm::dvec3 diffuse_left(0.0), specular_left(0.0), diffuse_lost(0.0), specular_lost(0.0);
    for (const SampledLight& light : lights) {
      const glm::dvec3 d = light.Visible(kDiffuse), s = light.Visible(kSpecular), g = light.Visible(kGrazing);
      const auto& whole = light.unshadowed;
      diffuse_left += d * whole[kDiffuse];
      diffuse_lost += (1.0 - d) * whole[kDiffuse];
      specular_left += s * whole[kSpecular] + g * whole[kGrazing];
      specular_lost += (1.0 - s) * whole[kSpecular] + (1.0 - g) * whole[kGrazing];
    }
    // What is left of these lights is a lower bound where others are free, all there is where none are; before a sky lights take
    // away, and black is the bound.
    if (scene.sky) {
      diffuse_left = others ? glm::dvec3(0.0) : glm::max(diffuse_left, 0.0);
      specular_left = others ? glm::dvec3(0.0) : glm::max(specular_left, 0.0);
    }
    diffuse = glm::vec3(others ? glm::max(glm::dvec3(diffuse) - diffuse_lost, diffuse_left) : diffuse_left);
    specular =
        glm::vec3(others ? glm::max(glm::dvec3(specular) - specular_lost, specular_left) : specular_left);
  }
};

ShadowedTruth Assemble(const SurfacePixels& pixels, TruthBand whole) {
  ShadowedTruth truth;
  std::vector<float> sampled;
  for (float error : whole.relative_error) {
    if (error > 0.0f) sampled.push_back(error);
  }
  truth.sampled_pixels = static_cast<int>(sampled.size());
  for (float error : sampled)
    truth.mean_error += static_cast<double>(error) / static_cast<double>(sampled.size());
  truth.p99_error = Quantile(std::move(sampled), 0.99);
  truth.radiance = {pixels.width, pixels.height, std::move(whole.diffuse), std::move(whole.specular)};
  truth.relative_error = std::move(whole.relative_error);
  truth.seconds = whole.seconds;
  return truth;
}

BandShader MakeShader(const Scene& scene, const SurfacePixels& pixels, const RadianceImage& unshadowed,
                      const TruthOptions& truth_options, const ShadowOptions& options) {
  return ShadowBands{scene,
                     SceneLights(scene),
                     SkyIntegrals(scene, pixels),
                     std::make_shared<const TexturedSky>(scene),
                     pixels,
                     unshadowed,
                     std::max(truth_options.tolerance, kLightShare * options.tolerance),
                     options.tolerance,
                     std::make_shared<const RayQuery>(scene)};
}

}  // namespace

ShadowedTruth ComputeShadowedTruth(const Scene& scene, const SurfacePixels& pixels,
                                   const RadianceImage& unshadowed, const TruthOptions& truth_options,
                                   const ShadowOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<TruthBand> bands(
      static_cast<std::size_t>((pixels.height + kTruthBandRows - 1) / kTruthBandRows));
  ShadeBands(pixels.height, MakeShader(scene, pixels, unshadowed, truth_options, options), options.progress,
             bands, std::vector<bool>(bands.size(), true), {});
  ShadowedTruth truth = Assemble(pixels, JoinBands(std::move(bands)));
  truth.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return truth;
}

ShadowedTruth CachedShadowedTruth(const Scene& scene, const SurfacePixels& pixels,
                                  const RadianceImage& unshadowed, const TruthOptions& truth_options,
                                  const ShadowOptions& options, const std::filesystem::path& cache_folder) {
  CachedPicture picture = CachedBands(
      pixels, ShadowKey(scene, pixels, truth_options, options),
      [&] { return MakeShader(scene, pixels, unshadowed, truth_options, options); }, options.progress,
      cache_folder);
  ShadowedTruth truth = Assemble(pixels, std::move(picture.whole));
  truth.cached = picture.cached;
  return truth;
}

}  // namespace arealab
