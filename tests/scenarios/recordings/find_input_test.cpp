// The inputs of a run: where they are searched, what is no input, and recorded sensor data.
#include "scenarios/recordings/recording.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/recorded_data.h"
#include "tests/support/test_files.h"

namespace remote_touch::find_input_test {
namespace {

namespace fs = std::filesystem;

class FindRecording : public testing::Test {
 protected:
  FindRecording() { fs::create_directory(folder_ / "here"), fs::current_path(folder_ / "here"); }
  ~FindRecording() override { fs::current_path(before_), set_data_folder({}); }

  const fs::path before_ = fs::current_path();
  const TestFolder folder_{"find_input"};
};

TEST_F(FindRecording, LooksHereAndThenBelowTheDataFolder) {
  set_data_folder((folder_ / "data").string());
  folder_.write("data/a.png", ""), folder_.write("data/scans/b.png", ""), folder_.write("here/a.png", "");
  EXPECT_EQ(find_input("a.png"), "a.png") << "here comes first";
  EXPECT_EQ(find_input("scans/b.png"), (folder_ / "data/scans/b.png").string());
  const std::string whole = (folder_ / "data/a.png").string();
  EXPECT_EQ(find_input(whole), whole);
}

TEST_F(FindRecording, ReportsTheSearchedFolders) {
  const std::string places = "no such recording, image or mesh: expected a folder or file here or below ";
  EXPECT_EQ(refusal([] { find_input("a.png"); }), "a.png: " + places + "REMOTE_TOUCH_DATA (not set)");
  set_data_folder("/data");
  EXPECT_EQ(refusal([] { find_input("a.png"); }), "a.png: " + places + "REMOTE_TOUCH_DATA = /data");
  EXPECT_EQ(input_places(), "here or below REMOTE_TOUCH_DATA = /data");
  EXPECT_THROW(find_input("/a.png"), MissingInput);
}

TEST_F(FindRecording, ANameThatNoFileCanHaveIsMissing) {
  set_data_folder((folder_ / "data").string());
  EXPECT_THROW(find_input(std::string(5000, 'x')), MissingInput);
}

// Their digest would never end.
TEST_F(FindRecording, RefusesPipesDevicesAndPartsThatAreNoFiles) {
  set_data_folder((folder_ / "data").string());
  folder_.write("data/trace.csv", ""), folder_.write("here/scan/depth/0000.png", "");
  EXPECT_EQ(find_input("trace.csv"), (folder_ / "data/trace.csv").string());
  folder_.write("here/scan/camera.json", R"({"width": 3, "height": 2, "fx": 10, "fy": 20, "cx": 1, "cy": 0.5,
                                             "depth_scale_m": 0.001, "frame_rate_hz": 20})");
  EXPECT_EQ(files_of({"scan"}).size(), 2u);
  const std::string problem = "cannot be read (a pipe or a device)";
  fs::create_symlink("/dev/zero", folder_ / "data/zero.csv");
  ASSERT_EQ(::mkfifo((folder_ / "here/pipe.csv").c_str(), 0600), 0);
  for (const char* name : {"pipe.csv", "zero.csv"}) {
    EXPECT_HAS(refusal([&] { find_input(name); }), problem + ": expected a file");
    EXPECT_HAS(refusal([&] { files_of({name}); }), problem + ": expected a file");
  }
  fs::create_symlink("/dev/zero", folder_ / "here/scan/depth/0001.png");
  EXPECT_HAS(refusal([] { files_of({"scan"}); }), "0001.png: " + problem);
  fs::remove(folder_ / "here/scan/depth/0001.png"), fs::remove(folder_ / "here/scan/camera.json");
  ASSERT_EQ(::mkfifo((folder_ / "here/scan/camera.json").c_str(), 0600), 0);
  EXPECT_HAS(refusal([] { files_of({"scan"}); }), "camera.json: " + problem);
  for (const char* name : {"mesh.obj", "poses.txt", "session.h5", "folder.csv"}) {
    fs::create_directory(name);
    EXPECT_HAS(refusal([&] { files_of({name}); }), "cannot be read (a folder): expected a file") << name;
  }
}

// The digest of such a file would take minutes, only for the reader to refuse it.
TEST_F(FindRecording, RefusesFilesThatNoReaderAccepts) {
  const auto refused = [&](const std::string& name, std::uintmax_t bytes) {
    folder_.write("here/" + name, "");
    fs::resize_file(name, bytes);  // takes no blocks on the disk
    return refusal([&] { files_of({name}); });
  };
  const std::uintmax_t text = 16 << 20, mesh = std::uintmax_t{2} << 30;
  for (const std::string name : {"a.csv", "a.traj", "a.txt", "a.tum"}) {
    EXPECT_EQ(refused(name, text), "no InputError");
    EXPECT_HAS(refused(name, text + 1), name + ": is longer than 16 MiB: expected a shorter text");
  }
  for (const std::string name : {"a.obj", "a.PLY", "a.stl"}) {
    EXPECT_EQ(refused(name, mesh), "no InputError");
    EXPECT_HAS(refused(name, mesh + 1),
               name + ": is larger than 2 GiB: expected a mesh of at most 5 million");
  }
  EXPECT_EQ(refused("session.h5", mesh + 1), "no InputError");
}

TEST_F(FindRecording, BagsAreReadAsAWhole) {
  for (const char* name :
       {"bag/metadata.yaml", "bag/bag_0.mcap", "bag/bag_1.mcap", "bag/notes.txt", "one.bag"})
    folder_.write(std::string("here/") + name, "");
  std::vector<std::string> names;
  for (const InputFile& file : files_of({"bag", 3, 1000})) names.push_back(file.name);
  EXPECT_EQ(names, (std::vector<std::string>{"bag_0.mcap", "bag_1.mcap", "metadata.yaml"}));
  ASSERT_EQ(files_of({"one.bag", 0, -1}).size(), 1u);
  EXPECT_EQ(files_of({"one.bag", 0, -1})[0].name, "one.bag");
}

// The environment variable is an input of the program: the Python package passes it to set_data_folder().
TEST_F(FindRecording, DoesNotReadTheEnvironment) {
  folder_.write("data/a.png", "");
  ::setenv("REMOTE_TOUCH_DATA", (folder_ / "data").c_str(), 1);
  EXPECT_THROW(find_input("a.png"), MissingInput);
  ::unsetenv("REMOTE_TOUCH_DATA");
}

}  // namespace
}  // namespace remote_touch::find_input_test

