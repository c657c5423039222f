// The report's folder: the schema, what the page is given against what the EXRs hold, hostile names,
// replacing as a whole.
#include "compare/report.h"

#include <fmt/format.h>
#define IMATH_HALF_NO_LOOKUP_TABLE  // the header alone
#include <Imath/half.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "compare/image_files.h"
#include "compare/page_data.h"
#include "scenes/error.h"
#include "tests/compare/synthetic_results.h"

namespace arealab::report_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class Folder {  // removed at the end
 public:
  Folder() : path_(fs::temp_directory_path() / fmt::format("arealab_report_test_{}", getpid())) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  fs::path operator/(const std::string& name) const { return path_ / name; }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string Read(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  EXPECT_TRUE(stream) << file;
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

const Results& Small() {
  static const Results results = [] {
    synthetic::Style warm;
    warm.radiance = {6.0, 5.0, 3.7};
    warm.base_color = {0.6, 0.4, 0.3};
    std::vector<SceneResult> scenes = {
        synthetic::MakeScene("gloss", "How does the reflection change?", {}, {48, 36, 6}),
        synthetic::MakeScene("warm", "Does colour survive?", warm, {48, 36, 6})};
    scenes[0].shadow = synthetic::MakeShadow(*scenes[0].truth);
    ShadowResult& none = scenes[1].shadow.emplace();
    none.light_lost = none.bias = none.rel_rmse = 0.0;
    return synthetic::MakeResults(scenes);
  }();
  return results;
}

// An independent reading of compare/page_data.h: the half bits of the six planes.
struct PageImage {
  std::string key;
  int width = 0, height = 0, exponent = 0, shift = 0;
  std::vector<std::string> modes;
  std::vector<std::vector<std::uint16_t>> planes{6};
};

PageImage DecodePage(const std::string& script, const PageImage* truth = nullptr) {
  const std::string head = "arealabImage(";
  EXPECT_EQ(script.compare(0, head.size(), head), 0);
  const std::size_t literal = script.find("},\"") + 2;
  const json arguments = json::parse("[" + script.substr(head.size(), literal - 1 - head.size()) + "]");
  PageImage image;
  image.key = arguments[0];
  image.width = arguments[1]["width"];
  image.height = arguments[1]["height"];
  image.exponent = arguments[1]["exponent"];
  image.shift = arguments[1]["shift"];
  image.modes = arguments[1]["planes"].get<std::vector<std::string>>();
  std::vector<unsigned char> packed;
  std::size_t end = literal + 1;
  for (; script[end] != '"'; ++end) {
    EXPECT_NE(script[end], '\n');
    if (script[end] != '\\') {
      packed.push_back(static_cast<unsigned char>(script[end]));
    } else if (const char escaped = script[++end]; escaped == 'x') {
      EXPECT_EQ(script.substr(end, 3), "x00");
      packed.push_back(0);
      end += 2;
    } else {
      packed.push_back(static_cast<unsigned char>(escaped == 'n' ? '\n' : escaped == 'r' ? '\r' : escaped));
    }
  }
  EXPECT_EQ(script.substr(end), "\");\n");
  const std::size_t size = static_cast<std::size_t>(image.width * image.height);
  std::vector<unsigned char> bytes(12 * size);
  uLongf length = static_cast<uLongf>(bytes.size());
  EXPECT_EQ(uncompress(bytes.data(), &length, packed.data(), static_cast<uLong>(packed.size())), Z_OK);
  std::size_t at = 0;
  for (std::size_t lobe = 0; lobe < 2; ++lobe) {
    for (std::size_t channel : {1u, 0u, 2u}) {
      const std::size_t index = 3 * lobe + channel;
      auto& plane = image.planes[index];
      const std::string& mode = image.modes[index];
      const std::vector<std::uint16_t> none(size, 0);
      const auto& base = mode[1] == 'g'   ? image.planes[3 * lobe + 1]
                         : mode[1] == 't' ? truth->planes[index]
                                          : none;
      plane.assign(size, 0);
      if (mode[0] != '=') {
        for (int y = 0; y < image.height; ++y) {
          for (int x = 0; x < image.width; ++x) {
            const auto get = [&](int u, int v) {
              return u < 0 || v < 0 ? 0
                                    : static_cast<int>(plane[static_cast<std::size_t>(v * image.width + u)]);
            };
            const std::size_t i = static_cast<std::size_t>(y * image.width + x);
            const int z = bytes[at + i] + 256 * bytes[at + size + i];
            const int residual = z % 2 == 0 ? z / 2 : -(z + 1) / 2;
            const int corner = x > 0 && y > 0 ? get(x - 1, y - 1) : 0;
            plane[i] =
                static_cast<std::uint16_t>((residual + get(x - 1, y) + get(x, y - 1) - corner) & 0xFFFF);
          }
        }
        at += 2 * size;
      }
      for (std::size_t i = 0; i < size; ++i)
        plane[i] = static_cast<std::uint16_t>(
            (plane[i] + (mode[1] == 't' ? base[i] >> image.shift : base[i])) & 0xFFFF);
    }
  }
  for (auto& plane : image.planes) {
    for (std::uint16_t& value : plane) value = static_cast<std::uint16_t>(value << image.shift);
  }
  EXPECT_EQ(at, length);
  return image;
}

void ExpectSameBits(float a, float b) {
  if (std::isnan(a) && std::isnan(b)) return;
  EXPECT_EQ(a, b);
}

// Sums of squares of a and of a − b over both lobes.
std::pair<double, double> Squares(const RadianceImage& a, const RadianceImage& b) {
  double size = 0.0, difference = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (const auto& [x, y] : {std::pair(a.diffuse[i], b.diffuse[i]), std::pair(a.specular[i], b.specular[i])}) {
      size += glm::dot(x, x);
      difference += glm::dot(x - y, x - y);
    }
  }
  return {size, difference};
}

RadianceImage Shown(const PageImage& page) {
  HalfImage half;
  half.width = page.width;
  half.height = page.height;
  half.exponent = page.exponent;
  for (std::size_t p = 0; p < 6; ++p) half.planes[p] = page.planes[p];
  return FromHalf(half);
}

TEST(Images, PageHoldsTheValuesWithinTheStatedRoundingAndExrsAreClose) {
  const Folder folder;
  WriteReport(Small(), folder / "report");
  std::map<std::string, int> modes;
  for (const SceneResult& scene : Small().scenes) {
    const PageImage truth = DecodePage(Read(folder / ("report/data/" + scene.name + "/truth.js")));
    for (const std::string& mode : truth.modes) ++modes[mode];
    double mean = 0.0;
    for (std::size_t i = 0; i < scene.truth->size(); ++i)
      mean += Luminance(scene.truth->Total(i)) / scene.lit_pixels;
    for (const VariantResult& variant : scene.variants) {
      if (!variant.image) continue;
      const std::string path = scene.name + "/" + variant.name;
      const PageImage page = DecodePage(Read(folder / ("report/data/" + path + ".js")), &truth);
      for (const std::string& mode : page.modes) ++modes[mode];
      EXPECT_EQ(page.key, path);
      const RadianceImage shown = Shown(page), shown_truth = Shown(truth),
                          stored = ReadExr(folder / ("report/images/" + path + ".exr"));
      ASSERT_EQ(stored.size(), variant.image->size());
      const auto [size, difference] = Squares(shown, stored);
      EXPECT_LE(difference, 0.01 * 0.01 * size) << path;  // DWA
      for (std::size_t i = 0; i < stored.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
          // Of a difference to the truth one step: 2⁻¹⁰ of the value, of a quarter of the mean where that is more;
          // doubled where a binade ends between the value and the truth's. Then half a step of the variant's own: an
          // eighth of its error, at most 2⁻⁷. The truth itself is kept to half of 2⁻⁷.
          for (const auto& [kept, exact, kept_truth, exact_truth] :
               {std::tuple(shown.diffuse[i][c], variant.image->diffuse[i][c], shown_truth.diffuse[i][c], scene.truth->diffuse[i][c]),
                std::tuple(shown.specular[i][c], variant.image->specular[i][c], shown_truth.specular[i][c], scene.truth->specular[i][c])}) {
            const double own = std::min(variant.total.rel_rmse / 8.0, 0x1p-7) / 2.0, magnitude = std::abs(static_cast<double>(exact));
            const double bound = std::max(magnitude, mean / 4.0) * 0x1p-9 + magnitude * own * (1.0 + 0x1p-8);
            const double truth_bound = std::max(std::abs(static_cast<double>(exact_truth)) * (0x1p-8 + 0x1p-10), mean * 0x1p-10);
            ASSERT_NEAR(kept_truth, exact_truth, truth_bound);
            ASSERT_NEAR(kept, exact, bound + truth_bound);
            if (exact > 0.51f * exact_truth && exact < 1.9f * exact_truth) {
              ASSERT_NEAR(kept - kept_truth, exact - exact_truth, bound) << path << ", truth " << exact_truth;
            }
          }
        }
      }
      EXPECT_TRUE(fs::exists(folder / ("report/images/" + path + ".png")));
    }
  }
  for (const char* mode : {"raw", "=g", "-t"}) EXPECT_GT(modes[mode], 0) << mode;
}

