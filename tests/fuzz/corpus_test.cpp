// Every seed of the corpus goes once through its target, so that a fault that was found once stays mended in
// every build.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/fuzz/shared/fuzz_target.h"
#include "tests/support/test_files.h"

namespace remote_touch::fuzz {
namespace {

namespace fs = std::filesystem;

class Corpus : public testing::TestWithParam<Target> {};

TEST_P(Corpus, IsReadOrRefusedInOneLine) {
  const fs::path folder = fs::path(REMOTE_TOUCH_SOURCE_DIR) / "tests/fuzz/corpus" / GetParam().name;
  const std::vector<std::string> seeds = files_in(folder);
  EXPECT_FALSE(seeds.empty()) << folder << " has no seeds";
  for (const std::string& seed : seeds) {
    SCOPED_TRACE(seed);
    EXPECT_NO_THROW(GetParam().read(bytes_of(folder / seed)));
  }
}

// A seed that is cut is what a killed writer leaves of a file, or a lost connection of a message. A seed that
// makes a library hang is left out, because it may still do so when it is cut.
TEST_P(Corpus, IsReadOrRefusedInOneLineWhereverItEnds) {
  constexpr std::size_t kCuts = 24;
  const fs::path folder = fs::path(REMOTE_TOUCH_SOURCE_DIR) / "tests/fuzz/corpus" / GetParam().name;
  for (const std::string& seed : files_in(folder)) {
    if (seed.starts_with("library-")) continue;
    const std::string bytes = bytes_of(folder / seed);
    for (std::size_t cut = 0; cut <= kCuts; ++cut) {
      const std::size_t last = std::min<std::size_t>(bytes.size(), 1);
      const std::size_t end = cut == kCuts ? bytes.size() - last : bytes.size() * cut / kCuts;
      SCOPED_TRACE(seed + ", its first " + std::to_string(end) + " bytes");
      EXPECT_NO_THROW(GetParam().read(bytes.substr(0, end)));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Corpus, testing::ValuesIn(targets()),
                         [](const auto& target) { return std::string(target.param.name); });

// A folder without a target would never be read.
TEST(CorpusFolders, EachHasATarget) {
  for (const std::string& folder : files_in(fs::path(REMOTE_TOUCH_SOURCE_DIR) / "tests/fuzz/corpus"))
    EXPECT_TRUE(std::any_of(targets().begin(), targets().end(), [&](const Target& target) {
      return target.name == folder;
    })) << folder;
}

}  // namespace
}  // namespace remote_touch::fuzz
