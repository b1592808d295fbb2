// Recordings of a sensor that sends clouds of points.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "runners/experiment/sessions/sensor_frame.h"
#include "runners/experiment/sessions/session_file.h"
#include "tests/support/test_files.h"

namespace remote_touch::session_cloud_test {
namespace {

// The sensor sends clouds, and every frame has its own number of points.
TEST(SessionCloud, GivesBackCloudsWithAndWithoutNormalsAndColour) {
  for (const bool more : {false, true}) {
    const TestFolder folder("session_file");
    SensorView view;
    view.cloud = {more, 3, 100};
    view.has_colour = more;
    std::vector<SensorFrame> frames(3);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t points = i == 1 ? 0 : 3 * (i + 1);
      frames[i].number = static_cast<int>(i);
      for (std::size_t k = 0; k < points * view.cloud->numbers_per_point(); ++k)
        frames[i].points.push_back(static_cast<float>(k) / 3);
      if (more) frames[i].colour.assign(points, 0xff8000 + static_cast<std::uint32_t>(i));
    }
    frames[2].points[4] = std::numeric_limits<float>::quiet_NaN();
    SessionWriter writer(folder / "x.h5", view, RigidTransform::Identity(),
                         {{"config", R"({"haptic_rate_hz": 1000})"}});
    for (const SensorFrame& frame : frames) writer.append(frame, 0.1 * frame.number, 0);
    writer.finish();
    const SessionReader read(folder / "x.h5");
    ASSERT_TRUE(read.view().cloud);
    EXPECT_EQ(read.view().cloud->has_normals, more);
    EXPECT_EQ(read.view().cloud->grid_columns, 3);
    ASSERT_EQ(read.frame_count(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
      const SensorFrame frame = read.frame(i);
      EXPECT_TRUE(frame.depth.empty());
      EXPECT_EQ(frame.colour, frames[i].colour);
      ASSERT_EQ(frame.points.size(), frames[i].points.size());
      // Bit for bit, since one of the numbers is a NaN, which does not equal itself.
      for (std::size_t k = 0; k < frame.points.size(); ++k)
        EXPECT_EQ(std::bit_cast<std::uint32_t>(frame.points[k]),
                  std::bit_cast<std::uint32_t>(frames[i].points[k]));
      EXPECT_TRUE(is_complete(frame, read.view()));
    }
  }
}

// A frame must have all that its view promises before it is used.
TEST(SessionCloud, AFrameWithHalfAPointIsNotComplete) {
  SensorView view;
  view.cloud = {true, 0, 1};
  SensorFrame frame;
  frame.points.assign(12, 1);
  EXPECT_TRUE(is_complete(frame, view));
  frame.points.pop_back();
  EXPECT_FALSE(is_complete(frame, view));
  frame.points.assign(12, 1);
  view.has_colour = true;
  EXPECT_FALSE(is_complete(frame, view));
  frame.colour.assign(2, 0);
  EXPECT_TRUE(is_complete(frame, view));
}

}  // namespace
}  // namespace remote_touch::session_cloud_test
