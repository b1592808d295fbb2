// The memory of a live run has a bound, however long it runs.
#include "runners/live/loop/live_log.h"

#include <gtest/gtest.h>

#include <cmath>

#include "runners/live/loop/live_logger.h"
#include "runners/live/loop/live_report.h"
#include "tests/support/test_files.h"

namespace remote_touch::live_log_test {
namespace {

// A disk that takes nothing: the camera is told that its frame was not taken.
TEST(LiveLogger, TakesNoMoreFramesThanCanWait) {
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

TEST(Samples, AllUpToTheirMaximum) {
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
