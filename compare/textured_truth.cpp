#include "compare/textured_truth.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "scenes/light_texture.h"
// clang-format off: the order matters
#include "glsl/dual_begin.h"
#include "glsl/brdf.glsl"
#include "glsl/brdf_choices.h"
#include "glsl/dual_end.h"
// clang-format on

namespace arealab {
namespace {

constexpr std::size_t kNodes = TexturedLight::kNodes;
const GaussRuleOnUnit& kRule = GaussOnUnit(kNodes);

constexpr int kMostLevels = 8;      // of which the last has 128 × 128 squares of 36 nodes: 9 MB
constexpr int kDeepest = 30;        // a light's 1e-9: what double tells apart
constexpr std::size_t kMostSquares = 6000;  // of one point and light; where they do not do the error says so

}  // namespace

ColorIntegrals::ColorIntegrals(const LightIntegrals& white, const glm::dvec3& texel)
    : form_factor(white.form_factor * texel),
      specular(white.specular * texel),
      specular_grazing(white.specular_grazing * texel),
      form_factor_error(white.form_factor_error * texel),
      specular_error(white.specular_error * texel),
      specular_grazing_error(white.specular_grazing_error * texel) {}

TexturedLight::TexturedLight(std::shared_ptr<const Image> texture) : texture_(std::move(texture)) {
  const std::vector<glm::vec4>& pixels = texture_->pixels;
  if (std::all_of(pixels.begin(), pixels.end(), [&](const glm::vec4& p) { return glm::vec3(p) == glm::vec3(pixels[0]); })) {
    constant_ = glm::dvec3(pixels[0]);
  } else {
    weights_.emplace(*texture_, kNodes, TextureWeights::LevelsFor(*texture_, kMostLevels));
  }
}

void TexturedLight::Weights(int level, int x, int y, std::span<glm::dvec3, kNodes * kNodes> weights) const {
  if (level < weights_->levels()) {
    std::ranges::copy(weights_->Of(level, x, y), weights.begin());
    return;
  }
  const double side = std::ldexp(1.0, -level);
  for (std::size_t j = 0; j < kNodes; ++j) {
    for (std::size_t i = 0; i < kNodes; ++i) {
      weights[j * kNodes + i] = kRule.weight[i] * kRule.weight[j] * TextureAt(*texture_, {(x + kRule.place[i]) * side, (y + kRule.place[j]) * side});
    }
  }
}

namespace {

struct LightSquare {
  int level, x, y;
};

struct TexturedSums {
  std::array<glm::dvec3, 3> value{glm::dvec3(0.0), glm::dvec3(0.0), glm::dvec3(0.0)};  // diffuse, specular, grazing

  TexturedSums& operator+=(const TexturedSums& other) {
    for (std::size_t k = 0; k < 3; ++k) value[k] += other.value[k];
    return *this;
  }
  // The greatest difference over the channels, of each integral.
  std::array<double, 3> Distance(const TexturedSums& other) const {
    std::array<double, 3> d;
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3 e = glm::abs(value[k] - other.value[k]);
      d[k] = std::max({e.x, e.y, e.z});
    }
    return d;
  }
  double Largest(std::size_t k) const { return std::max({value[k].x, value[k].y, value[k].z}); }
};

struct DividedSquare {
  LightSquare square;
  TexturedSums sums;                     // of its four quarters together
  std::array<TexturedSums, 4> quarters;
  std::array<double, 3> change;  // from the square's own sums to theirs, as an error of theirs
};

// One point before one light.
class Cubature {
 public:
  Cubature(const TexturedLight& weights, const ShadingPoint& point, const Light& light, double height)
      : weights_(weights), alpha_(point.alpha), brdf_(point.brdf), height_(std::abs(height)) {
    cos_v_ = glm::dot(point.normal, point.to_view);
    const glm::dvec3 across = point.to_view - point.normal * cos_v_;
    const double sin_v = glm::length(across);
    const glm::dvec3 any = std::abs(point.normal.x) < 0.5 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
    const glm::dvec3 x = sin_v > 1e-12 ? across / sin_v : glm::normalize(glm::cross(point.normal, any));
    const glm::dmat3 local = glm::transpose(glm::dmat3(x, glm::cross(point.normal, x), point.normal));
    view_ = {sin_v, 0.0, cos_v_};
    // From the upper left corner of the image, as the lit side shows it.
    along_u_ = local * light.axis_x * (height < 0.0 ? -2.0 : 2.0) * light.half_size.x;
    along_v_ = local * light.axis_y * -2.0 * light.half_size.y;
    corner_ = local * (light.center - point.position) - 0.5 * (along_u_ + along_v_);
    area_ = 4.0 * light.half_size.x * light.half_size.y;
  }

