#include "glsl/shader_library.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "scenes/error.h"
#include "tests/glsl/temporary_folder.h"

namespace arealab::shader_library_test {
namespace {

using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(ShaderLibrary, EmbeddedFilesAreTheSourceUnmodified) {
  std::ifstream stream(AREALAB_SOURCE_DIR "/glsl/surface.glsl", std::ios::binary);
  const std::string source{std::istreambuf_iterator<char>(stream), {}};
  ASSERT_FALSE(source.empty());
  EXPECT_EQ(ShaderLibrary().Find("surface.glsl"), source);
}

TEST(ShaderLibrary, ListIsSortedAndOfOneFolder) {
  const std::vector<std::string> names = ShaderLibrary().List("techniques");
  EXPECT_THAT(names, Contains("techniques/ltc.glsl"));
  EXPECT_THAT(names, Each(StartsWith("techniques/")));
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
  EXPECT_TRUE(ShaderLibrary().List("no_such_folder").empty());
  EXPECT_TRUE(ShaderLibrary().List("technique").empty());  // a prefix is not a folder
}

TEST(ShaderLibrary, AnOverrideWinsAndIsReadAtEveryCall) {
  const TemporaryFolder folder;
  const ShaderLibrary library(folder.path());
  EXPECT_EQ(library.Find("surface.glsl"), ShaderLibrary().Find("surface.glsl"));
  EXPECT_EQ(library.DisplayPath("surface.glsl"), "glsl/surface.glsl");
  const std::string path = folder.Write("surface.glsl", "first");
  EXPECT_EQ(library.Find("surface.glsl"), "first");
  EXPECT_EQ(library.DisplayPath("surface.glsl"), path);
  folder.Write("surface.glsl", "second");
  EXPECT_EQ(library.Find("surface.glsl"), "second");
}

TEST(ShaderLibrary, ListJoinsOverridesAndEmbedded) {
  const TemporaryFolder folder;
  folder.Write("techniques/mine.glsl", "");
  folder.Write("techniques/ltc.glsl", "");
  folder.Write("techniques/deeper/other.glsl", "");
  const std::vector<std::string> names = ShaderLibrary(folder.path()).List("techniques");
  EXPECT_THAT(names, Contains("techniques/mine.glsl"));
  EXPECT_EQ(std::count(names.begin(), names.end(), "techniques/ltc.glsl"), 1);
  EXPECT_THAT(names, Not(Contains(HasSubstr("other"))));
}

TEST(ShaderLibrary, NamesStayInside) {
  const TemporaryFolder folder;
  const std::string outside = folder.Write("secret.glsl", "secret");
  folder.Write("glsl/surface.glsl", "inside");
  const ShaderLibrary library(folder.path() / "glsl");
  EXPECT_EQ(library.Find("../secret.glsl"), std::nullopt);
  EXPECT_EQ(library.Find(outside), std::nullopt);
  EXPECT_EQ(library.Find(""), std::nullopt);
  EXPECT_EQ(library.Find("no_such_file.glsl"), std::nullopt);
  EXPECT_TRUE(library.List("..").empty());
}

TEST(ShaderLibrary, AMissingFolderIsRefused) {
  const TemporaryFolder folder;
  try {
    ShaderLibrary{folder.path() / "nothing"};
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("nothing: no such folder; expected"));
  }
}

}  // namespace
}  // namespace arealab::shader_library_test