// Against Imath's conversions, both ways: every half, and floats between and beyond them.
TEST(Images, HalvesAreThoseOfOpenExr) {
  HalfImage all;
  all.width = 256;
  all.height = 256;
  for (auto& plane : all.planes) {
    for (unsigned bits = 0; bits < 65536; ++bits) plane.push_back(static_cast<std::uint16_t>(bits));
  }
  const RadianceImage decoded = FromHalf(all);
  for (unsigned bits = 0; bits < 65536; ++bits) {
    half expected;
    expected.setBits(static_cast<std::uint16_t>(bits));
    const float value = decoded.diffuse[bits].x;
    ASSERT_TRUE(value == static_cast<float>(expected) || (std::isnan(value) && expected.isNan())) << bits;
  }
  RadianceImage image;
  image.width = image.height = 512;
  std::mt19937 random(1);
  while (image.diffuse.size() < 512 * 512) {
    glm::vec3 v;
    for (int c = 0; c < 3; ++c) {
      // Half's range with some room, and every third in its middle between two halves.
      const std::uint32_t bits = (random() & 0x8fffffffu) + 0x33000000u;
      v[c] = std::clamp(std::bit_cast<float>(c == 2 ? (bits & ~0x1fffu) | 0x1000u : bits), -65504.0f, 65504.0f);
    }
    image.diffuse.push_back(v);
  }
  image.diffuse[0].x = 65504.0f;  // so that no exponent is taken out
  image.specular = image.diffuse;
  const HalfImage rounded = ToHalf(image);
  ASSERT_EQ(rounded.exponent, 0);
  for (std::size_t i = 0; i < image.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const float v = image.diffuse[i][c];
      const std::uint16_t expected = half(v).bits() == 0x8000 ? std::uint16_t{0} : half(v).bits();
      ASSERT_EQ(rounded.planes[static_cast<std::size_t>(c)][i], expected) << v;
    }
  }
}