  ColorIntegrals Run(double tolerance) {
    Gather({0, 0, 0});
    const auto worse = [this](const DividedSquare& a, const DividedSquare& b) { return Badness(a.change) < Badness(b.change); };
    Retotal();
    std::make_heap(squares_.begin(), squares_.end(), worse);
    std::size_t count = squares_.size();
    for (int round = 0; !squares_.empty() && count < kMostSquares; ++round) {
      if (round % 64 == 0) Retotal();
      if (Badness(error_) < tolerance) break;
      std::pop_heap(squares_.begin(), squares_.end(), worse);
      const DividedSquare worst = squares_.back();
      squares_.pop_back();
      for (std::size_t k = 0; k < 3; ++k) error_[k] -= worst.change[k];
      for (int q = 0; q < 4; ++q) {
        const LightSquare square = Quarter(worst.square, q);
        if (square.level > kDeepest) {
          settled_ += worst.quarters[static_cast<std::size_t>(q)];
          continue;
        }
        DividedSquare divided = Divide(square, worst.quarters[static_cast<std::size_t>(q)]);
        for (std::size_t k = 0; k < 3; ++k) {
          error_[k] += divided.change[k];
          total_.value[k] += divided.sums.value[k] - worst.quarters[static_cast<std::size_t>(q)].value[k];
        }
        squares_.push_back(divided);
        std::push_heap(squares_.begin(), squares_.end(), worse);
        ++count;
      }
    }
    Retotal();
    ColorIntegrals result;
    const auto error = [&](std::size_t k) { return glm::dvec3(std::max(error_[k], kLeastStated * tolerance * total_.Largest(k))); };
    result.form_factor = glm::max(total_.value[0], 0.0);
    result.specular = glm::max(total_.value[1], 0.0);
    result.specular_grazing = glm::max(total_.value[2], 0.0);
    result.form_factor_error = error(0);
    result.specular_error = error(1);
    result.specular_grazing_error = error(2);
    return result;
  }

 private:
  // A change can be small by chance: no error below this share of the tolerance is stated.
  static constexpr double kLeastStated = 0.5;
  // Of a square's change on being divided, what is taken as its quarters' error.
  static constexpr double kShare = 0.5, kKinkShare = 2.0;

  static LightSquare Quarter(const LightSquare& s, int q) { return {s.level + 1, 2 * s.x + (q & 1), 2 * s.y + (q >> 1)}; }

  glm::dvec3 Place(double u, double v) const { return corner_ + u * along_u_ + v * along_v_; }

  // Relative to what there is of each integral; grazing counts as its share of a dielectric's lobe does.
  double Badness(const std::array<double, 3>& change) const {
    double worst = 0.0;
    for (std::size_t k = 0; k < 3; ++k) worst = std::max(worst, change[k] / std::max(total_.Largest(k) + (k == 2 ? 0.04 * total_.Largest(1) : 0.0), 1e-300));
    return worst;
  }

  void Retotal() {
    total_ = settled_;
    error_ = {};
    for (const DividedSquare& divided : squares_) {
      total_ += divided.sums;
      for (std::size_t k = 0; k < 3; ++k) error_[k] += divided.change[k];
    }
  }

  static constexpr double kEven = 0.5;

  // Divides until the distance and the half vector's slope, on whose scales the kernel varies, change from the middle of a square to its
  // corners by less than themselves, squared by half: there its polynomials converge, and agreement by chance is rare.
  void Gather(const LightSquare& s) {
    const double side = std::ldexp(1.0, -s.level);
    const glm::dvec3 middle = Place((s.x + 0.5) * side, (s.y + 0.5) * side);
    const glm::dvec3 a = 0.5 * side * along_u_, b = 0.5 * side * along_v_;
    if (middle.z + std::abs(a.z) + std::abs(b.z) <= 0.0) return;  // below the horizon
    if (s.level < kDeepest && !Even(middle, a, b)) {
      for (int q = 0; q < 4; ++q) Gather(Quarter(s, q));
      return;
    }
    squares_.push_back(Divide(s, Sum(s)));
  }

  glm::dvec2 Slope(const glm::dvec3& place) const {
    const glm::dvec3 h = place / glm::length(place) + view_;
    return glm::dvec2(h) / std::max(h.z, 1e-3);
  }

  bool Even(const glm::dvec3& middle, const glm::dvec3& a, const glm::dvec3& b) const {
    const double extent2 = glm::dot(a, a) + glm::dot(b, b);
    if (extent2 > kEven * glm::dot(middle, middle)) return false;
    const glm::dvec2 slope = Slope(middle);
    const double scale2 = alpha_ * alpha_ + glm::dot(slope, slope);
    for (const glm::dvec3& corner : {middle - a - b, middle + a - b, middle - a + b, middle + a + b}) {
      if (corner.z <= 0.0) continue;
      const glm::dvec2 change = Slope(corner) - slope;
      if (glm::dot(change, change) > kEven * scale2) return false;
    }
    return true;
  }

