#include "glsl/expand.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "glsl/fp64_rewrite.h"
#include "scenes/error.h"
#include "tests/glsl/temporary_folder.h"

namespace arealab::expand_test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// A small library of its own: technique "toy" with option "clip" in files and "way" by define.
class Expansion : public testing::Test {
 protected:
  Expansion() {
    technique_.name = "toy";
    technique_.options = {{"clip", "", {{"arc", ""}, {"none", ""}}}, {"way", "", {{"up", ""}, {"down", ""}}}};
    technique_.knobs = {{"gain", "Gain", "", 1.0, 0.0, 2.0}};
    technique_.tables = {{"lobe", "lobe.exr"}};
    variant_ = DefaultVariant(technique_);
    folder_.Write("test.frag", "#include \"technique\"\nvoid main() {}\n");
    folder_.Write("techniques/toy.glsl", "/*---\n---*/\n#include \"clip\"\nfloat Shade() { return 0.5; }\n");
    folder_.Write("clip/arc.glsl", "float Arc() { return 1.0; }\n");
    folder_.Write("clip/none.glsl", "float None() { return 1.0; }\n");
    folder_.Write("platform_float.glsl", "float in_float;\n");
    folder_.Write("platform_double.glsl", "float still_float = 1.0;\n");
  }

  ExpandedSource Run(Precision precision = Precision::kFloat) const {
    return Expand(ShaderLibrary(folder_.path()), "test.frag", variant_,
                  {{"EFFECT_DISK", 0}, {"EFFECT_SPHERE", 1}}, precision);
  }