TEST(Images, RoundingByTheTruthKeepsDifferences) {
  RadianceImage truth{64, 1, {}, {}}, image{64, 1, {}, {}};
  for (int i = 0; i < 64; ++i) {
    const float v = 1.0f + 0.9f * static_cast<float>(i) / 64.0f;  // one binade, its step 2⁻¹⁰
    truth.diffuse.push_back(glm::vec3(v));
    image.diffuse.push_back(glm::vec3(v * 1.00001f));  // far below a step: no difference may remain
    truth.specular.push_back(glm::vec3(0.001f * v));
    image.specular.push_back(glm::vec3(0.001f * v + 0.01f));
  }
  const HalfImage stored = ToHalf(truth, 0.5f), half = ToHalf(image, 0.5f, truth, stored);
  EXPECT_EQ(half.planes[0], stored.planes[0]);
  const RadianceImage a = FromHalf(half), b = FromHalf(stored);
  for (std::size_t i = 0; i < 64; ++i) {
    EXPECT_NEAR(a.specular[i].x - b.specular[i].x, 0.01f, 0x1p-12f);  // half of the step 2⁻¹¹ at 0.5
    EXPECT_EQ(std::fmod(b.specular[i].x, 0x1p-11f), 0.0f);
  }
  // Plain halves where nothing coarser is asked for.
  EXPECT_NEAR(FromHalf(ToHalf(truth)).specular[5].x, truth.specular[5].x, 0.001 * 0x1p-11);
}

