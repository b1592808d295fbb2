// The report about the frames of a recording.
#include "scenarios/recordings/frame_statistics.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <utility>

#include "core/geometry/colour.h"
#include "tests/support/test_files.h"

namespace remote_touch::frame_statistics_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// The image of a wall of 1 m x 1 m, points 1 cm apart, whose left border is at x.
PointCloud wall(double x, double z) {
  PointCloud cloud;
  cloud.image = ImageLayout{};  // image of some camera
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
  cloud.x[0] = cloud.y[0] = cloud.z[0] = kNan;  // not measured: its colour does not count
  statistics.add(1, cloud, 3);
  ASSERT_EQ(statistics.notes(3).size(), 1u);
  EXPECT_HAS(statistics.notes(3)[0].text, "2.5 % of the measured points have no colour (NaN)");
}

// Two frames have no colour image.
TEST(FrameStatistics, NotesFramesWithoutColours) {
  FrameStatistics statistics(4);
  PointCloud coloured = wall(0, 1), nothing = wall(0, 1);
  coloured.colour.assign(coloured.size(), 0xFF0000);
  nothing.x.assign(nothing.size(), kNan);
  statistics.add(0, coloured, 3);
  statistics.add(1, nothing, 3);  // no colour is missing, because it has no measured point
  EXPECT_TRUE(statistics.notes(3).empty());
  statistics.add(3, wall(0, 1), 3);
  statistics.add(2, wall(0, 1), 3);
  ASSERT_EQ(statistics.notes(3).size(), 1u);
  EXPECT_EQ(statistics.notes(3)[0].kind, "colours missing");
  EXPECT_EQ(statistics.notes(3)[0].text, "2 of 3 frames have no colours, the first is frame 2");
}

TEST(FrameStatistics, RecordingsWithoutColoursMissNone) {
  FrameStatistics statistics(1);
  statistics.add(0, wall(0, 1), 3);
  EXPECT_TRUE(statistics.notes(3).empty());
}

// Points of a lidar, x forward: z is no depth, and max_depth_m does not apply.
TEST(FrameStatistics, CloudsWithoutACameraHaveCoordinatesInsteadOfADepth) {
  FrameStatistics statistics(1);
  PointCloud cloud;
  for (const double x : {2.0, 30.0}) cloud.append({x, -1, x == 2 ? -1.5 : -0.25});
  statistics.add(0, cloud, 0.1);
  EXPECT_EQ(
      statistics.text(),
      "1 read: 100 % of 2 points measured, x 2 to 30 m, y -1 to -1 m, z -1.5 to -0.25 m, without colours");
  EXPECT_TRUE(statistics.notes(0.1).empty());
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
    for (const Note& note : notes)
      EXPECT_HAS(note.text, "beyond scenario.max_depth_m = 3 along the camera's axis");
  }
}

// Half of the wall remains in view if the camera moves by 0.5 m, and a tenth if it moves by 0.9 m.
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

// The second pair of frames is read first and has less in common.
TEST(FrameStatistics, NotesTheOverlapOfTheFirstPairInTheRecording) {
  FrameStatistics statistics(3);
  for (const auto& [frame, x] : {std::pair(2u, 5.0), {1u, 0.8}, {0u, 0.0}})
    statistics.add(frame, wall(x, 1), 3);
  ASSERT_EQ(statistics.notes(3).size(), 1u);
  const std::string text = statistics.notes(3)[0].text;
  EXPECT_HAS(text,
             "2 pair(s) of successive frames show different places, the first is frames 0 and 1: only ");
  EXPECT_EQ(text.find("only 0 %"), std::string::npos) << text;
}

// A wall that moves back and forth, by 1.2 mm to nearly a cell of 50 mm, counts as the same place, both at a
// border of the cells and between borders. A wall that moves by more than two cells counts as another place.
TEST(FrameStatistics, ASurfaceThatMovesALittleCountsAsTheSamePlace) {
  const auto notes = [](double at_m, double move_m) {
    FrameStatistics statistics(4);
    for (std::size_t frame = 0; frame < 4; ++frame)
      statistics.add(frame, wall(0, at_m + (frame % 2 == 0 ? -0.5 : 0.5) * move_m), 3);
    return statistics.notes(3);
  };
  for (const double move_m : {0.0012, 0.003, 0.01, 0.049})
    for (const double at_m : {0.5, 0.51, 0.525})
      EXPECT_TRUE(notes(at_m, move_m).empty()) << move_m << " at " << at_m;
  ASSERT_EQ(notes(0.5, 0.151).size(), 1u);
  EXPECT_EQ(notes(0.5, 0.151)[0].kind, "frames apart");
}

// All of the first frame is near the second, but little of the second is near the first.
TEST(FrameStatistics, NotesAFrameThatShowsMuchThatTheOtherDoesNot) {
  FrameStatistics statistics(2);
  PointCloud part = wall(0, 1);
  for (std::size_t i = 0; i < part.size(); ++i)
    if (i % 100 >= 30) part.x[i] = part.y[i] = part.z[i] = kNan;
  statistics.add(0, part, 3);
  statistics.add(1, wall(0, 1), 3);
  ASSERT_EQ(statistics.notes(3).size(), 1u);
  // The part has 6 of the 20 columns of cells, and one more is next to them.
  EXPECT_HAS(statistics.notes(3)[0].text, "only 35 % of the space that a frame shows");
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
