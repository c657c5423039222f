#include "compare/oat_claims.h"

#include <algorithm>
#include <cmath>
#include <numbers>
// clang-format off: the order matters
#include "glsl/dual_begin.h"
#include "glsl/spherical_cap.glsl"
#include "glsl/dual_end.h"
// clang-format on

namespace arealab {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

dual::Cap CapAt(double angle, double radius) {
  dual::Cap cap;
  cap.axis = {std::sin(angle), 0.0, std::cos(angle)};
  cap.versine = 2.0 * std::sin(0.5 * radius) * std::sin(0.5 * radius);
  return cap;
}

// [Tovchigrechko 2001] as the talk shows it, less 2π cos r1 for the caps' own areas; `sign` of the third term.
double ClosedForm(double r0, double r1, double d, double sign) {
  const auto angle = [](double numerator, double denominator) { return std::acos(std::clamp(numerator / denominator, -1.0, 1.0)); };
  const double c0 = std::cos(r0), c1 = std::cos(r1), cd = std::cos(d), s0 = std::sin(r0), s1 = std::sin(r1), sd = std::sin(d);
  return 2.0 * c1 * angle(-c0 + cd * c1, sd * s1) - 2.0 * c0 * angle(c1 - cd * c0, sd * s0) + sign * 2.0 * angle(-cd + c0 * c1, s0 * s1) -
         kTurn * c1;
}

}  // namespace

double CapOverlapExact(double radius0, double radius1, double distance) {
  return dual::IntersectCaps(CapAt(0.0, radius0), CapAt(distance, radius1)).area;
}

double CapOverlapSmoothstep(double radius0, double radius1, double distance) {
  const double smaller = std::min(radius0, radius1);
  return kTurn * (1.0 - std::cos(smaller)) * dual::SmoothstepOverlap(radius0, radius1, distance);
}

double CapOverlapPrinted(double radius0, double radius1, double distance) { return ClosedForm(radius0, radius1, distance, -1.0); }
double CapOverlapCorrected(double radius0, double radius1, double distance) { return ClosedForm(radius0, radius1, distance, 1.0); }

CapCurve MakeCapCurve(double radius0, double radius1, int count) {
  CapCurve curve;
  curve.radius0 = radius0;
  curve.radius1 = radius1;
  const double begin = std::abs(radius0 - radius1), end = radius0 + radius1;
  for (int i = 0; i < count; ++i) {
    const double distance = begin + (end - begin) * i / (count - 1);
    curve.distance.push_back(distance);
    curve.exact.push_back(CapOverlapExact(radius0, radius1, distance));
    curve.smoothstep.push_back(CapOverlapSmoothstep(radius0, radius1, distance));
  }
  return curve;
}

CapOverlapError MeasureCapOverlap(int steps) {
  CapOverlapError error;
  double squares = 0.0, sum = 0.0;
  for (int i = 1; i <= steps; ++i) {
    for (int j = 1; j <= i; ++j) {
      const double r0 = 0.5 * std::numbers::pi * i / steps, r1 = 0.5 * std::numbers::pi * j / steps;
      const double smaller = kTurn * (1.0 - std::cos(r1));
      for (int k = 0; k < steps; ++k) {
        const double d = (r0 - r1) + 2.0 * r1 * (k + 0.5) / steps;
        const double difference = (CapOverlapSmoothstep(r0, r1, d) - CapOverlapExact(r0, r1, d)) / smaller;
        squares += difference * difference;
        sum += difference;
        if (std::abs(difference) > std::abs(error.largest)) {
          error.largest = difference;
          error.radius0 = r0;
          error.radius1 = r1;
          error.distance = d;
        }
      }
    }
  }
  const double count = 0.5 * steps * (steps + 1.0) * steps;
  error.rms = std::sqrt(squares / count);
  error.bias = sum / count;
  return error;
}

double AveragedCentroidGain(double angle) { return std::cos(0.5 * angle) / std::cos(angle); }

}  // namespace arealab