TEST(Images, DroppedBitsMoveValuesByHalfAStepAndSpareTheRest) {
  RadianceImage image{4, 1, {}, {}};
  const float infinity = std::numeric_limits<float>::infinity();
  image.diffuse = {
      {1.0f, -1.37f, 1.999f}, {0.0f, 65504.0f, 3e-3f}, {infinity, -infinity, NAN}, {0.7f, 7.0f, 70.0f}};
  image.specular.assign(4, glm::vec3(0.3f));
  const HalfImage exact = ToHalf(image);
  for (int bits : {0, 1, 5}) {
    HalfImage coarse = exact;
    DropBits(coarse, bits);
    const RadianceImage kept = FromHalf(coarse);
    for (std::size_t i = 0; i < 4; ++i) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(coarse.planes[static_cast<std::size_t>(c)][i] % (1 << bits), 0);
        const float value = FromHalf(exact).diffuse[i][c];
        if (std::isfinite(value)) {
          // The largest half has no room above it: there the step is a whole one.
          const float share = value == 65504.0f ? 1.0f : 0.5f;
          EXPECT_NEAR(kept.diffuse[i][c], value, share * std::abs(value) * std::ldexp(1.0f, bits - 10))
              << bits;
        } else {
          ExpectSameBits(kept.diffuse[i][c], value);
        }
      }
    }
    EXPECT_EQ(kept.diffuse[0].x, 1.0f);
  }
}

TEST(Images, BrightDimAndBrokenValuesSurvive) {
  const Folder folder;
  RadianceImage image{2, 2, {}, {}};
  image.diffuse = {{1e6f, 2e6f, 3e6f}, {1.0f, 1.0f, 1.0f}, {0.0f, -0.0f, 5e5f}, {7e5f, 1.0f, 100.0f}};
  image.specular.assign(4, glm::vec3(0.25f));
  image.specular[3] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                       -2.0f};
  for (float scale : {1.0f, 1e-9f}) {
    RadianceImage scaled = image;
    for (auto* lobe : {&scaled.diffuse, &scaled.specular}) {
      for (glm::vec3& v : *lobe) v *= scale;
    }
    const HalfImage half = ToHalf(scaled);
    EXPECT_NE(half.exponent, 0);
    WriteExr(folder / "x.exr", half);
    const RadianceImage back = ReadExr(folder / "x.exr"), shown = FromHalf(half);
    for (std::size_t i = 0; i < 4; ++i) {
      for (int c = 0; c < 3; ++c) {
        ExpectSameBits(back.diffuse[i][c], shown.diffuse[i][c]);
        ExpectSameBits(back.specular[i][c], shown.specular[i][c]);
        EXPECT_NEAR(back.diffuse[i][c] / scale, image.diffuse[i][c], image.diffuse[i][c] * 0x1p-11f);
      }
    }
    EXPECT_TRUE(std::isnan(back.specular[3].x));
    EXPECT_TRUE(std::isinf(back.specular[3].y));
  }
}

// An EXR's header may carry the time of day ("YYYY:MM:DD hh:mm:ss"); ours must not.
TEST(Images, AnExrHasNoTimeInIt) {
  const Folder folder;
  WriteExr(folder / "x.exr", *Small().scenes[1].truth);
  std::ifstream file(folder / "x.exr", std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(file), {});
  const std::string header = bytes.substr(0, 1024);
  EXPECT_THAT(header, testing::HasSubstr("diffuse.R"));
  EXPECT_THAT(header, testing::Not(testing::ContainsRegex("[0-9][0-9][0-9][0-9]:[0-9][0-9]:[0-9][0-9] ")));
}

TEST(Images, UnroundedExrIsExact) {
  const Folder folder;
  const RadianceImage& image = *Small().scenes[1].truth;
  WriteExr(folder / "x.exr", image);
  const RadianceImage back = ReadExr(folder / "x.exr");
  EXPECT_EQ(back.diffuse, image.diffuse);
  EXPECT_EQ(back.specular, image.specular);
  EXPECT_THROW(WriteExr(folder / "x.exr/y.exr", image), InputError);  // x.exr is no folder
  EXPECT_THROW(ReadExr(folder / "none.exr"), InputError);
}

TEST(Images, GreyLayersAreOneChannel) {
  const SceneResult &grey = Small().scenes[0], &warm = Small().scenes[1];
  EXPECT_TRUE(ToHalf(*grey.truth).IsGray(0) && ToHalf(*grey.truth).IsGray(1));
  EXPECT_FALSE(ToHalf(*warm.truth).IsGray(0) || ToHalf(*warm.truth).IsGray(1));
  EXPECT_LT(2 * EncodePageImage("k", ToHalf(*grey.truth)).size(),
            EncodePageImage("k", ToHalf(*warm.truth)).size());
}

