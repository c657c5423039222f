// glsl/fp16_math.glsl as the driver compiles it: the rounding bit by bit, the functions on cases done by hand.
#include <glad/gl.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "compare/context.h"
#include "compare/point_shader.h"
#include "glsl/expand.h"
#include "glsl/fp16_rewrite.h"
#include "glsl/program.h"
#include "glsl/technique.h"
#include "tests/glsl/temporary_folder.h"

namespace arealab::fp16_test {
namespace {

constexpr int kWidth = 256;

// The expression in x, in half floats, at the points: one pixel each.
std::vector<float> Evaluate(const GladGLContext& gl, const std::string& expression, const std::vector<float>& points) {
  const TemporaryFolder folder;
  folder.Write("probe.frag", "layout(binding = 0) uniform sampler2D points;\nlayout(location = 0) out float value;\n"
                             "float Half(float x) { return " + expression + "; }\n"
                             "void main() {\n#define texelFetchExactly texelFetch\n"
                             "  value = Half(texelFetchExactly(points, ivec2(gl_FragCoord.xy), 0).x);\n}\n");
  const ShaderLibrary library(folder.path());
  const Program program(gl, Expand(library, "fullscreen.vert", {}, {}, Precision::kFloat),
                        Expand(library, "probe.frag", {}, {}, Precision::kHalf));
  const int rows = static_cast<int>((points.size() + kWidth - 1) / kWidth);
  std::vector<float> texels = points;
  texels.resize(static_cast<std::size_t>(rows * kWidth));
  const GlObject source = MakeTexture(gl, GL_R32F, 1, {kWidth, rows}), target = MakeTexture(gl, GL_R32F, 1, {kWidth, rows});
  const GlObject framebuffer = MakeFramebuffer(gl), vertices = MakeVertexArray(gl);
  gl.TextureSubImage2D(source.id(), 0, 0, 0, kWidth, rows, GL_RED, GL_FLOAT, texels.data());
  gl.NamedFramebufferTexture(framebuffer.id(), GL_COLOR_ATTACHMENT0, target.id(), 0);
  gl.BindTextureUnit(0, source.id());
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  gl.Viewport(0, 0, kWidth, rows);
  gl.BindVertexArray(vertices.id());
  gl.UseProgram(program.id());
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  gl.UseProgram(0);
  gl.BindVertexArray(0);
  gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
  std::vector<float> values(texels.size());
  gl.GetTextureImage(target.id(), 0, GL_RED, GL_FLOAT, static_cast<GLsizei>(values.size() * sizeof(float)), values.data());
  values.resize(points.size());
  return values;
}

class Fp16 : public testing::Test {
 protected:
  static void SetUpTestSuite() { context_ = CreateContext(ContextKind::kOsmesa); }
  static void TearDownTestSuite() { context_.reset(); }
  static float Value(const std::string& expression, float x = 0.0f) { return Evaluate(context_->gl(), expression, {x})[0]; }

