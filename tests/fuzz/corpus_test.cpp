// Every seed of the corpus goes once through its target, so that a fault that was found once stays mended in
// every build; and the child process of libFuzzer's programs.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <stdexcept>

#include "tests/fuzz/shared/fuzz_target.h"
#include "tests/fuzz/shared/lasting_child.h"
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

// Misbehaves as a library may that reads a damaged file.
std::string misbehave(const std::string& how) {
  static int count = 0;
  if (how == "count") return std::to_string(++count);
  if (how == "throw") throw std::runtime_error("no such thing");
  if (how == "crash") std::raise(SIGSEGV);
  if (how == "fill") return std::string(std::size_t{1} << 30, 'x').substr(0, 1);
  if (how == "end") ::_exit(0);
  return how;
}

// A child that reads many files answers like a child that begins anew for each of them.
TEST(LastingChild, ReportsEachEndLikeAChildPerQuestion) {
  const auto told = [](const RunInChild& run, const std::string& question) -> std::string {
    try {
      return "answered " + run({256u << 20, 1}, misbehave, question);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  };
  LastingChild child;
  const std::string long_text(1'000'000, 'x');  // more than a pipe takes at once
  for (const std::string& question :
       {std::string(), long_text, std::string("a\0b\n", 4), std::string("throw")})
    EXPECT_EQ(told(std::ref(child), question), told(in_own_child, question));
  for (int i = 1; i < 4; ++i) EXPECT_EQ(told(std::ref(child), "count"), "answered " + std::to_string(i));
  EXPECT_EQ(child.begun(), 1);
  for (const std::string question : {"crash", "fill", "end"}) {
    EXPECT_EQ(told(std::ref(child), question), told(in_own_child, question)) << question;
    EXPECT_HAS(told(std::ref(child), "count"), "answered ");  // the next question is read as ever
  }
  EXPECT_EQ(child.repeated(), 3);
}

}  // namespace
}  // namespace remote_touch::fuzz