TEST(ResultsFile, FollowsTheSchema) {
  const json all = json::parse(ResultsJson(Small()));
  EXPECT_EQ(all["schema"], 1);
  EXPECT_EQ(all["command"], Small().command);
  EXPECT_EQ(all["machine"]["cores"], "2");
  EXPECT_TRUE(all["renderer"].is_string());
  const json& scene = all["scenes"][0];
  for (const char* key : {"name", "width", "height", "effects", "lit_pixels", "truth", "variants", "pairs"}) {
    EXPECT_TRUE(scene.contains(key)) << key;
  }
  EXPECT_EQ(scene["truth"]["cached"], false);
  EXPECT_NEAR(scene["truth"]["relative_error"].get<double>(), 8.4e-5, 1e-12);
  const json& variant = scene["variants"][0];
  for (const char* lobe : {"total", "diffuse", "specular"}) {
    for (const char* key : {"rel_rmse", "bias", "relmse", "mae", "p99", "max", "flip"}) {
      EXPECT_TRUE(variant["error"][lobe].contains(key)) << lobe << " " << key;
    }
  }
  EXPECT_TRUE(variant["error"]["diffuse"]["flip"].is_null());  // measured for the total only
  EXPECT_TRUE(variant["error"]["split"]["model"].is_null());
  EXPECT_EQ(variant["time"]["ratio_interval"].size(), 2u);
  EXPECT_EQ(variant["reason"], nullptr);
  const json& refused = scene["variants"].back();
  EXPECT_EQ(refused["supported"], false);
  EXPECT_TRUE(refused["error"]["total"]["rel_rmse"].is_null());
  EXPECT_TRUE(refused["time"]["ratio_interval"].is_null());
  EXPECT_EQ(scene["pairs"].size(), 9u * 8u);
  EXPECT_EQ(scene["pairs"][0]["a"], "point");
}

// As RFC 4180 says.
std::vector<std::vector<std::string>> ParseCsv(const std::string& text) {
  std::vector<std::vector<std::string>> rows(1, std::vector<std::string>(1));
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"') {
      rows.back().back() += '"';
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && c == ',') {
      rows.back().emplace_back();
    } else if (!quoted && c == '\n') {
      if (i + 1 < text.size()) rows.emplace_back(1);
    } else if (quoted || c != '\r') {
      rows.back().back() += c;
    }
  }
  return rows;
}

TEST(ResultsFile, CsvHasOneRowPerSceneVariantAndLobe) {
  Results results = Small();
  results.scenes[0].variants.back().reason = "says \"no\", twice\nand more";
  const auto rows = ParseCsv(ResultsCsv(results));
  ASSERT_EQ(rows.size(), 1u + 2u * 10u * 3u);
  for (const auto& row : rows) EXPECT_EQ(row.size(), rows[0].size());
  EXPECT_EQ(rows[0][0], "scene");
  EXPECT_EQ(rows[1][1], "point");
  EXPECT_NEAR(std::stod(rows[1][4]), results.scenes[0].variants[0].total.rel_rmse, 1e-8);
  EXPECT_EQ(rows[30].back(), "says \"no\", twice\nand more");
  EXPECT_EQ(rows[30][4], "");
}

TEST(ResultsFile, SummaryIsSortedAndAligned) {
  const std::string table = SummaryTable(Small().scenes[0]);
  std::vector<std::string> lines;
  std::stringstream stream(table);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 2u + 10u);
  EXPECT_NE(lines[2].find("reference"), std::string::npos);
  EXPECT_NE(lines[2].find("within truth's error"), std::string::npos);
  std::vector<std::pair<double, std::string>> order;
  for (const VariantResult& v : Small().scenes[0].variants) {
    if (v.supported) order.emplace_back(v.total.rel_rmse, v.short_name);
  }
  std::sort(order.begin(), order.end());
  for (std::size_t i = 0; i < order.size(); ++i)
    EXPECT_EQ(lines[i + 2].find("  " + order[i].second + " "), 0u) << lines[i + 2];
  EXPECT_NE(lines[11].find("lightfield"), std::string::npos);
  EXPECT_NE(lines[11].find("not supported: lightfield shades rectangles only"), std::string::npos);
  // The error column ends where its heading does, in every row that has figures.
  const std::size_t end = lines[1].find("error %") + std::string("error %").size();
  for (std::size_t i = 2; i < 11; ++i) {
    EXPECT_NE(lines[i][end - 1], ' ') << lines[i];
    EXPECT_EQ(lines[i][end], ' ') << lines[i];
  }
}