  inline static std::unique_ptr<Context> context_;
};

// Every half float, the middle to the next one, and the floats beside that.
TEST_F(Fp16, RoundsToNearestEvenBitByBit) {
  std::vector<float> points;
  for (std::uint32_t half = 0; half <= 0x7bff; ++half) {
    const std::uint32_t exponent = half >> 10;
    if (exponent == 0) continue;
    const std::uint32_t bits = ((exponent + 112) << 23) | ((half & 0x3ff) << 13);
    for (const std::uint32_t beside : {0x0u, 0x1u, 0xfffu, 0x1000u, 0x1001u, 0x1fffu}) {
      points.push_back(std::bit_cast<float>(bits + beside));
      points.push_back(-points.back());
    }
  }
  for (const float x : {0.0f, 1e-40f, 5.9e-8f, 6.1e-5f, 65519.9f, 65520.0f, 1e38f, std::numeric_limits<float>::infinity()}) points.push_back(x);
  const std::vector<float> values = Evaluate(context_->gl(), "fp16(x)", points);
  int wrong = 0;
  for (std::size_t i = 0; i < points.size(); ++i) wrong += values[i] != RoundedToHalf(static_cast<double>(points[i]));
  EXPECT_EQ(wrong, 0);
  EXPECT_TRUE(std::isnan(Value("fp16(x)", std::nanf(""))));
}

TEST_F(Fp16, HandCases) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(Value("x + 1.0", 2048.0f), 2048.0f);  // a tie, to even
  EXPECT_EQ(Value("x + 3.0", 2048.0f), 2052.0f);
  EXPECT_EQ(Value("x + 1.0 - x", 4096.0f), 0.0f);
  EXPECT_EQ(Value("x * x", 255.875f), 65472.0f);  // 65472.02
  EXPECT_EQ(Value("x * x", 256.0f), kInfinity);
  EXPECT_EQ(Value("x * x", 0.0078125f), 0x1p-14f);
  EXPECT_EQ(Value("x * x", 0.0077f), 0.0f);  // 5.9e-5, below 2^-14
  EXPECT_EQ(Value("1.0 / 3.0 + x"), 0.333251953125f);
  EXPECT_EQ(Value("max(x, 1e-30)"), 0.0f);  // a guard that half floats do not hold
  // The step of a sum is lost, not that of its parts: 1 + 2^-11 is 1, so the third term is 2^-11 alone.
  EXPECT_EQ(Value("dot(vec3(1.0, x, 1.0), vec3(1.0, 1.0, -1.0))", 0x1p-11f), 0.0f);
  EXPECT_EQ(Value("length(vec3(x, 0.0, 0.0))", 300.0f), kInfinity);
  EXPECT_EQ(Value("normalize(vec3(x, 0.0, 0.0)).x", 300.0f), 0.0f);
  EXPECT_EQ(Value("mix(x, 4.0, 0.25)", 2.0f), 2.5f);
  EXPECT_EQ(Value("smoothstep(0.0, 1.0, x)", 0.25f), 0.15625f);
  EXPECT_EQ(Value("cross(vec3(1.0, x, 0.0), vec3(0.0, 1.0, 0.0)).z", 0.5f), 1.0f);
  EXPECT_EQ(Value("reflect(vec3(x, -1.0, 0.0), vec3(0.0, 1.0, 0.0)).y", 1.0f), 1.0f);
  EXPECT_EQ(Value("pow(x, 3.0)", 2.0f), 8.0f);
  EXPECT_EQ(Value("exp(x)", 12.0f), kInfinity);  // 162 755
  EXPECT_EQ(Value("mod(x, 3.0)", 7.0f), 1.0f);
}

// Half floats hold a light of ordinary size and place: what a technique makes of it is right within some of their steps, 2^-11.
TEST_F(Fp16, AnOrdinaryLightIsRightWithinSomeSteps) {
  const ShaderLibrary library;
  const std::vector<Technique> techniques = LoadTechniques(library);
  PointShader shader(*context_, library);
  PointCase c;
  c.normal = {0.0, 0.0, 1.0};
  c.to_view = {0.6, 0.0, 0.8};
  c.center = {0.25, 0.5, 2.0};
  for (const char* name : {"point", "ltc", "hill"}) {
    const Variant variant = ParseVariant(techniques, name);
    PointOptions half;
    half.precision = Precision::kHalf;
    const Shaded in_float = shader.Shade(variant, std::vector{c})[0], in_half = shader.Shade(variant, std::vector{c}, half)[0];
    EXPECT_NE(in_half.diffuse, in_float.diffuse) << name;
    EXPECT_NEAR(in_half.diffuse, in_float.diffuse, 0.02 * in_float.diffuse) << name;
    EXPECT_NEAR(in_half.specular, in_float.specular, 0.02 * in_float.specular) << name;
  }
}

}  // namespace
}  // namespace arealab::fp16_test
