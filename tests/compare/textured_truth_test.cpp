// Truth of textured lights against a brute-force quadrature that shares nothing with it: no shader text, a BRDF and a texture look-up
// of its own, Gauss's rule on a fixed grid that follows the texels.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "compare/textured_truth.h"

namespace arealab::textured_truth_test {
namespace {

using glm::dvec3;
constexpr double kCirclePi = 3.14159265358979323846;

std::shared_ptr<const Image> RandomTexture(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-0.5f, 2.0f);  // a fifth is black
  auto image = std::make_shared<Image>();
  image->width = width;
  image->height = height;
  for (int i = 0; i < width * height; ++i) {
    image->pixels.emplace_back(std::max(uniform(random), 0.0f), std::max(uniform(random), 0.0f), std::max(uniform(random), 0.0f), 1.0f);
  }
  return image;
}

// Of column or row `i`, the hat that bilinear interpolation gives it at u in [0, 1].
double Hat(double u, int i, int size) {
  const double p = std::min(std::max(u * size - 0.5, 0.0), size - 1.0);
  return std::max(1.0 - std::abs(p - i), 0.0);
}

dvec3 LookUp(const Image& image, double u, double v) {
  dvec3 sum(0.0);
  for (int j = 0; j < image.height; ++j) {
    const double row = Hat(v, j, image.height);
    if (row == 0.0) continue;
    for (int i = 0; i < image.width; ++i) {
      sum += row * Hat(u, i, image.width) * dvec3(image.pixels[static_cast<std::size_t>(j * image.width + i)]);
    }
  }
  return sum;
}

struct BruteForce {
  dvec3 diffuse{0.0}, specular{0.0}, grazing{0.0};
};

// Upper left of the image: the viewer before the lit side sees x to the right and y up.
BruteForce Integrate(const ShadingPoint& p, const Light& light, int cuts) {
  constexpr std::array<double, 5> node = {-0.906179845938664, -0.538469310105683, 0.0, 0.538469310105683, 0.906179845938664};
  constexpr std::array<double, 5> weight = {0.236926885056189, 0.478628670499366, 0.568888888888889, 0.478628670499366, 0.236926885056189};
  const double height = glm::dot(p.position - light.center, light.normal);
  BruteForce result;
  if (height <= 0.0 && !light.two_sided) return result;
  const double mirrored = height < 0.0 ? -1.0 : 1.0;
  const Image& image = *light.texture;
  const int nu = 2 * image.width * cuts, nv = 2 * image.height * cuts;  // texels' centres are on the grid
  for (int j = 0; j < nv; ++j) {
    for (int i = 0; i < nu; ++i) {
      for (std::size_t k = 0; k < 25; ++k) {
        const double u = (i + 0.5 + 0.5 * node[k % 5]) / nu, v = (j + 0.5 + 0.5 * node[k / 5]) / nv;
        const double x = mirrored * (2.0 * u - 1.0) * light.half_size.x, y = (1.0 - 2.0 * v) * light.half_size.y;
        const dvec3 to = light.center + x * light.axis_x + y * light.axis_y - p.position;
        const double distance = glm::length(to);
        const dvec3 l = to / distance;
        const double cos_l = glm::dot(p.normal, l), cos_v = glm::dot(p.normal, p.to_view);
        if (cos_l <= 0.0) continue;
        const double area = 4.0 * light.half_size.x * light.half_size.y / (nu * nv) * 0.25 * weight[k % 5] * weight[k / 5];
        const double solid_angle = area * std::abs(glm::dot(light.normal, l)) / (distance * distance);
        const dvec3 h = glm::normalize(l + p.to_view), across = h - p.normal * glm::dot(p.normal, h);
        const double cos_h = glm::dot(p.normal, h), t = 1.0 + glm::dot(across, across) / (cos_h * cos_h * p.alpha * p.alpha);
        const double density = 1.0 / (kCirclePi * p.alpha * p.alpha * std::pow(cos_h, 4) * t * t);
        const auto lambda = [&](double c) { return 0.5 * (std::sqrt(1.0 + p.alpha * p.alpha * (1.0 - c * c) / (c * c)) - 1.0); };
        const double specular = density / (1.0 + lambda(cos_v) + lambda(cos_l)) / (4.0 * cos_v) * solid_angle;
        const dvec3 texel = LookUp(image, u, v);
        result.diffuse += texel * (cos_l * solid_angle / kCirclePi);
        result.specular += texel * specular;
        result.grazing += texel * (specular * std::pow(1.0 - glm::dot(p.to_view, h), 5));
      }
    }
  }
  return result;
}

struct Configuration {
  ShadingPoint point;
  Light light;
};

// The point over a floor, the light anywhere before it, often across the horizon.
Configuration RandomConfiguration(std::mt19937& random, double roughness) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Configuration c;
  const double angle = 0.7 * (uniform(random) + 1.0);
  c.point = {dvec3(0.1, -0.2, 0.0), dvec3(0.0, 0.0, 1.0), dvec3(std::sin(angle), 0.0, std::cos(angle)), roughness * roughness};
  c.light.half_size = {0.3 + 0.25 * uniform(random), 0.3 + 0.25 * uniform(random)};
  c.light.center = dvec3(uniform(random) - 0.6, uniform(random), 0.35 + 0.4 * uniform(random));
  c.light.normal = glm::normalize(c.point.position - c.light.center + 0.6 * dvec3(uniform(random), uniform(random), uniform(random)));
  c.light.axis_x = glm::normalize(glm::cross(dvec3(uniform(random), uniform(random), 1.0), c.light.normal));
  c.light.axis_y = glm::cross(c.light.normal, c.light.axis_x);
  return c;
}

