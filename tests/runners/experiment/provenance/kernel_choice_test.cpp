#include "runners/experiment/provenance/kernel_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/kernels/isa.h"
#include "tests/support/test_files.h"

namespace remote_touch::kernel_choice_test {
namespace {

namespace fs = std::filesystem;

class KernelChoiceTest : public testing::Test {
 protected:
  static std::size_t levels() { return supported_kernels().size(); }
  // Times in which the given level is the fastest.
  static LevelTimes times(std::size_t fastest) {
    LevelTimes made(levels(), 3e-5);
    made[fastest] = 1e-5;
    return made;
  }
  const Kernels& chosen(const fs::path& folder, std::size_t fastest) {
    return choose_kernels("", folder, [&] { return ++measured_, times(fastest); });
  }
  fs::path file() const { return folder_ / "cache" / (level_times_key() + ".levels"); }

  TestFolder folder_{"kernel_choice"};
  int measured_ = 0;
};

TEST_F(KernelChoiceTest, TheFastestIsMeasuredOnceAndKept) {
  if (levels() == 1) GTEST_SKIP() << "this machine has one level only: nothing to choose";
  for (std::size_t fastest = 0; fastest < levels(); ++fastest) {
    const fs::path cache = folder_ / std::to_string(fastest);
    EXPECT_EQ(&chosen(cache, fastest), supported_kernels()[fastest]);
    EXPECT_EQ(measured_, 1);
    EXPECT_EQ(&chosen(cache, 0), supported_kernels()[fastest]) << "from the cache, whatever is measured now";
    EXPECT_EQ(measured_, 1);
    measured_ = 0;
  }
}

TEST_F(KernelChoiceTest, AForcedLevelIsNeitherMeasuredNorKept) {
  for (const Kernels* kernels : supported_kernels())
    EXPECT_EQ(&choose_kernels(kernels->isa, folder_ / "cache", [&] { return ++measured_, times(0); }),
              kernels);
  EXPECT_EQ(measured_, 0);
  EXPECT_FALSE(fs::exists(folder_ / "cache"));
  EXPECT_HAS(refusal([&] { choose_kernels("x86-64-v9", folder_ / "cache"); }),
             "REMOTE_TOUCH_ISA = x86-64-v9: expected x86-64 up to x86-64");
}

// The file has one byte changed, is cut anywhere, is longer, is a folder, or is intact but holds times that
// are impossible.
TEST_F(KernelChoiceTest, DamagedFilesAreMeasuredAgain) {
  if (levels() == 1) GTEST_SKIP() << "this machine has one level only: nothing to choose";
  const std::size_t last = levels() - 1;
  chosen(folder_ / "cache", last);
  const std::string good = bytes_of(file()), name = "cache/" + file().filename().string();
  std::vector<std::string> damaged = {"", good + "x", good.substr(1), good + std::string(1 << 20, 'x')};
  for (std::size_t i = 0; i < good.size(); ++i) {
    damaged.push_back(good);
    damaged.back()[i] ^= 1;
    damaged.push_back(good.substr(0, i));
  }
  for (const std::string& bytes : damaged) {
    folder_.write(name, bytes);
    measured_ = 0;
    EXPECT_EQ(&chosen(folder_ / "cache", last), supported_kernels()[last]);
    EXPECT_EQ(measured_, 1) << bytes.size();
    ASSERT_EQ(bytes_of(file()), good);
  }
  for (const double wrong :
       {0.0, -1e-5, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    LevelTimes impossible = times(0);
    impossible.back() = wrong;
    ASSERT_TRUE(write_level_times(folder_ / "cache", level_times_key(), impossible));
    EXPECT_FALSE(read_level_times(folder_ / "cache", level_times_key(), levels())) << wrong;
  }
  fs::remove(file()), fs::create_directory(file());
  EXPECT_EQ(&chosen(folder_ / "cache", last), supported_kernels()[last]);
}

TEST_F(KernelChoiceTest, AnotherProcessorsTimesDoNotCount) {
  const fs::path cache = folder_ / "cache";
  ASSERT_TRUE(write_level_times(cache, "another", times(0)));
  EXPECT_TRUE(read_level_times(cache, "another", levels()));
  EXPECT_FALSE(read_level_times(cache, "another", levels() + 1)) << "of another number of levels";
  EXPECT_FALSE(read_level_times(cache, level_times_key(), levels()));
  fs::copy_file(cache / "another.levels", file());
  EXPECT_FALSE(read_level_times(cache, level_times_key(), levels())) << "the key is in the file, too";
}

TEST_F(KernelChoiceTest, AFolderThatCannotBeUsedIsNoError) {
  if (levels() == 1) GTEST_SKIP() << "this machine has one level only: nothing to choose";
  const fs::path plain = folder_.write("plain", "a file");
  for (const fs::path& folder : {fs::path(), plain, plain / "below", fs::path("/proc/none")}) {
    measured_ = 0;
    EXPECT_EQ(&chosen(folder, 1), supported_kernels()[1]);
    EXPECT_EQ(&chosen(folder, 0), supported_kernels()[0]);
    EXPECT_EQ(measured_, 2) << folder;
  }
}

TEST_F(KernelChoiceTest, TheKeyIsTheSameAtEveryStart) {
  EXPECT_EQ(level_times_key().size(), 64u);
  EXPECT_EQ(level_times_key(), level_times_key());
}

// The measurement itself: its result can be stored, and it chooses a level of this machine.
TEST_F(KernelChoiceTest, TheMachineIsMeasured) {
  const LevelTimes measured = time_supported_levels();
  ASSERT_EQ(measured.size(), levels());
  ASSERT_TRUE(write_level_times(folder_ / "cache", "k", measured));
  EXPECT_EQ(read_level_times(folder_ / "cache", "k", levels()), measured);
  const Kernels& kernels = choose_kernels("", folder_ / "cache");
  EXPECT_EQ(std::count(supported_kernels().begin(), supported_kernels().end(), &kernels), 1);
  EXPECT_EQ(speeds_text(LevelTimes(1, 1e-5)), "x86-64 1.00");
  if (levels() > 1) {
    EXPECT_EQ(speeds_text({3e-5, 2e-5}), "x86-64 1.00, x86-64-v3 1.50");
  }
}

}  // namespace
}  // namespace remote_touch::kernel_choice_test
