// Results made of analytic pictures, for the tests of the report: a sphere on a floor of rising roughness
// under a rectangle, by midpoint sums of a few or many points. Nothing from glsl/ or scenes/ but the plain
// structs.
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "compare/flip.h"
#include "compare/metrics.h"
#include "compare/results.h"

namespace arealab::synthetic {

struct Style {
  double light_x = 0.0, light_z = 1.6, half_width = 0.8, half_height = 0.4;
  glm::dvec3 radiance{6.0, 6.0, 6.0};
  glm::dvec3 base_color{0.5, 0.5, 0.5};
  double metalness = 0.0;
};

// A technique: how many points stand for the light along each side, and what it does wrong.
struct Flaw {
  int points = 1;
  double diffuse_gain = 1.0, specular_gain = 1.0, alpha_gain = 1.0;
  bool no_specular = false;
};

inline RadianceImage Shade(const Style& style, const Flaw& flaw, int width, int height,
                           std::vector<glm::vec3>* emission) {
  RadianceImage image;
  image.width = width;
  image.height = height;
  const std::size_t size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  image.diffuse.assign(size, glm::vec3(0.0f));
  image.specular.assign(size, glm::vec3(0.0f));
  if (emission) emission->assign(size, glm::vec3(0.0f));
  const glm::dvec3 eye(0.0, -3.2, 1.3), forward = glm::normalize(glm::dvec3(0.0, 0.2, 0.45) - eye);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 0, 1))),
                   up = glm::cross(right, forward);
  const glm::dvec3 light_center(style.light_x, 1.2, style.light_z),
      light_normal = glm::normalize(glm::dvec3(0, -1, -0.5));
  const glm::dvec3 axis_x(1, 0, 0), axis_y = glm::cross(light_normal, axis_x);
  const glm::dvec3 sphere(-0.75, 0.1, 0.4);
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      const double u = (2.0 * (x + 0.5) - width) / height * 0.5, v = (1.0 - 2.0 * (y + 0.5) / height) * 0.5;
      const glm::dvec3 ray = glm::normalize(forward + u * right + v * up);
      double nearest = 1e30;
      glm::dvec3 normal(0.0);
      if (ray.z < 0.0) {
        nearest = -eye.z / ray.z;
        normal = {0, 0, 1};
        if (nearest > 9.0) nearest = 1e30;
      }
      const glm::dvec3 offset = eye - sphere;
      const double b = glm::dot(offset, ray), c = glm::dot(offset, offset) - 0.16, root = b * b - c;
      if (root > 0.0 && -b - std::sqrt(root) < nearest) {
        nearest = -b - std::sqrt(root);
        normal = glm::normalize(eye + nearest * ray - sphere);
      }
      const double facing = glm::dot(ray, light_normal);
      if (facing < 0.0) {
        const double t = glm::dot(light_center - eye, light_normal) / facing;
        const glm::dvec3 d = eye + t * ray - light_center;
        if (t > 0.0 && t < nearest && std::abs(glm::dot(d, axis_x)) < style.half_width &&
            std::abs(glm::dot(d, axis_y)) < style.half_height) {
          if (emission) (*emission)[i] = glm::vec3(style.radiance);
          continue;
        }
      }
      if (nearest > 1e29) continue;
      const glm::dvec3 p = eye + nearest * ray, to_view = -ray;
      const double roughness = normal.z == 1.0 ? std::clamp(0.5 + 0.3 * p.x, 0.12, 0.9) : 0.3;
      const double alpha = roughness * roughness * flaw.alpha_gain, alpha2 = alpha * alpha;
      glm::dvec3 diffuse(0.0), specular(0.0);
      const glm::dvec3 f0 = glm::mix(glm::dvec3(0.04), style.base_color, style.metalness);
      for (int k = 0; k < flaw.points * flaw.points; ++k) {
        const double s = (k % flaw.points + 0.5) / flaw.points * 2.0 - 1.0;
        const double t = (k / flaw.points + 0.5) / flaw.points * 2.0 - 1.0;
        const glm::dvec3 q =
            light_center + s * style.half_width * axis_x + t * style.half_height * axis_y - p;
        const double distance2 = glm::dot(q, q);
        const glm::dvec3 l = q / std::sqrt(distance2);
        const double n_dot_l = glm::dot(normal, l), n_dot_v = glm::dot(normal, to_view);
        const double light_cosine = -glm::dot(l, light_normal);
        if (n_dot_l <= 0.0 || n_dot_v <= 0.0 || light_cosine <= 0.0) continue;
        const double area = 4.0 * style.half_width * style.half_height / (flaw.points * flaw.points);
        const double solid_angle = area * light_cosine / distance2;
        const glm::dvec3 h = glm::normalize(l + to_view);
        const double n_dot_h = glm::dot(normal, h), q2 = n_dot_h * n_dot_h * (alpha2 - 1.0) + 1.0;
        const double d = alpha2 / (std::numbers::pi * q2 * q2);
        const double visibility = 0.5 / (n_dot_l * std::sqrt(n_dot_v * n_dot_v * (1 - alpha2) + alpha2) +
                                         n_dot_v * std::sqrt(n_dot_l * n_dot_l * (1 - alpha2) + alpha2));
        const glm::dvec3 fresnel = f0 + (1.0 - f0) * std::pow(1.0 - glm::dot(h, to_view), 5.0);
        diffuse += style.radiance * style.base_color * (1.0 - style.metalness) *
                   (n_dot_l * solid_angle / std::numbers::pi);
        if (!flaw.no_specular)
          specular += style.radiance * fresnel * (d * visibility * n_dot_l * solid_angle);
      }
      image.diffuse[i] = glm::vec3(diffuse * flaw.diffuse_gain);
      image.specular[i] = glm::vec3(specular * flaw.specular_gain);
    }
  });
  return image;
}

