// The rules of the house that no compiler checks, each on the source tree and on a planted violation.
#include <gmock/gmock.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "glsl/effects.h"
#include "glsl/technique.h"
#include "tests/glsl/temporary_folder.h"

namespace arealab::house_test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

const fs::path kRoot = AREALAB_SOURCE_DIR;

// Includes run one way only: each room sees itself and those before it.
const std::vector<std::string> kRooms{"scenes", "glsl", "compare", "app"};

// Headers of graphics systems, by the first room that may see them.
const std::vector<std::pair<std::string, std::string>> kForeignHeaders{
    {"glad/", "glsl"}, {"GL/", "compare"}, {"EGL/", "compare"}, {"KHR/", "compare"},
    {"GLFW/", "app"},  {"imgui", "app"},   {"GLES", "nowhere"}, {"epoxy/", "nowhere"},
};

const std::set<std::string> kTopLevel{"CMakeLists.txt", "README.md", "LICENSE", "app",
                                      "compare",        "glsl",      "scenes",  "tests"};

struct Line {
  std::string file;  // relative to the root
  int number = 0;
  std::string text;

  std::string Complaint() const { return file + ":" + std::to_string(number) + ": " + text; }
};

bool HasExtension(const fs::path& file, const std::vector<std::string>& extensions) {
  return std::find(extensions.begin(), extensions.end(), file.extension()) != extensions.end();
}

std::vector<Line> LinesOf(const fs::path& root, const std::string& room,
                          const std::vector<std::string>& extensions) {
  std::vector<Line> lines;
  if (!fs::is_directory(root / room)) return lines;
  for (const auto& entry : fs::recursive_directory_iterator(root / room)) {
    if (!entry.is_regular_file() || !HasExtension(entry.path(), extensions)) continue;
    std::ifstream stream(entry.path());
    std::string text;
    for (int number = 1; std::getline(stream, text); ++number) {
      lines.push_back({fs::relative(entry.path(), root).generic_string(), number, text});
    }
  }
  return lines;
}

const std::vector<std::string> kHostText{".h", ".cpp"};
const std::vector<std::string> kShaderText{".glsl", ".frag", ".vert"};
const std::vector<std::string> kAllText{".h", ".cpp", ".glsl", ".frag", ".vert"};

// What follows `#` on a preprocessor line, without the blanks; nothing on another line.
std::string Directive(const std::string& line) {
  const auto hash = line.find_first_not_of(" \t");
  if (hash == std::string::npos || line[hash] != '#') return "";
  const auto word = line.find_first_not_of(" \t", hash + 1);
  return word == std::string::npos ? "" : line.substr(word);
}

// The name in #include "NAME" or <NAME>; nothing on another line.
std::string Included(const std::string& line) {
  const std::string directive = Directive(line);
  if (!directive.starts_with("include")) return "";
  const auto open = directive.find_first_of("\"<");
  if (open == std::string::npos) return "";
  const auto close = directive.find_first_of("\">", open + 1);
  return directive.substr(open + 1, close - open - 1);
}

std::ptrdiff_t Rank(const std::string& room) {
  return std::find(kRooms.begin(), kRooms.end(), room) - kRooms.begin();
}

bool IsBackwards(const std::string& included, const std::string& room) {
  if (included.find("..") != std::string::npos) return true;  // includes are root-relative
  const std::string target = included.substr(0, included.find('/'));
  const bool is_room = included.find('/') != std::string::npos && Rank(target) < std::ssize(kRooms);
  if (is_room) return Rank(target) > Rank(room);
  return std::any_of(kForeignHeaders.begin(), kForeignHeaders.end(), [&](const auto& header) {
    return included.starts_with(header.first) && Rank(header.second) > Rank(room);
  });
}

