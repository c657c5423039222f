// glsl/fp64_math.glsl, compiled as C++, against the C library in extended precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <limits>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wliteral-suffix"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wshadow"

namespace arealab::fp64_math_test {
namespace {
namespace shader {

using glm::abs, glm::floor, glm::isnan, glm::packDouble2x32, glm::sqrt, glm::unpackDouble2x32;
using glm::dvec2, glm::dvec3, glm::dvec4, glm::uvec2;
using uint = unsigned int;

constexpr double operator"" lf(long double value) {
  return static_cast<double>(value);
}

#define precise
#define OUT(type) type&
#include "glsl/fp64_math.glsl"
#undef OUT
#undef precise

}  // namespace shader

#pragma GCC diagnostic pop

// |got - want| in units of the last place of a double of want's size.
double UlpError(double got, long double want) {
  int exponent = 0;
  std::frexp(static_cast<double>(want), &exponent);
  const long double ulp = std::ldexp(1.0L, std::max(exponent, -1021) - 53);
  return static_cast<double>(std::fabs(got - want) / ulp);
}

// Points 0 … 1 of a low-discrepancy sequence (golden ratio), so that no grid hides a bad spot.
double Spread(int i) {
  return std::fmod(0.5 + i * 0.6180339887498949, 1.0);
}

constexpr int kPoints = 100000;

double WorstError(double low, double high, const std::function<double(double)>& function,
                  const std::function<long double(long double)>& exact) {
  double worst = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double x = low + (high - low) * Spread(i);
    worst = std::max(worst, UlpError(function(x), exact(x)));
  }
  return worst;
}

// max_ulp is the measured worst case, rounded up to the next half.
struct Case {
  const char* name;
  double low, high;
  std::function<double(double)> function;
  std::function<long double(long double)> exact;
  double max_ulp;
};

#define AREALAB_CASE(name, low, high, max_ulp)                                                               \
  Case {                                                                                                     \
#name, low, high,                                                                                        \
        [](double x) { return shader::fp64_##name(x); }, [](long double x) { return std::name(x); }, max_ulp \
  }

TEST(Fp64Math, FunctionsOfOneArgumentAreWithinTheirUlps) {
  const Case cases[] = {
      AREALAB_CASE(exp, -1.0, 1.0, 1.0),      AREALAB_CASE(exp, -700.0, 700.0, 1.0),
      AREALAB_CASE(exp2, -2.0, 2.0, 1.0),     AREALAB_CASE(exp2, -1000.0, 1000.0, 1.0),
      AREALAB_CASE(log, 0.5, 2.0, 1.0),       AREALAB_CASE(log, 1e-300, 1.0, 1.0),
      AREALAB_CASE(log, 1.0, 1e300, 1.0),     AREALAB_CASE(log2, 0.5, 2.0, 1.0),
      AREALAB_CASE(log2, 1.0, 1e6, 1.0),      AREALAB_CASE(sin, -4.0, 4.0, 1.0),
      AREALAB_CASE(sin, -1e6, 1e6, 1.0),      AREALAB_CASE(cos, -4.0, 4.0, 1.0),
      AREALAB_CASE(cos, -1e6, 1e6, 1.0),      AREALAB_CASE(tan, -4.0, 4.0, 2.5),
      AREALAB_CASE(asin, -1.0, 1.0, 2.5),     AREALAB_CASE(acos, -1.0, 1.0, 3.0),
      AREALAB_CASE(acos, 0.999, 1.0, 2.5),    AREALAB_CASE(atan, -1.0, 1.0, 2.0),
      AREALAB_CASE(atan, -1e3, 1e3, 1.5),     AREALAB_CASE(sinh, -1.5, 1.5, 2.0),
      AREALAB_CASE(sinh, -700.0, 700.0, 2.5), AREALAB_CASE(cosh, -2.0, 2.0, 2.0),
      AREALAB_CASE(cosh, -700.0, 700.0, 2.5), AREALAB_CASE(tanh, -1.0, 1.0, 3.0),
      AREALAB_CASE(tanh, -30.0, 30.0, 2.0),
  };
  for (const Case& c : cases) {
    const double worst = WorstError(c.low, c.high, c.function, c.exact);
    EXPECT_LE(worst, c.max_ulp) << c.name << " on [" << c.low << ", " << c.high << "]";
  }
}

TEST(Fp64Math, PowIsWithinItsUlps) {
  double worst = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double x = std::exp(20.0 * Spread(i) - 10.0);
    const double y = 120.0 * (Spread(7 * i + 3) - 0.5);
    worst = std::max(worst, UlpError(shader::fp64_pow(x, y),
                                     std::pow(static_cast<long double>(x), static_cast<long double>(y))));
  }
  EXPECT_LE(worst, 1.0);
}

TEST(Fp64Math, AtanOfTwoArgumentsIsWithinItsUlps) {
  double worst = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double y = 4.0 * Spread(i) - 2.0;
    const double x = 4.0 * Spread(5 * i + 1) - 2.0;
    worst = std::max(worst, UlpError(shader::fp64_atan(y, x),
                                     std::atan2(static_cast<long double>(y), static_cast<long double>(x))));
  }
  EXPECT_LE(worst, 2.0);
}

