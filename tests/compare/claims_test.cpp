// The pages "the source's claims": every figure is computed, so a changed shader text changes figures and verdicts.
#include "compare/claims.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "compare/page_parts.h"
#include "scenes/error.h"

namespace arealab::claims_test {
namespace {

namespace fs = std::filesystem;

class ClaimsFolder {
 public:
  ClaimsFolder() : path_(fs::temp_directory_path() / ("arealab-claims-" + std::to_string(getpid()))) { fs::create_directories(path_); }
  ~ClaimsFolder() { fs::remove_all(path_); }
  fs::path operator/(const char* name) const { return path_ / name; }

 private:
  fs::path path_;
};

std::string PageText(const fs::path& file) {
  std::ifstream stream(file);
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

const CheckedClaim& About(const std::vector<CheckedClaim>& checked, const std::string& words) {
  for (const CheckedClaim& one : checked) {
    if (one.claim.sentence.find(words) != std::string::npos) return one;
  }
  throw std::logic_error("no claim about " + words);
}

TEST(Claims, EverySourceHasFiguresAndAPage) {
  const auto context = CreateContext();
  const ShaderLibrary library;
  ClaimBench bench(*context, library, nullptr);
  std::vector<ClaimsPage> pages;
  for (const ClaimSource& source : ClaimSources()) {
    SCOPED_TRACE(source.name);
    const auto checked = CheckClaims(source, bench);
    EXPECT_GE(checked.size(), 3u);
    for (const auto& [claim, finding] : checked) {
      SCOPED_TRACE(claim.sentence);
      EXPECT_TRUE(claim.command.starts_with("arealab "));
      if (finding.verdict == Verdict::kUnknown) {
        EXPECT_FALSE(finding.note.empty());
        continue;
      }
      ASSERT_FALSE(finding.figures.empty());
      for (const ClaimFigure& figure : finding.figures) EXPECT_TRUE(std::isfinite(figure.value)) << figure.name;
    }
    pages.push_back(MakeClaimsPage(source, checked));
    EXPECT_NE(pages.back().html.find(Escaped(source.citation)), std::string::npos);
    EXPECT_EQ(pages.back().html.find("nan"), std::string::npos);
    EXPECT_EQ(pages.back().holds + pages.back().partly + pages.back().fails + pages.back().unknown, static_cast<int>(checked.size()));
  }
  LinkClaimsPages(pages, "index.html");
  for (const ClaimsPage& page : pages) {
    EXPECT_NE(page.html.find("href=\"index.html\""), std::string::npos);
    for (const ClaimsPage& other : pages) {
      EXPECT_EQ(page.html.find("href=\"claims-" + other.name + ".html\"") != std::string::npos, page.name != other.name);
    }
  }
  EXPECT_THROW(ClaimSources("hil"), InputError);
  EXPECT_EQ(ClaimSources("oat").size(), 1u);
}

TEST(Claims, AChangedShaderTextChangesFigureAndVerdict) {
  const auto context = CreateContext();
  const ClaimsFolder folder;
  fs::create_directories(folder / "glsl/edge");
  // The "quadratic" made exact, and the four-term arc cosine too: the text's complaint has no ground any more.
  std::ofstream(folder / "glsl/edge/fast_acos.glsl") << PageText(fs::path(AREALAB_SOURCE_DIR) / "glsl/edge/acos.glsl");
  const ShaderLibrary before, after(folder / "glsl");
  ClaimBench first(*context, before, nullptr), second(*context, after, nullptr);
  const auto was = CheckClaims(ClaimSources("hill")[0], first), is = CheckClaims(ClaimSources("hill")[0], second);
  const Finding &rings = About(was, "arc cosine is too inexact").finding, &cured = About(is, "arc cosine is too inexact").finding;
  EXPECT_EQ(rings.verdict, Verdict::kHolds);
  EXPECT_EQ(cured.verdict, Verdict::kFails);
  EXPECT_LT(cured.figures[0].value, 1e-3 * rings.figures[0].value);
  const ClaimsPage page = MakeClaimsPage(ClaimSources("hill")[0], was), cured_page = MakeClaimsPage(ClaimSources("hill")[0], is);
  EXPECT_NE(page.html, cured_page.html);
  EXPECT_EQ(page.holds, cured_page.holds + 1);
}

TEST(Claims, PagesAreKeptAndADamagedOneIsMadeAgain) {
  const auto context = CreateContext();
  const ShaderLibrary library;
  const ClaimsFolder folder;
  int made = 0;
  const auto bench = [&] {
    ++made;
    return std::make_unique<ClaimBench>(*context, library, nullptr);
  };
  const auto pages = [&] { return CachedClaimsPages(ClaimSources("oat"), "here", folder / "cache", bench); };
  const ClaimsPage first = pages().at(0), again = pages().at(0);
  EXPECT_EQ(made, 1);
  EXPECT_EQ(first.html, again.html);
  EXPECT_EQ(first.holds, again.holds);
  EXPECT_EQ(first.fails, again.fails);
  for (const auto& entry : fs::directory_iterator(folder / "cache")) fs::resize_file(entry.path(), 1000);
  EXPECT_EQ(pages().at(0).html, first.html);
  EXPECT_EQ(made, 2);
  CachedClaimsPages(ClaimSources("oat"), "elsewhere", folder / "cache", bench);
  EXPECT_EQ(made, 3);
  CachedClaimsPages(ClaimSources("oat"), "here", "/proc/none", bench);  // cannot be kept, and is made all the same
  EXPECT_EQ(made, 4);
}

}  // namespace
}  // namespace arealab::claims_test
