// The fuzzers' corpus through their targets, in every run: as it is, cut short, and with bytes changed.
#include <gtest/gtest.h>

#include <iterator>
#include <random>

#include "tests/fuzz/targets.h"

namespace arealab::corpus_test {
namespace {

class FuzzCorpus : public testing::TestWithParam<fuzz::Target> {};

TEST_P(FuzzCorpus, IsReadOrRefusedInALine) {
  const std::filesystem::path folder = std::filesystem::path(AREALAB_SOURCE_DIR) / "tests/fuzz/corpus" / GetParam().name;
  int seeds = 0;
  std::mt19937 random(20261127);
  const auto run = [&](const std::string& bytes, const std::string& what) {
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
    EXPECT_NO_THROW(GetParam().run({data, bytes.size()})) << what;
  };
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream in(entry.path(), std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(in), {});
    ASSERT_FALSE(bytes.empty());
    ++seeds;
    const std::string name = entry.path().filename().string();
    run(bytes, name);
    for (int i = 0; i < 6; ++i) {
      run(bytes.substr(0, 1 + random() % bytes.size()), name + ", cut short");
      std::string changed = bytes;
      for (int flips = 0; flips < 3; ++flips) changed[random() % changed.size()] = static_cast<char>(random());
      run(changed, name + ", changed");
    }
  }
  EXPECT_GE(seeds, 3);
}

INSTANTIATE_TEST_SUITE_P(Targets, FuzzCorpus, testing::ValuesIn(fuzz::kTargets),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace arealab::corpus_test
