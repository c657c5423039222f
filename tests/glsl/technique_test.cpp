#include "glsl/technique.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <ostream>

#include "scenes/error.h"
#include "tests/glsl/temporary_folder.h"

namespace arealab::technique_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

// A right header.
const std::string kHeader = R"(/*---
summary = "A test"
citation = "Nobody 2026, § 1"
author_note = "one form"
shapes = ["rectangle", "sphere"]
lobes = ["diffuse"]
brdfs = ["ggx"]
effects = ["two_sided"]
exact = ["lambert_sphere"]

[[option]]
name = "way"
summary = "which way"
choices = [
  ["up", "upwards"],
  ["down", "downwards"],
  ["along", "neither"],
]

[[option]]
name = "again"
summary = "once more"
choices = [["no", "once"], ["yes", "twice"]]

[[knob]]
name = "gain"
label = "Gain"
unit = "EV"
initial = 1
min = -2.5
max = 4

[tables]
lobe = "lobe_{way}_{again}.exr"

[published]
way = "down"
---*/
void main() {}
)";

// With the first `from` replaced.
std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// The file's name sorts before every embedded technique, so that its error is the first.
constexpr const char* kFile = "techniques/a_test.glsl";

Technique Load(const std::string& text) {
  const TemporaryFolder folder;
  folder.Write(kFile, text);
  return LoadTechniques(ShaderLibrary(folder.path())).at(0);
}

// The message without the path before ":LINE: ".
std::string ErrorOf(const std::string& text) {
  const TemporaryFolder folder;
  const std::string path = folder.Write(kFile, text);
  try {
    LoadTechniques(ShaderLibrary(folder.path()));
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_THAT(message, StartsWith(path + ":"));
    EXPECT_EQ(message.find('\n'), std::string::npos);
    EXPECT_NE(message.find("; expected "), std::string::npos) << message;
    return message.substr(std::min(path.size() + 1, message.size()));
  }
  return "accepted";
}

TEST(Technique, HeaderIsRead) {
  const Technique technique = Load(kHeader);
  EXPECT_EQ(technique.name, "a_test");
  EXPECT_EQ(technique.summary, "A test");
  EXPECT_EQ(technique.citation, "Nobody 2026, § 1");
  EXPECT_EQ(technique.author_note, "one form");
  EXPECT_THAT(technique.shapes, ElementsAre(LightShape::kRectangle, LightShape::kSphere));
  EXPECT_TRUE(technique.diffuse);
  EXPECT_FALSE(technique.specular);
  EXPECT_THAT(technique.brdfs, ElementsAre("ggx"));
  EXPECT_THAT(technique.effects, ElementsAre("two_sided"));
  EXPECT_THAT(technique.exact, ElementsAre("lambert_sphere"));

  ASSERT_EQ(technique.options.size(), 2u);
  EXPECT_EQ(technique.options[0].name, "way");  // in the header's order, which is not the alphabet's
  EXPECT_EQ(technique.options[0].summary, "which way");
  ASSERT_EQ(technique.options[0].choices.size(), 3u);
  EXPECT_EQ(technique.options[0].choices[0].name, "up");
  EXPECT_EQ(technique.options[0].choices[2].summary, "neither");
  EXPECT_EQ(technique.options[1].choices[0].name, "no");

  ASSERT_EQ(technique.knobs.size(), 1u);
  EXPECT_EQ(technique.knobs[0].name, "gain");
  EXPECT_EQ(technique.knobs[0].label, "Gain");
  EXPECT_EQ(technique.knobs[0].unit, "EV");
  EXPECT_EQ(technique.knobs[0].initial, 1.0);
  EXPECT_EQ(technique.knobs[0].min, -2.5);
  EXPECT_EQ(technique.knobs[0].max, 4.0);

  ASSERT_EQ(technique.tables.size(), 1u);
  EXPECT_EQ(technique.tables[0].name, "lobe");
  EXPECT_EQ(technique.tables[0].file, "lobe_{way}_{again}.exr");
  // What [published] leaves out is the default.
  EXPECT_EQ(technique.published, (std::map<std::string, std::string>{{"way", "down"}, {"again", "no"}}));
}

