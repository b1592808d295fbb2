// The frames of a recording together: what they have in common, when they are shown, and the report about
// them.
#include "scenarios/recordings/recording.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/points/point_cloud.h"
#include "scenarios/recordings/frame_statistics.h"
#include "tests/support/test_files.h"

namespace remote_touch::frame_statistics_test {
namespace {

constexpr CameraIntrinsics kCamera = {4, 3, 10, 10, 1.5, 1};

PointCloud image(const CameraIntrinsics& camera, double depth_m) {
  DepthImage depth{camera.width, camera.height, {}};
  depth.z_m.assign(camera.pixels(), depth_m);
  return cloud_from_depth(depth, camera, RigidTransform::Identity());
}

PointCloud grid(int columns, int rows) {
  PointCloud cloud;
  for (int i = 0; i < columns * rows; ++i) cloud.append({-1.0, 0.1 * (i % columns), 0.1 * (i / columns)});
  cloud.grid_columns = columns;
  return cloud;
}

std::string problem(const PointCloud& first, PointCloud later) {
  return refusal([&] {
    conform(layout_of(first), "2.pcd", later);
    throw InputError("conforms");
  });
}

// The corner pixel is 1.5 columns from the centre: with a focal length of 16 instead of 10 px its point is
// 0.9 px off, with 17 px 1.05 px.
TEST(FrameLayout, LaterFramesAreLikeTheFirstOrRefused) {
  const auto seen_with = [](double focal_px) { return image({4, 3, focal_px, focal_px, 1.5, 1}, 1); };
  const PointCloud first = image(kCamera, 1);
  PointCloud unorganised = grid(4, 3), few = grid(5, 2);
  unorganised.grid_columns = few.grid_columns = 0;
  const std::string used = ", as the first frame that is used ";
  struct Row {
    PointCloud first, later;
    std::string text = "conforms";
  };
  const Row rows[] = {
      {first, image(kCamera, 2)},
      {first, image({2, 6, 10, 10, 1.5, 1}, 1),
       "2.pcd: has 2 x 6 points: expected 4 x 3 points" + used + "has"},
      {seen_with(16), seen_with(10)},
      {seen_with(17), seen_with(10), "2.pcd: has another camera than the first"},
      {first, grid(4, 3), "has another camera than the first frame that is used, or none"},
      {first, unorganised, "2.pcd: has points in no order: expected an organised cloud" + used + "is"},
      {grid(4, 3), unorganised, "2.pcd: has points in no order"},
      {unorganised, grid(4, 3), "2.pcd: is an organised cloud: expected points in no order" + used + "has"},
      {unorganised, first, "2.pcd: is an organised cloud"},
      {unorganised, {}},
      {unorganised, few},  // clouds without a camera may change their size
      {grid(4, 3), grid(5, 2)},
  };
  for (const Row& row : rows) EXPECT_HAS(problem(row.first, row.later), row.text);
}

// All frames are images, or none is: a camera that only later frames have is not used.
TEST(FrameLayout, HasNoCameraInAnyFrameIfTheFirstHasNone) {
  PointCloud later = image(kCamera, 1);
  later.grid_columns = 4;
  conform(layout_of(grid(4, 3)), "2.pcd", later);
  EXPECT_FALSE(later.image);
  EXPECT_EQ(later.columns(), 4);
}

// The frame has no measured point, or too few for a fit.
TEST(FrameLayout, FramesWithTooFewPointsForAFitHaveTheCameraOfTheFirst) {
  const FrameLayout layout = layout_of(image(kCamera, 1));
  PointCloud nothing, one_point = image(kCamera, 2);
  for (std::size_t i = 0; i < one_point.size(); ++i)
    if (i != 5) one_point.x[i] = one_point.y[i] = one_point.z[i] = std::nan("");
  one_point.image.reset(), one_point.grid_columns = 4;
  for (PointCloud* cloud : {&nothing, &one_point}) {
    conform(layout, "2.pcd", *cloud);
    ASSERT_TRUE(cloud->image);
    EXPECT_EQ(cloud->size(), 12u);
    EXPECT_EQ(cloud->image->camera.fx, 10);
    EXPECT_LT(cloud->image->pixel_slack, 1e-5);
  }
  EXPECT_TRUE(std::isnan(nothing.z[5]));
  EXPECT_EQ(one_point.z[5], 2);
  one_point.image.reset(), one_point.x[5] += 0.15;  // 0.75 px
  EXPECT_HAS(problem(image(kCamera, 1), one_point), "has another camera");
}

// The times at which the frames of a recording are shown.

using Playback = FrameTimes::Playback;

RecordingIndex stamped(const std::vector<double>& times_s) {
  RecordingIndex index;
  for (const double time_s : times_s) index.frames.push_back({time_s, {}, {}});
  index.is_stamped = true;
  index.frame_rate_hz = times_s.size() > 1 ? static_cast<double>(times_s.size() - 1) / times_s.back() : 30;
  return index;
}

RecordingIndex steady(int frames, double rate_hz) {
  RecordingIndex index;
  for (int j = 0; j < frames; ++j) index.frames.push_back({j / rate_hz, {}, {}});
  index.frame_rate_hz = rate_hz;
  return index;
}

std::vector<double> times_of(const FrameTimes& times, int frames) {
  std::vector<double> all;
  for (int i = 0; i < frames; ++i) all.push_back(times.captured_s(i));
  return all;
}

std::vector<std::size_t> sources_of(const FrameTimes& times, int frames) {
  std::vector<std::size_t> all;
  for (int i = 0; i < frames; ++i) all.push_back(times.source(i));
  return all;
}

// Frames 1 to 3 of four, 0.25 and 0.75 s apart: 2 Hz on average, so that a loop takes 1 + 0.5 s.
TEST(FrameTimes, AreTheStampsAlsoWhereThePartIsPlayedAgain) {
  const RecordingIndex index = stamped({0, 8, 8.25, 9});
  const InputPart part{"x", 1, -1};
  const FrameTimes hold(index, part, Playback::hold, 0), loop(index, part, Playback::loop, 0),
      ping_pong(index, part, Playback::ping_pong, 0);
  EXPECT_EQ(times_of(hold, 3), (std::vector<double>{0, 0.25, 1}));
  EXPECT_EQ(times_of(loop, 7), (std::vector<double>{0, 0.25, 1, 1.5, 1.75, 2.5, 3}));
  EXPECT_EQ(sources_of(loop, 7), (std::vector<std::size_t>{1, 2, 3, 1, 2, 3, 1}));
  EXPECT_EQ(times_of(ping_pong, 7), (std::vector<double>{0, 0.25, 1, 1.75, 2, 2.25, 3}));
  EXPECT_EQ(sources_of(ping_pong, 7), (std::vector<std::size_t>{1, 2, 3, 2, 1, 2, 3}));
  EXPECT_EQ(hold.rate_hz(), 2) << "the mean of the part, not of the recording";
}

TEST(FrameTimes, AreMultiplesOfThePeriodOfASteadyRecording) {
  const FrameTimes loop(steady(3, 30), {"x", 0, -1}, Playback::loop, 0);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(loop.captured_s(i), i / 30.0);
  EXPECT_FALSE(loop.follows_stamps());
}

TEST(FrameTimes, IgnoreTheStampsIfARateIsChosenOrThereIsOneFrame) {
  for (const Playback playback : {Playback::hold, Playback::loop, Playback::ping_pong}) {
    const FrameTimes single(stamped({0, 1, 5}), {"x", 1, 1}, playback, 0);
    EXPECT_EQ(single.captured_s(0), 0);
    EXPECT_EQ(single.source(0), 1u);
    EXPECT_FALSE(single.follows_stamps());
    const FrameTimes chosen(stamped({0, 1, 5}), {"x", 0, -1}, playback, 10);
    EXPECT_EQ(times_of(chosen, 3), (std::vector<double>{0, 1 / 10.0, 2 / 10.0}));
    EXPECT_EQ(chosen.rate_hz(), 10);
    EXPECT_EQ(chosen.text(), "10 Hz (recorded at 0.4 Hz)");
    EXPECT_FALSE(chosen.follows_stamps());
  }
}

// A pause is a time between frames that is nearer to two periods than to one, because a frame is missing.
TEST(FrameTimes, ReportTheRateThatIsPlayed) {
  const auto text = [](const RecordingIndex& index, double chosen_hz = 0) {
    return FrameTimes(index, {"x", 0, -1}, Playback::hold, chosen_hz).text();
  };
  EXPECT_EQ(text(steady(3, 30)), "30 Hz");
  EXPECT_EQ(text(steady(3, 30), 30), "30 Hz");
  EXPECT_EQ(text(stamped({0, 0.1, 0.2, 0.34})), "8.82353 Hz") << "uneven, but none is missing";
  EXPECT_EQ(text(stamped({0, 0.25, 0.5, 1.5, 1.75, 2})), "4 Hz with pauses of up to 1 s (2.5 Hz on average)");
  const RecordingIndex paused = stamped({0, 0.25, 0.5, 60, 60.25});
  EXPECT_EQ(FrameTimes(paused, {"x", 0, -1}, Playback::hold, 0).usual_rate_hz(), 4);
}

TEST(FrameTimes, APartThatIsTooFastIsRefused) {
  const RecordingIndex index = stamped({0, 1, 1 + 1.0 / 16384, 4});
  EXPECT_HAS(refusal([&] {
               FrameTimes(index, {"x", 1, 2}, Playback::hold, 0);
             }),
             "x: frames 1 to 2 have timestamps of more than 10000 frames a second: expected seconds");
}

// The report about the frames of a recording.

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

// Points of a lidar, x forward: z is no depth, and max_depth_m does not apply.
TEST(FrameStatistics, CloudsWithoutACameraHaveCoordinatesInsteadOfADepth) {
  FrameStatistics statistics(1);
  PointCloud cloud;
  for (const double x : {2.0, 30.0}) cloud.append({x, -1, x == 2 ? -1.5 : -0.25});
  statistics.add(0, cloud, 0.1);
  EXPECT_EQ(
      statistics.text(),
      "1 read: 100 % of 2 points measured, x 2 to 30 m, y -1 to -1 m, z -1.5 to -0.25 m, without colours");
  EXPECT_TRUE(statistics.notes(0.1).empty()) << "no colours are missing where there are none";
  FrameStatistics of_nothing(1);
  PointCloud nothing;
  nothing.append(Vec3::Constant(kNan));
  of_nothing.add(0, nothing, 3);
  EXPECT_EQ(of_nothing.text(), "1 read: 0 % of 1 points measured, without colours");
}

using Frames = std::vector<std::pair<std::size_t, PointCloud>>;

// Returns the notes on these frames, one on each line.
std::string notes_on(const Frames& frames) {
  FrameStatistics statistics(10);
  for (const auto& [frame, cloud] : frames) statistics.add(frame, cloud, 3);
  std::string text;
  for (const Note& note : statistics.notes(3)) text += note.kind + ": " + note.text + "\n";
  return text;
}

// Half of the wall remains in view if the camera moves by 0.5 m, and a tenth if it moves by 0.9 m.
TEST(FrameStatistics, NotesWhatIsUnusual) {
  PointCloud coloured = wall(0, 1), pale, nothing = wall(0, 1), far = wall(0, 1), part = wall(0, 1);
  coloured.colour.assign(coloured.size(), 0xFF0000), pale = coloured;
  for (std::size_t i = 0; i < 500; ++i) pale.colour[i] = kNoColour;
  pale.x[0] = pale.y[0] = pale.z[0] = kNan;  // not measured: its colour does not count
  nothing.x.assign(nothing.size(), kNan);
  for (std::size_t i = 0; i < 1000; ++i) far.z[i] = 4;
  PointCloud too_far = far;
  too_far.z[1000] = 4;
  for (std::size_t i = 0; i < part.size(); ++i)
    if (i % 100 >= 30) part.x[i] = part.y[i] = part.z[i] = kNan;
  const std::string pairs =
      "2 pair(s) of successive frames show different places, the first is frames 0 and 1: only ";
  const std::pair<Frames, std::string> rows[] = {
      {{{0, coloured}, {1, nothing}}, ""},  // no colour is missing, because it has no measured point
      {{{0, coloured}, {1, pale}}, "2.5 % of the measured points have no colour (NaN)"},
      {{{0, coloured}, {1, nothing}, {3, wall(0, 1)}, {2, wall(0, 1)}},
       "colours missing: 2 of 3 frames have no colours, the first is frame 2"},
      {{{0, far}}, ""},
      {{{0, too_far}}, "beyond scenario.max_depth_m = 3 along the camera's axis"},
      {{{0, wall(0, 1)}, {1, wall(0.5, 1)}, {2, wall(1, 1)}}, ""},
      {{{0, wall(0, 1)}, {1, wall(0.9, 1)}, {2, wall(1.8, 1)}}, pairs},
      {{{2, wall(5, 1)}, {1, wall(0.8, 1)}, {0, wall(0, 1)}}, pairs},  // the second pair is read first
      {{{0, wall(0, 1)}, {5, wall(5, 1)}},
       ""},  // they do not follow each other: a run reads the first for its path
      // All of the first is near the second: 6 of the 20 columns of cells, and one more is next to them.
      {{{0, part}, {1, wall(0, 1)}}, "only 35 % of the space that a frame shows"},
  };
  for (const auto& [frames, text] : rows) {
    const std::string notes = notes_on(frames);
    EXPECT_EQ(std::count(notes.begin(), notes.end(), '\n'), text.empty() ? 0 : 1) << notes;
    EXPECT_HAS(notes, text);
  }
  EXPECT_FALSE(contains(notes_on(rows[7].first), "only 0 %")) << "that is the second pair";
}

// A wall that moves back and forth, by 1.2 mm to nearly a cell of 50 mm, counts as the same place, both at a
// border of the cells and between borders. A wall that moves by more than two cells counts as another place.
TEST(FrameStatistics, ASurfaceThatMovesALittleCountsAsTheSamePlace) {
  const auto notes = [](double at_m, double move_m) {
    Frames frames;
    for (const double side : {-0.5, 0.5, -0.5, 0.5})
      frames.push_back({frames.size(), wall(0, at_m + side * move_m)});
    return notes_on(frames);
  };
  for (const double move_m : {0.0012, 0.003, 0.01, 0.049})
    for (const double at_m : {0.5, 0.51, 0.525})
      EXPECT_EQ(notes(at_m, move_m), "") << move_m << " at " << at_m;
  EXPECT_HAS(notes(0.5, 0.151), "frames apart: ");
}

}  // namespace
}  // namespace remote_touch::frame_statistics_test