// Names that a scene file could bring along.
Results Hostile() {
  const std::string markup = "</script><img src=x onerror=\"window.injected=1\"><b>bold</b>&amp;'\"";
  Results results = Small();
  results.command = "arealab compare '" + markup + "'";
  results.machine["os"] = markup;
  SceneResult& scene = results.scenes[1];
  scene.name = "../" + markup;
  scene.question = markup + "\xE2\x80\xA8line";
  scene.file = markup;
  scene.unit = "W/(m² sr)";
  scene.effects = {markup};
  scene.variants.back().reason = markup;
  scene.variants[1].summary = scene.variants[1].citation = scene.variants[1].note = markup;
  scene.variants[2].name = scene.variants[2].short_name = "a\xFFname\n" + markup;  // and not even UTF-8
  scene.variants[3].name = "..";
  scene.pairs.clear();
  return results;
}

TEST(Report, HostileNamesStayTextAndInsideTheFolder) {
  const Folder folder;
  WriteReport(Hostile(), folder / "report");
  const std::string page = Read(folder / "report/index.html");
  EXPECT_EQ(page.find("<img src=x"), std::string::npos);
  const auto count = [&](const std::string& what) {
    int n = 0;
    for (std::size_t at = page.find(what); at != std::string::npos; at = page.find(what, at + 1)) ++n;
    return n;
  };
  EXPECT_EQ(count("</script>"), 4);
  const std::size_t begin = page.find("id=\"results\">") + 13;
  const json data = json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  EXPECT_EQ(data["scenes"][1]["question"], Hostile().scenes[1].question);
  for (const auto& entry : fs::directory_iterator(folder.path()))
    EXPECT_EQ(entry.path().filename(), "report");
  for (const char* kind : {"images", "data"}) {
    const fs::path inside = folder / "report" / kind;
    int folders = 0, files = 0;
    for (const auto& entry : fs::directory_iterator(inside)) folders += entry.is_directory() ? 1 : 0;
    for (const auto& entry : fs::recursive_directory_iterator(inside))
      files += entry.is_regular_file() ? 1 : 0;
    EXPECT_EQ(folders, 2);
    EXPECT_EQ(files, 21 * (kind[0] == 'i' ? 2 : 1) +  // truth and nine variants, twice; one shadowed truth
                         (kind[0] == 'd' ? 2 : 0));   // emission
  }
}

// Its steps are coarse, but not where there is no shadow, and never more than 2⁻⁷ off, beside truth's own 2⁻⁸.
TEST(Report, ShadowedTruthIsKeptWithinAPercent) {
  const Folder folder;
  WriteReport(Small(), folder / "report");
  const SceneResult& scene = Small().scenes[0];
  const PageImage page = DecodePage(Read(folder / "report/data/gloss/truth.js"));
  const RadianceImage truth = Shown(page),
                      stored = Shown(DecodePage(Read(folder / "report/data/gloss/truth-shadowed.js"), &page));
  const RadianceImage& exact = *scene.shadow->image;
  int whole = 0, partly = 0, black = 0;
  for (std::size_t i = 0; i < stored.size(); ++i) {
    if (exact.diffuse[i] == scene.truth->diffuse[i]) {
      EXPECT_EQ(stored.diffuse[i], truth.diffuse[i]);
      EXPECT_EQ(stored.specular[i], truth.specular[i]);
      ++whole;
    } else if (exact.diffuse[i] == glm::vec3(0.0f)) {
      EXPECT_EQ(stored.diffuse[i], glm::vec3(0.0f));
      ++black;
    } else {
      const float mean = 0.1f;  // below a quarter of truth's mean the files' own steps are coarser
      EXPECT_NEAR(stored.diffuse[i].x, exact.diffuse[i].x,
                  0x1p-7f * std::max(exact.diffuse[i].x, mean) + 0x1p-8f * scene.truth->diffuse[i].x);
      ++partly;
    }
  }
  EXPECT_GT(whole, 100);
  EXPECT_GT(partly, 100);
  EXPECT_GT(black, 20);
  EXPECT_FALSE(fs::exists(folder / "report/images/warm/truth-shadowed.exr"));
  const json shadow = json::parse(ResultsJson(Small()))["scenes"][0]["truth"]["shadow"];
  EXPECT_EQ(shadow["present"], true);
  EXPECT_NEAR(shadow["light_lost"].get<double>(), scene.shadow->light_lost, 1e-12);
  EXPECT_NEAR(shadow["error"]["p99"].get<double>(), 0.0198, 1e-12);
  EXPECT_EQ(json::parse(ResultsJson(Small()))["scenes"][1]["truth"]["shadow"]["present"], false);
}