// A soft shadow that rises to black towards the right.
inline ShadowResult MakeShadow(const RadianceImage& truth) {
  auto image = std::make_shared<RadianceImage>(truth);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double u = static_cast<double>(i % static_cast<std::size_t>(truth.width)) / truth.width;
    const auto left = static_cast<float>(std::clamp(2.5 - 3.0 * u, 0.0, 1.0));
    image->diffuse[i] *= left;
    image->specular[i] *= left;
  }
  const ErrorMetrics missing = CompareImages(TotalRadiance(truth), TotalRadiance(*image), truth.width);
  return {.light_lost = missing.bias / (1.0 + missing.bias),
          .bias = missing.bias,
          .rel_rmse = missing.rel_rmse,
          .mean_error = 0.0102,
          .p99_error = 0.0198,
          .seconds = 3.2,
          .cached = false,
          .image = image};
}

struct Size {
  int width = 96, height = 72, truth_points = 12;
};

inline SceneResult MakeScene(const std::string& name, const std::string& question, const Style& style,
                             const Size& size, bool flip = true) {
  SceneResult scene;
  scene.name = name;
  scene.question = question;
  scene.file = "scenes/" + name + ".toml";
  scene.unit = "W/(m² sr)";
  scene.width = size.width;
  scene.height = size.height;
  scene.exposure = 0.5;
  scene.effects = {"fresnel", "two_sided"};
  auto emission = std::make_shared<std::vector<glm::vec3>>();
  auto truth = std::make_shared<RadianceImage>(
      Shade(style, {.points = size.truth_points}, size.width, size.height, emission.get()));
  scene.truth = truth;
  scene.emission = emission;
  scene.truth_relative_error = 8.4e-5;
  scene.truth_seconds = 0.213;
  for (std::size_t i = 0; i < truth->size(); ++i)
    scene.lit_pixels += truth->Total(i) != glm::vec3(0.0f) ? 1 : 0;

  struct Named {
    const char *name, *short_name, *summary, *citation, *note;
    Flaw flaw;
    double ratio;
  };
  const int n = size.truth_points;
  const std::vector<Named> all = {
      {"point",
       "point",
       "The light as one point at its centre.",
       "Common ground",
       "One form only.",
       {1},
       1.0},
      {"drobot",
       "drobot",
       "Most representative point for diffuse and specular.",
       "Drobot 2014",
       "Ours clamps the cone.",
       {2, 1.06, 0.9},
       2.1},
      {"drobot+cone=threshold",
       "drobot@published",
       "Most representative point for diffuse and specular.",
       "Drobot 2014",
       "As published.",
       {2, 1.06, 1.3},
       2.2},
      {"oat",
       "oat",
       "Spherical caps that intersect.",
       "Oat 2006",
       "The specular lobe is our extension.",
       {3, 0.85, 0.7},
       1.6},
      {"hill",
       "hill",
       "LTC with the vector form factor and a proxy sphere.",
       "Hill & Heitz 2016",
       "Fitted sphere.",
       {n - 4, 1.004, 1.01, 1.01},
       3.2},
      {"hill+sphere=table",
       "hill@published",
       "LTC with the vector form factor and a proxy sphere.",
       "Hill & Heitz 2016",
       "As published.",
       {n - 4, 0.99, 1.02, 1.03},
       3.4},
      {"ltc",
       "ltc",
       "Linearly transformed cosines, exact horizon clip.",
       "Heitz et al. 2016; Hill & Heitz 2016",
       "Five-cornered clip.",
       {n - 2, 1.0, 1.004, 1.005},
       3.9},
      {"ltc+clip=switch+edge=rational",
       "ltc@published",
       "Linearly transformed cosines, exact horizon clip.",
       "Heitz et al. 2016",
       "As published.",
       {n - 2, 1.0, 1.03, 1.04},
       5.6},
      {"reference",
       "reference",
       "The truth's integrand in the shader.",
       "Findings",
       "One form only.",
       {n, 1.00001, 0.99999},
       24.0},
  };
  scene.tile_columns = 4;
  scene.tile_needs = {0, 0, 1, 7, 9, 17, 25, 27, 29, 31, 31, 31};
  const std::vector<glm::vec3> total = TotalRadiance(*truth);
  const FlipReference reference(total, size.width);
  for (const Named& named : all) {
    VariantResult variant;
    variant.name = named.name;
    variant.short_name = named.short_name;
    variant.summary = named.summary;
    variant.citation = named.citation;
    variant.note = named.note;
    variant.image =
        std::make_shared<RadianceImage>(Shade(style, named.flaw, size.width, size.height, nullptr));
    Measure(*truth, flip ? &reference : nullptr, &variant);
    variant.within_truth_error = variant.total.rel_rmse < 4.0 * scene.truth_relative_error;
    const auto around = [](double value) { return Estimate{value, 0.97 * value, 1.04 * value}; };
    variant.time.ratio_to_point = around(named.ratio);
    variant.time.ns_per_pixel = around(8.0 * named.ratio);
    variant.time.net_ns_per_pixel = around(8.0 * named.ratio - 5.0);
    variant.time.net_ratio_to_point = around((8.0 * named.ratio - 5.0) / 3.0);
    variant.time.rounds = 9;
    const int cycles = static_cast<int>(100.0 * named.ratio) + 400;
    if (variant.name != "reference") {
      variant.saving = Saving{around(0.3 + 0.1 * named.ratio), 11, {{"bonaire", {cycles + 30, 2 * cycles}}}};
      variant.saving->per_pixel["tiles"] = {around(0.8 + 0.1 * named.ratio), {{"bonaire", 0.9}}};
      if (variant.name != "point") variant.saving->per_pixel["branch"] = {around(1.2 + 0.1 * named.ratio), {{"bonaire", 1.1}}};
    }
    for (const auto& [gpu, share] : {std::pair("bonaire", 1), std::pair("navi21", 2)}) {
      if (variant.name == "reference") continue;
      GpuCost& cost = variant.isa[gpu];
      cost.core = {.instructions = cycles / 4, .cycles = cycles / share, .vgprs = 40, .sgprs = 48, .bytes = cycles};
      cost.full = {.instructions = cycles / 4 + 20, .cycles = cycles / share + 30, .vgprs = 44, .sgprs = 48, .bytes = cycles};
      if (variant.short_name == "ltc@published") cost.paths["below"] = {.instructions = 30, .cycles = 123};
    }
    scene.variants.push_back(variant);
  }
  VariantResult refused;
  refused.name = refused.short_name = "lightfield";
  refused.summary = "Light-field vector put into a BRDF.";
  refused.citation = "Arvo 1995";
  refused.supported = false;
  refused.reason = "lightfield shades rectangles only; this scene has a sphere";
  scene.variants.push_back(refused);
  for (const VariantResult& a : scene.variants) {
    for (const VariantResult& b : scene.variants) {
      if (a.name == b.name || !a.image || !b.image) continue;
      scene.pairs.push_back(
          {a.name, b.name,
           CompareImages(TotalRadiance(*a.image), TotalRadiance(*b.image), size.width).rel_rmse});
    }
  }
  return scene;
}

inline Results MakeResults(const std::vector<SceneResult>& scenes) {
  Results results;
  results.command = "arealab compare gloss horizon --out report";
  results.version = "0.1.0";
  results.date = "2026-11-22T16:00:00Z";
  results.machine = {{"cpu", "Synthetic CPU @ 2.0 GHz"},
                     {"cores", "2"},
                     {"os", "Debian GNU/Linux 12"},
                     {"compiler", "g++ 12.2"}};
  results.platform = "OSMesa";
  results.renderer = "llvmpipe (LLVM 15.0.6, 256 bits)";
  results.gl_version = "4.5 (Core Profile) Mesa 22.3.6";
  results.compilers = "radv Mesa 22.3.6 by glslang 11:12.0.0";
  results.scenes = scenes;
  return results;
}

}  // namespace arealab::synthetic
