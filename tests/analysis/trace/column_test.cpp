// Hashes of clouds and runs: what changes them, what does not, and that a difference persists to the end.

#include "analysis/trace/column.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>

#include "analysis/trace/trace.h"
#include "runners/experiment/simulation/simulation.h"
#include "tests/support/scenes.h"

namespace remote_touch::column_hash_test {
namespace {

TEST(Fingerprint, CloudHashDependsOnEveryBitButNotOnTheOrder) {
  PointCloud cloud = scenes::random_cloud(300, 0.1, 1);
  const std::uint64_t reference = points_hash(cloud);
  PointCloud turned = cloud;
  for (auto* column : {&turned.x, &turned.y, &turned.z}) std::reverse(column->begin(), column->end());
  EXPECT_EQ(points_hash(turned), reference);
  for (auto* column : {&cloud.x, &cloud.y, &cloud.z}) {
    const double kept = column->at(150);
    column->at(150) = std::nextafter(kept, 1);
    EXPECT_NE(points_hash(cloud), reference);
    column->at(150) = kept;
  }
  std::swap(cloud.x[3], cloud.x[4]);  // the same numbers, but other points
  EXPECT_NE(points_hash(cloud), reference);
  std::swap(cloud.x[3], cloud.x[4]);
  cloud.fixture_radius_m.assign(cloud.size(), 0);
  EXPECT_NE(points_hash(cloud), reference);
}

// The chain that the header describes, computed by hand.
TEST(Fingerprint, EqualsTheChainComputedByHand) {
  const std::vector<Column> columns = {{"a", "1", "", std::vector<double>{0.5, 2}},
                                       {"b", "1", "", std::vector<std::int32_t>{-1, 7, 8, 9}, 2, {}}};
  const std::uint64_t row0 = mixed(mixed(mixed(0, 0x3fe0000000000000u), ~std::uint64_t{0}), 7);
  const std::uint64_t row1 = mixed(mixed(mixed(0, 0x4000000000000000u), 8), 9);
  const std::uint64_t first = mixed(0, row0);
  EXPECT_EQ(running_hash(columns), (std::vector<std::uint64_t>{first, mixed(first, row1)}));
  EXPECT_EQ(mixed(0, 1), 0x9e3779b9e17d05acu);  // the value that any other program computes
}

TEST(Fingerprint, EqualNumbersHaveEqualHashes) {
  const auto of = [](double value) { return running_hash({{"a", "1", "", std::vector<double>{value}}}); };
  EXPECT_EQ(of(0.0), of(-0.0));
  EXPECT_EQ(of(std::nan("1")), of(-std::nan("2")));
  EXPECT_NE(of(0.0), of(5e-324));
}

TEST(Fingerprint, RunningHashDiffersFromTheFirstDifferenceOn) {
  const Trace trace = simulate(Experiment::load("fig4.12"));
  std::vector<Column> columns = trace.columns();
  columns.pop_back();
  const auto reference = running_hash(columns);
  for (const std::size_t tick : {std::size_t{0}, std::size_t{411}, trace.length() - 1}) {
    std::vector<Column> changed = columns;
    auto& force = std::get<std::vector<double>>(changed[3].values);
    force[3 * tick + 2] = std::nextafter(force[3 * tick + 2], 1);
    const auto hashes = running_hash(changed);
    for (std::size_t i = 0; i < hashes.size(); ++i) EXPECT_EQ(hashes[i] == reference[i], i < tick) << i;
  }
}

// Two seeds have other points in every frame, so their hashes differ in every tick. The hash of one run
// changes at each frame update and only there.
TEST(Fingerprint, TraceHasFrameHashesOnlyOnRequest) {
  SimulationOptions options;
  EXPECT_EQ(simulate(Experiment::load("fig4.12"), options).frame_hash.back(), 0u);
  options.hash_frames = true;
  const Trace one = simulate(Experiment::load("fig4.12"), options);
  const Trace other = simulate(Experiment::load("fig4.12", {"seed=2"}), options);
  for (std::size_t i = 0; i < one.length(); ++i) {
    EXPECT_NE(one.frame_hash[i], other.frame_hash[i]);
    EXPECT_EQ(i > 0 && one.frame_hash[i] != one.frame_hash[i - 1], one.frame_update(i));
  }
}

}  // namespace
}  // namespace remote_touch::column_hash_test

namespace remote_touch::sequence_log_test {
namespace {

struct Tick {
  int step;
  bool running;
  int missed;
  double sequence_distance_m = std::nan("");
};

// A tick every millisecond.
Trace trace_of(const std::vector<Tick>& ticks) {
  Trace trace;
  for (const Tick& tick : ticks) {
    RenderOutput out;
    GuidanceOutput guidance;
    guidance.sequence_distance_m = tick.sequence_distance_m,
    guidance.sequence_angle_rad = 30 * tick.sequence_distance_m;
    guidance.sequence_step = tick.step, guidance.sequence_running = tick.running;
    guidance.sequence_missed = tick.missed;
    out.guidance = guidance;
    trace.append(0.001 * static_cast<double>(trace.length()), {}, out, {});
  }
  return trace;
}

TEST(SequenceLog, IsEmptyWithoutATask) {
  Trace trace;
  trace.append(0, {}, {}, {});
  EXPECT_TRUE(sequence_log(trace).empty());
  EXPECT_TRUE(sequence_log(trace_of({{0, false, 0}, {0, false, 0}})).empty());
}

TEST(SequenceLog, HasTheTimesAtWhichAStepBeganAndEnded) {
  const auto log = sequence_log(trace_of({{0, false, 0}, {0, true, 0}, {0, true, 0}, {1, false, 0, 0.003}}));
  ASSERT_EQ(log.size(), 1u);
  EXPECT_EQ(log[0].began_s, 0.001);
  EXPECT_EQ(log[0].ended_s, 0.003);
  EXPECT_FALSE(log[0].missed);
  EXPECT_EQ(log[0].distance_m, 0.003);
  EXPECT_EQ(log[0].angle_rad, 30 * 0.003);
}

// One tick in which the first step reaches its deadline, the second begins and ends, and the third begins.
TEST(SequenceLog, OnlyTheRunningOneOfSeveralStepsInATickIsMissed) {
  const auto log = sequence_log(trace_of({{0, true, 0}, {2, true, 1}, {2, true, 1}}));
  ASSERT_EQ(log.size(), 3u);
  EXPECT_TRUE(log[0].missed);
  EXPECT_FALSE(log[1].missed);
  EXPECT_EQ(log[1].began_s, 0.001);
  EXPECT_EQ(log[1].ended_s, 0.001);
  EXPECT_EQ(log[2].step, 2);
  EXPECT_TRUE(std::isnan(log[2].ended_s));
  EXPECT_TRUE(std::isnan(log[0].distance_m)) << "has no goal";
}

}  // namespace
}  // namespace remote_touch::sequence_log_test
