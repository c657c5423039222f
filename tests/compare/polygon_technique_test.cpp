// Polygons and ellipses through the techniques: a rectangle given as a polygon, a polygon cut from a corner on, exact Lambert, limits,
// and what a polygon's and an ellipse's truth must be beside the shapes that they turn into.
#include <gtest/gtest.h>

#include "tests/compare/technique_laws.h"

namespace arealab::polygon_technique_test {
namespace {

class PolygonTechnique : public testing::Test {
 protected:
  static void SetUpTestSuite() { points_ = std::make_unique<TechniquePoints>(); }
  static void TearDownTestSuite() { points_.reset(); }
  static std::unique_ptr<TechniquePoints> points_;
};
std::unique_ptr<TechniquePoints> PolygonTechnique::points_;

// The rectangle of a case as a polygon.
PointCase AsPolygon(PointCase c) {
  const glm::dvec2 h = c.half_size;
  c.shape = LightShape::kPolygon;
  c.corners = {{-h.x, -h.y}, {h.x, -h.y}, {h.x, h.y}, {-h.x, h.y}};
  return c;
}

std::vector<PointCase> AsPolygons(std::vector<PointCase> cases) {
  for (PointCase& c : cases) c = AsPolygon(c);
  return cases;
}

// Of `count` corners at random angles about an ellipse.
std::vector<PointCase> RandomPolygons(unsigned seed, int count) {
  PointRandom random(seed);
  std::vector<PointCase> cases;
  for (int i = 0; i < count; ++i) {
    PointCase c = RandomPoint(random, LightShape::kPolygon);
    c.half_size = {random(0.2, 1.0), random(0.2, 1.0)};
    SetOutline(c, RandomOutline(random, 3 + i % 6, c.half_size));
    cases.push_back(c.Rounded());
  }
  return cases;
}

std::vector<PointCase> RandomEllipses(unsigned seed, int count) {
  PointRandom random(seed);
  std::vector<PointCase> cases;
  for (int i = 0; i < count; ++i) {
    PointCase c = RandomPoint(random, LightShape::kEllipse);
    c.half_size = {random(0.1, 1.0), random(0.1, 1.0)};
    cases.push_back(c.Rounded());
  }
  return cases;
}

TEST_F(PolygonTechnique, ARectangleAsAPolygonIsTheRectangle) {
  const std::vector<PointCase> rectangles = RandomPoints(41, LightShape::kRectangle, 2000);
  const std::vector<PointCase> polygons = AsPolygons(rectangles);
  const std::vector<Shaded> as_truth = TruthOf(polygons), truth = TruthOf(rectangles);
  EXPECT_LT(RelativeRmse(as_truth, truth, &Shaded::diffuse), 1e-14);
  EXPECT_LT(RelativeRmse(as_truth, truth, &Shaded::specular), 1e-12);
  // In double the same but for the order of sums; ltc's arc has another closing side, hill sums another way round.
  for (const char* name : {"ltc+clip=stream", "ltc+clip=none", "hill", "light_field", "light_field+vector=unit", "point", "reference", "oat",
                           "ltc+clip=stream+edge=acos", "ltc+clip=stream+edge=half_angle", "ltc+clip=stream+edge=rational"}) {
    const std::vector<Shaded> a = points_->Shade(name, polygons, Precision::kDouble), b = points_->Shade(name, rectangles, Precision::kDouble);
    EXPECT_LT(RelativeRmse(a, b, &Shaded::diffuse), 3e-5) << name;
    EXPECT_LT(RelativeRmse(a, b, &Shaded::specular), 3e-5) << name;
    if (std::string(name).ends_with("acos") || std::string(name).ends_with("unit")) continue;  // whose float loses more
    const std::vector<Shaded> f = points_->Shade(name, polygons);
    EXPECT_LT(RelativeRmse(f, a, &Shaded::diffuse), 1e-4) << name;
    EXPECT_LT(RelativeRmse(f, a, &Shaded::specular), 1e-3) << name;
  }
}

TEST_F(PolygonTechnique, ExactForLambert) {
  const std::vector<PointCase> polygons = RandomPolygons(42, 3000), ellipses = RandomEllipses(43, 3000);
  for (const std::vector<PointCase>& cases : {polygons, ellipses}) {
    const std::vector<Shaded> truth = TruthOf(cases);
    for (const char* name : {"ltc", "light_field", "reference"}) {
      if (name == std::string("light_field") && cases.front().shape == LightShape::kEllipse) continue;
      EXPECT_LT(RelativeRmse(points_->Shade(name, cases, Precision::kDouble), truth, &Shaded::diffuse), 1e-5) << name;
      EXPECT_LT(RelativeRmse(points_->Shade(name, cases), truth, &Shaded::diffuse), 1e-4) << name;
    }
  }
}

// The specular of the reference is the truth's own rule.
TEST_F(PolygonTechnique, TheReferenceIsTheTruth) {
  for (const std::vector<PointCase>& cases : {RandomPolygons(44, 1000), RandomEllipses(45, 1000)}) {
    EXPECT_LT(RelativeRmse(points_->Shade("reference+level=dense", cases), TruthOf(cases, 1e-4), &Shaded::specular), 1e-3);
  }
}

// Sampling has no bias: over many seeds the mean tends to the truth.
TEST_F(PolygonTechnique, MonteCarloTendsToTheTruth) {
  for (const std::vector<PointCase>& cases : {RandomPolygons(46, 200), RandomEllipses(47, 200)}) {
    const std::vector<Shaded> mean = points_->MeanOverSeeds("monte_carlo+samples=64", cases, 200);
    const std::vector<Shaded> truth = TruthOf(cases);
    EXPECT_LT(RelativeRmse(mean, truth, &Shaded::diffuse), 0.01);
    EXPECT_LT(RelativeRmse(mean, truth, &Shaded::specular), 0.02);
  }
}

TEST_F(PolygonTechnique, AShrinkingLightTendsToThePoint) {
  for (std::vector<PointCase> cases : {RandomPolygons(48, 400), RandomEllipses(49, 400)}) {
    for (PointCase& c : cases) {
      c.half_size *= 1e-3;
      for (glm::dvec2& corner : c.corners) corner *= 1e-3;
    }
    const std::vector<Shaded> point = points_->Shade("point", cases, Precision::kDouble);
    EXPECT_LT(RelativeRmse(TruthOf(cases), point, &Shaded::diffuse), 1e-4);
    for (const char* name : {"ltc", "hill", "light_field", "reference", "oat"}) {
      if (name == std::string("light_field") && cases.front().shape == LightShape::kEllipse) continue;
      EXPECT_LT(RelativeRmse(points_->Shade(name, cases, Precision::kDouble), point, &Shaded::diffuse), 1e-3) << name << " " << Name(cases.front().shape);
    }
  }
}

// Regular polygons of the disk's area come nearer to its form factor corner by corner, in the truth and in ltc.
TEST_F(PolygonTechnique, RegularPolygonsTendToTheDisk) {
  std::vector<PointCase> disks = RandomPoints(50, LightShape::kDisk, 500);
  const std::vector<Shaded> disk = TruthOf(disks), ltc_disk = points_->Shade("ltc", disks);
  double before = 1.0, ltc_before = 1.0;
  for (const int corners : {3, 4, 6, 8}) {
    std::vector<PointCase> polygons = disks;
    for (PointCase& c : polygons) {
      const double step = glm::two_pi<double>() / corners;
      const double radius = c.half_size.x * std::sqrt(step / std::sin(step));
      c.shape = LightShape::kPolygon;
      c.half_size = glm::dvec2(radius);
      for (int i = 0; i < corners; ++i) c.corners.emplace_back(radius * std::cos(i * step), radius * std::sin(i * step));
    }
    const double error = RelativeRmse(TruthOf(polygons), disk, &Shaded::diffuse);
    const double ltc_error = RelativeRmse(points_->Shade("ltc", polygons), ltc_disk, &Shaded::diffuse);
    EXPECT_LT(error, 0.6 * before) << corners;
    EXPECT_LT(ltc_error, 0.6 * ltc_before) << corners;
    before = error;
    ltc_before = ltc_error;
  }
  EXPECT_LT(before, 0.01);
}

// An ellipse of equal half axes is the disk; one that is stretched and seen from the axis keeps the closed form ab/√((a² + h²)(b² + h²)).
TEST_F(PolygonTechnique, AnEllipseOfEqualHalfAxesIsTheDisk) {
  const std::vector<PointCase> disks = RandomPoints(51, LightShape::kDisk, 1000);
  std::vector<PointCase> ellipses = disks;
  for (PointCase& c : ellipses) c.shape = LightShape::kEllipse;
  const std::vector<Shaded> truth = TruthOf(disks), as_truth = TruthOf(ellipses);
  EXPECT_LT(RelativeRmse(as_truth, truth, &Shaded::diffuse), 2e-7);  // axes in float are square to 6e-8 only
  EXPECT_LT(RelativeRmse(as_truth, truth, &Shaded::specular), 1e-4);
  for (const char* name : {"ltc", "ltc@published", "hill", "hill@published", "reference", "oat", "point"}) {
    const std::vector<Shaded> a = points_->Shade(name, ellipses), b = points_->Shade(name, disks);
    EXPECT_LT(RelativeRmse(a, b, &Shaded::diffuse), 1e-4) << name;
    EXPECT_LT(RelativeRmse(a, b, &Shaded::specular), 1e-3) << name;
  }
  PointCase above;
  above.shape = LightShape::kEllipse;
  above.half_size = {0.75, 0.25};
  const double expected = 0.75 * 0.25 / std::sqrt((0.5625 + 1.0) * (0.0625 + 1.0));
  EXPECT_NEAR(above.Truth().form_factor, expected, 1e-14);
  for (const char* name : {"ltc", "hill", "reference"}) EXPECT_NEAR(points_->Shade(name, {above})[0].diffuse, expected, 2e-5) << name;
}

// The cap of equal solid angle: of a polygon and an ellipse seen whole, oat's diffuse is the cap's, within its own closed form.
TEST_F(PolygonTechnique, OatTakesTheSolidAngle) {
  for (const std::vector<PointCase>& all : {RandomPolygons(52, 300), RandomEllipses(53, 300)}) {
    std::vector<PointCase> cases;
    std::vector<double> expected;
    for (PointCase c : all) {
      c.position = glm::dvec3(0.0);
      c.normal = glm::dvec3(glm::vec3(glm::normalize(c.center)));
      // ∫ dω over the light by a fine grid on the unit disk or on triangles about the centroid.
      const auto at = [&](glm::dvec2 p) {
        const glm::dvec3 to = c.center + c.axis_x * p.x + c.axis_y * p.y;
        return -glm::dot(to, c.light_normal) / std::pow(glm::dot(to, to), 1.5);
      };
      double omega = 0.0;
      constexpr int kSteps = 64;
      const std::size_t sides = c.corners.empty() ? 64 : c.corners.size();
      for (std::size_t s = 0; s < sides; ++s) {
        for (int i = 0; i < kSteps; ++i) {
          for (int j = 0; j < kSteps; ++j) {
            const double r = (i + 0.5) / kSteps, t = (j + 0.5) / kSteps;
            if (c.corners.empty()) {
              if (j > 0) continue;
              const double angle = (static_cast<double>(s) + 0.5) * glm::two_pi<double>() / static_cast<double>(sides);
              omega += at(c.half_size * r * glm::dvec2(std::cos(angle), std::sin(angle))) * c.half_size.x * c.half_size.y * r / kSteps *
                       glm::two_pi<double>() / static_cast<double>(sides);
            } else {
              const glm::dvec2 p = c.corners[s], q = c.corners[(s + 1) % sides];
              omega += at(r * (p + t * (q - p))) * r * (p.x * q.y - p.y * q.x) / (kSteps * kSteps);
            }
          }
        }
      }
      const double versine = omega / glm::two_pi<double>();
      cases.push_back(c);
      expected.push_back(versine * (2.0 - versine));  // sin² of the cap about the normal
    }
    const std::vector<Shaded> shaded = points_->Shade("oat", cases);
    for (std::size_t i = 0; i < cases.size(); ++i) EXPECT_NEAR(shaded[i].diffuse, expected[i], 2e-3 * expected[i]) << i;
  }
}

TEST_F(PolygonTechnique, HardPointsStayFinite) {
  std::vector<PointCase> cases;
  for (PointCase c : HardPoints()) {
    if (c.shape == LightShape::kRectangle) cases.push_back(AsPolygon(c));
  }
  for (const char* name : {"ltc", "ltc@published", "ltc+clip=none", "hill", "hill@published", "light_field", "light_field@published", "point",
                           "reference", "monte_carlo", "oat"}) {
    const std::vector<Shaded> shaded = points_->Shade(name, cases);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      ASSERT_TRUE(std::isfinite(shaded[i].diffuse) && shaded[i].diffuse >= 0.0) << name << " " << i;
      ASSERT_TRUE(std::isfinite(shaded[i].specular) && shaded[i].specular >= 0.0) << name << " " << i;
    }
  }
}

}  // namespace
}  // namespace arealab::polygon_technique_test
