// Linked programs are kept by content; an entry that is damaged, or another driver's, is as good as none.
#include "compare/program_cache.h"

#include <glad/gl.h>
#include <gtest/gtest.h>

#include <fstream>

#include "compare/cache_file.h"
#include "compare/context.h"
#include "glsl/renderer.h"
#include "tests/glsl/temporary_folder.h"

namespace arealab::program_cache_test {
namespace {

// Counts what is found and kept.
class Counting : public ProgramStore {
 public:
  std::optional<std::string> Find(const std::string& content) override {
    const auto kept = programs.find(content);
    if (kept == programs.end()) return std::nullopt;
    ++found;
    return kept->second;
  }
  void Keep(const std::string& content, const std::string& bytes) override {
    ++written;
    programs[content] = bytes;
  }

  std::map<std::string, std::string> programs;
  int found = 0, written = 0;
};

class ProgramCache : public testing::Test {
 protected:
  ProgramCache() : context_(CreateContext(ContextKind::kOsmesa)), techniques_(LoadTechniques(library_)) {}
  ~ProgramCache() override { KeepProgramsIn(nullptr); }

  RadianceImage Draw(const std::shared_ptr<ProgramStore>& store) {
    KeepProgramsIn(store);
    Renderer renderer(context_->gl(), library_);
    renderer.DrawScene(scene_, {32, 32});
    return renderer.Shade(ParseVariant(techniques_, "point"));
  }
  void ExpectSame(const RadianceImage& a, const RadianceImage& b) {
    EXPECT_EQ(a.diffuse, b.diffuse);
    EXPECT_EQ(a.specular, b.specular);
  }

  std::unique_ptr<Context> context_;
  ShaderLibrary library_;
  std::vector<Technique> techniques_;
  Scene scene_ = LoadScene(FindScene("gloss"));
};

TEST_F(ProgramCache, WhatIsFoundDrawsTheSame) {
  GLint formats = 0;
  context_->gl().GetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats);
  if (formats == 0) GTEST_SKIP() << "the driver gives no program binaries (Mesa: where its own cache is off)";
  const RadianceImage plain = Draw(nullptr);
  const auto store = std::make_shared<Counting>();
  ExpectSame(Draw(store), plain);
  EXPECT_EQ(store->found, 0);
  const int written = store->written;
  EXPECT_GT(written, 2);
  ExpectSame(Draw(store), plain);
  EXPECT_EQ(store->found, written);
  EXPECT_EQ(store->written, written) << "what is found is not linked again";

  // Damaged, cut short, of a format that nobody knows, another program's texts: refused, linked from source and kept anew.
  const auto kept = store->programs;
  for (const auto& spoil : {+[](std::string& bytes) { bytes[bytes.size() / 2] ^= 1; }, +[](std::string& bytes) { bytes.resize(bytes.size() / 2); },
                            +[](std::string& bytes) { bytes[0] ^= 1; }, +[](std::string& bytes) { bytes.assign(200, 'x'); }, +[](std::string& bytes) { bytes.clear(); }}) {
    store->programs = kept;
    store->written = 0;
    for (auto& program : store->programs) spoil(program.second);
    ExpectSame(Draw(store), plain);
    EXPECT_EQ(store->written, written);
  }
}

TEST_F(ProgramCache, FilesAreCheckedBeforeTheDriverSeesThem) {
  const TemporaryFolder folder;
  const auto store = ProgramsInFolder(folder.path());
  store->Keep("text of a program", "bytes");
  EXPECT_EQ(store->Find("text of a program"), "bytes");
  EXPECT_EQ(store->Find("another text"), std::nullopt);
  for (const auto& file : std::filesystem::directory_iterator(folder.path())) {
    std::fstream stream(file.path(), std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(-2, std::ios::end);
    stream.put('?');
  }
  const int damaged = DamagedCacheEntries();
  EXPECT_EQ(store->Find("text of a program"), std::nullopt);
  EXPECT_EQ(DamagedCacheEntries(), damaged + 1);
}

}  // namespace
}  // namespace arealab::program_cache_test
