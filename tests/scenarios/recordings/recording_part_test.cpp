// Folders in which a recording is searched.
#include "scenarios/recordings/recording_part.h"

#include <gtest/gtest.h>

#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>

#include "tests/support/test_files.h"

namespace remote_touch::recording_part_test {
namespace {

namespace fs = std::filesystem;

class FindRecording : public testing::Test {
 protected:
  FindRecording() { fs::create_directory(folder_ / "here"), fs::current_path(folder_ / "here"); }
  ~FindRecording() override { fs::current_path(before_), set_data_folder({}); }

  const fs::path before_ = fs::current_path();
  const TestFolder folder_{"find_recording"};
};

TEST_F(FindRecording, LooksHereAndThenBelowTheDataFolder) {
  set_data_folder((folder_ / "data").string());
  folder_.write("data/a.png", ""), folder_.write("data/scans/b.png", ""), folder_.write("here/a.png", "");
  EXPECT_EQ(find_recording("a.png"), "a.png") << "here comes first";
  EXPECT_EQ(find_recording("scans/b.png"), (folder_ / "data/scans/b.png").string());
  const std::string whole = (folder_ / "data/a.png").string();
  EXPECT_EQ(find_recording(whole), whole);
}

TEST_F(FindRecording, ReportsTheSearchedFolders) {
  const std::string places = "no such recording, image or mesh: expected a folder or file here or below ";
  EXPECT_EQ(refusal([] { find_recording("a.png"); }), "a.png: " + places + "REMOTE_TOUCH_DATA (not set)");
  set_data_folder("/data");
  EXPECT_EQ(refusal([] { find_recording("a.png"); }), "a.png: " + places + "REMOTE_TOUCH_DATA = /data");
  EXPECT_EQ(recording_places(), "here or below REMOTE_TOUCH_DATA = /data");
  EXPECT_THROW(find_recording("/a.png"), MissingRecording);
}

TEST_F(FindRecording, RefusesPipesAndDevices) {
  set_data_folder((folder_ / "data").string());
  folder_.write("data/trace.csv", "");
  fs::create_symlink("/dev/zero", folder_ / "data/zero.csv");
  ASSERT_EQ(::mkfifo((folder_ / "here/pipe.csv").c_str(), 0600), 0);
  for (const char* name : {"pipe.csv", "zero.csv"}) {
    EXPECT_HAS(refusal([&] { find_recording(name); }),
               "cannot be read (a pipe or a device): expected a file");
    EXPECT_HAS(refusal([&] { files_of({name}); }), "cannot be read (a pipe or a device): expected a file");
  }
  EXPECT_EQ(find_recording("trace.csv"), (folder_ / "data/trace.csv").string());
}

TEST_F(FindRecording, ANameThatNoFileCanHaveIsMissing) {
  set_data_folder((folder_ / "data").string());
  EXPECT_THROW(find_recording(std::string(5000, 'x')), MissingRecording);
}

// Their digest would never end.
TEST_F(FindRecording, RefusesPartsThatAreNoFiles) {
  folder_.write("here/scan/camera.json", R"({"width": 3, "height": 2, "fx": 10, "fy": 20, "cx": 1, "cy": 0.5,
                                             "depth_scale_m": 0.001, "frame_rate_hz": 20})");
  folder_.write("here/scan/depth/0000.png", "");
  EXPECT_EQ(files_of({"scan"}).size(), 2u);
  fs::create_symlink("/dev/zero", folder_ / "here/scan/depth/0001.png");
  EXPECT_HAS(refusal([] { files_of({"scan"}); }), "0001.png: cannot be read (a pipe or a device)");
  fs::remove(folder_ / "here/scan/depth/0001.png"), fs::remove(folder_ / "here/scan/camera.json");
  ASSERT_EQ(::mkfifo((folder_ / "here/scan/camera.json").c_str(), 0600), 0);
  EXPECT_HAS(refusal([] { files_of({"scan"}); }), "camera.json: cannot be read (a pipe or a device)");
  for (const char* name : {"mesh.obj", "poses.txt", "session.h5", "trace.csv"}) {
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
  EXPECT_THROW(find_recording("a.png"), MissingRecording);
  ::unsetenv("REMOTE_TOUCH_DATA");
}

}  // namespace
}  // namespace remote_touch::recording_part_test