  std::string ErrorOfRun() const {
    try {
      Run();
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  std::string Path(const std::string& name) const { return (folder_.path() / name).generic_string(); }

  // The 1-based line of the text that holds `what`.
  static std::size_t LineOf(const ExpandedSource& source, const std::string& what) {
    const auto at = source.text.find(what);
    EXPECT_NE(at, std::string::npos) << what << " in\n" << source.text;
    return static_cast<std::size_t>(
               std::count(source.text.begin(), source.text.begin() + static_cast<std::ptrdiff_t>(at), '\n')) +
           1;
  }

  TemporaryFolder folder_;
  Technique technique_;
  Variant variant_;
};

TEST_F(Expansion, TheHostsPrologueHeadsTheText) {
  const std::string text = Run().text;
  EXPECT_THAT(text, StartsWith("#version 450 core\n"));
  for (const char* line :
       {"#define AREALAB_FLOAT 1\n", "#define AREALAB_DOUBLE 0\n", "#define AREALAB_DUAL 0\n",
        "#define EFFECT_DISK 0\n", "#define EFFECT_SPHERE 1\n", "#define CLIP_ARC 1\n",
        "#define CLIP_NONE 0\n", "#define WAY_UP 1\n", "#define WAY_DOWN 0\n", "uniform float knob_gain;\n",
        "uniform sampler2D table_lobe;\n", "#define OUT(type) out type\n", "#define INOUT(type) inout type\n",
        "#define IN(type) in type\n", "#define assert(condition)\n"}) {
    EXPECT_THAT(text, HasSubstr(line));
  }
}

TEST_F(Expansion, EachLineKnowsItsOrigin) {
  const ExpandedSource source = Run();
  EXPECT_EQ(source.origins.size(),
            static_cast<std::size_t>(std::count(source.text.begin(), source.text.end(), '\n')));
  const auto origin = [&](const std::string& what) { return source.origins.at(LineOf(source, what) - 1); };
  EXPECT_EQ(origin("float Shade()").file, Path("techniques/toy.glsl"));
  EXPECT_EQ(origin("float Shade()").line, 4);
  EXPECT_EQ(origin("float Arc()").file, Path("clip/arc.glsl"));
  EXPECT_EQ(origin("float Arc()").line, 1);
  EXPECT_EQ(origin("void main()").file, Path("test.frag"));
  EXPECT_EQ(origin("void main()").line, 2);
}

TEST_F(Expansion, AnOptionsIncludeIsTheChosenFile) {
  variant_.options["clip"] = "none";
  const std::string text = Run().text;
  EXPECT_THAT(text, HasSubstr("float None()"));
  EXPECT_THAT(text, Not(HasSubstr("float Arc()")));
  EXPECT_THAT(text, HasSubstr("#define CLIP_NONE 1\n"));
}

TEST_F(Expansion, FilesAreIncludedOnceAndPragmaOnceIsDropped) {
  folder_.Write("shared.glsl", "#pragma once\n  # pragma  once\nfloat Shared() { return 1.0; }\n");
  folder_.Write(
      "test.frag",
      "#include \"shared.glsl\"\n  #  include \"shared.glsl\" // again\n#pragma STDGL invariant(all)\n");
  const std::string text = Run().text;
  EXPECT_EQ(text.find("float Shared()"), text.rfind("float Shared()"));
  EXPECT_THAT(text, Not(HasSubstr("pragma once")));
  EXPECT_THAT(text, HasSubstr("#pragma STDGL invariant(all)"));
  EXPECT_THAT(text, Not(HasSubstr("include")));
}

TEST_F(Expansion, IncludesInCommentsAreNone) {
  folder_.Write("test.frag",
                "/* first\n#include \"nothing.glsl\"\n*/\n// #include \"nothing.glsl\"\n/* a */ /* "
                "b\n#include \"nothing\"*/\n// /*\n#include \"clip\"\n");
  EXPECT_THAT(Run().text, HasSubstr("float Arc()"));
}

TEST_F(Expansion, AFileWithoutALastNewlineKeepsToItsLine) {
  folder_.Write("clip/arc.glsl", "float Arc() { return 1.0; }");
  EXPECT_THAT(Run().text, HasSubstr("float Arc() { return 1.0; }\nfloat Shade()"));
}

TEST_F(Expansion, UnknownIncludesAreRefusedWithFileAndLine) {
  folder_.Write("test.frag", "\n#include \"nothing.glsl\"\n");
  EXPECT_EQ(ErrorOfRun(),
            Path("test.frag") +
                ":2: unknown include \"nothing.glsl\"; expected a file under glsl/ or \"platform\", "
                "\"brdf\", \"diffuse\", \"technique\", \"clip\", \"way\"");
  folder_.Write("test.frag", "#include \"way\"\n");
  EXPECT_THAT(ErrorOfRun(),
              StartsWith(Path("test.frag") + ":1: unknown include \"way\" (glsl/way/up.glsl); expected"));
}

TEST_F(Expansion, MalformedDirectivesAreRefused) {
  for (const char* line :
       {"#include <clip>", "#include clip", "#include \"\"", "#include \"clip", "#include"}) {
    folder_.Write("test.frag", std::string("\n\n") + line + "\n");
    EXPECT_EQ(ErrorOfRun(), Path("test.frag") + ":3: malformed include; expected #include \"NAME\"") << line;
  }
  folder_.Write("test.frag", "#version 330\n");
  EXPECT_EQ(ErrorOfRun(), Path("test.frag") + ":1: #version; expected none, the host writes it");
}

TEST_F(Expansion, CyclesAreRefusedWithTheirChain) {
  folder_.Write("test.frag", "#include \"a.glsl\"\n");
  folder_.Write("a.glsl", "\n#include \"b.glsl\"\n");
  folder_.Write("b.glsl", "\n\n#include \"a.glsl\"\n");
  EXPECT_EQ(ErrorOfRun(),
            Path("b.glsl") + ":3: includes go in a circle: a.glsl -> b.glsl -> a.glsl; expected none");
  folder_.Write("a.glsl", "#include \"a.glsl\"\n");
  EXPECT_EQ(ErrorOfRun(), Path("a.glsl") + ":1: includes go in a circle: a.glsl -> a.glsl; expected none");
}

TEST_F(Expansion, AMissingMainFileIsRefused) {
  EXPECT_THROW(Expand(ShaderLibrary(folder_.path()), "nothing.frag", variant_, {}, Precision::kFloat),
               InputError);
}

TEST_F(Expansion, WithoutATechniqueOnlyFilesResolve) {
  folder_.Write("test.frag", "#include \"platform\"\nvoid main() {}\n");
  variant_ = {};
  EXPECT_THAT(Run().text, HasSubstr("float in_float;"));
  folder_.Write("test.frag", "#include \"technique\"\n");
  EXPECT_THAT(ErrorOfRun(), HasSubstr("unknown include \"technique\""));
}

TEST_F(Expansion, DoubleRewritesAllButThePlatform) {
  folder_.Write("test.frag", "#include \"platform\"\n#include \"technique\"\nvoid main() {}\n");
  const ExpandedSource source = Run(Precision::kDouble);
  EXPECT_THAT(source.text, HasSubstr("#define AREALAB_FLOAT 0\n#define AREALAB_DOUBLE 1\n"));
  EXPECT_THAT(source.text, HasSubstr("float still_float = 1.0;\n"));
  EXPECT_THAT(source.text, HasSubstr("double Shade() { return 0.5lf; }\n"));
  EXPECT_THAT(source.text, HasSubstr("uniform float knob_gain;\n"));
  EXPECT_THAT(source.text, HasSubstr("double fp64_acos(double x)"));
  EXPECT_EQ(source.origins.at(LineOf(source, "double Shade()") - 1).line, 4);
}

TEST_F(Expansion, LogsNameTheAuthorsLine) {
  const ExpandedSource source = Run();
  const std::string line = std::to_string(LineOf(source, "float Shade()"));
  const std::string place = Path("techniques/toy.glsl") + ":4: ";
  // Mesa, NVIDIA, glslang and AMD, Apple's and Intel's with a column.
  EXPECT_EQ(source.RewriteLog("0:" + line + "(5): error: `x' undeclared\n"),
            place + "error: `x' undeclared\n");
  EXPECT_EQ(source.RewriteLog("0(" + line + ") : error C1008: undefined variable \"x\""),
            place + "error C1008: undefined variable \"x\"");
  EXPECT_EQ(source.RewriteLog("ERROR: 0:" + line + ": 'x' : undeclared identifier"),
            place + "error: 'x' : undeclared identifier");
  EXPECT_EQ(source.RewriteLog("WARNING: 0:" + line + ": 'x' : unused"), place + "warning: 'x' : unused");
  EXPECT_EQ(source.RewriteLog("error: 0:" + line + "(1): preprocessor"), "error: " + place + "preprocessor");
}

TEST_F(Expansion, LogsAreLeftAloneWhereTheyNameNoLine) {
  const ExpandedSource source = Run();
  const std::string log =
      "error: 10:2 ratio, 1.0:3, 0:0, 0:999999, 0:99999999999999999999, 0(x)\n\nno place\n";
  EXPECT_EQ(source.RewriteLog(log), log);
  EXPECT_EQ(source.RewriteLog(""), "");
  EXPECT_EQ(source.RewriteLog("0"), "0");
}

TEST_F(Expansion, SeveralLogLinesAreEachRewritten) {
  const ExpandedSource source = Run();
  const std::string shade = std::to_string(LineOf(source, "float Shade()"));
  const std::string main = std::to_string(LineOf(source, "void main()"));
  EXPECT_EQ(source.RewriteLog("0:" + shade + "(1): error: one\n0:" + main + "(2): error: two\n"),
            Path("techniques/toy.glsl") + ":4: error: one\n" + Path("test.frag") + ":2: error: two\n");
}

struct Rewrite {
  const char* from;
  const char* to;
};

class RewriteAsDoubleTest : public testing::TestWithParam<Rewrite> {};

void PrintTo(const Rewrite& rewrite, std::ostream* out) {
  *out << rewrite.from;
}

TEST_P(RewriteAsDoubleTest, Rewrites) {
  EXPECT_EQ(RewriteAsDouble(GetParam().from), GetParam().to);
}

INSTANTIATE_TEST_SUITE_P(
    Types, RewriteAsDoubleTest,
    testing::Values(Rewrite{"float x;", "double x;"},
                    Rewrite{"vec2 a; vec3 b; vec4 c;", "dvec2 a; dvec3 b; dvec4 c;"},
                    Rewrite{"mat3 m; mat4x3 n; mat2x4(1)", "dmat3 m; dmat4x3 n; dmat2x4(1)"},
                    Rewrite{"float[2](a, b)", "double[2](a, b)"}, Rewrite{"OUT(vec3) n", "OUT(dvec3) n"},
                    Rewrite{"ivec3 uvec2 bvec4 dvec3 double sampler2D",
                            "ivec3 uvec2 bvec4 dvec3 double sampler2D"},
                    Rewrite{"vec5 mat3x vec22 mat1 vector floaty my_float afloat",
                            "vec5 mat3x vec22 mat1 vector floaty my_float afloat"}));

INSTANTIATE_TEST_SUITE_P(
    Literals, RewriteAsDoubleTest,
    testing::Values(Rewrite{"1.0", "1.0lf"}, Rewrite{"1.", "1.lf"}, Rewrite{".5", ".5lf"},
                    Rewrite{"1e-4", "1e-4lf"}, Rewrite{"2.5E+3", "2.5E+3lf"}, Rewrite{"1.0f", "1.0lf"},
                    Rewrite{"1.0F", "1.0lf"}, Rewrite{"1.0lf", "1.0lf"}, Rewrite{"1.0LF", "1.0lf"},
                    Rewrite{"3", "3"}, Rewrite{"3u", "3u"}, Rewrite{"0x1e5", "0x1e5"},
                    Rewrite{"0xfFu", "0xfFu"}, Rewrite{"1e-4-2", "1e-4lf-2"}, Rewrite{"x-1.0+y", "x-1.0lf+y"},
                    Rewrite{"a[1].x", "a[1].x"}, Rewrite{"v.x*2.0", "v.x*2.0lf"}, Rewrite{"p1.x2", "p1.x2"},
                    Rewrite{"vec3(1.0, 2, .5)", "dvec3(1.0lf, 2, .5lf)"}));

INSTANTIATE_TEST_SUITE_P(
    Calls, RewriteAsDoubleTest,
    testing::Values(Rewrite{"acos(x)", "fp64_acos(x)"}, Rewrite{"atan (y, x)", "fp64_atan (y, x)"},
                    Rewrite{"pow(exp2(x), log(y))", "fp64_pow(fp64_exp2(x), fp64_log(y))"},
                    Rewrite{"float exp = 1.0;", "double exp = 1.0lf;"}, Rewrite{"lobe.exp(x)", "lobe.exp(x)"},
                    Rewrite{"sqrt(x) inversesqrt(x) mix(a, b, t) dot(a, b)",
                            "sqrt(x) inversesqrt(x) mix(a, b, t) dot(a, b)"},
                    Rewrite{"MyAcos(x) acosine(x)", "MyAcos(x) acosine(x)"}));

INSTANTIATE_TEST_SUITE_P(
    Surroundings, RewriteAsDoubleTest,
    testing::Values(
        Rewrite{"// float 1.0\nfloat", "// float 1.0\ndouble"},
        Rewrite{"/* float\n1.0 */ 1.0", "/* float\n1.0 */ 1.0lf"}, Rewrite{"/* open float", "/* open float"},
        Rewrite{"x / y // vec3", "x / y // vec3"}, Rewrite{"#if A > 1.0\n1.0", "#if A > 1.0\n1.0lf"},
        Rewrite{"#if A \\\n  == 1.0\n1.0", "#if A \\\n  == 1.0\n1.0lf"},
        Rewrite{"#define K 1.5\n", "#define K 1.5lf\n"},
        Rewrite{"  # define F(x) (acos(x) * vec3(0.5))\n", "  # define F(x) (fp64_acos(x) * dvec3(0.5lf))\n"},
        Rewrite{"#define K \\\n  1.5\n2.0", "#define K \\\n  1.5lf\n2.0lf"},
        Rewrite{"#define vec3 vec4\n", "#define vec3 dvec4\n"}, Rewrite{"#define\n1.0", "#define\n1.0lf"},
        Rewrite{"#endif\nfloat", "#endif\ndouble"}, Rewrite{"", ""}, Rewrite{"1.0", "1.0lf"}));

}  // namespace
}  // namespace arealab::expand_test