  DividedSquare Divide(const LightSquare& square, const TexturedSums& own) const {
    DividedSquare divided{square, {}, {}, {}};
    for (int q = 0; q < 4; ++q) {
      divided.quarters[static_cast<std::size_t>(q)] = Sum(Quarter(square, q));
      divided.sums += divided.quarters[static_cast<std::size_t>(q)];
    }
    divided.change = divided.sums.Distance(own);
    // A quarter of it is mostly left, or far less; where the horizon's kink runs through, more by chance.
    const double side = std::ldexp(1.0, -square.level), middle = Place((square.x + 0.5) * side, (square.y + 0.5) * side).z;
    const bool crossed = std::abs(middle) < 0.5 * side * (std::abs(along_u_.z) + std::abs(along_v_.z));
    for (double& change : divided.change) change *= crossed ? kKinkShare : kShare;
    return divided;
  }

  // The square's rule.
  TexturedSums Sum(const LightSquare& s) const {
    return dual::WithBrdf(brdf_, 0.0, [&](const auto& over_ggx) {
      std::array<glm::dvec3, kNodes * kNodes> weights;
      weights_.Weights(s.level, s.x, s.y, weights);
      const double side = std::ldexp(1.0, -s.level), area = area_ * side * side;
      TexturedSums sums;
      for (std::size_t j = 0; j < kNodes; ++j) {
        for (std::size_t i = 0; i < kNodes; ++i) {
          const glm::dvec3 place = Place((s.x + kRule.place[i]) * side, (s.y + kRule.place[j]) * side);
          if (place.z <= 0.0) continue;
          const double distance2 = glm::dot(place, place), inverse = 1.0 / std::sqrt(distance2), cos_l = place.z * inverse;
          const double solid_angle = area * height_ * inverse / distance2;
          const double diffuse = cos_l * solid_angle / glm::pi<double>();
          const glm::dvec3& weight = weights[j * kNodes + i];
          sums.value[0] += diffuse * weight;
          if (cos_v_ <= 0.0) continue;
          const glm::dvec3 sum = place * inverse + view_;
          const double length2 = glm::dot(sum, sum), v_dot_h = std::sqrt(length2) * 0.5;
          const double tan2 = (sum.x * sum.x + sum.y * sum.y) / (sum.z * sum.z), tail = alpha_ * alpha_ + tan2;
          const double cos2_h = sum.z * sum.z / length2;
          const double density = alpha_ * alpha_ / (glm::pi<double>() * cos2_h * cos2_h * tail * tail);  // GGX D(h)
          const double specular = density * cos_l * over_ggx(cos_v_, cos_l, v_dot_h, tan2, alpha_) * solid_angle;
          sums.value[1] += specular * weight;
          sums.value[2] += specular * dual::SchlickWeight(v_dot_h) * weight;
        }
      }
      return sums;
    });
  }

  const TexturedLight& weights_;
  double alpha_, cos_v_ = 0.0;
  Brdf brdf_;
  double height_;  // m, of the point over the light's plane
  double area_ = 0.0;
  glm::dvec3 view_{0.0}, corner_{0.0}, along_u_{0.0}, along_v_{0.0};  // frame: z the normal, x towards the viewer
  std::vector<DividedSquare> squares_;  // a heap, the worst first
  TexturedSums total_, settled_;
  std::array<double, 3> error_{};
};

}  // namespace

ColorIntegrals TexturedLight::Integrate(const ShadingPoint& point, const Light& light, double tolerance) const {
  if (constant_) return ColorIntegrals(IntegrateLight(point, light, tolerance), *constant_);
  const double height = glm::dot(point.position - light.center, light.normal);
  if (height == 0.0 || (height < 0.0 && !light.two_sided)) return {};
  return Cubature(*this, point, light, height).Run(tolerance);
}

SceneLights::SceneLights(const Scene& scene) : scene_(&scene) {
  std::map<std::shared_ptr<const Image>, std::shared_ptr<const TexturedLight>> made;
  for (const Light& light : scene.lights) {
    std::shared_ptr<const TexturedLight> weights;
    if (light.texture) {
      std::shared_ptr<const TexturedLight>& kept = made[light.texture];
      if (!kept) kept = std::make_shared<const TexturedLight>(light.texture);
      weights = kept;
    }
    weights_.push_back(std::move(weights));
  }
}

ColorIntegrals SceneLights::Integrate(const ShadingPoint& point, std::size_t light, double tolerance) const {
  const Light& source = scene_->lights[light];
  if (weights_[light]) return weights_[light]->Integrate(point, source, tolerance);
  return ColorIntegrals(IntegrateLight(point, source, tolerance));
}

}  // namespace arealab