TEST(Fp64Math, SmallArgumentsKeepTheirDigits) {
  for (double x = 1e-1; x > 1e-200; x *= 0.013) {
    EXPECT_LE(UlpError(shader::fp64_sin(x), std::sin(static_cast<long double>(x))), 1.0) << x;
    EXPECT_LE(UlpError(shader::fp64_tan(x), std::tan(static_cast<long double>(x))), 2.5) << x;
    EXPECT_LE(UlpError(shader::fp64_asin(x), std::asin(static_cast<long double>(x))), 2.0) << x;
    EXPECT_LE(UlpError(shader::fp64_atan(x), std::atan(static_cast<long double>(x))), 1.0) << x;
    EXPECT_LE(UlpError(shader::fp64_sinh(x), std::sinh(static_cast<long double>(x))), 1.0) << x;
    EXPECT_LE(UlpError(shader::fp64_tanh(x), std::tanh(static_cast<long double>(x))), 2.5) << x;
    EXPECT_LE(UlpError(shader::fp64_log(x), std::log(static_cast<long double>(x))), 1.0) << x;
    EXPECT_LE(UlpError(shader::fp64_log(1.0 + x), std::log(static_cast<long double>(1.0 + x))), 1.0) << x;
  }
}

// Near a multiple of π/2 the reduction decides every digit.
TEST(Fp64Math, ZerosOfSineAndCosineKeepTheirDigits) {
  for (int k = 1; k < 1000; ++k) {
    const double x = k * 1.5707963267948966;
    const long double wide = x;
    const double near_zero = k % 2 == 0 ? shader::fp64_sin(x) : shader::fp64_cos(x);
    EXPECT_LE(UlpError(near_zero, k % 2 == 0 ? std::sin(wide) : std::cos(wide)), 1.0) << k;
  }
}

TEST(Fp64Math, SpecialValues) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double not_a_number = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(shader::fp64_exp(0.0), 1.0);
  EXPECT_EQ(shader::fp64_exp(1000.0), infinity);
  EXPECT_EQ(shader::fp64_exp(-1000.0), 0.0);
  EXPECT_TRUE(std::isnan(shader::fp64_exp(not_a_number)));
  EXPECT_EQ(shader::fp64_exp2(10.0), 1024.0);
  EXPECT_EQ(shader::fp64_exp2(-1074.0), std::numeric_limits<double>::denorm_min());
  EXPECT_TRUE(std::isnan(shader::fp64_exp2(not_a_number)));
  EXPECT_EQ(shader::fp64_log(1.0), 0.0);
  EXPECT_EQ(shader::fp64_log(0.0), -infinity);
  EXPECT_EQ(shader::fp64_log(infinity), infinity);
  EXPECT_TRUE(std::isnan(shader::fp64_log(-1.0)));
  EXPECT_TRUE(std::isnan(shader::fp64_log(not_a_number)));
  EXPECT_EQ(shader::fp64_log2(8.0), 3.0);
  EXPECT_EQ(shader::fp64_log2(std::numeric_limits<double>::denorm_min()), -1074.0);
  EXPECT_EQ(shader::fp64_pow(0.0, 5.0), 0.0);
  EXPECT_EQ(shader::fp64_pow(3.0, 0.0), 1.0);
  EXPECT_EQ(shader::fp64_pow(2.0, 10.0), 1024.0);
  EXPECT_EQ(shader::fp64_pow(0.0, -1.0), infinity);
  EXPECT_EQ(shader::fp64_pow(infinity, -1.0), 0.0);
  EXPECT_TRUE(std::isnan(shader::fp64_pow(-2.0, 2.0)));
  EXPECT_EQ(shader::fp64_acos(1.0), 0.0);
  EXPECT_EQ(shader::fp64_acos(-1.0), std::acos(-1.0));
  EXPECT_TRUE(std::isnan(shader::fp64_acos(1.5)));
  EXPECT_EQ(shader::fp64_asin(1.0), std::asin(1.0));
  EXPECT_EQ(shader::fp64_atan(0.0, 0.0), 0.0);
  EXPECT_EQ(shader::fp64_atan(1.0, 0.0), std::atan2(1.0, 0.0));
  EXPECT_EQ(shader::fp64_atan(infinity), std::atan(infinity));
  EXPECT_TRUE(std::isnan(shader::fp64_atan(not_a_number)));
  EXPECT_EQ(shader::fp64_tanh(800.0), 1.0);
  EXPECT_EQ(shader::fp64_tanh(-800.0), -1.0);
}

TEST(Fp64Math, VectorsGoByComponent) {
  const glm::dvec3 x(0.1, 0.7, 2.0);
  const glm::dvec3 power = shader::fp64_pow(x, glm::dvec3(2.0, 3.0, -1.0));
  EXPECT_EQ(power.y, shader::fp64_pow(0.7, 3.0));
  EXPECT_EQ(power.z, shader::fp64_pow(2.0, -1.0));
  EXPECT_EQ(shader::fp64_exp(x).z, shader::fp64_exp(2.0));
}

}  // namespace
}  // namespace arealab::fp64_math_test
