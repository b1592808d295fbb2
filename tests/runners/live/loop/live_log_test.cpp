// The memory of a live run has a bound, however long it runs.
#include "runners/live/loop/live_log.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include "tests/support/test_files.h"

namespace remote_touch::live_log_test {
namespace {

// The disk accepts nothing, so the logger refuses a frame when too many wait.
TEST(LiveLogger, AcceptsNoMoreFramesThanCanWait) {
  const TestFolder folder("live_logger");
  SensorView view;
  view.camera = {2, 2, 2, 2, 1, 1};
  Ring<LiveTick> rows(4);
  LiveLogger logger(rows, 1000,
                    std::make_unique<SessionRecorder>(folder / "session.h5", view, RigidTransform::Identity(),
                                                      TextAttributes{{"config", "{}"}}));
  SensorFrame frame;
  frame.depth = {1000, 1000, 1000, 1000};
  int taken = 0;
  while (taken < 1000 && logger.record(frame, 0.03 * taken, 0)) ++taken;
  EXPECT_EQ(taken, 90);
  EXPECT_FALSE(logger.record(frame, 4, 0));
  logger.step();
  EXPECT_EQ(logger.failure(), "");
  EXPECT_TRUE(logger.record(frame, 5, 0)) << "those that waited are on the disk";
  logger.finish();
}

TEST(Samples, KeepsAllUpToTheirMaximum) {
  Samples samples;
  EXPECT_TRUE(std::isnan(samples.least()));
  for (int i = 0; i < 1000; ++i) samples.push_back(i % 100);
  EXPECT_EQ(samples.size(), 1000u);
  EXPECT_EQ(samples.kept().size(), 1000u);
  EXPECT_EQ(samples.least(), 0);
  EXPECT_EQ(samples.greatest(), 99);
}

TEST(Samples, KeepsAnEvenPartIfThereAreTooMany) {
  Samples samples;
  const std::size_t all = 5 * Samples::kMax / 2 + 3;
  for (std::size_t i = 0; i < all; ++i) samples.push_back(static_cast<double>(i));
  EXPECT_EQ(samples.size(), all);
  EXPECT_EQ(samples.greatest(), static_cast<double>(all - 1));
  ASSERT_LE(samples.kept().size(), Samples::kMax);
  ASSERT_GE(samples.kept().size(), Samples::kMax / 2);
  for (std::size_t i = 0; i < samples.kept().size(); ++i)
    ASSERT_EQ(samples.kept()[i], 4 * static_cast<double>(i));
}

TEST(GreatestOfPieces, EveryPieceHasItsGreatest) {
  GreatestOfPieces pieces;
  const int all = 10 * static_cast<int>(GreatestOfPieces::kPieces);
  for (int i = 0; i < all; ++i) pieces.push_back(i, i == 1234 ? 7 : 1);
  ASSERT_LE(pieces.greatest().size(), 2 * GreatestOfPieces::kPieces);
  ASSERT_GE(pieces.greatest().size(), GreatestOfPieces::kPieces);
  const double length = pieces.begin_s()[1] - pieces.begin_s()[0];
  for (std::size_t i = 0; i < pieces.greatest().size(); ++i) {
    const double begin = length * static_cast<double>(i);
    EXPECT_EQ(pieces.begin_s()[i], begin);
    EXPECT_EQ(pieces.greatest()[i], begin <= 1234 && 1234 < begin + length ? 7 : 1) << i;
  }
}

TEST(LiveLog, TheTraceEndsWhereItsRowsEndAndTheCountsGoOn) {
  LiveLog log;
  log.max_rows = 100;
  LiveTick tick;
  for (int i = 0; i < 1000; ++i) {
    tick.number = i, tick.step_s = 1e-6f * static_cast<float>(i);
    log.append(tick, 1000);
    EXPECT_EQ(log.is_whole(), i < 100);
  }
  EXPECT_EQ(log.trace.length(), 100u);
  EXPECT_EQ(log.row_step_s.size(), 100u);
  const LiveReport report = live_report(log, {});
  EXPECT_EQ(report.counts.front().value, 1000);
  EXPECT_EQ(report.times.front().count, 1000u);
  EXPECT_FLOAT_EQ(static_cast<float>(report.times.front().greatest), 999e-6f);
}

double count_of(const LiveReport& report, const std::string& name) {
  for (const auto& count : report.counts)
    if (count.name == name) return count.value;
  ADD_FAILURE() << name;
  return -1;
}

constexpr const char *kMissed = "missed deadlines, percent", *kProcessing = "processing of a frame, mean us",
                     *kPause = "longest pause between frames, ms", *kForce = "largest force written, N";

TEST(LiveReport, HasNoValueForWhatWasNotMeasured) {
  const LiveReport report = live_report({}, {});
  for (const char* name : {kMissed, kProcessing, kPause, kForce})
    EXPECT_TRUE(std::isnan(count_of(report, name))) << name;
  EXPECT_EQ(count_of(report, "ticks"), 0);
  EXPECT_EQ(count_of(report, "missed deadlines"), 0);
  const std::string shown = text(report);
  EXPECT_HAS(shown, std::string("  ") + kForce + std::string(35, ' ') + "none\n");
  EXPECT_HAS(shown, "0      none      none      none      none      none\n");
  EXPECT_EQ(shown.find("nan"), std::string::npos) << shown;
  const Figure figure = live_figure(report);
  EXPECT_TRUE(std::isnan(std::get<std::vector<double>>(figure.tables[1].columns[1].values).back()));
}

TEST(LiveReport, HasNoPauseWithOneFrame) {
  LiveCounts counts;
  counts.camera.received = 3, counts.camera.reversed = 2, counts.camera.processing_s = 0.004;
  const LiveReport one = live_report({}, counts);
  EXPECT_TRUE(std::isnan(count_of(one, kPause)));
  EXPECT_EQ(count_of(one, kProcessing), 4000);
  counts.camera.received = 4, counts.camera.max_pause_s = 0.5;
  EXPECT_EQ(count_of(live_report({}, counts), kPause), 500);
}

TEST(LiveReport, ATickWithoutForceIsMeasured) {
  LiveLog log;
  log.append({}, 1000);
  const LiveReport report = live_report(log, {});
  EXPECT_EQ(count_of(report, kMissed), 0);
  EXPECT_EQ(count_of(report, kForce), 0);
}

TEST(LiveLog, CountsTheTicksInWhichTheGateLimits) {
  LiveLog log;
  LiveTick tick;
  for (const bool is_limited : {false, true, true}) {
    tick.is_limited = is_limited;
    log.append(tick, 1000);
    ++tick.number;
  }
  EXPECT_EQ(log.limited_ticks, 2);
  EXPECT_EQ(count_of(live_report(log, {}), "ticks with a force or torque limited for safety"), 2);
}

TEST(LiveLog, ACloudOfASlowCameraIsStaleAfterTwoAndAHalfPeriods) {
  EXPECT_EQ(LiveLog::stale_after_s(30), 0.2);
  EXPECT_EQ(LiveLog::stale_after_s(2), 1.25);
  LiveLog log;
  log.stale_s = LiveLog::stale_after_s(2);
  LiveTick tick;
  for (int i = 0; i < 1300; ++i) {
    tick.number = i, tick.taken = i == 0 ? 0 : -1;
    log.append(tick, 1000);
  }
  EXPECT_EQ(log.stale_ticks, 1299 - 1250);
}

TEST(LiveLog, AFrameThatIsNotNewerThanTheOneBeforeIsReversed) {
  LiveLog log;
  LiveTick tick;
  for (const int taken : {3, -1, 4, 4, -1, 2, 5}) {  // -1: no frame
    tick.taken = taken;
    log.append(tick, 1000);
    ++tick.number;
  }
  EXPECT_EQ(log.reversed_frames, 2);
  EXPECT_EQ(log.latency_s.size(), 5u);
}

}  // namespace
}  // namespace remote_touch::live_log_test
