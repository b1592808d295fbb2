// The report about the frames of a recording.
#include "scenarios/recordings/frame_statistics.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/cloud/colour.h"
#include "tests/support/test_files.h"

namespace remote_touch::frame_statistics_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// A wall of 1 m x 1 m, points 1 cm apart, whose left border is at x.
PointCloud wall(double x, double z) {
  PointCloud cloud;
  for (int row = 0; row < 100; ++row)
    for (int column = 0; column < 100; ++column) cloud.append({x + 0.01 * column, 0.01 * row, z});
  return cloud;
}

TEST(FrameStatistics, CountsMeasuredPointsOfAllFramesOnce) {
  FrameStatistics statistics(3);
  PointCloud first = wall(0, 1), second = wall(0, 2);
  for (std::size_t i = 0; i < 5000; ++i) first.x[i] = first.y[i] = first.z[i] = kNan;
  second.colour.assign(second.size(), 0);
  statistics.add(0, first, 3);
  statistics.add(1, second, 3);
  statistics.add(0, first, 3);  // read again
  EXPECT_EQ(statistics.frames_read(), 2u);
  EXPECT_EQ(statistics.text(), "2 read: 75 % of 20000 points measured, depth 1 to 2 m, with colours");
}

TEST(FrameStatistics, NotesPointsWithoutColour) {
  FrameStatistics statistics(2);
  PointCloud cloud = wall(0, 1);
  cloud.colour.assign(cloud.size(), 0xFF0000);
  statistics.add(0, cloud, 3);
  EXPECT_TRUE(statistics.notes(3).empty());
  for (std::size_t i = 0; i < 500; ++i) cloud.colour[i] = kNoColour;
  cloud.x[0] = cloud.y[0] = cloud.z[0] = kNan;  // it was not measured: its colour is not missed
  statistics.add(1, cloud, 3);
  ASSERT_EQ(statistics.notes(3).size(), 1u);
  EXPECT_HAS(statistics.notes(3)[0].text, "2.5 % of the measured points have no colour (NaN)");
}

TEST(FrameStatistics, HasNoDepthRangeWithoutAMeasurement) {
  FrameStatistics statistics(1);
  PointCloud nothing;
  nothing.append(Vec3::Constant(kNan));
  statistics.add(0, nothing, 3);
  EXPECT_EQ(statistics.text(), "1 read: 0 % of 1 points measured, without colours");
}

TEST(FrameStatistics, NotesPointsBeyondTheLimitAboveATenth) {
  for (const std::size_t beyond : {1000, 1001}) {
    FrameStatistics statistics(1);
    PointCloud cloud = wall(0, 1);
    for (std::size_t i = 0; i < beyond; ++i) cloud.z[i] = 4;
    statistics.add(0, cloud, 3);
    const std::vector<Note> notes = statistics.notes(3);
    ASSERT_EQ(notes.size(), beyond > 1000 ? 1u : 0u);
    for (const Note& note : notes) EXPECT_HAS(note.text, "beyond scenario.max_depth_m = 3");
  }
}

// A third of the wall remains in view when the camera moves by two thirds of it, then less.
TEST(FrameStatistics, NotesSuccessiveFramesThatShowDifferentPlaces) {
  for (const double step : {0.5, 0.9}) {
    FrameStatistics statistics(3);
    for (std::size_t frame = 0; frame < 3; ++frame)
      statistics.add(frame, wall(step * static_cast<double>(frame), 1), 3);
    const std::vector<Note> notes = statistics.notes(3);
    ASSERT_EQ(notes.size(), step > 0.7 ? 1u : 0u);
    for (const Note& note : notes)
      EXPECT_HAS(note.text,
                 "2 pair(s) of successive frames show different places, the first is frames 0 and 1");
  }
}

// Frames that do not follow each other may differ: a run reads the first frame for its path.
TEST(FrameStatistics, ComparesSuccessiveFramesOnly) {
  FrameStatistics statistics(10);
  statistics.add(0, wall(0, 1), 3);
  statistics.add(5, wall(5, 1), 3);
  EXPECT_TRUE(statistics.notes(3).empty());
}

}  // namespace
}  // namespace remote_touch::frame_statistics_test
