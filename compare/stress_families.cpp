#include "compare/stress_families.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "scenes/error.h"

namespace arealab {
namespace {

using glm::dvec3;

const std::vector<LightShape> kAll{LightShape::kRectangle, LightShape::kDisk, LightShape::kSphere,
                                   LightShape::kEllipse, LightShape::kPolygon};
const std::vector<LightShape> kFlat{LightShape::kRectangle, LightShape::kDisk, LightShape::kEllipse,
                                    LightShape::kPolygon};
const std::vector<LightShape> kLong{LightShape::kRectangle, LightShape::kEllipse, LightShape::kPolygon};
const std::vector<LightShape> kCornered{LightShape::kRectangle, LightShape::kPolygon};
const std::vector<LightShape> kRound{LightShape::kSphere};
const std::vector<LightShape> kTubes{LightShape::kTube};

bool HasOneSize(LightShape shape) {
  return shape == LightShape::kDisk || shape == LightShape::kSphere;
}
bool HasRim(LightShape shape) {
  return shape == LightShape::kDisk || shape == LightShape::kEllipse;
}

double Length(const PointCase& c) {
  return std::max(c.half_size.x, c.half_size.y);
}

// Half sizes x and y; disks and spheres take x.
void SetSize(PointCase& c, double x, double y) {
  c.half_size = {x, HasOneSize(c.shape) ? x : y};
}

// A polygon's corners about their centroid, three to eight on a circle. In half sizes, as places on a light are
// while its case is made; MakeCases turns them into metres.
void GiveCorners(PointCase& c, CaseRandom& random) {
  if (c.shape != LightShape::kPolygon) return;
  const int count = static_cast<int>(random(3.0, 8.999));
  const double turn = random(0.0, 2.0 * std::numbers::pi);
  for (int i = 0; i < count; ++i) {
    const double angle = turn + 2.0 * std::numbers::pi * (i + random(0.0, 0.7)) / count;
    c.corners.emplace_back(std::cos(angle), std::sin(angle));
  }
  arealab::Light light;
  SetCorners(light, c.corners);
  c.corners = light.corners;
}

// On the outline, in half sizes: a corner, or a place on a side.
glm::dvec2 AnyCorner(const PointCase& c, CaseRandom& random) {
  if (c.shape != LightShape::kPolygon) return {random.Chance(0.5) ? 1.0 : -1.0, random.Chance(0.5) ? 1.0 : -1.0};
  return c.corners[static_cast<std::size_t>(random(0.0, static_cast<double>(c.corners.size()) - 0.001))];
}
glm::dvec2 OnAnySide(const PointCase& c, double from, double to, CaseRandom& random) {
  const auto count = static_cast<double>(c.corners.size());
  const auto i = static_cast<std::size_t>(random(0.0, count - 0.001));
  return glm::mix(c.corners[i], c.corners[(i + 1) % c.corners.size()], random(from, to));
}

// Turns the light's lit side to `normal`, its axes about it at random.
void FaceTo(PointCase& c, const dvec3& normal, CaseRandom& random) {
  c.light_normal = glm::normalize(normal);
  c.axis_x = random.Perpendicular(c.light_normal);
  c.axis_y = glm::cross(c.light_normal, c.axis_x);
}

// The point where the light has the plane coordinates x, y (in half sizes) and the height h (m) over its
// plane.
void PlacePoint(PointCase& c, double x, double y, double h) {
  c.center =
      c.position - c.axis_x * (x * c.half_size.x) - c.axis_y * (y * c.half_size.y) - c.light_normal * h;
}

// The view at a cosine to the normal.
void SetView(PointCase& c, double cosine, CaseRandom& random) {
  c.to_view =
      cosine * c.normal + std::sqrt(std::max(1.0 - cosine * cosine, 0.0)) * random.Perpendicular(c.normal);
}

// All along the world's axes in quarters of a metre: what random numbers never do, an exact 0, scenes do all
// the time.
void Align(PointCase& c, CaseRandom& random) {
  const auto quarters = [&](int from, int to) { return 0.25 * std::floor(random(from, to + 1.0)); };
  const std::array<dvec3, 3> axes{dvec3(1.0, 0.0, 0.0), dvec3(0.0, 1.0, 0.0), dvec3(0.0, 0.0, 1.0)};
  const auto first = static_cast<std::size_t>(random(0.0, 2.999)),
             second = (first + (random.Chance(0.5) ? 1 : 2)) % 3;
  const double cosine = glm::dot(c.normal, c.to_view);
  c.normal = axes[static_cast<std::size_t>(random(0.0, 2.999))] * (random.Chance(0.5) ? 1.0 : -1.0);
  SetView(c, random.Chance(0.3) ? 1.0 : cosine, random);
  c.light_normal = axes[first] * (random.Chance(0.5) ? 1.0 : -1.0);
  c.axis_x = axes[second];
  c.axis_y = glm::cross(c.light_normal, c.axis_x);
  SetSize(c, quarters(1, 8), quarters(1, 8));
  const double least = c.shape == LightShape::kSphere ? c.half_size.x + 0.25 : 0.5;
  c.center = c.position - c.light_normal * (least + quarters(0, 8)) + c.axis_x * quarters(-4, 4) +
             c.axis_y * quarters(-4, 4);
}

// Everything that a scene ordinarily has: half sizes of 0.2 to 2 m, 1 to 4 m away (a sphere is left by at
// least a tenth of its radius), lit from the front; a roughness from 0.1 to 1.
PointCase Ordinary(CaseRandom& random, LightShape shape) {
  PointCase c;
  c.shape = shape;
  c.normal = random.Direction();
  SetView(c, random(0.05, 1.0), random);
  c.roughness = random(0.1, 1.0);
  c.f0 = random.Chance(0.5) ? 1.0 : 0.04;
  const double height = random(0.2, 2.0), width = random(0.2, 2.0);  // drawn in an order that every compiler keeps, here and below
  SetSize(c, width, height);
  GiveCorners(c, random);
  dvec3 to_center = random.Direction();
  if (glm::dot(to_center, c.normal) < 0.0) to_center = -to_center;
  if (random.Chance(0.5)) {  // where the highlight is
    const dvec3 mirror = 2.0 * glm::dot(c.normal, c.to_view) * c.normal - c.to_view;
    to_center = glm::normalize(mirror + 0.5 * random.Direction());
  }
  double distance = random(1.0, 4.0);
  if (shape == LightShape::kSphere) distance = std::max(distance, 1.1 * c.half_size.x);
  c.center = c.position + distance * to_center;
  dvec3 normal = random.Direction();
  if (glm::dot(normal, to_center) > 0.0) normal = -normal;
  if (glm::dot(normal, to_center) > -0.05) normal -= 0.1 * to_center;  // edge-on is a family of its own
  FaceTo(c, normal, random);
  if (random.Chance(0.15)) Align(c, random);
  return c;
}

// Turns the surface so that its horizon runs through that place of the light, m from the centre.
void CutAt(PointCase& c, double x, double y, CaseRandom& random) {
  const double cosine = glm::dot(c.normal, c.to_view);
  c.normal = random.Perpendicular(c.center + c.axis_x * x + c.axis_y * y - c.position);
  SetView(c, cosine, random);
}

// The surface's horizon through the light: along a random direction as seen from a place inside its outline.
PointCase Crossing(CaseRandom& random, LightShape shape) {
  PointCase c = Ordinary(random, shape);
  const double spread = shape == LightShape::kSphere ? 0.6 : shape == LightShape::kPolygon ? 0.4 : 0.95;
  const double y = spread * c.half_size.y * random(-1.0, 1.0), x = spread * c.half_size.x * random(-1.0, 1.0);
  CutAt(c, x, y, random);
  return c;
}

// A corner, two corners or the rim within 1e-7 (relative) of the horizon.
PointCase Touching(CaseRandom& random, LightShape shape) {
  PointCase c = Ordinary(random, shape);
  const glm::dvec2 corner = AnyCorner(c, random);
  dvec3 touched = c.center + corner.x * c.half_size.x * c.axis_x;
  if (!HasOneSize(shape) && !HasRim(shape)) touched += corner.y * c.half_size.y * c.axis_y;
  dvec3 along = random.Direction();  // with the touched place it spans the horizon
  if (shape == LightShape::kRectangle && random.Chance(0.5)) along = random.Chance(0.5) ? c.axis_x : c.axis_y;
  if (shape == LightShape::kPolygon && random.Chance(0.5)) {
    const glm::dvec2 side = AnyCorner(c, random) - corner;
    along = c.axis_x * (side.x * c.half_size.x) + c.axis_y * (side.y * c.half_size.y);
    if (side == glm::dvec2(0.0)) along = c.axis_x;
  }
  if (HasRim(shape)) along = c.axis_y;
  if (shape == LightShape::kSphere) {  // a tangent from the point
    const dvec3 to_center = c.center - c.position;
    const double distance = glm::length(to_center), sine = c.half_size.x / distance;
    const dvec3 side = random.Perpendicular(to_center);
    touched = to_center / distance * std::sqrt(1.0 - sine * sine) + side * sine;
    along = glm::cross(to_center, side);
  }
  const double cosine = glm::dot(c.normal, c.to_view);
  c.normal = glm::normalize(glm::cross(touched, along));
  if (random.Chance(0.5)) c.normal = -c.normal;
  if (!random.Chance(0.25)) {
    const dvec3 aside = random.Direction();
    c.normal = glm::normalize(c.normal + random.Log(1e-9, 1e-7) * aside);
  }
  SetView(c, cosine, random);
  return c;
}

// Over the light's plane, next to it: 0, 1e-25 m or 1e-9 of the light's size to `most` of it.
double Height(double most, const PointCase& c, CaseRandom& random) {
  if (random.Chance(0.2)) return random.Chance(0.5) ? 0.0 : 1e-25;
  return random.Log(1e-9, most) * Length(c);
}

// On the light's plane, or as near to it as 1e-9 to 1e-4 of its size; inside the outline and out.
PointCase OnPlane(CaseRandom& random, LightShape shape) {
  PointCase c = Ordinary(random, shape);
  const double reach = random.Chance(0.5) ? 0.99 : 4.0;
  const double height = Height(1e-4, c, random), y = random(-reach, reach), x = random(-reach, reach);
  PlacePoint(c, x, y, height);
  return c;
}

// On a side of the light or its rim, or within 1e-9 to 1e-3 of its size.
PointCase OnEdge(CaseRandom& random, LightShape shape) {
  PointCase c = Ordinary(random, shape);
  double x = random.Chance(0.5) ? 1.0 : -1.0, y = random(-1.0, 1.0);
  if (HasRim(shape)) {
    const double angle = random(0.0, 2.0 * std::numbers::pi);
    x = std::cos(angle);
    y = std::sin(angle);
  }
  if (shape == LightShape::kPolygon) {
    const glm::dvec2 place = OnAnySide(c, 0.0, 1.0, random);
    x = place.x;
    y = place.y;
  }
  if (random.Chance(0.7)) x += random.Signed(1e-9, 1e-3);
  if (shape == LightShape::kRectangle && random.Chance(0.5)) std::swap(x, y);
  PlacePoint(c, x, y, Height(1e-3, c, random));
  return c;
}

PointCase OnCorner(CaseRandom& random, LightShape shape) {
  PointCase c = Ordinary(random, shape);
  glm::dvec2 place = AnyCorner(c, random);
  if (random.Chance(0.7)) {
    place.x += random.Signed(1e-9, 1e-3);
    place.y += random.Signed(1e-9, 1e-3);
  }
  PlacePoint(c, place.x, place.y, Height(1e-3, c, random));
  return c;
}

// Inside a sphere, at its centre, on its surface or next to it.
PointCase InsideSphere(CaseRandom& random, LightShape shape) {
  PointCase c = Ordinary(random, shape);
  double distance = random(0.0, 1.0);
  if (random.Chance(0.5)) distance = 1.0 + random.Signed(1e-8, 1e-3);
  if (random.Chance(0.1)) distance = 1.0;
  if (random.Chance(0.1)) distance = random.Chance(0.5) ? 0.0 : random.Log(1e-9, 1e-3);
  c.center = c.position + distance * c.half_size.x * random.Direction();
  return c;
}

// The lit face, or a sphere's surface, 1e-7 to 0.1 of the light's size in front of the point.
PointCase Contact(CaseRandom& random, LightShape shape) {
  PointCase c = Ordinary(random, shape);
  const double gap = random.Log(1e-7, 0.1);
  if (shape == LightShape::kSphere) {
    c.center = c.position + (1.0 + gap) * c.half_size.x * random.Direction();
    return c;
  }
  double x = random(-1.0, 1.0), y = random(-1.0, 1.0);
  if (HasRim(shape) && x * x + y * y > 1.0) x = y = 0.5;
  if (shape == LightShape::kPolygon) {
    x *= 0.3;
    y *= 0.3;
  }
  if (random.Chance(0.5)) {  // on the surface that faces the light
    FaceTo(c, -c.normal, random);
  }
  PlacePoint(c, x, y, gap * Length(c));
  return c;
}

// A tube of 0.4 to 4 m and a radius of a hundredth to a half of that.
PointCase OrdinaryTube(CaseRandom& random, LightShape shape) {
  PointCase c = Ordinary(random, shape);
  c.half_size.y = c.half_size.x * random.Log(2e-2, 1.0);
  return c;
}

// The point beside the wall, or beyond an end, 1e-6 to 0.1 of the radius outside of the cylinder, prolonged, or inside.
PointCase AtTube(CaseRandom& random, LightShape shape) {
  PointCase c = OrdinaryTube(random, shape);
  const double distance = c.half_size.y * (random.Chance(0.2) ? random(0.0, 1.0) : 1.0 + random.Log(1e-6, 0.1));
  c.center = c.position - c.axis_x * (random(-1.5, 1.5) * c.half_size.x) - c.light_normal * distance;
  return c;
}

// A tube seen nearly along its axis, from 1e-4 to 0.1 rad beside it.
PointCase AlongTube(CaseRandom& random, LightShape shape) {
  PointCase c = OrdinaryTube(random, shape);
  const dvec3 to_center = glm::normalize(c.center - c.position);
  c.axis_x = glm::normalize(to_center + random.Log(1e-4, 0.1) * random.Perpendicular(to_center));
  c.axis_y = random.Perpendicular(c.axis_x);
  c.light_normal = glm::cross(c.axis_x, c.axis_y);
  return c;
}

// A tube cut by the horizon.
PointCase CrossingTube(CaseRandom& random, LightShape shape) {
  PointCase c = OrdinaryTube(random, shape);
  const double y = c.half_size.y * random(-1.0, 1.0), x = c.half_size.x * random(-1.0, 1.0);
  CutAt(c, x, y, random);
  return c;
}

// 1 : 1e3 to 1 : 1e5, or 1e4 to 1e5 of its lengths away.
PointCase ThinTube(CaseRandom& random, LightShape shape) {
  PointCase c = OrdinaryTube(random, shape);
  if (random.Chance(0.3)) c.center = c.position + glm::normalize(c.center - c.position) * (random.Log(1e4, 1e5) * c.half_size.x);
  c.half_size.y = c.half_size.x * random.Log(1e-5, 1e-3);
  return c;
}

PointCase Far(CaseRandom& random, LightShape shape) {
  PointCase c = Ordinary(random, shape);
  c.center = c.position + glm::normalize(c.center - c.position) * (random.Log(1e4, 1e5) * Length(c));
  return c;
}

PointCase Scaled(PointCase c, double scale) {
  c.position *= scale;
  c.center *= scale;
  c.half_size *= scale;
  return c;
}

// The whole scene of a hundredth of a millimetre.
PointCase Tiny(CaseRandom& random, LightShape shape) {
  return Scaled(Ordinary(random, shape), random.Log(1e-5, 1e-4));
}

// The whole scene of a hundred kilometres, or the light alone.
PointCase Huge(CaseRandom& random, LightShape shape) {
  PointCase c = Ordinary(random, shape);
  const double scale = random.Log(1e4, 1e5);
  if (random.Chance(0.5)) return Scaled(c, scale);
  const double distance = glm::length(c.center - c.position);
  if (shape == LightShape::kSphere) {
    c.center = c.position + glm::normalize(c.center - c.position) * (scale * c.half_size.x + distance);
  }
  c.half_size *= scale;
  return c;
}

PointCase Thin(CaseRandom& random, LightShape shape) {
  PointCase c = Ordinary(random, shape);
  c.half_size.y = c.half_size.x * random.Log(1e-5, 1e-3);
  if (random.Chance(0.5)) {
    std::swap(c.half_size.x, c.half_size.y);
  }
  return c;
}

// Consecutive corners, as the point sees them, in one direction (equal or nearly: the light is a dot, or ends
// on) or in opposite ones (the point next to the middle of a side).
PointCase Corners(CaseRandom& random, LightShape shape) {
  PointCase c = Ordinary(random, shape);
  if (random.Chance(0.5)) {
    c.half_size *= random.Log(1e-7, 1e-4);
    if (random.Chance(0.5)) c.half_size.y = c.half_size.x * random.Log(1e-3, 1.0);
  } else if (shape == LightShape::kPolygon) {
    const glm::dvec2 place = OnAnySide(c, 0.25, 0.75, random) * (1.0 + random.Signed(1e-7, 1e-2));
    PlacePoint(c, place.x, place.y, random.Log(1e-7, 1e-2) * Length(c));
  } else {
    const double height = random.Log(1e-7, 1e-2) * Length(c), y = 1.0 + random.Signed(1e-7, 1e-2), x = random(-0.5, 0.5);
    PlacePoint(c, x, y, height);
  }
  return c;
}

// A light without an extent along one axis or both, or one that no square of a float holds: no light.
PointCase NoArea(CaseRandom& random, LightShape shape) {
  PointCase c = Ordinary(random, shape);
  const double rest = random.Chance(0.5) ? 0.0 : random.Log(1e-38, 1e-20);
  if (random.Chance(0.5) || HasOneSize(shape))
    c.half_size = glm::dvec2(rest);
  else if (random.Chance(0.5))
    c.half_size.x = rest;
  else
    c.half_size.y = rest;
  return c;
}

// The view along the normal, or 1e-9 to 1e-3 rad beside it.
PointCase ViewAlongNormal(CaseRandom& random, LightShape shape) {
  PointCase c = Ordinary(random, shape);
  if (random.Chance(0.3)) c.normal = {0.0, 0.0, 1.0};
  const double angle = random.Chance(0.2) ? 0.0 : random.Log(1e-9, 1e-3);
  c.to_view = glm::normalize(std::cos(angle) * c.normal + std::sin(angle) * random.Perpendicular(c.normal));
  return c;
}

PointCase ViewGrazing(CaseRandom& random, LightShape shape) {
  PointCase c = Ordinary(random, shape);
  SetView(c, random.Log(1e-7, 1e-2), random);
  return c;
}

PointCase ViewBelow(CaseRandom& random, LightShape shape) {
  PointCase c = Ordinary(random, shape);
  SetView(c, -random.Log(1e-7, 1.0), random);
  return c;
}

// Roughness 0, the least alpha, 1, one that is denormal.
PointCase Roughness(CaseRandom& random, LightShape shape) {
  PointCase c = Ordinary(random, shape);
  if (random.Chance(0.1)) {  // the half vector is the normal, to the last bit
    c.to_view = c.normal;
    c.center = c.position + 4.0 * c.normal;
    FaceTo(c, -c.normal, random);
  }
  const std::array<double, 5> values{0.0, 1e-4, 1.0, 1e-40, 0.01};
  c.roughness = values[static_cast<std::size_t>(random(0.0, 4.999))];
  return c;
}

// A mirror in which the light's own outline is.
PointCase Mirror(CaseRandom& random, LightShape shape) {
  PointCase c = Roughness(random, shape);
  c.roughness = random.Chance(0.5) ? 0.0 : random.Log(1e-3, 0.03);
  const dvec3 mirror = 2.0 * glm::dot(c.normal, c.to_view) * c.normal - c.to_view;
  c.center = c.position + mirror * glm::length(c.center - c.position);
  if (glm::dot(c.light_normal, mirror) > 0.0) FaceTo(c, -c.light_normal, random);
  c.center += c.axis_x * (c.half_size.x * random(-1.0, 1.0)) + c.axis_y * (c.half_size.y * random(-1.0, 1.0));
  return c;
}

PointCase RadianceRange(CaseRandom& random, LightShape shape) {
  PointCase c = Ordinary(random, shape);
  c.radiance = random.Log(1e-30, 1e30);
  return c;
}

// Half to one and a tenth long, as filtered normal maps have them.
PointCase NormalMap(CaseRandom& random, LightShape shape) {
  PointCase c = Ordinary(random, shape);
  c.normal *= random(0.5, 1.1);
  return c;
}

PointCase Offset(CaseRandom& random, LightShape shape) {
  PointCase c = Ordinary(random, shape);
  const dvec3 offset = 1e6 * random.Direction();
  c.position += offset;
  c.center += offset;
  return c;
}

// The light turned away but for 1e-7 to 1e-2 rad.
PointCase EdgeOn(CaseRandom& random, LightShape shape) {
  PointCase c = Ordinary(random, shape);
  const dvec3 to_center = glm::normalize(c.center - c.position);
  FaceTo(c, random.Perpendicular(to_center) - to_center * random.Log(1e-7, 1e-2), random);
  return c;
}

// Half of the light above the horizon and half below, or all of it beside the point's plane: what is left of
// the vector form factor along the normal is nothing, or all of it is.
PointCase ZeroVector(CaseRandom& random, LightShape shape) {
  PointCase c = Ordinary(random, shape);
  if (random.Chance(0.5) && shape != LightShape::kSphere) {  // in the plane, outside: F is 0
    const double height = random.Chance(0.5) ? 0.0 : random.Log(1e-12, 1e-7) * Length(c), y = random(-1.0, 1.0), x = random(1.5, 4.0);
    PlacePoint(c, x, y, height);
    return c;
  }
  const dvec3 to_center = glm::normalize(c.center - c.position);
  if (shape != LightShape::kSphere) FaceTo(c, -to_center, random);
  const double cosine = glm::dot(c.normal, c.to_view);
  c.normal = random.Perpendicular(to_center);  // F lies in the horizon
  SetView(c, cosine, random);
  return c;
}

double Between(double from, double to, double t) {
  return from + (to - from) * t;
}

// A panel of 1 × 0.6 m, 2 m away on the x axis, that faces the point; the viewer opposite at `view` rad from
// the normal.
PointCase Panel(double view, LightShape shape) {
  PointCase c;
  c.shape = shape;
  c.roughness = 0.25;
  c.to_view = {-std::sin(view), 0.0, std::cos(view)};
  c.center = {2.0, 0.0, 0.8};
  c.light_normal = {-1.0, 0.0, 0.0};
  c.axis_x = {0.0, 1.0, 0.0};
  c.axis_y = {0.0, 0.0, -1.0};
  SetSize(c, 0.5, 0.3);
  if (shape == LightShape::kPolygon) {
    arealab::Light light;
    SetCorners(light, {{-0.5, -0.3}, {0.5, -0.3}, {0.4, 0.2}, {0.0, 0.3}, {-0.5, 0.1}});
    c.corners = light.corners;
    c.half_size = light.half_size;
  }
  return c;
}

PointCase Sinking(double t, LightShape shape) {
  PointCase c = Panel(1.2, shape);
  c.center.z = Between(0.7, -0.7, t);
  return c;
}

PointCase Swinging(double t, LightShape shape) {
  PointCase c = Panel(Between(-0.3, 0.3, t), shape);
  c.center = {0.3, 0.2, 1.5};
  c.light_normal = {0.0, 0.0, -1.0};
  c.axis_x = {1.0, 0.0, 0.0};
  c.axis_y = {0.0, -1.0, 0.0};
  return c;
}

PointCase Polished(double t, LightShape shape) {
  PointCase c = Panel(1.1, shape);
  c.roughness = Between(0.3, 0.0, t);
  return c;
}

// Across a smooth floor, from under the panel's foot to 20 m before it.
PointCase AcrossFloor(double t, LightShape shape) {
  PointCase c = Panel(1.0, shape);
  c.roughness = 0.2;
  c.center.x = 0.05 * std::pow(400.0, t);
  return c;
}

PointCase Grazing(double t, LightShape shape) {
  PointCase c = Panel(Between(1.309, 1.536, t), shape);  // 75° to 88°
  c.roughness = 0.08;
  c.center = {4.0, 0.0, 0.5};
  return c;
}

// The point sinks to the light's plane, past its side.
PointCase ToThePlane(double t, LightShape shape) {
  PointCase c = Panel(0.8, shape);
  c.light_normal = {0.0, 0.0, -1.0};
  c.axis_x = {1.0, 0.0, 0.0};
  c.axis_y = {0.0, -1.0, 0.0};
  c.center = {0.45, 0.0, 0.5 * std::pow(1e-3, t)};
  return c;
}

constexpr int kBlock = 2048;  // cases of one random engine

struct Field {
  const char* name;
  glm::dvec3 PointCase::*vector;
  double PointCase::*number;
};
constexpr std::array<Field, 10> kFields{{{"position", &PointCase::position, nullptr},
                                         {"normal", &PointCase::normal, nullptr},
                                         {"to_view", &PointCase::to_view, nullptr},
                                         {"roughness", nullptr, &PointCase::roughness},
                                         {"f0", nullptr, &PointCase::f0},
                                         {"center", &PointCase::center, nullptr},
                                         {"axis_x", &PointCase::axis_x, nullptr},
                                         {"axis_y", &PointCase::axis_y, nullptr},
                                         {"light_normal", &PointCase::light_normal, nullptr},
                                         {"radiance", nullptr, &PointCase::radiance}}};

// `least` to `most` numbers with commas between.
std::vector<double> ParseNumbers(const std::string& key, const std::string& text, std::size_t least,
                                 std::size_t most) {
  std::vector<double> numbers;
  const char* at = text.c_str();
  while (true) {
    char* end = nullptr;
    numbers.push_back(std::strtod(at, &end));
    const bool last = *end == '\0';
    if (end == at || (!last && *end != ',') || !std::isfinite(numbers.back()) || numbers.size() > most ||
        (last && numbers.size() < least)) {
      throw InputError(fmt::format("--case: {}={}; expected {} finite number{} with commas between", key, text,
                                   least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most),
                                   most == 1 ? "" : "s"));
    }
    if (last) return numbers;
    at = end + 1;
  }
}

}  // namespace

