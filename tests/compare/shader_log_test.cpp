// A compile error of the driver names the file and the line that the author edits, in both precisions.
#include <gmock/gmock.h>

#include <algorithm>
#include <memory>
#include <string>

#include "compare/context.h"
#include "glsl/effects.h"
#include "glsl/expand.h"
#include "glsl/program.h"
#include "scenes/error.h"
#include "tests/glsl/temporary_folder.h"

namespace arealab::shader_log_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class ShaderLog : public testing::TestWithParam<Precision> {
 protected:
  std::string ErrorOf(const std::string& name, const std::string& text) {
    const std::string path = folder_.Write(name, text);
    const ShaderLibrary library(folder_.path());
    const std::vector<Technique> techniques = LoadTechniques(library);
    const Variant variant = ParseVariant(techniques, "point");
    try {
      const Program program(context_->gl(), Expand(library, "fullscreen.vert", {}, {}, Precision::kFloat),
                            Expand(library, "lighting.frag", variant, Defines(SceneEffects(Scene{})), GetParam()));
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_THAT(message, StartsWith(path));
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      return message.substr(std::min(path.size(), message.size()));
    }
    return "compiled";
  }

  TemporaryFolder folder_;
  std::unique_ptr<Context> context_ = CreateContext(ContextKind::kOsmesa);
};

const std::string kHeader =
    "/*---\nsummary = \"s\"\ncitation = \"c\"\nauthor_note = \"n\"\nshapes = [\"rectangle\"]\n"
    "lobes = [\"diffuse\"]\nbrdfs = [\"ggx\"]\n---*/\n";

TEST_P(ShaderLog, NamesTheTechniquesLine) {
  const std::string text = kHeader +
                           "#include \"surface.glsl\"\n"                                          // line 9
                           "Radiance ShadeLight(Surface surface, Light light, vec3 to_view) {\n"  // 10
                           "  float x = no_such_name;\n"                                          // 11
                           "  return Radiance(vec3(x), vec3(0.0));\n}\n";
  const std::string error = ErrorOf("techniques/point.glsl", text);
  EXPECT_THAT(error, StartsWith(":11: error:"));
  EXPECT_THAT(error, HasSubstr("no_such_name"));
}

TEST_P(ShaderLog, NamesTheLineOfAnIncludedFile) {
  const std::string surface = ShaderLibrary().Find("surface.glsl").value();
  const auto lines = std::count(surface.begin(), surface.end(), '\n');
  EXPECT_THAT(ErrorOf("surface.glsl", surface + "\nfloat Broken() { return vec7(1.0); }\n"),
              StartsWith(":" + std::to_string(lines + 2) + ": error:"));
}

TEST_P(ShaderLog, NamesTheLineOfAPreprocessorError) {
  EXPECT_THAT(ErrorOf("techniques/point.glsl", kHeader + "\n#error by hand\n"), StartsWith(":10: "));
}

INSTANTIATE_TEST_SUITE_P(Precisions, ShaderLog, testing::Values(Precision::kFloat, Precision::kDouble));

}  // namespace
}  // namespace arealab::shader_log_test
