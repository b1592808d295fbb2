#include "runners/experiment/provenance/level_timing.h"

#include <gtest/gtest.h>

#include <map>

#include "core/kernels/isa.h"
#include "runners/experiment/provenance/kernel_tasks.h"

namespace remote_touch::level_timing_test {
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

}  // namespace
}  // namespace remote_touch::level_timing_test