std::vector<std::string> BackwardIncludes(const fs::path& root) {
  std::vector<std::string> found;
  for (const std::string& room : kRooms) {
    for (const Line& line : LinesOf(root, room, kAllText)) {
      const std::string included = Included(line.text);
      if (!included.empty() && IsBackwards(included, room)) found.push_back(line.Complaint());
    }
  }
  return found;
}

// Dotfiles and what .gitignore keeps out (build folders, out/) are no part of the house.
std::vector<std::string> StrangersAtTheTop(const fs::path& root) {
  std::vector<std::string> found;
  for (const auto& entry : fs::directory_iterator(root)) {
    const std::string name = entry.path().filename().string();
    const bool ignored =
        name.starts_with('.') || (entry.is_directory() && (name.starts_with("build") || name == "out"));
    if (!ignored && !kTopLevel.contains(name)) found.push_back(name);
  }
  return found;
}

bool IsCondition(const std::string& directive) {
  return directive.starts_with("if") || directive.starts_with("elif");
}

// Undefined names count as 0 in an #if, in silence: shaders use names that are always defined, and never ask.
std::vector<std::string> AsksWhetherDefined(const fs::path& root) {
  std::vector<std::string> found;
  for (const Line& line : LinesOf(root, "glsl", kShaderText)) {
    const std::string directive = Directive(line.text);
    const bool asks = directive.starts_with("ifdef") || directive.starts_with("ifndef") ||
                      (IsCondition(directive) && directive.find("defined") != std::string::npos);
    if (asks) found.push_back(line.Complaint());
  }
  return found;
}

std::vector<std::string> Identifiers(const std::string& text) {
  std::vector<std::string> words;
  std::string word;
  for (const char c : text + " ") {
    const bool in_word = std::isalnum(static_cast<unsigned char>(c)) || c == '_';
    if (in_word) word += c;
    if (in_word || word.empty()) continue;
    if (!std::isdigit(static_cast<unsigned char>(word[0]))) words.push_back(word);
    word.clear();
  }
  return words;
}

// The names in the conditions of the shader text, each with a line that has it.
std::vector<std::pair<std::string, Line>> ConditionNames(const fs::path& root) {
  std::vector<std::pair<std::string, Line>> names;
  for (const Line& line : LinesOf(root, "glsl", kShaderText)) {
    std::string directive = Directive(line.text);
    if (!IsCondition(directive)) continue;
    directive = directive.substr(0, directive.find("//"));
    for (const std::string& word : Identifiers(directive)) {
      if (word != "if" && word != "elif") names.emplace_back(word, line);
    }
  }
  return names;
}

std::string Upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

std::set<std::string> EmittedEffects() {
  std::set<std::string> names;
  for (const Effect& effect : SceneEffects(Scene{})) names.insert(effect.Define());
  return names;
}

std::set<std::string> HostDefines(const std::vector<Technique>& techniques) {
  std::set<std::string> names = EmittedEffects();
  names.insert({"AREALAB_FLOAT", "AREALAB_DOUBLE", "AREALAB_DUAL", "PATH_LIT", "PATH_ABOVE", "PATH_CROSSING", "PATH_BELOW", "PATH_FAR", "PATH_NEAR"});
  for (const Brdf brdf : kDiffuseBrdfs) names.insert(Upper(std::string("diffuse_") + Name(brdf)));
  for (const Technique& technique : techniques) {
    for (const Option& option : technique.options) {
      for (const Choice& choice : option.choices) names.insert(Upper(option.name + "_" + choice.name));
    }
  }
  return names;
}

std::set<std::string> ShaderDefines(const fs::path& root) {
  std::set<std::string> names;
  for (const Line& line : LinesOf(root, "glsl", kShaderText)) {
    const std::string directive = Directive(line.text);
    const std::vector<std::string> words = Identifiers(directive);
    if (directive.starts_with("define") && words.size() > 1) names.insert(words[1]);
  }
  return names;
}

