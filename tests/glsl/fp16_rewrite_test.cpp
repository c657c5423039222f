// The rewrite of shader text for half floats, and what a half float is.
#include "glsl/fp16_rewrite.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

namespace arealab::fp16_rewrite_test {
namespace {

TEST(RoundedToHalf, IsTheNearestWithTiesToEven) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  // 2^-10 is the step above 1; 1 + 2^-11 lies between two, of which 1 is even, 1 + 3·2^-11 between two, of which 1 + 2^-9 is.
  EXPECT_EQ(RoundedToHalf(1.0 + 0x1p-11), 1.0f);
  EXPECT_EQ(RoundedToHalf(1.0 + 0x1p-11 + 0x1p-30), 1.0f + 0x1p-10f);
  EXPECT_EQ(RoundedToHalf(1.0 + 3.0 * 0x1p-11), 1.0f + 0x1p-9f);
  EXPECT_EQ(RoundedToHalf(2049.0), 2048.0f);
  EXPECT_EQ(RoundedToHalf(2051.0), 2052.0f);
  EXPECT_EQ(RoundedToHalf(-3.14159265358979), -3.140625f);
  EXPECT_EQ(RoundedToHalf(65504.0), 65504.0f);
  EXPECT_EQ(RoundedToHalf(65519.99), 65504.0f);
  EXPECT_EQ(RoundedToHalf(65520.0), kInfinity);
  EXPECT_EQ(RoundedToHalf(-1e30), -kInfinity);
  EXPECT_EQ(RoundedToHalf(0x1p-14), 0x1p-14f);
  EXPECT_EQ(RoundedToHalf(0.999 * 0x1p-14), 0.0f);
  EXPECT_EQ(RoundedToHalf(1e-30), 0.0f);
  EXPECT_TRUE(std::signbit(RoundedToHalf(-1e-30)));
  EXPECT_TRUE(std::isnan(RoundedToHalf(std::nan(""))));
}

TEST(Fp16Rewrite, RoundsEveryResultByPrecedence) {
  for (const auto& [text, rewritten] : {
           std::pair{"return a + b * c;", "return fp16(a + fp16(b * c));"},
           std::pair{"x = (a - b) / -c;", "x = fp16((fp16(a - b)) / -c);"},
           std::pair{"x = a - b - c;", "x = fp16(fp16(a - b) - c);"},
           std::pair{"return -x;", "return -x;"},
           std::pair{"x += y;", "x = fp16(x + (y));"},
           std::pair{"v.xy *= a + b;", "v.xy = fp16(v.xy * (fp16(a + b)));"},
           std::pair{"float d = dot(n, v) * 2.0;", "float d = fp16(fp16_dot(n, v) * 2.0);"},
           std::pair{"float r = sqrt(max(x, 0.0));", "float r = fp16(sqrt(max(x, 0.0)));"},
           std::pair{"float s = a < b ? a * a : b;", "float s = a < b ? fp16(a * a) : b;"},
           std::pair{"if (a * b > c) return a;", "if (fp16(a * b) > c) return a;"},
           std::pair{"if (a > c) x -= 1.0; else x = y * y;", "if (a > c) x = fp16(x - (1.0)); else x = fp16(y * y);"},
           std::pair{"for (int i = 0; i < 4; ++i) s += w[2 * i + 1];", "for (int i = 0; i < 4; ++i) s = fp16(s + (w[2 * i + 1]));"},
           std::pair{"vec3 f(IN(vec3) a, float b) { return a * b; }", "vec3 f(IN(vec3) a, float b) { return fp16(a * b); }"},
           std::pair{"#define TWICE(x) (2.0 * x)  // a + b\n#if A + B\n", "#define TWICE(x) (fp16(2.0 * x))  // a + b\n#if A + B\n"},
           std::pair{"a /* b * c */ * d", "fp16(a /* b * c */ * d)"},
           std::pair{"float[2](a * b, c)[0]", "float[2](fp16(a * b), c)[0]"},
           std::pair{"f(a)(b).x++", "f(a)(b).x++"},
       }) {
    EXPECT_EQ(RewriteAsHalf(text), rewritten);
  }
}

TEST(Fp16Rewrite, LiteralsAreHalfFloats) {
  EXPECT_EQ(RewriteAsHalf("x = 3.14159265;"), "x = 3.140625;");
  EXPECT_EQ(RewriteAsHalf("x = 1e-30; y = 1e30; z = 2.f; i = 3; u = 0x7fu;"),
            "x = 0.0; y = uintBitsToFloat(0x7f800000u); z = 2.0; i = 3; u = 0x7fu;");
}

TEST(Fp16Rewrite, AComputedConstantIsNoneToTheCompiler) {
  EXPECT_EQ(RewriteAsHalf("const float kA = 0.5;\nconst float kB = 1.0 / kA;"), "const float kA = 0.5;\n float kB = fp16(1.0 / kA);");
  EXPECT_EQ(RewriteAsHalf("const int kN = 2 * kM;"), "const int kN = 2 * kM;");
  EXPECT_EQ(RewriteAsHalf("float f(const float a, const int n) { return a; }"), "float f(const float a, const int n) { return a; }");
}

// The driver's messages name the author's lines.
TEST(Fp16Rewrite, KeepsEveryLineOfTheLibrary) {
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(std::string(AREALAB_SOURCE_DIR) + "/glsl")) {
    if (entry.path().extension() != ".glsl" && entry.path().extension() != ".frag") continue;
    std::ifstream file(entry.path());
    const std::string text(std::istreambuf_iterator<char>(file), {}), rewritten = RewriteAsHalf(text);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), std::count(rewritten.begin(), rewritten.end(), '\n')) << entry.path();
    ++files;
  }
  EXPECT_GT(files, 40);
}

}  // namespace
}  // namespace arealab::fp16_rewrite_test