double Largest(const dvec3& v) { return std::max({v.x, v.y, v.z}); }

TEST(TexturedTruth, IsWhatBruteForceFinds) {
  constexpr double kTolerance = 1e-4;
  std::mt19937 random(7);
  int beyond = 0;
  for (const double roughness : {0.2, 0.35, 0.6, 1.0}) {
    for (int i = 0; i < 6; ++i) {
      Configuration c = RandomConfiguration(random, roughness);
      c.light.texture = RandomTexture(5, 3, static_cast<unsigned>(i));
      const ColorIntegrals truth = TexturedLight(c.light.texture).Integrate(c.point, c.light, kTolerance);
      const BruteForce brute = Integrate(c.point, c.light, roughness < 0.3 ? 14 : 8);
      SCOPED_TRACE(testing::Message() << "roughness " << roughness << ", case " << i);
      const auto compare = [&](const dvec3& a, const dvec3& b, const dvec3& stated, double scale) {
        const double error = Largest(glm::abs(a - b));
        EXPECT_LE(error, 2.0 * kTolerance * scale);
        if (error > Largest(stated) + 1e-6 * Largest(b)) ++beyond;
      };
      compare(truth.form_factor, brute.diffuse, truth.form_factor_error, Largest(brute.diffuse));
      compare(truth.specular, brute.specular, truth.specular_error, Largest(brute.specular));
      compare(truth.specular_grazing, brute.grazing, truth.specular_grazing_error, Largest(brute.grazing) + 0.04 * Largest(brute.specular));
    }
  }
  EXPECT_LE(beyond, 2) << "of 72 integrals are farther from brute force than what the truth states";
}

// More texels than squares are stored for, and a back side that is lit.
TEST(TexturedTruth, FineTexturesAndBacksToo) {
  std::mt19937 random(3);
  for (const bool back : {false, true}) {
    Configuration c = RandomConfiguration(random, 0.5);
    c.light.texture = RandomTexture(140, 12, 5);
    if (back) {
      c.light.normal = -c.light.normal;
      c.light.axis_x = -c.light.axis_x;
    }
    c.light.two_sided = true;
    const ColorIntegrals truth = TexturedLight(c.light.texture).Integrate(c.point, c.light, 1e-5);
    // Both lit sides show the image upright, so turning the light about its y axis changes nothing.
    Light turned = c.light;
    turned.normal = -turned.normal;
    turned.axis_x = -turned.axis_x;
    const ColorIntegrals other = TexturedLight(c.light.texture).Integrate(c.point, turned, 1e-5);
    const BruteForce brute = Integrate(c.point, c.light, 1);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(truth.form_factor[k], brute.diffuse[k], 1e-4 * brute.diffuse[k]);
      EXPECT_NEAR(truth.specular[k], brute.specular[k], 1e-4 * brute.specular[k]);
      EXPECT_NEAR(truth.form_factor[k], other.form_factor[k], 1e-12);
    }
  }
}

// A texture of ones is no texture; one that a trillionth keeps from being constant goes the general way to the same.
TEST(TexturedTruth, OfAConstantIsTheUntextured) {
  std::mt19937 random(11);
  for (const double roughness : {0.05, 0.2, 0.5, 1.0}) {
    for (int i = 0; i < 20; ++i) {
      Configuration c = RandomConfiguration(random, roughness);
      auto ones = std::make_shared<Image>(*RandomTexture(16, 16, 1));
      std::fill(ones->pixels.begin(), ones->pixels.end(), glm::vec4(1.0f));
      const LightIntegrals white = IntegrateLight(c.point, c.light, 1e-4);
      const ColorIntegrals same = TexturedLight(ones).Integrate(c.point, c.light, 1e-4);
      EXPECT_EQ(same.form_factor.y, white.form_factor);
      EXPECT_EQ(same.specular.y, white.specular);
      EXPECT_EQ(same.specular_grazing.y, white.specular_grazing);
      auto nearly = std::make_shared<Image>(*ones);
      nearly->pixels[40].x = 1.0f + 1e-6f;
      const ColorIntegrals close = TexturedLight(nearly).Integrate(c.point, c.light, 1e-4);
      SCOPED_TRACE(testing::Message() << "roughness " << roughness << ", case " << i);
      EXPECT_NEAR(close.form_factor.y, white.form_factor, 2e-4 * white.form_factor);
      EXPECT_NEAR(close.specular.y, white.specular, 2e-4 * white.specular + 1e-9);
      EXPECT_NEAR(close.specular_grazing.y, white.specular_grazing, 2e-4 * (white.specular_grazing + 0.04 * white.specular) + 1e-9);
    }
  }
}

}  // namespace
}  // namespace arealab::textured_truth_test