std::vector<std::string> UnknownConditions(const fs::path& root, const std::vector<Technique>& techniques) {
  const std::set<std::string> host = HostDefines(techniques);
  const std::set<std::string> shader = ShaderDefines(root);
  std::vector<std::string> found;
  for (const auto& [name, line] : ConditionNames(root)) {
    if (!host.contains(name) && !shader.contains(name)) found.push_back(line.Complaint());
  }
  return found;
}

// A technique is a file: no condition may name one, nor "TECHNIQUE".
std::vector<std::string> TechniqueLadders(const fs::path& root, const std::vector<Technique>& techniques) {
  const auto names_a_technique = [&](const std::string& word) {
    const std::string upper = Upper(word);
    return upper.find("TECHNIQUE") != std::string::npos ||
           std::any_of(techniques.begin(), techniques.end(),
                       [&](const Technique& t) { return upper == Upper(t.name); });
  };
  std::vector<std::string> found;
  for (const auto& [name, line] : ConditionNames(root)) {
    if (names_a_technique(name)) found.push_back(line.Complaint());
  }
  return found;
}

// Effects that the host emits and no shader reads.
std::vector<std::string> IdleEffects(const fs::path& root) {
  std::set<std::string> idle = EmittedEffects();
  for (const auto& [name, line] : ConditionNames(root)) idle.erase(name);
  return {idle.begin(), idle.end()};
}

std::vector<std::string> UnfinishedWork(const fs::path& root) {
  std::vector<std::string> found;
  for (const std::string& room : kRooms) {
    for (const Line& line : LinesOf(root, room, kAllText)) {
      for (const std::string& word : Identifiers(line.text)) {
        if (word == "TODO" || word == "FIXME" || word == "XXX" || word == "HACK")
          found.push_back(line.Complaint());
      }
    }
  }
  return found;
}

TEST(House, TheRoomsAreThere) {
  for (const std::string& room : kRooms) EXPECT_FALSE(LinesOf(kRoot, room, kHostText).empty()) << room;
  EXPECT_FALSE(LinesOf(kRoot, "glsl", kShaderText).empty());
}

TEST(House, IncludesRunOneWay) {
  EXPECT_THAT(BackwardIncludes(kRoot), IsEmpty());
}

TEST(House, BackwardIncludesAreFound) {
  const TemporaryFolder folder;
  folder.Write("scenes/a.h",
               "#include \"scenes/b.h\"\n#include <vector>\n\n  #  include \"glsl/program.h\"\n");
  folder.Write("scenes/b.cpp", "#include <GL/gl.h>\n#include <glad/gl.h>\n");
  folder.Write("glsl/a.cpp", "#include \"scenes/a.h\"\n#include <glad/gl.h>\n#include <EGL/egl.h>\n");
  folder.Write("glsl/a.glsl", "#include \"app/a.glsl\"\n");
  folder.Write("compare/a.cpp", "#include <EGL/egl.h>\n#include \"app/window.h\"\n");
  folder.Write("app/a.cpp",
               "#include \"compare/a.h\"\n#include <GLFW/glfw3.h>\n#include \"../scenes/a.h\"\n");
  EXPECT_THAT(BackwardIncludes(folder.path()),
              testing::UnorderedElementsAre(
                  "scenes/a.h:4:   #  include \"glsl/program.h\"", "scenes/b.cpp:1: #include <GL/gl.h>",
                  "scenes/b.cpp:2: #include <glad/gl.h>", "glsl/a.cpp:3: #include <EGL/egl.h>",
                  "glsl/a.glsl:1: #include \"app/a.glsl\"", "compare/a.cpp:2: #include \"app/window.h\"",
                  "app/a.cpp:3: #include \"../scenes/a.h\""));
}

TEST(House, TheTopLevelHoldsOnlyWhatIsAllowed) {
  EXPECT_THAT(StrangersAtTheTop(kRoot), IsEmpty());
}