TEST(Technique, DeparturesAreRead) {
  const std::string departs = "[[departs]]\nlaw = \"point_limit\"\nlobe = \"diffuse\"\n"
                              "when = { way = [\"up\", \"down\"], shape = \"sphere\" }\nerror = 0.25\nwhy = \"coarse\"\n---*/";
  const auto with = [&](const std::string& from, const std::string& to) {
    return Replaced(kHeader, "---*/", Replaced(departs, from, to));
  };
  const Technique technique = Load(with("", ""));
  ASSERT_EQ(technique.departures.size(), 1u);
  const Departure& departure = technique.departures[0];
  EXPECT_EQ(departure.law, "point_limit");
  EXPECT_EQ(departure.lobe, "diffuse");
  EXPECT_EQ(departure.when, (std::map<std::string, std::vector<std::string>>{{"way", {"up", "down"}}, {"shape", {"sphere"}}}));
  EXPECT_EQ(departure.error, 0.25);
  EXPECT_EQ(departure.why, "coarse");
  EXPECT_THAT(ErrorOf(with("point_limit", "point")), testing::HasSubstr("unknown law \"point\"; expected "));
  EXPECT_THAT(ErrorOf(with("\"down\"", "\"aside\"")), testing::HasSubstr("unknown way \"aside\"; expected "));
  EXPECT_THAT(ErrorOf(with("\"sphere\"", "\"disk\"")), testing::HasSubstr("unknown shape \"disk\"; expected "));
  EXPECT_THAT(ErrorOf(with("way =", "weigh =")), testing::HasSubstr("unknown option \"weigh\""));
  EXPECT_THAT(ErrorOf(with("0.25", "0")), testing::HasSubstr("the error is not above 0; expected "));
  EXPECT_THAT(ErrorOf(Replaced(kHeader, "lambert_sphere", "radiance")), testing::HasSubstr("unknown name \"radiance\" in exact"));
}

TEST(Technique, TheLeastHeaderIsEnough) {
  const Technique technique = Load(
      "/*---\nsummary = \"s\"\ncitation = \"c\"\nauthor_note = \"n\"\nshapes = [\"disk\"]\n"
      "lobes = [\"specular\"]\nbrdfs = [\"ggx\"]\n---*/\n");
  EXPECT_FALSE(technique.diffuse);
  EXPECT_TRUE(technique.specular);
  EXPECT_THAT(technique.options, IsEmpty());
  EXPECT_THAT(technique.knobs, IsEmpty());
  EXPECT_THAT(technique.tables, IsEmpty());
  EXPECT_THAT(technique.published, IsEmpty());
}

TEST(Technique, CarriageReturnsDoNoHarm) {
  std::string text = kHeader;
  for (auto at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 2))
    text.insert(at, "\r");
  EXPECT_EQ(Load(text).options.size(), 2u);
}

TEST(Technique, TheHeaderMayEndTheFile) {
  EXPECT_EQ(Load(kHeader.substr(0, kHeader.find("---*/") + 5)).name, "a_test");
}

TEST(Technique, FilesOfOtherKindsAreNoTechniques) {
  const TemporaryFolder folder;
  folder.Write("techniques/notes.txt", "not a header");
  folder.Write("techniques/ltc.glsl~", "an editor's copy");
  EXPECT_EQ(LoadTechniques(ShaderLibrary(folder.path())).size(), LoadTechniques(ShaderLibrary()).size());
}

TEST(Technique, BuiltInHeadersAreRightAndSorted) {
  const std::vector<Technique> techniques = LoadTechniques(ShaderLibrary());
  ASSERT_GE(techniques.size(), 1u);
  EXPECT_TRUE(std::is_sorted(techniques.begin(), techniques.end(),
                             [](const auto& a, const auto& b) { return a.name < b.name; }));
}

TEST(Technique, AChoiceOfAnOptionWithAFolderNeedsItsFile) {
  const TemporaryFolder folder;
  const std::string path = folder.Write(kFile, kHeader);
  folder.Write("way/up.glsl", "");
  folder.Write("way/down.glsl", "");
  try {
    LoadTechniques(ShaderLibrary(folder.path()));
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(
        std::string(error.what()),
        path +
            ":17: choice \"along\" has no file way/along.glsl; expected a file in glsl/way/ for each choice");
  }
  folder.Write("way/along.glsl", "");
  EXPECT_NO_THROW(LoadTechniques(ShaderLibrary(folder.path())));
}

TEST(Technique, ANameThatIsNoIdentifierIsRefused) {
  const TemporaryFolder folder;
  const std::string path = folder.Write("techniques/A-test.glsl", kHeader);
  try {
    LoadTechniques(ShaderLibrary(folder.path()));
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), StartsWith(path + ":1: \"A-test\" cannot name a technique; expected "));
  }
}