double CaseRandom::Log(double from, double to) {
  return from * std::pow(to / from, uniform_(engine_));
}

double CaseRandom::Signed(double from, double to) {
  const double magnitude = Log(from, to);
  return Chance(0.5) ? -magnitude : magnitude;
}

glm::dvec3 CaseRandom::Direction() {
  const double z = (*this)(-1.0, 1.0), phi = (*this)(0.0, 2.0 * std::numbers::pi), r = std::sqrt(1.0 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

glm::dvec3 CaseRandom::Perpendicular(const glm::dvec3& v) {
  while (true) {
    const dvec3 p = glm::cross(v, Direction());
    if (glm::dot(p, p) > 1e-6 * glm::dot(v, v)) return glm::normalize(p);
  }
}

const std::vector<StressFamily>& StressFamilies() {
  static const std::vector<StressFamily> families{
      {"ordinary", "lights of 0.2 to 2 m half size, 1 to 4 m away, roughness 0.1 to 1", false, kAll,
       Ordinary},
      {"crossing", "the light across the horizon, every set of corners above", false, kAll, Crossing},
      {"touching", "a corner, a side or the rim within 1e-7 of the horizon", false, kAll, Touching},
      {"on_plane", "the point on the light's plane or within 1e-4 of its size", true, kFlat, OnPlane},
      {"on_edge", "the point on a side or the rim, or within 1e-3 of the size", true, kFlat, OnEdge},
      {"on_corner", "the point at a corner, or within 1e-3 of the size", true, kCornered, OnCorner},
      {"inside_sphere", "the point inside a sphere, on its surface, at its centre", true, kRound,
       InsideSphere},
      {"contact", "the lit face 1e-7 to 0.1 of its size in front of the point", true, kAll, Contact},
      {"far", "the light 1e4 to 1e5 of its sizes away", false, kAll, Far},
      {"tiny", "a scene of 1e-5 to 1e-4 m", false, kAll, Tiny},
      {"huge", "a scene, or a light, of 1e4 to 1e5 m", false, kAll, Huge},
      {"thin", "sides, or half axes, of 1 : 1e3 to 1 : 1e5", false, kLong, Thin},
      {"corners", "consecutive corners in nearly one direction, or in opposite ones", true, kCornered,
       Corners},
      {"no_area", "a light without extent, or with one whose square is no float", false, kAll, NoArea},
      {"view_normal", "the view along the normal, or up to 1e-3 rad beside it", true, kAll, ViewAlongNormal},
      {"view_grazing", "the view 1e-7 to 1e-2 over the surface", true, kAll, ViewGrazing},
      {"view_below", "the view below the surface", false, kAll, ViewBelow},
      {"roughness", "roughness 0, 1e-4, 0.01, 1 and denormal", true, kAll, Roughness},
      {"mirror", "the light's outline in a mirror of roughness 0 to 0.03", true, kAll, Mirror},
      {"radiance", "radiance from 1e-30 to 1e30", false, kAll, RadianceRange},
      {"normal_map", "normals of length 0.5 to 1.1", false, kAll, NormalMap},
      {"offset", "coordinates 1e6 m from the origin", true, kAll, Offset},
      {"edge_on", "the light edge-on but for 1e-7 to 1e-2 rad", true, kFlat, EdgeOn},
      {"zero_vector", "a vector form factor of 0, or without a part along the normal", true, kAll,
       ZeroVector},
      {"tube", "tubes of 0.4 to 4 m, 1 to 4 m away", false, kTubes, OrdinaryTube},
      {"tube_crossing", "a tube across the horizon", false, kTubes, CrossingTube},
      {"tube_beside", "the point beside the wall of a tube, prolonged, or inside", true, kTubes, AtTube},
      {"tube_along", "a tube seen 1e-4 to 0.1 rad beside its axis", true, kTubes, AlongTube},
      {"tube_thin", "a tube of 1 : 1e3 to 1 : 1e5, also from afar", false, kTubes, ThinTube},
  };
  return families;
}

const std::vector<StressPath>& StressPaths() {
  static const std::vector<StressPath> paths{
      {"sinking", "a panel sinks through the horizon", kAll, Sinking},
      {"swinging", "the view swings through the normal", kAll, Swinging},
      {"polished", "the roughness falls from 0.3 to 0", kAll, Polished},
      {"floor", "across a smooth floor, away from a panel on it", kAll, AcrossFloor},
      {"grazing", "the view sinks from 75° to 88°, roughness 0.08", kAll, Grazing},
      {"plane", "the point nears the light's plane, past its side", kFlat, ToThePlane},
  };
  return paths;
}

std::vector<PointCase> MakeCases(const StressFamily& family, LightShape shape, int count,
                                 std::uint64_t seed) {
  std::vector<PointCase> cases(static_cast<std::size_t>(count));
  std::uint64_t name = 1469598103934665603u;  // FNV-1a: a family's cases do not depend on its place
  for (const char* c = family.name; *c != '\0'; ++c)
    name = (name ^ static_cast<unsigned char>(*c)) * 1099511628211u;
  const int blocks = (count + kBlock - 1) / kBlock;
  tbb::parallel_for(0, blocks, [&](int block) {
    CaseRandom random(name ^ (seed * 1000003u + static_cast<std::uint64_t>(block) * 3u +
                              static_cast<std::uint64_t>(shape)));
    for (int i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i) {
      PointCase c = family.make(random, shape);
      glm::dvec2 reach(0.0);
      for (glm::dvec2& corner : c.corners) {
        corner *= c.half_size;
        reach = glm::max(reach, glm::abs(corner));
      }
      if (!c.corners.empty()) c.half_size = reach;
      cases[static_cast<std::size_t>(i)] = c.Rounded();
    }
  });
  return cases;
}

std::string CaseLine(const PointCase& c) {
  std::string line = fmt::format("shape={}", Name(c.shape));
  for (const Field& field : kFields) {
    if (field.vector != nullptr) {
      const dvec3& v = c.*field.vector;
      line += fmt::format(" {}={:.9g},{:.9g},{:.9g}", field.name, v.x, v.y, v.z);
    } else {
      line += fmt::format(" {}={:.9g}", field.name, c.*field.number);
    }
  }
  line += fmt::format(" half_size={:.9g},{:.9g}", c.half_size.x, c.half_size.y);
  for (std::size_t i = 0; i < c.corners.size(); ++i)
    line += fmt::format("{}{:.9g},{:.9g}", i == 0 ? " corners=" : ",", c.corners[i].x, c.corners[i].y);
  return line;
}

PointCase ParseCase(std::string_view line) {
  PointCase c;
  while (true) {
    line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
    if (line.empty()) {
      if ((c.shape == LightShape::kPolygon) != !c.corners.empty()) {
        throw InputError("--case: corners and shape=polygon; expected both or neither");
      }
      return c.Rounded();
    }
    const std::string word(line.substr(0, line.find(' ')));
    line.remove_prefix(word.size());
    const auto equals = word.find('=');
    if (equals == std::string::npos)
      throw InputError(fmt::format("--case: \"{}\"; expected NAME=VALUE", word));
    const std::string key = word.substr(0, equals), value = word.substr(equals + 1);
    const auto field = std::ranges::find_if(kFields, [&](const Field& f) { return key == f.name; });
    if (key == "shape") {
      const auto shape = std::ranges::find_if(kLightShapes, [&](LightShape s) { return value == Name(s); });
      if (shape == std::end(kLightShapes)) {
        throw InputError(fmt::format("--case: shape={}; expected rectangle, disk, sphere, ellipse, polygon or tube", value));
      }
      c.shape = *shape;
    } else if (key == "half_size") {
      const std::vector<double> v = ParseNumbers(key, value, 2, 2);
      c.half_size = {v[0], v[1]};
    } else if (key == "corners") {
      const std::vector<double> v = ParseNumbers(key, value, 6, 16);
      if (v.size() % 2 != 0) throw InputError(fmt::format("--case: {}={}; expected pairs x,y", key, value));
      c.corners.clear();
      for (std::size_t i = 0; i < v.size(); i += 2) c.corners.emplace_back(v[i], v[i + 1]);
    } else if (field == kFields.end()) {
      throw InputError(
          fmt::format("--case: unknown {}; expected what `arealab stress` prints as a case", key));
    } else if (field->vector != nullptr) {
      const std::vector<double> v = ParseNumbers(key, value, 3, 3);
      c.*field->vector = {v[0], v[1], v[2]};
    } else {
      c.*field->number = ParseNumbers(key, value, 1, 1)[0];
    }
  }
}

std::string CaseScene(const PointCase& c, const std::string& about) {
  // The scene language's ranges: lengths from 1e-6 m, radiance from above 0 to 1e12.
  const auto length = [](double x) { return std::clamp(x, 1e-6, 1e7); };
  const double radiance = std::clamp(c.radiance, 1e-30, 1e12);
  const bool said = radiance == c.radiance && length(c.half_size.x) == c.half_size.x &&
                    length(c.half_size.y) == c.half_size.y && std::abs(glm::length(c.normal) - 1.0) < 1e-6 &&
                    glm::dot(c.normal, c.to_view) > 0.0 && (c.corners.empty() || !WhyNoPolygon(c.corners));
  const dvec3 normal = glm::normalize(c.normal);
  const double distance = glm::length(c.center - c.position), degrees = 180.0 / std::numbers::pi;
  const double away = std::clamp(distance, 1e-5, 1e6);  // of the camera, and the surface's size
  const auto triple = [](const dvec3& v) { return fmt::format("[{:.9g}, {:.9g}, {:.9g}]", v.x, v.y, v.z); };
  std::string text = fmt::format("# {}\n# --case '{}'\n", about, CaseLine(c));
  if (!said)
    text +=
        "# The scene language holds this case only nearly: sizes, radiance or a direction are out of its "
        "range.\n";
  text += fmt::format("\n[camera]\nposition = {}\ntarget = {}\nup = {}\nvertical_fov = 30.0\n",
                      triple(c.position + away * c.to_view), triple(c.position),
                      triple(std::abs(c.to_view.z) < 0.9 ? dvec3(0.0, 0.0, 1.0) : dvec3(0.0, 1.0, 0.0)));
  text +=
      fmt::format("\n[[material]]\nname = \"surface\"\nbase_color = {}\nmetalness = {}\nroughness = {:.9g}\n",
                  c.f0 < 1.0 ? 0.8 : 1.0, c.f0 < 1.0 ? 0.0 : 1.0, c.roughness);
  text += fmt::format(
      "\n[[surface]]\ntype = \"plane\"\nsize = [{0:.9g}, {0:.9g}]\nposition = {1}\nrotation = [0.0, "
      "{2:.12g}, {3:.12g}]\nmaterial = \"surface\"\n",
      length(2.0 * away), triple(c.position), std::acos(std::clamp(normal.z, -1.0, 1.0)) * degrees,
      std::atan2(normal.y, normal.x) * degrees);
  text += fmt::format("\n[[light]]\nshape = \"{}\"\nposition = {}\nradiance = {:.9g}\n", Name(c.shape),
                      triple(c.center), radiance);
  if (c.shape == LightShape::kTube) {
    return text + fmt::format("axis = {}\nlength = {:.9g}\nradius = {:.9g}\n", triple(c.axis_x), 2.0 * length(c.half_size.x), length(c.half_size.y));
  }
  if (c.shape != LightShape::kSphere) {
    text += fmt::format("normal = {}\nup = {}\n", triple(c.light_normal), triple(c.axis_y));
  }
  const glm::dvec2 size(length(c.half_size.x), length(c.half_size.y));
  switch (c.shape) {
    case LightShape::kRectangle:
      text += fmt::format("size = [{:.9g}, {:.9g}]\n", 2.0 * size.x, 2.0 * size.y);
      break;
    case LightShape::kEllipse:
      text += fmt::format("radii = [{:.9g}, {:.9g}]\n", size.x, size.y);
      break;
    case LightShape::kPolygon:
      for (std::size_t i = 0; i < c.corners.size(); ++i)
        text += fmt::format("{}[{:.9g}, {:.9g}]", i == 0 ? "corners = [" : ", ", c.corners[i].x, c.corners[i].y);
      text += "]\n";
      break;
    default:
      text += fmt::format("radius = {:.9g}\n", size.x);
  }
  return text;
}

}  // namespace arealab