TEST(Report, EqualFileNamesAreToldApart) {
  const Folder folder;
  Results results = Small();
  results.scenes[1].name = "gloss";
  results.scenes[1].variants[0].name = "truth";
  results.scenes[1].variants[1].name = "a/b";
  results.scenes[1].variants[2].name = "a:b";
  WriteReport(results, folder / "report");
  for (const char* file : {"gloss/point.exr", "gloss-2/truth.exr", "gloss-2/truth-2.exr", "gloss-2/a_b.exr",
                           "gloss-2/a_b-2.exr"}) {
    EXPECT_TRUE(fs::exists(folder / "report/images" / file)) << file;
  }
}

// Three maps of a variant whose error was split, on one scale: black below 1e-7, and none where it was not.
TEST(Report, SaysWhoseErrorItIsPixelByPixel) {
  const Folder folder;
  Results results = Small();
  SceneResult& scene = results.scenes[0];
  VariantResult& variant = scene.variants[0];
  const auto pixels = static_cast<std::size_t>(scene.width) * static_cast<std::size_t>(scene.height);
  variant.split = {0.1, 1e-3, 1e-7};
  variant.split.maps = {{"model", std::vector<float>(pixels, 1.0f)}, {"approximation", std::vector<float>(pixels, 0.0f)},
                        {"rounding", std::vector<float>(pixels, std::numeric_limits<float>::quiet_NaN())}};
  results.hard_cases = {3, 1, 24000, "<html>the hard cases</html>\n"};
  WriteReport(results, folder / "out");
  int maps = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "out/images")) {
    for (const char* part : {"-model.png", "-approximation.png", "-rounding.png"})
      maps += entry.path().filename().string().ends_with(part);
  }
  EXPECT_EQ(maps, 3);
  EXPECT_TRUE(fs::exists(folder / "out/hard-cases.html"));
  const nlohmann::json json = nlohmann::json::parse(ResultsJson(results));
  EXPECT_EQ(json["hard_cases"]["failures"], 1);
  EXPECT_EQ(json["scenes"][0]["variants"][0]["error"]["split"]["model"], 0.1);
}

TEST(Report, ReplacesAnEarlierReportAsAWhole) {
  const Folder folder;
  WriteReport(Small(), folder / "report/");
  std::ofstream(folder / "report/left-over") << "from the first";
  // As an interrupted run leaves it: a process of that number cannot live.
  fs::create_directories(folder / ".report.partial-999999999/images");
  WriteReport(Small(), folder / "report");
  EXPECT_TRUE(fs::exists(folder / "report/index.html"));
  EXPECT_FALSE(fs::exists(folder / "report/left-over"));
  int entries = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder.path())) ++entries;
  EXPECT_EQ(entries, 1);
}

