// Bad luck: killed, no room, no right to write, a damaged cache, a shader that does not compile or never ends. Each time one
// line says so, and what was there before stays.
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <chrono>
#include <random>
#include <thread>

#include "tests/app/program.h"

namespace arealab::bad_luck_test {
namespace {

namespace fs = std::filesystem;
using FileBytes = std::map<std::string, std::string>;

// Without what differs from run to run: the date, times, and whether a truth came from the cache.
std::string Lasting(std::string text) {
  for (const std::string key : {"\"date\":", "\"seconds\":", "\"cached\":"}) {
    for (std::size_t at = 0; (at = text.find(key, at)) != std::string::npos;) {
      at += key.size();
      text.erase(at, text.find_first_of(",}\n", at) - at);
    }
  }
  return text;
}

FileBytes Lasting(FileBytes files) {
  for (const char* name : {"results.json", "index.html"}) files[name] = Lasting(files[name]);
  return files;
}

// The first file in which they differ, or nothing.
std::string Difference(const FileBytes& a, const FileBytes& b) {
  for (const auto& [name, bytes] : a) {
    if (!b.contains(name)) return name + " is missing";
    if (b.at(name) != bytes) return name + " differs";
  }
  for (const auto& [name, bytes] : b) {
    if (!a.contains(name)) return name + " is new";
  }
  return "";
}

// Every finished entry of a cache, with what changes where it is written again.
std::map<std::string, std::pair<ino_t, std::int64_t>> Entries(const fs::path& cache) {
  std::map<std::string, std::pair<ino_t, std::int64_t>> entries;
  std::error_code none;
  for (const auto& entry : fs::recursive_directory_iterator(cache, none)) {
    struct stat status {};
    const std::string name = entry.path().string();
    if (name.ends_with(".tmp") || stat(name.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) continue;
    entries[name] = {status.st_ino, 1000000000 * static_cast<std::int64_t>(status.st_mtim.tv_sec) + status.st_mtim.tv_nsec};
  }
  return entries;
}

class BadLuck : public ProgramTest {
 protected:
  static constexpr const char* kPoint = " gloss --size 24x24 --technique point --gpu none --context osmesa";

  // In the test's folder, so that command lines are the same wherever that is.
  Outcome Run(const std::string& arguments, const std::function<void()>& prepare = {}) const {
    return Arealab(arguments, [&] {
      if (chdir(folder_.c_str()) != 0) _exit(126);
      if (prepare) prepare();
    });
  }

  // A scene with apertures that is soon computed.
  void WriteYard() const {
    WriteFile("yard.toml",
              "[aperture]\nrays = 64\ncell = 0.2\n[camera]\nposition = [0.0, -4.0, 1.9]\ntarget = [0.0, 0.0, 0.2]\n[[material]]\nname = \"a\"\n"
              "[[surface]]\ntype = \"plane\"\nsize = [3.0, 3.0]\nmaterial = \"a\"\n[[surface]]\ntype = \"box\"\nsize = [0.5, 0.5, 1.0]\n"
              "material = \"a\"\n[[light]]\nshape = \"disk\"\nposition = [1.0, 0.5, 1.5]\ntarget = [0.0, 0.0, 0.0]\nradius = 0.4\nradiance = 5.0\n");
  }

  // An earlier report, to be found again.
  FileBytes MakeReport() const {
    const Outcome made = Run(std::string("compare") + kPoint + " --out out --cache cache");
    EXPECT_EQ(made.status, 0) << made.out;
    FileBytes files = Files("out");
    EXPECT_TRUE(files.contains("index.html"));
    return files;
  }
};

// What is there is the earlier report or the new one, whole; what was computed is used again; the run that is let finish gives
// the bits of one that nobody disturbed.
TEST_F(BadLuck, KilledAtTwentyRandomMoments) {
  constexpr unsigned kSeed = 20261127;
  constexpr int kRounds = 4, kKills = 5;
  WriteYard();
  const std::string command = "compare gloss yard.toml --size 64x64 --technique ltc --technique point --gpu none --context osmesa --out out --cache ";
  const auto seconds = [&] {
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(Run(command + "cache").status, 0);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  double whole = seconds(), cached = seconds();
  const FileBytes undisturbed = Lasting(Files("out"));

  std::mt19937 random(kSeed);
  std::size_t reused = 0, killed = 0;
  for (int round = 0; round < kRounds; ++round) {
    fs::remove_all(folder_ / "out");
    fs::remove_all(folder_ / "cache");
    const FileBytes earlier = round % 2 == 0 ? MakeReport() : FileBytes();
    if (round % 2 == 0) fs::remove_all(folder_ / "cache");
    for (int kill_number = 0; kill_number <= kKills; ++kill_number) {
      const auto before = Entries(folder_ / "cache");
      double& span = kill_number == 0 ? whole : cached;
      const double moment = span * std::uniform_real_distribution<double>(0.02, 0.98)(random);
      SCOPED_TRACE("seed " + std::to_string(kSeed) + ", round " + std::to_string(round) + ", after " + std::to_string(moment) + " s");
      if (kill_number < kKills) {
        const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
        const pid_t child = StartArealab(command + "cache", nowhere, [&] {
          if (chdir(folder_.c_str()) != 0) _exit(126);
        });
        close(nowhere);
        std::this_thread::sleep_for(std::chrono::duration<double>(moment));
        kill(child, SIGKILL);
        int status = 0;
        waitpid(child, &status, 0);
        killed += WIFSIGNALED(status);
        if (!WIFSIGNALED(status)) span *= 0.8;  // it had ended: the machine is quicker now
        ASSERT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) == 0);
      } else {
        const Outcome last = Run(command + "cache");
        ASSERT_EQ(last.status, 0) << last.out;
        EXPECT_EQ(last.out.find("damaged"), std::string::npos) << last.out;
      }
      const FileBytes now = Files("out");
      EXPECT_EQ(now == earlier ? "" : Difference(undisturbed, Lasting(now)), "");
      EXPECT_TRUE(now != earlier || kill_number < kKills);
      const auto after = Entries(folder_ / "cache");
      for (const auto& [name, written] : before) {
        if (!after.contains(name)) continue;  // rows that became a whole picture
        ++reused;
        EXPECT_EQ(after.at(name), written) << name << " was written again";
      }
    }
    EXPECT_EQ(Names(), (std::vector<std::string>{"cache", "out", "yard.toml"}));  // what was half-filled is gone
  }
  EXPECT_GT(killed, 8u);
  EXPECT_GT(reused, 20u);
}

// No room for a file of more than so many bytes, as on a disk that fills up.
std::function<void()> RoomFor(rlim_t bytes) {
  return [bytes] {
    signal(SIGXFSZ, SIG_IGN);  // the write fails instead
    const rlimit limit{bytes, bytes};
    setrlimit(RLIMIT_FSIZE, &limit);
  };
}

// A folder's owner without the right to write in it; root loses the right to do so all the same.
void ObeyPermissions() {
  constexpr unsigned long kDacOverride = 1;  // CAP_DAC_OVERRIDE
  prctl(PR_CAPBSET_DROP, kDacOverride, 0, 0, 0);
}

TEST_F(BadLuck, AFullDiskIsALineAndTheEarlierReportStays) {
  const FileBytes earlier = MakeReport();
  for (const rlim_t bytes : {0, 300, 3000, 20000}) {  // fails at the first file, at the pictures, at the tables, at the page
    SCOPED_TRACE(bytes);
    ExpectRefused(Run("compare gloss --size 24x24 --technique ltc --gpu none --context osmesa --out out --cache other", RoomFor(bytes)),
                  "expected a folder with room");
    EXPECT_EQ(Difference(earlier, Files("out")), "");
    fs::remove_all(folder_ / "other");
  }
  EXPECT_EQ(Names(), (std::vector<std::string>{"cache", "out"}));
}

TEST_F(BadLuck, AFullDiskLeavesOtherCommandsEarlierFiles) {
  const std::vector<std::pair<std::string, std::string>> commands = {
      {"render gloss --technique ltc --size 24x24 --context osmesa -o made/a.exr", "made/a.exr: cannot be written"},
      {"render gloss --technique ltc --size 24x24 --context osmesa -o made/a.png", "made/a.png: cannot be written"},
      {"check gloss --technique ltc --golden made/golden --out made --update", "cannot be written"},
      {"export gloss --technique ltc --target essl300 --out made/export", "not writable"},
      {"fit --table ltc_ggx_polygon --table-size 4 --out made/tables", "cannot be written"},
      {"stress --technique point --cases 500 --out made/stress", "cannot be written"},
      {"sweep roughness --values 0.3 --technique point --size 16x16 --seconds 0 --cache cache --out made/sweep", "cannot be written"}};
  for (const auto& [command, message] : commands) {
    SCOPED_TRACE(command);
    fs::create_directories(folder_ / "made");
    const Outcome whole = Run(command);
    ASSERT_EQ(whole.status, 0) << whole.out;
    const FileBytes earlier = Files("made");
    ASSERT_FALSE(earlier.empty());
    const std::string again = command.starts_with("check") ? command + " --glsl " + Path("glsl") : command;
    if (command.starts_with("check")) {
      // What it draws must have changed, or nothing is written.
      std::ifstream in(std::string(AREALAB_SOURCE_DIR) + "/glsl/techniques/point.glsl");
      WriteFile("glsl/techniques/ltc.glsl", std::string(std::istreambuf_iterator<char>(in), {}));
    }
    ExpectRefused(Run(again, RoomFor(10)), message);
    EXPECT_EQ(Difference(earlier, Files("made")), "");
    fs::remove_all(folder_ / "made");
  }
}

TEST_F(BadLuck, AFullStandardOutputIsNotSuccess) {
  EXPECT_EQ(Run("list --json >/dev/full").status, 2);
}

TEST_F(BadLuck, AReadOnlyFolderIsALineAndTheEarlierReportStays) {
  fs::create_directories(folder_ / "place");
  const std::string compare = std::string("compare") + kPoint + " --out place/out --cache cache";
  ASSERT_EQ(Run(compare).status, 0);
  ASSERT_EQ(Run("render gloss --size 24x24 --context osmesa -o place/out/a.exr").status, 0);
  const FileBytes earlier = Files("place");
  const auto permit = [&](fs::perms rights) {
    fs::permissions(folder_ / "place", rights);
    fs::permissions(folder_ / "place/out", rights);
  };
  permit(fs::perms::owner_read | fs::perms::owner_exec);
  ASSERT_NE(Run("--version >place/probe", ObeyPermissions).status, 0) << "the folder is not read-only: the test cannot fail";
  ExpectRefused(Run(compare, ObeyPermissions), "cannot be written to");
  ExpectRefused(Run("compare" + std::string(kPoint) + " --out place/new --cache cache", ObeyPermissions), "cannot be written to");
  ExpectRefused(Run("render gloss --size 24x24 --context osmesa -o place/out/a.exr", ObeyPermissions), "Permission denied");
  ExpectRefused(Run("export gloss --out place/export", ObeyPermissions), "place/export");
  ExpectRefused(Run("stress --technique point --cases 500 --out place/out", ObeyPermissions), "Permission denied");
  ExpectRefused(Run("sweep roughness --values 0.3 --technique point --size 16x16 --seconds 0 --cache cache --out place/sweep", ObeyPermissions), "place/sweep");
  ExpectRefused(Run("fit --table ltc_ggx_polygon --table-size 4 --out place/tables", ObeyPermissions), "place/tables");
  EXPECT_EQ(Difference(earlier, Files("place")), "");
  permit(fs::perms::owner_all);
}

TEST_F(BadLuck, ACacheThatCannotBeWrittenCostsTheStoringAlone) {
  WriteFile("cache", "a file where the folder should be");
  const Outcome outcome = Run(std::string("compare") + kPoint + " --out out --cache cache");
  EXPECT_EQ(outcome.status, 0) << outcome.out;
  EXPECT_EQ(ReadJson("out/results.json").at("scenes").size(), 1u);
}

// Damaged entries are made anew, with a line that says so, and the figures are the same; entries of another layout too.
TEST_F(BadLuck, ADamagedCacheIsMadeAnew) {
  WriteYard();
  const std::string command = "compare yard.toml --size 24x24 --technique ltc --gpu bonaire --context osmesa --out out --cache cache";
  ASSERT_EQ(Run(command).status, 0);
  const FileBytes undisturbed = Lasting(Files("out"));
  const FileBytes entries = Files("cache");
  ASSERT_GT(entries.size(), 5u);  // truth, shadows, apertures, cycles
  const std::vector<std::function<std::string(std::string)>> damages = {
      [](std::string bytes) { return bytes.substr(0, bytes.size() / 2); }, [](const std::string&) { return std::string(); },
      [](std::string bytes) { return bytes + "x"; },
      [](std::string bytes) {
        bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 4);
        return bytes;
      },
      [](std::string bytes) { return "ALCACHE0" + bytes.substr(8); },  // another version's
      [](const std::string&) { return std::string("\0\xff not ours", 11); }};
  for (std::size_t shift = 0; shift < damages.size(); shift += 3) {  // each entry damaged in two ways, all in all ways
    std::size_t entry = shift;
    for (const auto& [name, bytes] : entries) std::ofstream(folder_ / "cache" / name, std::ios::binary) << damages[entry++ % damages.size()](bytes);
    const Outcome outcome = Run(command);
    EXPECT_EQ(outcome.status, 0) << outcome.out;
    EXPECT_NE(outcome.out.find("damaged entries were made anew"), std::string::npos) << outcome.out;
    EXPECT_EQ(Difference(undisturbed, Lasting(Files("out"))), "");
  }
  const Outcome healed = Run(command);
  EXPECT_EQ(healed.out.find("damaged"), std::string::npos) << healed.out;
  EXPECT_TRUE(ReadJson("out/results.json").at("scenes").at(0).at("truth").at("cached").get<bool>());
}

// The author's own shader. Each of the commands that draw it says what is wrong in a line.
constexpr const char* kHeader =
    "/*---\nsummary = \"s\"\ncitation = \"c\"\nauthor_note = \"n\"\nshapes = [\"rectangle\", \"disk\", \"sphere\"]\n"
    "lobes = [\"diffuse\", \"specular\"]\nbrdfs = [\"ggx\"]\neffects = [\"fresnel\"]\n---*/\n#include \"surface.glsl\"\n"
    "Radiance ShadeLight(Surface surface, Light light, vec3 to_view) {\n";

TEST_F(BadLuck, AShaderThatDoesNotCompileIsALine) {
  const FileBytes earlier = MakeReport();
  WriteFile("glsl/techniques/mine.glsl", std::string(kHeader) + "  return Radiance(surface.difuse_albedo, vec3(0.0));\n}\n");
  const std::string place = "techniques/mine.glsl:12: ", mine = " --technique mine --glsl glsl --context osmesa";
  ExpectRefused(Run("compare gloss --size 24x24 --gpu none --out out --cache cache" + mine), place);
  ExpectRefused(Run("render gloss --size 24x24 -o a.exr" + mine), place);
  ExpectRefused(Run("stress --cases 500" + mine), place);
  EXPECT_EQ(Difference(earlier, Files("out")), "");
  EXPECT_EQ(Names(), (std::vector<std::string>{"cache", "glsl", "out"}));
}

TEST_F(BadLuck, AShaderThatNeverEndsIsALine) {
  const FileBytes earlier = MakeReport();
  // llvmpipe leaves a shader's loops after 65535 rounds: these take a minute together.
  WriteFile("glsl/techniques/mine.glsl",
            std::string(kHeader) +
                "  float x = surface.alpha;\n  while (x < 9.0) x = sin(cos(sin(cos(sin(cos(sin(cos(sin(cos(x + to_view.x))))))))));\n"
                "  return Radiance(vec3(x), vec3(0.0));\n}\n");
  const auto soon = [] { setenv("AREALAB_SHADER_SECONDS", "1", 1); };
  const std::string line = "techniques/mine.glsl:1: the shader has not ended after 1 s; expected", mine = " --technique mine --glsl glsl --context osmesa";
  ExpectRefused(Run("compare gloss --size 256x256 --gpu none --out out --cache cache" + mine, soon), line);
  ExpectRefused(Run("render gloss --size 256x256 -o a.exr" + mine, soon), line);
  ExpectRefused(Run("stress --cases 100000" + mine, soon), line);
  EXPECT_EQ(Difference(earlier, Files("out")), "");
  EXPECT_EQ(Names(), (std::vector<std::string>{"cache", "glsl", "out"}));
}

}  // namespace
}  // namespace arealab::bad_luck_test