// Readers against recorded sensor data, which are kept outside of the repository; skipped where they are
// missing.
namespace remote_touch::recorded_data_test {
namespace {

namespace fs = std::filesystem;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

struct Known {
  const char* path;
  std::size_t frames;
  double rate_hz, least_valid_percent, most_valid_percent;
  double fy, cx, nearest_m, farthest_m;  // NaN: not stated
};
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr Known kRecordings[] = {
    {"rgbd/visp_organ_table", 70, 30, 89.0, 92.5, kNone, kNone, kNone, kNone},
    {"rgbd/pcd_single/mosd_boxes_learn3.pcd", 1, 30, 67.05, 67.15, 525, 319.5, 0.52, 1.33},
    {"rgbd/pcl_grabber_laptop", 3, 3.79, 88.25, 88.45, kNone, 320, kNone, kNone},
    {"rgbd/tum_office_frame", 1, 30, 80.75, 80.85, 539.2, kNone, kNone, kNone},
};

TEST(RecordedData, IsReadAsItsReadmeSays) {
  std::string missing;
  for (const Known& known : kRecordings) {
    SCOPED_TRACE(known.path);
    if (!fs::exists(data_root() / known.path)) {
      missing = known.path;
      continue;
    }
    const RecordingIndex index = index_recording(data_root() / known.path);
    ASSERT_EQ(index.frames.size(), known.frames);
    EXPECT_EQ(index.frame_rate_hz, known.rate_hz);
    for (std::size_t j = 0; j < std::min<std::size_t>(3, known.frames); ++j) {
      const PointCloud cloud = read_frame(index, j, kNoLimit);
      ASSERT_EQ(cloud.size(), 640u * 480u);
      ASSERT_TRUE(cloud.image);
      EXPECT_LT(cloud.image->pixel_slack, 1e-3);
      EXPECT_EQ(cloud.colour.size(), cloud.size());
      double valid = 0, nearest_m = kNoLimit, farthest_m = 0;
      for (const double z : cloud.z)
        if (!std::isnan(z)) ++valid, nearest_m = std::min(nearest_m, z), farthest_m = std::max(farthest_m, z);
      EXPECT_GE(100 * valid / static_cast<double>(cloud.size()), known.least_valid_percent);
      EXPECT_LE(100 * valid / static_cast<double>(cloud.size()), known.most_valid_percent);
      EXPECT_FALSE(std::abs(cloud.image->camera.fy - known.fy) > 0.01);
      EXPECT_FALSE(std::abs(cloud.image->camera.cx - known.cx) > 0.01);
      EXPECT_FALSE(std::abs(nearest_m - known.nearest_m) > 0.01);
      EXPECT_FALSE(std::abs(farthest_m - known.farthest_m) > 0.01);
    }
  }
  if (!missing.empty()) GTEST_SKIP() << "recorded data are missing: " << missing;
}

}  // namespace
}  // namespace remote_touch::recorded_data_test
