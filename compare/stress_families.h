// Hard cases for a shading technique: families of configurations at which a careless formula divides 0 by 0,
// overflows, cancels or steps; each a seeded generator.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "compare/point_shader.h"

namespace arealab {

class CaseRandom {
 public:
  explicit CaseRandom(std::uint64_t seed) : engine_(seed) {}
  double operator()(double from, double to) { return from + (to - from) * uniform_(engine_); }
  double Log(double from, double to);     // even in the logarithm
  double Signed(double from, double to);  // ± Log
  bool Chance(double probability) { return uniform_(engine_) < probability; }
  glm::dvec3 Direction();                         // unit, even over the sphere
  glm::dvec3 Perpendicular(const glm::dvec3& v);  // unit

 private:
  std::mt19937_64 engine_;
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
};

struct StressFamily {
  const char* name;      // "contact"
  const char* sentence;  // what its cases are
  // Whether the last bit of an input moves the answer by more than the bounds of a rounding error allow.
  // There the error is held against what such bits do, not against the answer.
  bool ill_conditioned;
  std::vector<LightShape> shapes;
  PointCase (*make)(CaseRandom& random, LightShape shape);
};

// In the order of the report; the first is what a scene ordinarily has.
const std::vector<StressFamily>& StressFamilies();

// The first `count` cases of a family, as floats; the same for the same seed, and the first of more.
std::vector<PointCase> MakeCases(const StressFamily& family, LightShape shape, int count, std::uint64_t seed);

// A way through a hard place: what a frame sees while something moves. t runs from 0 to 1.
struct StressPath {
  const char* name;      // "sinking"
  const char* sentence;  // what moves
  std::vector<LightShape> shapes;
  PointCase (*make)(double t, LightShape shape);
};
const std::vector<StressPath>& StressPaths();

// A case as one line, "shape=disk position=0,0,0 … radiance=1", every number in the digits that tell floats
// apart, and back. Throws InputError on what is not such a line; what is left out has the value of a
// PointCase.
std::string CaseLine(const PointCase& c);
PointCase ParseCase(std::string_view line);

// A scene whose picture's middle is the case, in the scene language; `about` heads it. A scene's normals are
// unit and its lights have an area and a radiance above 0: what the language cannot say is said in a comment.
std::string CaseScene(const PointCase& c, const std::string& about);

}  // namespace arealab