TEST(House, StrangersAtTheTopAreFound) {
  const TemporaryFolder folder;
  folder.Write("README.md", "");
  folder.Write(".ci/run", "");
  folder.Write("build-debug/x", "");
  folder.Write("scripts/x", "");
  EXPECT_THAT(StrangersAtTheTop(folder.path()), ElementsAre("scripts"));
}

TEST(House, ShadersNeverAskWhetherANameIsDefined) {
  EXPECT_THAT(AsksWhetherDefined(kRoot), IsEmpty());
}

TEST(House, AskingWhetherDefinedIsFound) {
  const TemporaryFolder folder;
  folder.Write("glsl/a.glsl",
               "#ifdef A\n#endif\n  # ifndef B\n#endif\n#if A && defined(B)\n#endif\n#if A\n#endif\n");
  EXPECT_THAT(AsksWhetherDefined(folder.path()),
              ElementsAre("glsl/a.glsl:1: #ifdef A", "glsl/a.glsl:3:   # ifndef B",
                          "glsl/a.glsl:5: #if A && defined(B)"));
}

TEST(House, EveryNameInAConditionIsDefined) {
  EXPECT_THAT(UnknownConditions(kRoot, LoadTechniques(ShaderLibrary(kRoot / "glsl"))), IsEmpty());
}

TEST(House, EveryEffectIsRead) {
  EXPECT_THAT(IdleEffects(kRoot), IsEmpty());
}

TEST(House, UnknownAndIdleEffectsAreFound) {
  const TemporaryFolder folder;
  folder.Write("glsl/a.glsl",
               "#define SIZE 1\n#if SIZE > 0x1F && EFFECT_SPHERE // EFFECT_NOTE\n#elif EFFECT_SPERE\n#endif\n"
               "float EFFECT_DISK;  // no condition\n#if WAY_UP || AREALAB_DUAL\n#endif\n");
  Technique technique;
  technique.name = "toy";
  technique.options = {{"way", "", {{"up", ""}, {"down", ""}}}};
  EXPECT_THAT(UnknownConditions(folder.path(), {technique}),
              ElementsAre("glsl/a.glsl:3: #elif EFFECT_SPERE"));
  EXPECT_THAT(UnknownConditions(folder.path(), {}),
              ElementsAre("glsl/a.glsl:3: #elif EFFECT_SPERE", "glsl/a.glsl:6: #if WAY_UP || AREALAB_DUAL"));
  const std::vector<std::string> idle = IdleEffects(folder.path());
  EXPECT_EQ(std::count(idle.begin(), idle.end(), "EFFECT_DISK"), 1);
  EXPECT_EQ(std::count(idle.begin(), idle.end(), "EFFECT_SPHERE"), 0);
}

TEST(House, NoConditionNamesATechnique) {
  EXPECT_THAT(TechniqueLadders(kRoot, LoadTechniques(ShaderLibrary(kRoot / "glsl"))), IsEmpty());
}

TEST(House, TechniqueLaddersAreFound) {
  const TemporaryFolder folder;
  folder.Write("glsl/a.frag", "#if TECHNIQUE_LTC\n#elif TOY\n#elif TOYS\n#endif\n");
  Technique technique;
  technique.name = "toy";
  EXPECT_THAT(TechniqueLadders(folder.path(), {technique}),
              ElementsAre("glsl/a.frag:1: #if TECHNIQUE_LTC", "glsl/a.frag:2: #elif TOY"));
}

TEST(House, NothingIsLeftUnfinished) {
  EXPECT_THAT(UnfinishedWork(kRoot), IsEmpty());
}

TEST(House, UnfinishedWorkIsFound) {
  const TemporaryFolder folder;
  folder.Write("app/a.cpp", "int a;  // TODO: b\nint TODOS;\n");
  EXPECT_THAT(UnfinishedWork(folder.path()), ElementsAre("app/a.cpp:1: int a;  // TODO: b"));
}

}  // namespace
}  // namespace arealab::house_test
