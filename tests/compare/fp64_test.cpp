// glsl/fp64_math.glsl as the driver compiles it, against the C library in extended precision. The same bounds
// as for the same text in C++ (tests/glsl/fp64_math_test.cpp): a driver that reorders or fuses would lose the
// pairs' low parts.
#include <glad/gl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "compare/context.h"
#include "glsl/expand.h"
#include "tests/glsl/temporary_folder.h"

namespace arealab::fp64_test {
namespace {

constexpr int kPoints = 100000;
constexpr int kGroupSize = 100;

constexpr const char* kProbe = R"(layout(local_size_x = 100) in;
layout(std430, binding = 0) readonly buffer Points { dvec2 points[]; };
layout(std430, binding = 1) writeonly buffer Values { double values[]; };
void main() {
  double x = points[gl_GlobalInvocationID.x].x;
  double y = points[gl_GlobalInvocationID.x].y;
  values[gl_GlobalInvocationID.x] = CALL;
}
)";

// Values of the GLSL expression `call` of x and y at the points.
std::vector<double> Evaluate(const GladGLContext& gl, const std::string& call,
                             const std::vector<glm::dvec2>& points) {
  const TemporaryFolder folder;
  folder.Write("fp64_probe.comp", std::string("#define CALL ") + call + "\n" + kProbe);
  const ShaderLibrary library(folder.path());
  const ExpandedSource source = Expand(library, "fp64_probe.comp", Variant{}, {}, Precision::kDouble);

  const GLuint shader = gl.CreateShader(GL_COMPUTE_SHADER);
  const char* text = source.text.c_str();
  gl.ShaderSource(shader, 1, &text, nullptr);
  gl.CompileShader(shader);
  std::string log(4096, '\0');
  gl.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  const GLuint program = gl.CreateProgram();
  gl.AttachShader(program, shader);
  gl.LinkProgram(program);
  GLint linked = GL_FALSE;
  gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
  EXPECT_EQ(linked, GL_TRUE) << source.RewriteLog(log.c_str());

  GLuint buffers[2] = {};
  gl.CreateBuffers(2, buffers);
  const auto count = static_cast<GLsizeiptr>(points.size());
  gl.NamedBufferData(buffers[0], count * GLsizeiptr{sizeof(glm::dvec2)}, points.data(), GL_STATIC_DRAW);
  gl.NamedBufferData(buffers[1], count * GLsizeiptr{sizeof(double)}, nullptr, GL_STATIC_READ);
  gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffers[0]);
  gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, buffers[1]);
  gl.UseProgram(program);
  gl.DispatchCompute(static_cast<GLuint>(points.size()) / kGroupSize, 1, 1);
  gl.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  std::vector<double> values(points.size());
  gl.GetNamedBufferSubData(buffers[1], 0, count * GLsizeiptr{sizeof(double)}, values.data());

  gl.UseProgram(0);
  gl.DeleteBuffers(2, buffers);
  gl.DeleteProgram(program);
  gl.DeleteShader(shader);
  return values;
}

// |got - want| in units of the last place of a double of want's size.
double UlpError(double got, long double want) {
  int exponent = 0;
  std::frexp(static_cast<double>(want), &exponent);
  return static_cast<double>(std::fabs(got - want) / std::ldexp(1.0L, std::max(exponent, -1021) - 53));
}

// Points 0 … 1 of a low-discrepancy sequence in two dimensions (the plastic number's powers).
glm::dvec2 Spread(int i) {
  return {std::fmod(0.5 + i * 0.7548776662466927, 1.0), std::fmod(0.5 + i * 0.5698402909980532, 1.0)};
}

struct Function {
  const char* call;
  glm::dvec2 low, high;  // of x and y
  std::function<long double(long double, long double)> exact;
  double max_ulp;  // the bound of the same text in C++
};

void PrintTo(const Function& function, std::ostream* out) {
  *out << function.call;
}

class Fp64OnTheDriver : public testing::TestWithParam<Function> {};

