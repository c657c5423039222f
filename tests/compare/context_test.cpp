#include "compare/context.h"

#include <glad/gl.h>
#include <gmock/gmock.h>

#include <array>
#include <cstdlib>

#include "scenes/error.h"

namespace arealab::context_test {
namespace {

using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// Clears a 1×1 float texture to `value` in the current context and reads it back: one round trip through the
// driver.
float RoundTrip(const Context& context, float value) {
  const GladGLContext& gl = context.gl();
  GLuint texture = 0;
  gl.CreateTextures(GL_TEXTURE_2D, 1, &texture);
  gl.TextureStorage2D(texture, 1, GL_RGBA32F, 1, 1);
  const std::array<float, 4> in{value, value, value, value};
  gl.ClearTexImage(texture, 0, GL_RGBA, GL_FLOAT, in.data());
  std::array<float, 4> out{};
  gl.GetTextureImage(texture, 0, GL_RGBA, GL_FLOAT, sizeof(out), out.data());
  gl.DeleteTextures(1, &texture);
  EXPECT_EQ(gl.GetError(), static_cast<GLenum>(GL_NO_ERROR));
  return out[2];
}

std::string ErrorOf(std::optional<ContextKind> kind, const ContextLibraries& libraries) {
  try {
    CreateContext(kind, libraries);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

class EachKind : public testing::TestWithParam<ContextKind> {};

TEST_P(EachKind, WorksAlone) {
  const auto context = CreateContext(GetParam());
  EXPECT_EQ(context->kind(), GetParam());
  EXPECT_FALSE(context->renderer().empty());
  EXPECT_THAT(context->version(), StartsWith("4."));
  EXPECT_EQ(RoundTrip(*context, 0.25f), 0.25f);
}

TEST_P(EachKind, CanBeMadeAgainAfterItsEnd) {
  for (int i = 0; i < 3; ++i) {
    const auto context = CreateContext(GetParam());
    EXPECT_EQ(RoundTrip(*context, static_cast<float>(i)), static_cast<float>(i));
  }
}

TEST_P(EachKind, TwoOfAKindLiveTogetherAndOneOutlivesTheOther) {
  const auto first = CreateContext(GetParam());
  {
    const auto second = CreateContext(GetParam());
    EXPECT_EQ(RoundTrip(*second, 2.0f), 2.0f);
    first->MakeCurrent();
    EXPECT_EQ(RoundTrip(*first, 1.0f), 1.0f);
    second->MakeCurrent();
  }
  first->MakeCurrent();
  EXPECT_EQ(RoundTrip(*first, 3.0f), 3.0f);
}

TEST_P(EachKind, IsReleasedAndTakenUpAgain) {
  const auto context = CreateContext(GetParam());
  context->Release();
  context->Release();
  context->MakeCurrent();
  EXPECT_EQ(RoundTrip(*context, 5.0f), 5.0f);
}

INSTANTIATE_TEST_SUITE_P(Context, EachKind, testing::Values(ContextKind::kOsmesa, ContextKind::kEgl),
                         [](const auto& kind) { return kind.param == ContextKind::kEgl ? "Egl" : "Osmesa"; });

TEST(Context, OsmesaAndEglAlternateInOneProcess) {
  const auto osmesa = CreateContext(ContextKind::kOsmesa);
  const auto egl = CreateContext(ContextKind::kEgl);
  EXPECT_EQ(osmesa->platform(), "OSMesa");
  EXPECT_THAT(egl->platform(), AnyOf("EGL device", "EGL surfaceless"));
  for (int i = 0; i < 4; ++i) {
    osmesa->MakeCurrent();
    EXPECT_EQ(RoundTrip(*osmesa, 1.5f), 1.5f);
    egl->MakeCurrent();
    EXPECT_EQ(RoundTrip(*egl, 2.5f), 2.5f);
  }
}

TEST(Context, OsmesaIsSoftware) {
  EXPECT_TRUE(CreateContext(ContextKind::kOsmesa)->software());
}

TEST(Context, DefaultIsAGpuOrElseOsmesa) {
  const auto context = CreateContext();
  EXPECT_TRUE(context->kind() == ContextKind::kOsmesa || !context->software()) << context->renderer();
}

TEST(Context, DefaultFallsBackOnEglWithoutOsmesa) {
  EXPECT_EQ(CreateContext(std::nullopt, {.osmesa = "libnothing.so.8"})->kind(), ContextKind::kEgl);
}

TEST(Context, DefaultNeedsNoEgl) {
  EXPECT_EQ(CreateContext(std::nullopt, {.egl = "libnothing.so.1"})->kind(), ContextKind::kOsmesa);
}

TEST(Context, NothingThereIsOneLine) {
  const ContextLibraries nothing{.osmesa = "libnothing.so.8", .egl = "libnothing.so.1"};
  for (const std::optional<ContextKind> kind :
       {std::optional<ContextKind>{}, std::optional{ContextKind::kOsmesa},
        std::optional{ContextKind::kEgl}}) {
    const std::string error = ErrorOf(kind, nothing);
    EXPECT_THAT(error, StartsWith("no "));
    EXPECT_THAT(error, HasSubstr("libnothing.so"));
    EXPECT_THAT(error, HasSubstr("; expected "));
    EXPECT_THAT(error, Not(HasSubstr("\n")));
  }
}

TEST(Context, LibraryThatIsNoGlIsRefused) {
  EXPECT_THAT(ErrorOf(ContextKind::kOsmesa, {.osmesa = "libm.so.6"}),
              HasSubstr("OSMesaCreateContextAttribs"));
  EXPECT_THAT(ErrorOf(ContextKind::kEgl, {.egl = "libm.so.6"}), HasSubstr("eglGetProcAddress"));
}

TEST(Context, EnvironmentNamesTheLibraries) {
  setenv("AREALAB_OSMESA", "libnothing.so.8", 1);
  const ContextLibraries libraries = ContextLibraries::FromEnvironment();
  unsetenv("AREALAB_OSMESA");
  EXPECT_EQ(libraries.osmesa, "libnothing.so.8");
  EXPECT_EQ(libraries.egl, "libEGL.so.1");
}

}  // namespace
}  // namespace arealab::context_test
