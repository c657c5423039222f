// Shades points, each with a light of its own, with any technique on the GL: for tests of what a technique
// computes.
#pragma once

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "compare/point_shader.h"

namespace arealab {

class PointRandom {
 public:
  explicit PointRandom(unsigned seed) : engine_(seed) {}
  double operator()(double from, double to) { return from + (to - from) * uniform_(engine_); }
  double Log(double from, double to) { return from * std::pow(to / from, uniform_(engine_)); }
  glm::dvec3 Direction() {
    const double z = (*this)(-1.0, 1.0), phi = (*this)(0.0, glm::two_pi<double>()),
                 r = std::sqrt(1.0 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }

 private:
  std::mt19937_64 engine_;
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
};

// A viewer above the surface, a light of 0.2 to 1 m half size whose centre is 1 to 4 m away and which faces
// the point.
inline PointCase RandomPoint(PointRandom& random, LightShape shape) {
  PointCase c;
  c.shape = shape;
  c.normal = random.Direction();
  c.to_view = random.Direction();
  if (glm::dot(c.normal, c.to_view) < 0.0) c.to_view = -c.to_view;
  c.roughness = random(0.1, 1.0);
  const glm::dvec3 to_center = random.Direction();  // each draw in a statement of its own: compilers order operands as they like
  c.center = random(1.0, 4.0) * to_center;
  c.light_normal = random.Direction();
  if (glm::dot(c.light_normal, c.position - c.center) < 0.0) c.light_normal = -c.light_normal;
  c.axis_x = glm::normalize(glm::cross(random.Direction(), c.light_normal));
  c.axis_y = glm::cross(c.light_normal, c.axis_x);
  c.half_size = {random(0.2, 1.0), random(0.2, 1.0)};
  if (shape == LightShape::kDisk || shape == LightShape::kSphere) c.half_size.y = c.half_size.x;
  if (shape == LightShape::kSphere) c.half_size *= 0.9;  // the point stays outside
  if (shape == LightShape::kTube) c.half_size.y *= 0.2;
  return c.Rounded();
}

// Corners at random angles about an ellipse, counter-clockwise.
inline std::vector<glm::dvec2> RandomOutline(PointRandom& random, int corners, const glm::dvec2& half_size) {
  std::vector<glm::dvec2> outline;
  for (int k = 0; k < corners; ++k) {
    const double angle = (k + random(0.0, 0.6)) * glm::two_pi<double>() / corners;
    outline.push_back(half_size * glm::dvec2(std::cos(angle), std::sin(angle)));
  }
  return outline;
}

// Makes the case's light the polygon of these corners, in its plane from its centre, which goes to theirs.
inline void SetOutline(PointCase& c, const std::vector<glm::dvec2>& outline) {
  Light light = c.Light();
  SetCorners(light, outline);
  c.corners = light.corners;
  c.center = light.center;
  c.half_size = light.half_size;
}

// Points at which a careless formula divides 0 by 0 or overflows, for every shape.
inline std::vector<PointCase> HardPoints() {
  std::vector<PointCase> cases;
  for (const LightShape shape : {LightShape::kRectangle, LightShape::kDisk, LightShape::kSphere, LightShape::kTube}) {
    for (const double roughness : {0.0, 1e-3, 0.3, 1.0}) {
      for (const double n_dot_v : {1.0, 0.6, 1e-3}) {
        for (const double size : {1e-4, 1.0, 1e4}) {
          for (const double distance : {0.0, 1e-6, 1e-3, 0.5, 1.0, 1e4}) {
            // The light above the point, beside it, below the horizon, with the point in its plane or at its
            // edge.
            for (int place = 0; place < 5; ++place) {
              PointCase c;
              c.shape = shape;
              c.roughness = roughness;
              c.half_size = glm::dvec2(size);
              if (shape == LightShape::kTube) c.half_size.y *= 0.1;
              c.to_view = {std::sqrt(1.0 - n_dot_v * n_dot_v), 0.0, n_dot_v};
              c.center = {0.0, 0.0, distance};
              if (place == 1) c.center = {distance, 0.0, 0.0};
              if (place == 2) c.center = {0.0, 0.0, -distance};
              if (place == 3) c.center = {size, size, distance};
              if (place == 4) {
                c.light_normal = {1.0, 0.0, 0.0};
                c.axis_x = {0.0, 1.0, 0.0};
                c.axis_y = {0.0, 0.0, 1.0};
                c.center = {-distance, 0.0, 0.5 * size};
              }
              cases.push_back(c.Rounded());
            }
          }
        }
      }
    }
  }
  return cases;
}

class TechniquePoints {
 public:
  std::vector<Variant> Variants(const std::string& technique) const {
    std::vector<Variant> variants;
    for (const Variant& variant : AllVariants(techniques_)) {
      if (variant.technique->name == technique) variants.push_back(variant);
    }
    return variants;
  }

  std::vector<Shaded> Shade(const Variant& variant, const std::vector<PointCase>& cases, const PointOptions& options) {
    return shader_.Shade(variant, cases, options);
  }

  std::vector<Shaded> Shade(const std::string& variant_name, const std::vector<PointCase>& cases,
                            Precision precision = Precision::kFloat,
                            const std::map<std::string, double>& knobs = {}) {
    return shader_.Shade(ParseVariant(techniques_, variant_name), cases, {precision, knobs});
  }

  // Of the knob "seed" from 0 on.
  std::vector<Shaded> MeanOverSeeds(const std::string& variant_name, const std::vector<PointCase>& cases, int seeds) {
    std::vector<Shaded> mean(cases.size());
    for (int seed = 0; seed < seeds; ++seed) {
      const std::vector<Shaded> shaded = Shade(variant_name, cases, Precision::kFloat, {{"seed", seed}});
      for (std::size_t i = 0; i < cases.size(); ++i) {
        mean[i].diffuse += shaded[i].diffuse / seeds;
        mean[i].specular += shaded[i].specular / seeds;
      }
    }
    return mean;
  }

 private:
  std::unique_ptr<Context> context_ = CreateContext(ContextKind::kOsmesa);
  ShaderLibrary library_;
  std::vector<Technique> techniques_ = LoadTechniques(library_);
  PointShader shader_{*context_, library_};
};

// sqrt(Σ(a−b)²/Σb²) of one lobe.
inline double RelativeRmse(const std::vector<Shaded>& a, const std::vector<Shaded>& b, double Shaded::*lobe) {
  double squares = 0.0, reference = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    squares += (a[i].*lobe - b[i].*lobe) * (a[i].*lobe - b[i].*lobe);
    reference += b[i].*lobe * b[i].*lobe;
  }
  return std::sqrt(squares / reference);
}

}  // namespace arealab
