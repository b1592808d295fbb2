#include "runners/experiment/provenance/kernel_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>

#include "core/kernels/isa.h"
#include "tests/support/test_files.h"

namespace remote_touch::kernel_choice_test {
namespace {

// A processor whose clock advances only while it works: by a given time for each level, and by more while it
// is disturbed.
struct Processor {
  double now_s = 100;
  std::map<const Kernels*, double> needs_s = {};
  int calls = 0, disturbed_until_call = 0;

  KernelTask task(double factor) {
    return {"task", [this, factor](const Kernels& kernels) {
              const double extra_s = calls++ < disturbed_until_call ? 1e-3 * calls : 0;
              now_s += factor * needs_s.at(&kernels) + extra_s;
            }};
  }
  LevelTimes timed(std::vector<KernelTask> tasks, double max_s) {
    return time_levels(
        levels, tasks, [this] { return now_s; }, max_s);
  }
  // Any tables will do, because they are not called.
  std::vector<const Kernels*> levels = {&tables[0], &tables[1], &tables[2]};
  inline static const Kernels tables[3] = {kernels_for(Isa::x86_64), kernels_for(Isa::x86_64),
                                           kernels_for(Isa::x86_64)};
};

Processor processor(double first_s, double second_s, double third_s) {
  Processor made;
  made.needs_s = {{made.levels[0], first_s}, {made.levels[1], second_s}, {made.levels[2], third_s}};
  return made;
}

TEST(LevelTiming, IsTheGeometricMeanOfTheLeastTimes) {
  Processor machine = processor(8e-5, 4e-5, 2e-5);
  machine.disturbed_until_call = 12;  // two rounds of six calls
  const LevelTimes times = machine.timed({machine.task(1), machine.task(4)}, 1);
  ASSERT_EQ(times.size(), 3u);  // sqrt(1 * 4) of each; the clock at 100 s rounds to 2e-14
  EXPECT_NEAR(times[0], 16e-5, 1e-12);
  EXPECT_NEAR(times[1], 8e-5, 1e-12);
  EXPECT_NEAR(times[2], 4e-5, 1e-12);
  EXPECT_EQ(machine.calls, 20 * 6);
}

TEST(LevelTiming, EndsAfterTheTimeButNotBeforeThreeRounds) {
  Processor machine = processor(1e-3, 1e-3, 1e-3);
  machine.timed({machine.task(1)}, 9.5e-3);
  EXPECT_EQ(machine.calls, 4 * 3);  // a fourth round, as 9 ms have passed after three
  machine.calls = 0;
  machine.timed({machine.task(1)}, 0);
  EXPECT_EQ(machine.calls, 3 * 3);
}

TEST(LevelTiming, AClockThatStandsStillIsNoError) {
  Processor machine = processor(0, 0, 0);
  const LevelTimes times = machine.timed({machine.task(1)}, 1e-3);
  for (const double time_s : times) EXPECT_GT(time_s, 0);
  EXPECT_EQ(fastest_level(times), 0u);
}

TEST(FastestLevel, AHigherOneMustBeClearlyFaster) {
  EXPECT_EQ(fastest_level({1}), 0u);
  EXPECT_EQ(fastest_level({4, 2, 1}), 2u);
  EXPECT_EQ(fastest_level({4, 2, 1.99}), 1u);  // not clearly
  EXPECT_EQ(fastest_level({4, 2, 2.5}), 1u);   // AVX-512 loses
  EXPECT_EQ(fastest_level({4, 2, 1.94}), 2u);  // 2 / 1.03 = 1.9417
  EXPECT_EQ(fastest_level({4, 2, 1.943}), 1u);
  EXPECT_EQ(fastest_level({4, 5, 3.9}), 0u);  // compared with the one chosen so far
  EXPECT_EQ(fastest_level({4, 3.95, 3.85}), 2u);
  EXPECT_EQ(fastest_level({2, 2, 2}), 0u);
}

// The measured tasks do the real work, on every level, without an access that a sanitizer would stop.
TEST(KernelTasks, RunOnEveryLevelForAMeasurableTime) {
  const std::vector<KernelTask> tasks = representative_tasks();
  ASSERT_EQ(tasks.size(), 4u);
  for (const KernelTask& task : tasks)
    for (const Kernels* kernels : supported_kernels()) EXPECT_NO_THROW(task.run(*kernels)) << task.name;
}

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