TEST(Report, NothingStaysOfOneThatWasNotFinished) {
  const Folder folder;
  const Results results = Small();
  {
    ReportWriter writer(folder / "report");
    writer.Add(results.scenes[0]);
    EXPECT_FALSE(fs::exists(folder / "report"));
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

// As `compare` does, which keeps one scene's images at a time.
TEST(Report, IsTheSameWithoutTheImagesThatWereAdded) {
  const Folder folder;
  Results results = Small();
  WriteReport(results, folder / "whole");
  ReportWriter writer(folder / "piecewise");
  for (SceneResult& scene : results.scenes) {
    writer.Add(scene);
    scene.ReleaseImages();
  }
  writer.Finish(results);
  for (const auto& entry : fs::recursive_directory_iterator(folder / "whole")) {
    if (!entry.is_regular_file()) continue;
    const fs::path file = fs::relative(entry.path(), folder / "whole");
    EXPECT_EQ(Read(folder / "piecewise" / file.string()), Read(entry.path())) << file;
  }
}

TEST(Report, RefusesAFolderThatHoldsSomethingElse) {
  const Folder folder;
  fs::create_directories(folder / "home");
  std::ofstream(folder / "home/thesis.txt") << "irreplaceable";
  EXPECT_THROW(CheckReportDirectory(folder / "home"), InputError);
  EXPECT_THROW(WriteReport(Small(), folder / "home"), InputError);
  EXPECT_EQ(Read(folder / "home/thesis.txt"), "irreplaceable");
  EXPECT_THROW(CheckReportDirectory(folder / "home/thesis.txt"), InputError);
  EXPECT_THROW(CheckReportDirectory("/proc/none/report"), InputError);
  CheckReportDirectory(folder / "new/deep/report");
  EXPECT_TRUE(fs::is_directory(folder / "new/deep"));
}

TEST(Report, OneUnshadedSceneAndNone) {
  const Folder folder;
  Results results = synthetic::MakeResults({});
  WriteReport(results, folder / "empty");
  SceneResult scene;
  scene.name = "bare";
  scene.width = scene.height = 4;
  results.scenes = {scene};
  WriteReport(results, folder / "bare");
  EXPECT_TRUE(fs::exists(folder / "bare/index.html"));
}

// Relative differences as the page defines them, from the values in the page's files.
json Expected(const fs::path& report, const SceneResult& scene) {
  const auto lobe_of = [](const RadianceImage& image, const std::string& lobe, std::size_t i) {
    return glm::dvec3(lobe == "diffuse"    ? image.diffuse[i]
                      : lobe == "specular" ? image.specular[i]
                                           : glm::vec3(0.0f)) +
           (lobe == "total" ? glm::dvec3(image.diffuse[i]) + glm::dvec3(image.specular[i]) : glm::dvec3(0.0));
  };
  const auto luminance = [](const glm::dvec3& v) { return 0.2126 * v.x + 0.7152 * v.y + 0.0722 * v.z; };
  json expected = json::array();
  for (const auto& [a, b] : {std::pair("ltc", "truth"), std::pair("drobot", "hill"),
                             std::pair("point", "truth"), std::pair("truth", "truth-shadowed")}) {
    const auto page = [&](const std::string& stem) { return Read(report / "data" / scene.name / (stem + ".js")); };
    const PageImage truth = DecodePage(page("truth"));
    const RadianceImage image_a = Shown(DecodePage(page(a), &truth)), image_b = Shown(DecodePage(page(b), &truth));
    for (const std::string lobe : {"total", "diffuse", "specular"}) {
      double floor = 0.0;
      int lit = 0;
      for (std::size_t i = 0; i < scene.truth->size(); ++i) {
        const double y = luminance(lobe_of(*scene.truth, lobe, i));
        floor += y;
        lit += y > 0.0 ? 1 : 0;
      }
      floor *= 0.01 / lit;
      for (std::size_t i = 5; i < image_a.size(); i += 131) {
        const glm::dvec3 va = lobe_of(image_a, lobe, i), vb = lobe_of(image_b, lobe, i),
                         d = glm::abs(va - vb);
        if (va == glm::dvec3(0.0) && vb == glm::dvec3(0.0)) continue;
        const double base = std::max(luminance(vb), floor);
        expected.push_back({{"scene", scene.name},
                            {"a", a},
                            {"b", b},
                            {"lobe", lobe},
                            {"floor", floor},
                            {"x", i % static_cast<std::size_t>(scene.width)},
                            {"y", i / static_cast<std::size_t>(scene.width)},
                            {"signed", (luminance(va) - luminance(vb)) / base},
                            {"magnitude", std::max({d.x, d.y, d.z}) / base}});
      }
    }
  }
  return expected;
}

// What report_page_test.py opens: AREALAB_REPORT_SAMPLE names its folder.
TEST(Report, WritesTheSampleForThePageTest) {
  const Folder folder;
  const char* sample = std::getenv("AREALAB_REPORT_SAMPLE");
  const fs::path root = sample != nullptr ? fs::path(sample) : folder / "sample";
  Results results = Small();
  results.scenes.push_back(Hostile().scenes[1]);
  results.scenes.back().exposure = 1.0;
  {  // a variant that yields NaN
    VariantResult& broken = results.scenes[1].variants[1];
    auto image = std::make_shared<RadianceImage>(*broken.image);
    for (std::size_t i = 0; i < 48; ++i)
      image->specular[24 * 48 + i].y = std::numeric_limits<float>::quiet_NaN();
    broken.image = image;
    Measure(*results.scenes[1].truth, nullptr, &broken);
  }
  WriteReport(results, root / "report");
  const json expected = Expected(root / "report", results.scenes[0]);
  EXPECT_GT(expected.size(), 30u);
  std::ofstream(root / "expected.json") << expected.dump();
  EXPECT_TRUE(fs::exists(root / "report/index.html"));
}

}  // namespace
}  // namespace arealab::report_test