using L = long double;

TEST_P(Fp64OnTheDriver, IsWithinTheUlpsOfTheSameTextInCpp) {
  const Function& function = GetParam();
  std::vector<glm::dvec2> points;
  for (int i = 0; i < kPoints; ++i)
    points.push_back(function.low + (function.high - function.low) * Spread(i));
  const auto context = CreateContext(ContextKind::kOsmesa);
  const std::vector<double> values = Evaluate(context->gl(), function.call, points);
  double worst = 0.0;
  int not_finite = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(values[i])) ++not_finite;
    worst = std::max(worst, UlpError(values[i], function.exact(points[i].x, points[i].y)));
  }
  EXPECT_EQ(not_finite, 0);
  EXPECT_LE(worst, function.max_ulp);
}

INSTANTIATE_TEST_SUITE_P(
    AllFunctions, Fp64OnTheDriver,
    testing::Values(
        Function{"fp64_exp(x)", {-700, 0}, {700, 0}, [](L x, L) { return std::exp(x); }, 1.0},
        Function{"fp64_exp2(x)", {-1000, 0}, {1000, 0}, [](L x, L) { return std::exp2(x); }, 1.0},
        Function{"fp64_log(x)", {1e-3, 0}, {10, 0}, [](L x, L) { return std::log(x); }, 1.0},
        Function{"fp64_log2(x)", {1e-3, 0}, {10, 0}, [](L x, L) { return std::log2(x); }, 1.0},
        Function{"fp64_pow(x, y)", {1e-3, -90}, {10, 90}, [](L x, L y) { return std::pow(x, y); }, 1.0},
        Function{"fp64_sin(x)", {-1e6, 0}, {1e6, 0}, [](L x, L) { return std::sin(x); }, 1.0},
        Function{"fp64_cos(x)", {-4, 0}, {4, 0}, [](L x, L) { return std::cos(x); }, 1.0},
        Function{"fp64_tan(x)", {-4, 0}, {4, 0}, [](L x, L) { return std::tan(x); }, 2.5},
        Function{"fp64_asin(x)", {-1, 0}, {1, 0}, [](L x, L) { return std::asin(x); }, 2.5},
        Function{"fp64_acos(x)", {-1, 0}, {1, 0}, [](L x, L) { return std::acos(x); }, 3.0},
        Function{"fp64_atan(x)", {-9, 0}, {9, 0}, [](L x, L) { return std::atan(x); }, 1.5},
        Function{"fp64_atan(y, x)", {-2, -2}, {2, 2}, [](L x, L y) { return std::atan2(y, x); }, 2.0},
        Function{"fp64_sinh(x)", {-5, 0}, {5, 0}, [](L x, L) { return std::sinh(x); }, 2.5},
        Function{"fp64_cosh(x)", {-5, 0}, {5, 0}, [](L x, L) { return std::cosh(x); }, 2.5},
        Function{"fp64_tanh(x)", {-5, 0}, {5, 0}, [](L x, L) { return std::tanh(x); }, 3.0}));

TEST(Fp64SpecialValues, SurviveTheDriver) {
  const auto context = CreateContext(ContextKind::kOsmesa);
  const std::vector<glm::dvec2> points(kGroupSize, glm::dvec2(-1.0, 2.0));
  const auto value = [&](const std::string& call) { return Evaluate(context->gl(), call, points)[0]; };
  EXPECT_TRUE(std::isnan(value("fp64_log(x)")));
  EXPECT_TRUE(std::isnan(value("fp64_acos(y)")));
  EXPECT_TRUE(std::isnan(value("fp64_exp(sqrt(x))")));
  EXPECT_EQ(value("fp64_log(x + 1.0lf)"), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(value("fp64_exp(1000.0lf * y)"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(value("fp64_pow(dvec3(y), dvec3(1.0lf, 2.0lf, 3.0lf)).z"), 8.0);
}

}  // namespace
}  // namespace arealab::fp64_test