TEST(Technique, AHeaderIsNeeded) {
  EXPECT_THAT(ErrorOf("void main() {}\n"), StartsWith("1: no header; expected /*---"));
  EXPECT_THAT(ErrorOf(""), StartsWith("1: no header"));
  EXPECT_THAT(ErrorOf("\n" + kHeader), StartsWith("1: no header"));
  EXPECT_THAT(ErrorOf("/*---\nsummary = \"s\"\n"), StartsWith("1: the header has no end; expected ---*/"));
  EXPECT_THAT(ErrorOf(Replaced(kHeader, "one form", "one */ form")),
              StartsWith("4: \"*/\" ends the comment"));
}

struct WrongHeader {
  const char* from;
  const char* to;
  const char* error;  // its beginning
};

void PrintTo(const WrongHeader& wrong, std::ostream* out) {
  *out << wrong.from << " -> " << wrong.to;
}

class WrongHeaders : public testing::TestWithParam<WrongHeader> {};

TEST_P(WrongHeaders, AreRefusedWithFileAndLine) {
  EXPECT_THAT(ErrorOf(Replaced(kHeader, GetParam().from, GetParam().to)), StartsWith(GetParam().error));
}

INSTANTIATE_TEST_SUITE_P(
    Technique, WrongHeaders,
    testing::Values(
        // TOML itself
        WrongHeader{"\"A test\"", "A test", "2: "},        //
        WrongHeader{"[published]", "[published", "36: "},  //
        WrongHeader{"citation", "summary", "3: "},         // a key twice
        WrongHeader{"[tables]", "[published]", "36: "},    // a table twice
        // keys
        WrongHeader{"author_note", "autor_note",
                    "4: unknown key \"autor_note\"; expected summary, citation, author_note"},
        WrongHeader{"label", "lable", "27: unknown key \"lable\"; expected name, label, unit"},
        WrongHeader{"choices = [[", "choice = [[",
                    "23: unknown key \"choice\"; expected name, summary, choices"},
        WrongHeader{"summary = \"A test\"\n", "\n", "1: no key \"summary\"; expected summary = …"},
        WrongHeader{"citation = \"Nobody 2026, § 1\"\n", "\n", "1: no key \"citation\""},
        WrongHeader{"author_note = \"one form\"\n", "\n", "1: no key \"author_note\""},
        WrongHeader{"shapes = [\"rectangle\", \"sphere\"]\n", "\n", "1: no key \"shapes\""},
        WrongHeader{"lobes = [\"diffuse\"]\n", "\n", "1: no key \"lobes\""},
        WrongHeader{"brdfs = [\"ggx\"]\n", "\n", "1: no key \"brdfs\""},
        WrongHeader{"summary = \"which way\"\n", "\n", "11: no key \"summary\""},
        WrongHeader{"name = \"way\"\n", "\n", "11: no key \"name\""},
        WrongHeader{"choices = [[\"no\", \"once\"], [\"yes\", \"twice\"]]\n", "\n", "20: no key \"choices\""},
        WrongHeader{"max = 4\n", "\n", "25: no key \"max\""},
        // text
        WrongHeader{"\"A test\"", "7", "2: summary is not a string"},            //
        WrongHeader{"\"A test\"", "\"\"", "2: summary is empty"},                //
        WrongHeader{"\"A test\"", "\"a\\nb\"", "2: summary has several lines"},  //
        // lists
        WrongHeader{"[\"rectangle\", \"sphere\"]", "\"disk\"", "5: shapes is not an array"},
        WrongHeader{"[\"rectangle\", \"sphere\"]", "[]",
                    "5: shapes is empty; expected rectangle, disk, sphere"},
        WrongHeader{"\"sphere\"", "\"spere\"",
                    "5: unknown name \"spere\" in shapes; expected rectangle, disk, sphere, polygon, ellipse, tube (did you mean "
                    "\"sphere\"?)"},
        WrongHeader{"\"sphere\"", "\"rectangle\"", "5: \"rectangle\" stands twice in shapes"},
        WrongHeader{"\"sphere\"", "3", "5: shapes is not a string"},  //
        WrongHeader{"[\"diffuse\"]", "[\"matte\"]",
                    "6: unknown name \"matte\" in lobes; expected diffuse, specular"},
        WrongHeader{"[\"ggx\"]", "[\"lambert\"]",
                    "7: unknown name \"lambert\" in brdfs; expected ggx, ggx_separable, beckmann, blinn_phong, ward, phong"},
        WrongHeader{"[\"down\", \"downwards\"]", "[\"down\", \"downwards\", { brdf = \"ward\" }]",
                    "14: choice \"down\" needs unknown brdf \"ward\"; expected ggx"},
        WrongHeader{"[\"down\", \"downwards\"]", "[\"down\", \"downwards\", { shape = \"disk\" }]",
                    "14: choice \"down\" needs unknown shape \"disk\"; expected rectangle, sphere"},
        WrongHeader{"[\"two_sided\"]", "[\"shiny\"]",
                    "8: unknown name \"shiny\" in effects; expected rectangle"},
        WrongHeader{"[\"lambert_sphere\"]", "[\"all\"]",
                    "9: unknown name \"all\" in exact; expected lambert_rectangle"},
        // options
        WrongHeader{"[[option]]", "[option]", "20: "},  //
        WrongHeader{"name = \"again\"", "name = \"way\"", "21: option \"way\" stands twice"},
        WrongHeader{"name = \"again\"", "name = \"effect\"", "21: an option cannot be named \"effect\""},
        WrongHeader{"name = \"again\"", "name = \"Again\"", "21: name \"Again\" is no name"},
        WrongHeader{"[\"down\", \"downwards\"]", "[\"up\", \"downwards\"]", "16: choice \"up\" stands twice"},
        WrongHeader{"[\"down\", \"downwards\"]", "[\"down\"]", "16: a choice is not a pair"},
        WrongHeader{"[\"down\", \"downwards\"]", "\"down\"", "16: a choice is not a pair"},
        WrongHeader{"[\"down\", \"downwards\"]", "[\"do wn\", \"downwards\"]",
                    "16: choice \"do wn\" is no name"},
        WrongHeader{"[\"down\", \"downwards\"]", "[\"down\", 1]", "16: the choice's line is not a string"},
        WrongHeader{", [\"yes\", \"twice\"]", "", "23: option \"again\" leaves no choice; expected two"},
        WrongHeader{"[[\"no\", \"once\"], [\"yes\", \"twice\"]]", "{ no = \"once\" }",
                    "23: choices is not an array"},
        WrongHeader{"name = \"again\"\nsummary = \"once more\"\nchoices = [[\"no\", \"once\"]",
                    "name = \"way_up\"\nsummary = \"once more\"\nchoices = [[\"no\", \"once\"]",
                    "34: unknown option \"again\""},
        // knobs
        WrongHeader{"[[knob]]", "[knob]", "25: knob is no array of tables; expected [[knob]]"},
        WrongHeader{"initial = 1", "initial = \"1\"", "29: initial is not a finite number"},
        WrongHeader{"initial = 1", "initial = nan", "29: initial is not a finite number"},
        WrongHeader{"max = 4", "max = inf", "31: max is not a finite number"},
        WrongHeader{"initial = 1", "initial = 5", "29: initial 5 is out of range; expected -2.5 to 4"},
        WrongHeader{"initial = 1", "initial = -3", "29: initial -3 is out of range"},
        WrongHeader{"max = 4", "max = -2.5", "31: max -2.5 is not above min -2.5"},
        WrongHeader{"label = \"Gain\"", "label = \"\"", "27: label is empty"},
        // tables and published
        WrongHeader{"{again}", "{agian}",
                    "34: unknown option \"agian\"; expected way, again (did you mean \"again\"?)"},
        WrongHeader{"{again}", "{again", "34: \"lobe_{way}_{again.exr\" lacks a }"},
        WrongHeader{"lobe_{way}", "../lobe_{way}",
                    "34: \"../lobe_{way}_{again}.exr\" is no file in glsl/tables/"},
        WrongHeader{"lobe = ", "Lobe = ", "34: table \"Lobe\" is no name"},
        WrongHeader{"\nway = \"down\"", "\nwey = \"down\"",
                    "37: unknown option \"wey\"; expected way, again"},
        WrongHeader{
            "\nway = \"down\"", "\nway = \"dawn\"",
            "37: unknown choice \"dawn\" of option way; expected up, down, along (did you mean \"down\"?)"},
        WrongHeader{"\nway = \"down\"", "\nway = 1", "37: way is not a string"}));

TEST(Technique, TwoChoicesWithOneDefineAreRefused) {
  const std::string clash = Replaced(Replaced(kHeader, "name = \"again\"", "name = \"way_a\""),
                                     "[\"along\", \"neither\"]", "[\"a_no\", \"neither\"]");
  EXPECT_THAT(ErrorOf(Replaced(clash, "{again}", "{way_a}")),
              StartsWith("20: WAY_A_NO would be defined twice"));
}

TEST(Technique, TwoKnobsOfOneNameAreRefused) {
  const std::string knob = "[[knob]]\nname = \"gain\"\nlabel = \"Gain\"\ninitial = 0\nmin = 0\nmax = 1\n\n";
  EXPECT_THAT(ErrorOf(Replaced(kHeader, "[tables]", knob + "[tables]")),
              StartsWith("34: knob \"gain\" stands twice"));
}

}  // namespace
}  // namespace arealab::technique_test
