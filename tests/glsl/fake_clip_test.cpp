// The fake clipping: what the article says of it, what its listing does instead, and its area beside the
// exact one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "glsl/dual_begin.h"
#include "glsl/surface.glsl"
namespace documented {
#include "glsl/segment/documented.glsl"
#include "glsl/fake_clip.glsl"
}  // namespace documented
namespace printed {
#include "glsl/segment/printed.glsl"
#include "glsl/fake_clip.glsl"
}  // namespace printed
#include "glsl/dual_end.h"

namespace arealab {
namespace {

using glm::dvec2;
using glm::dvec3;

double Area(const auto& clipped) {
  return std::max(clipped.high.x - clipped.low.x, 0.0) * std::max(clipped.high.y - clipped.low.y, 0.0);
}

// Of the part of the rectangle that is above the horizon [Sutherland & Hodgman 1974].
double ExactArea(const dvec3& point, const dvec3& normal, const dvec2& half) {
  const std::vector<dvec2> corners{
      {half.x, half.y}, {-half.x, half.y}, {-half.x, -half.y}, {half.x, -half.y}};
  const auto height = [&](const dvec2& p) { return glm::dot(dvec3(p, 0.0) - point, normal); };
  std::vector<dvec2> kept;
  for (std::size_t i = 0; i < 4; ++i) {
    const dvec2 a = corners[i], b = corners[(i + 1) % 4];
    const double ha = height(a), hb = height(b);
    if (ha > 0.0) kept.push_back(a);
    if (ha * hb < 0.0) kept.push_back(a + (b - a) * (ha / (ha - hb)));
  }
  double twice = 0.0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const dvec2 a = kept[i], b = kept[(i + 1) % kept.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  return 0.5 * std::abs(twice);
}

TEST(FakeClip, SegmentAsDocumentedAndAsPrinted) {
  const dvec2 p0(0.0), p1(1.0, 0.0);
  // Cut: short of the crossing by the inset. Both above: the end.
  EXPECT_NEAR(dual::documented::ClipSegment(p0, p1, 1.0, -2.0, 1e-3).x, 0.499, 1e-12);
  EXPECT_NEAR(dual::printed::ClipSegment(p0, p1, 1.0, -2.0, 1e-3).x, 0.499, 1e-12);
  EXPECT_EQ(dual::documented::ClipSegment(p0, p1, 1.0, 1.0, 1e-3), p1);
  EXPECT_EQ(dual::printed::ClipSegment(p0, p1, 1.0, 1.0, 1e-3), p1);
  // Both below: the start, says the comment; the listing only where the side falls.
  EXPECT_EQ(dual::documented::ClipSegment(p0, p1, -1.0, -1.0, 1e-3), p0);
  EXPECT_EQ(dual::printed::ClipSegment(p0, p1, -1.0, -1.0, 1e-3), p0);
  EXPECT_EQ(dual::documented::ClipSegment(p0, p1, -2.0, 1.0, 1e-3), p0);
  EXPECT_EQ(dual::printed::ClipSegment(p0, p1, -2.0, 1.0, 1e-3), p1);
  EXPECT_EQ(dual::printed::ClipSegment(p0, p1, -1.0, 0.0, 1e-3), p1);
}

// The article's listing, line by line, with HLSL's rules for a level side: a clamped NaN is 0, and a mix by 0 takes its first. What its
// rise of 0 is signed, which the listing leaves to the hardware, is taken as +.
dvec3 ListedSegment(const dvec3& p0, const dvec3& p1, const dvec3& plane_position, const dvec3& plane_normal) {
  const dvec3 v = p1 - p0, to_plane = plane_position - p0;
  const double d = glm::dot(to_plane, plane_normal), t = d / (glm::dot(v, plane_normal) + 0.0);
  const auto saturate = [](double x) { return x > 0.0 ? std::min(x, 1.0) : 0.0; };
  return d > 0.0 || t >= 0.0 ? p0 + saturate(t - 1e-3) * v : p1;
}
glm::dvec4 ListedClipping(const dvec3& position, const dvec3& normal, const dvec2& scale) {
  const double x0 = scale.x * (normal.x < 0.0 ? -1.0 : 1.0), y0 = scale.y * (normal.y < 0.0 ? -1.0 : 1.0);
  const dvec3 p0(x0, y0, 0.0), p1(-x0, y0, 0.0), p2(-x0, -y0, 0.0), p3(x0, -y0, 0.0);
  dvec2 low(100.0), high(-100.0);
  for (const auto& round : {std::vector{p1, p2, p3, p0}, std::vector{p3, p2, p1, p0}}) {
    dvec3 p = p0;
    for (const dvec3& to : round) {
      p = ListedSegment(p, to, position, normal);
      low = glm::min(low, dvec2(p)), high = glm::max(high, dvec2(p));
    }
  }
  return {low, high};
}

TEST(FakeClip, PrintedIsTheListing) {
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int cut = 0;
  for (int i = 0; i < 50000; ++i) {
    const dvec2 half(1.5 + uniform(engine), 1.5 + uniform(engine));
    const dvec3 point(3.0 * uniform(engine), 3.0 * uniform(engine), 1.001 + uniform(engine));
    dvec3 normal(uniform(engine), uniform(engine), uniform(engine));
    if (i % 11 == 0) normal.x = 0.0;  // level sides
    if (i % 13 == 0) normal.y = 0.0;
    normal = glm::normalize(normal);
    const glm::dvec4 listed = ListedClipping(point, normal, half);
    const auto clipped = dual::printed::ClipToRectangle(point, normal, half);
    ASSERT_LT(glm::length(listed - glm::dvec4(clipped.low, clipped.high)), 1e-11) << i;
    const double share = Area(clipped) / (4.0 * half.x * half.y);
    cut += share > 0.0 && share < 1.0 ? 1 : 0;
  }
  EXPECT_GT(cut, 10000);
}

// A light below a horizon that is parallel to it keeps its whole area as printed, none as documented.
TEST(FakeClip, ParallelPlane) {
  const dvec3 above_the_light(0.0, 0.0, 1.0), up(0.0, 0.0, 1.0);
  EXPECT_EQ(Area(dual::documented::ClipToRectangle(above_the_light, up, dvec2(1.0))), 0.0);
  EXPECT_EQ(Area(dual::printed::ClipToRectangle(above_the_light, up, dvec2(1.0))), 4.0);
  for (const double z : {0.0, 1.0}) {  // in the plane, and the light above
    const dvec3 point(0.0, 0.0, z);
    EXPECT_TRUE(std::isfinite(Area(dual::printed::ClipToRectangle(point, -up, dvec2(1.0)))));
    EXPECT_EQ(Area(dual::documented::ClipToRectangle(point, -up, dvec2(1.0))), z > 0.0 ? 4.0 : 0.0);
  }
}

// A diagonal cut through the middle: half is left, all is kept. That is the method.
TEST(FakeClip, DiagonalHalfKeepsAll) {
  const dvec3 normal = glm::normalize(dvec3(1.0, 1.0, 0.0)), point(0.01, 0.0, 1.0);
  EXPECT_NEAR(ExactArea(point, normal, dvec2(1.0)), 1.98, 1e-3);
  EXPECT_NEAR(Area(dual::documented::ClipToRectangle(point, normal, dvec2(1.0))), 3.95, 0.01);
  EXPECT_NEAR(Area(dual::printed::ClipToRectangle(point, normal, dvec2(1.0))), 3.95, 0.01);
}

// A horizon along the light's sides is clipped exactly, but for the inset.
TEST(FakeClip, HorizonAlongASideIsExact) {
  for (int i = 1; i < 20; ++i) {
    const dvec3 normal(1.0, 0.0, 0.0), point(-1.0 + 0.1 * i, 5.0, 2.0);
    for (const double area : {Area(dual::documented::ClipToRectangle(point, normal, dvec2(1.0))),
                              Area(dual::printed::ClipToRectangle(point, normal, dvec2(1.0)))}) {
      EXPECT_NEAR(area, ExactArea(point, normal, dvec2(1.0)), 5e-3) << i;
    }
  }
}

// How often a curve turns from rising to falling or back.
struct Turns {
  int count = 0;
  void Add(double value) {
    if (!std::isnan(last_) && std::abs(value - last_) > 1e-5) {
      count += (value - last_) * step_ < 0.0 ? 1 : 0;
      step_ = value - last_;
    }
    last_ = value;
  }

 private:
  double last_ = NAN, step_ = 0.0;
};

// The "area bounces" that he warns of, as a curve of area against the plane's tilt: over half a turn of the
// horizon the exact area rises and falls once, the fake's turns back five more times; never smaller, at
// most 1.9 of 4 too large. As documented and as printed alike, since the light is never wholly below a plane
// that is level with a side.
TEST(FakeClip, AreaBouncesWhileThePlaneTilts) {
  const dvec3 point(0.13, -0.18, 0.63);
  const dvec3 from = glm::normalize(dvec3(-0.773, -0.634, 0.009));
  const dvec3 towards = glm::normalize(dvec3(0.592, -0.717, 0.368));
  Turns exact, documented, printed;
  double most_over = 0.0, most_under = 0.0, apart = 0.0;
  for (int i = 0; i <= 900; ++i) {
    const double tilt = glm::radians(0.2 * i);
    const dvec3 normal = glm::normalize(from * std::cos(tilt) + towards * std::sin(tilt));
    const double is = ExactArea(point, normal, dvec2(1.0));
    const double fake = Area(dual::documented::ClipToRectangle(point, normal, dvec2(1.0)));
    const double as_printed = Area(dual::printed::ClipToRectangle(point, normal, dvec2(1.0)));
    exact.Add(is);
    documented.Add(fake);
    printed.Add(as_printed);
    most_over = std::max(most_over, fake - is);
    most_under = std::max(most_under, is - fake);
    apart = std::max(apart, std::abs(fake - as_printed));
  }
  EXPECT_EQ(exact.count, 1);
  EXPECT_EQ(documented.count, 6);
  EXPECT_EQ(printed.count, 6);
  EXPECT_NEAR(most_over, 1.86, 0.02);
  EXPECT_LT(most_under, 5e-3);  // the inset
  EXPECT_EQ(apart, 0.0);
}

// And as the horizon turns through the light's centre: half is left at every angle, the fake keeps half to
// all.
TEST(FakeClip, AreaBouncesWhileThePlaneTurns) {
  Turns fake;
  for (int i = 0; i <= 360; ++i) {
    const double angle = glm::radians(static_cast<double>(i));
    const dvec3 normal(std::cos(angle), std::sin(angle), 0.0), point(0.0, 0.0, 1.0);
    const double area = Area(dual::documented::ClipToRectangle(point, normal, dvec2(1.0)));
    EXPECT_TRUE(area > 1.99 && area < 4.001) << i;
    fake.Add(area);
  }
  EXPECT_EQ(fake.count, 7);  // up to 4 and down to 2 in each quarter
}

}  // namespace
}  // namespace arealab
