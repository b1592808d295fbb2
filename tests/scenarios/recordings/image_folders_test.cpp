#include "scenarios/recordings/recording.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "tests/support/recorded_data.h"
#include "tests/support/test_files.h"

// The pairing of colour images with depth images of a folder.
namespace remote_touch::image_folders_test {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

class FolderFiles : public testing::Test {
 protected:
  void write(const Names& names) const {
    for (const std::string& name : names) folder_.write(name, "");
  }
  // Returns the names of the colour images, in the order of the depth images.
  Names colours() const {
    Names names;
    for (const fs::path& file : colour_images(files_in_order(folder_ / "depth", ".png"), folder_ / "rgb"))
      names.push_back(file.filename().string());
    return names;
  }
  std::string error() const {
    return refusal([&] { colours(); });
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  const TestFolder folder_{"folder_files_test"};
};

TEST_F(FolderFiles, EqualNamesBelongTogether) {
  write({"depth/1.png", "depth/2.png"});
  EXPECT_EQ(colours(), (Names{"", ""})) << "there are no colour images";
  write({"rgb/2.png", "rgb/a1.png"});
  EXPECT_EQ(colours(), (Names{"", "2.png"}));
}

TEST_F(FolderFiles, OtherNamesBelongTogetherByTheirNumbers) {
  write({"depth/frame-9.depth.png", "depth/frame-10.depth.png", "depth/frame-11.depth.png"});
  write({"rgb/f010.color.png", "rgb/f9.color.png"});
  EXPECT_EQ(colours(), (Names{"f9.color.png", "f010.color.png", ""}));
}

TEST_F(FolderFiles, AllNumbersCount) {
  write({"depth/k2_0001.png", "depth/k3_0001.png", "rgb/3_1.png", "rgb/2_1.png"});
  EXPECT_EQ(colours(), (Names{"2_1.png", "3_1.png"}));
  fs::remove(folder_ / "rgb/2_1.png"), fs::remove(folder_ / "rgb/3_1.png");
  write({"rgb/1.png"});
  EXPECT_HAS(error(),
             path("rgb/1.png") + ": it is not clear whether it belongs to " + path("depth/k2_0001.png"));
}

TEST_F(FolderFiles, ColourImagesWithoutExactlyOnePartnerAreRefused) {
  write({"depth/a_1.png", "depth/a_2.png", "rgb/1.jpg"});
  EXPECT_HAS(error(),
             path("rgb") + ": holds no .png file: expected the colour images of " + path("depth/a_1.png"));
  write({"rgb/7.png"});
  EXPECT_HAS(error(), path("rgb/7.png") + ": it is not clear whether it belongs to " + path("depth/a_1.png"));
  write({"rgb/b_1.png", "rgb/c_01.png"});
  EXPECT_HAS(error(),
             path("rgb/c_01.png") + ": it is not clear whether it belongs to " + path("depth/a_1.png"));
  fs::remove(folder_ / "rgb/c_01.png");
  EXPECT_EQ(colours(), (Names{"b_1.png", ""}));
  write({"depth/z_1.png"});
  EXPECT_HAS(error(),
             path("rgb/b_1.png") + ": it is not clear whether it belongs to " + path("depth/z_1.png"));
}

TEST_F(FolderFiles, LinksToNothingAreRefused) {
  write({"depth/1.png", "rgb/1.png"});
  for (const char* name : {"depth/2.png", "rgb/2.png", "rgb"}) {
    fs::remove_all(folder_ / name);
    fs::create_symlink("nowhere", folder_ / name);
    EXPECT_HAS(error(), path(name) + ": is a link to a file that does not exist: expected a file");
    fs::remove(folder_ / name);
  }
}

}  // namespace
}  // namespace remote_touch::image_folders_test

// Readers against recorded sensor data, which are kept outside of the repository; skipped where they are
// missing.
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
