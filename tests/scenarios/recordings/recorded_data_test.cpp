// Readers against recorded sensor data, which are kept outside of the repository; skipped where they are
// missing.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "scenarios/recordings/recording.h"
#include "tests/support/recorded_data.h"

namespace remote_touch::recorded_data_test {
namespace {

namespace fs = std::filesystem;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

#define SKIP_WITHOUT(path) \
  if (!fs::exists(path)) GTEST_SKIP() << "recorded data are missing: " << (path)

double valid_percent(const PointCloud& cloud) {
  std::size_t valid = 0;
  for (const double z : cloud.z) valid += !std::isnan(z);
  return 100.0 * static_cast<double>(valid) / static_cast<double>(cloud.size());
}

void expect_organised(const PointCloud& cloud) {
  ASSERT_EQ(cloud.size(), 640u * 480u);
  ASSERT_TRUE(cloud.image);
  EXPECT_LT(cloud.image->pixel_slack, 1e-3);
  EXPECT_EQ(cloud.colour.size(), cloud.size());
}

TEST(RecordedData, OrganTable) {
  const fs::path path = data_root() / "rgbd/visp_organ_table";
  SKIP_WITHOUT(path);
  const RecordingIndex index = index_recording(path);
  EXPECT_EQ(index.frames.size(), 70u);
  EXPECT_EQ(index.frame_rate_hz, 30);
  const PointCloud cloud = read_frame(index, 0, kNoLimit);
  expect_organised(cloud);
  EXPECT_GE(valid_percent(cloud), 89.0);
  EXPECT_LE(valid_percent(cloud), 92.5);
  EXPECT_LT(valid_percent(read_frame(index, 0, 0.8)), valid_percent(cloud));
}

TEST(RecordedData, BoxesOnATable) {
  const fs::path path = data_root() / "rgbd/pcd_single/mosd_boxes_learn3.pcd";
  SKIP_WITHOUT(path);
  const RecordingIndex index = index_recording(path);
  ASSERT_EQ(index.frames.size(), 1u);
  const PointCloud cloud = read_frame(index, 0, kNoLimit);
  expect_organised(cloud);
  EXPECT_NEAR(valid_percent(cloud), 67.1, 0.05);
  EXPECT_NEAR(cloud.image->camera.fx, 525, 0.01);
  EXPECT_NEAR(cloud.image->camera.fy, 525, 0.01);
  EXPECT_NEAR(cloud.image->camera.cx, 319.5, 0.01);
  EXPECT_NEAR(cloud.image->camera.cy, 239.5, 0.01);
  double nearest_distance_m = kNoLimit, max_depth_m = 0;
  for (const double z : cloud.z) {
    if (z < nearest_distance_m) nearest_distance_m = z;
    if (z > max_depth_m) max_depth_m = z;
  }
  EXPECT_NEAR(nearest_distance_m, 0.52, 0.01);
  EXPECT_NEAR(max_depth_m, 1.33, 0.01);
}

TEST(RecordedData, LaptopSequence) {
  const fs::path path = data_root() / "rgbd/pcl_grabber_laptop";
  SKIP_WITHOUT(path);
  const RecordingIndex index = index_recording(path);
  ASSERT_EQ(index.frames.size(), 3u);
  EXPECT_EQ(index.frame_rate_hz, 3.79);
  for (std::size_t j = 0; j < 3; ++j) {
    const PointCloud cloud = read_frame(index, j, kNoLimit);
    expect_organised(cloud);
    EXPECT_NEAR(valid_percent(cloud), 88.35, 0.1);
    EXPECT_NEAR(cloud.image->camera.cx, 320, 0.01);
  }
}

TEST(RecordedData, TumOfficeFrame) {
  const fs::path path = data_root() / "rgbd/tum_office_frame";
  SKIP_WITHOUT(path);
  const RecordingIndex index = index_recording(path);
  ASSERT_EQ(index.frames.size(), 1u);
  const PointCloud cloud = read_frame(index, 0, kNoLimit);
  expect_organised(cloud);
  EXPECT_NEAR(valid_percent(cloud), 80.8, 0.05);
  EXPECT_EQ(cloud.image->camera.fy, 539.2);
}

}  // namespace
}  // namespace remote_touch::recorded_data_test
