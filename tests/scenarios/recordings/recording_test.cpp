// Recordings in folders: images and clouds, their cameras, stamps and colours, and what is refused.
#include "scenarios/recordings/recording.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/note_kinds.h"
#include "tests/support/test_files.h"

namespace remote_touch::recording_test {
namespace {

namespace fs = std::filesystem;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

const std::string kCamera =
    R"({"width": 3, "height": 2, "fx": 10, "fy": 20.5, "cx": 1, "cy": 0.5, "depth_scale_m": 0.001,)"
    R"( "frame_rate_hz": 20, "colour_registered": true})";

class Recording : public ::testing::Test {
 protected:
  // Four pixels at x = -x, x and y = -1, 1, all at z = 2.
  void write_pcd(const std::string& name, const std::string& x) {
    const std::string rows = "-" + x + " -1 2\n" + x + " -1 2\n-" + x + " 1 2\n" + x + " 1 2\n";
    folder_.write(name, pcd_header("x y z", "4 4 4", "F F F", "1 1 1", "2", "2", "4", "ascii") + rows);
  }

  // Writes a recording folder of two frames.
  void write_recording() {
    folder_.write("camera.json", kCamera);
    folder_.write_depth("depth/0000.png", 1000), folder_.write_depth("depth/0001.png", 2000);
    folder_.write_colour("rgb/0000.png", 0x11), folder_.write_colour("rgb/0001.png", 0x22);
  }

  // Expects a refusal about this file below the folder (with ":line" where one is expected).
  void expect_error(const std::string& subject, const std::string& part) {
    const std::string text = refusal([&] {
      const RecordingIndex index = index_recording(folder_.path());
      for (std::size_t j = 0; j < index.frames.size(); ++j) read_frame(index, j, kNoLimit);
    });
    EXPECT_EQ(text.rfind((folder_ / subject).string() + ": ", 0), 0u) << text << "\nis not about " << subject;
    EXPECT_HAS(text, part);
  }

  const TestFolder folder_{"recording_test"};
};

TEST_F(Recording, IndexesAndReadsAFolder) {
  write_recording();
  const RecordingIndex index = index_recording(folder_ / "");
  EXPECT_EQ(index.kind, RecordingIndex::Kind::depth_image);
  EXPECT_EQ(index.camera.width, 3);
  EXPECT_EQ(index.camera.height, 2);
  EXPECT_EQ(index.camera.fy, 20.5);
  EXPECT_EQ(index.metres_per_unit, 0.001);
  EXPECT_EQ(index.frame_rate_hz, 20);
  ASSERT_EQ(index.frames.size(), 2u);
  EXPECT_EQ(index.frames[0].captured_s, 0);
  EXPECT_EQ(index.frames[1].captured_s, 1 / 20.0);
  EXPECT_EQ(description(index, "5 Hz"), folder_.path().filename().string() +
                                            ": 2 frame(s) from depth PNG at 5 Hz, 3 x 2 pixels, "
                                            "f = 10, 20.5, c = 1, 0.5 (camera.json)");
  EXPECT_EQ(frame_name(index, 1), (folder_ / "depth/0001.png").string());

  const PointCloud cloud = read_frame(index, 1, 2.0045);
  ASSERT_EQ(cloud.size(), 6u);
  EXPECT_TRUE(cloud.point(1).isApprox(Vec3(0, -0.5 * 2.001 / 20.5, 2.001), 1e-15));
  EXPECT_TRUE(cloud.point(3).isApprox(Vec3(-0.2003, 0.5 * 2.003 / 20.5, 2.003), 1e-15));
  EXPECT_TRUE(cloud.point(5).array().isNaN().all());  // beyond the limit
  ASSERT_TRUE(cloud.image);
  EXPECT_EQ(cloud.image->camera.fx, 10);
  EXPECT_TRUE(cloud.image->X_WC.matrix().isIdentity(0));
  EXPECT_EQ(cloud.colour, std::vector<std::uint32_t>(6, 0x222222));
}

TEST_F(Recording, ReadsColourOnlyWhereItIsRegistered) {
  write_recording();
  fs::remove(folder_ / "rgb/0000.png");
  const RecordingIndex index = index_recording(folder_.path());
  EXPECT_TRUE(index.frames[0].colour.empty());
  EXPECT_TRUE(read_frame(index, 0, kNoLimit).colour.empty());
  EXPECT_EQ(index.frames[1].colour, folder_ / "rgb/0001.png");
  std::string json = kCamera;
  folder_.write("camera.json", json.replace(json.find("true"), 4, "false"));
  const RecordingIndex unregistered = index_recording(folder_.path());
  EXPECT_TRUE(unregistered.frames[1].colour.empty());
  EXPECT_EQ(kinds_of(unregistered.notes), Kinds{"colours missing"});
  fs::remove_all(folder_ / "rgb");
  EXPECT_TRUE(index_recording(folder_.path()).notes.empty());
}

// The cameras that the benchmark publishes.
TEST_F(Recording, TheCameraOfTumIsThatOfItsSequence) {
  folder_.write_depth("rgbd_dataset_freiburg3_desk/depth/a.png", 1000);
  folder_.write_depth("x/depth/a.png", 1000);
  const auto camera = [&](const std::string& folder, const std::string& comment) {
    folder_.write(folder + "/depth.txt", comment + "1 depth/a.png\n");
    return index_recording(folder_ / folder);
  };
  EXPECT_EQ(camera("rgbd_dataset_freiburg3_desk", "").camera.fx, 535.4);
  EXPECT_EQ(camera("x", "# file: 'rgbd_dataset_freiburg1_xyz.bag'\n").camera.fx, 517.3);
  EXPECT_EQ(camera("x", "# file: 'rgbd_dataset_freiburg2_xyz.bag'\n").camera.cy, 249.7);
  EXPECT_HAS(description(camera("x", "# freiburg2\n"), "5 Hz"), "c = 325.1, 249.7 (freiburg2 of TUM");
  EXPECT_TRUE(camera("x", "# freiburg2\n").notes.empty());
  EXPECT_EQ(kinds_of(camera("x", "").notes), Kinds{"camera assumed"});
  EXPECT_EQ(camera("x", "").frame_rate_hz, 30) << "one frame has no rate of its own";
}

TEST_F(Recording, HasTheNameOfTheCurrentFolder) {
  write_recording();
  struct InFolder {
    explicit InFolder(const fs::path& folder) { fs::current_path(folder); }
    ~InFolder() { fs::current_path(before); }
    const fs::path before = fs::current_path();
  };
  std::string name, below;
  {
    const InFolder here(folder_.path());
    name = index_recording(".").name, below = index_recording("depth/..").name;
  }
  EXPECT_EQ(name, folder_.path().filename().string());
  EXPECT_EQ(below, name);
}

TEST_F(Recording, HasFilesWithEndingsInCapitalLettersButNoHiddenOnes) {
  folder_.write("camera.json", kCamera);
  folder_.write_depth("depth/0000.PNG", 1000), folder_.write_depth("depth/0001.png", 1000);
  folder_.write_colour("rgb/0000.png", 0x11), folder_.write_colour("rgb/0001.png", 0x22);
  for (const char* name : {"depth/._0001.png", "depth/.old.png", "rgb/._0001.png"})
    folder_.write(name, "no image");
  const RecordingIndex index = index_recording(folder_.path());
  ASSERT_EQ(index.frames.size(), 2u);
  EXPECT_EQ(index.frames[0].depth.filename(), "0000.PNG");
  EXPECT_EQ(index.frames[0].colour.filename(), "0000.png");
  EXPECT_EQ(index.frames[1].colour.filename(), "0001.png");
  write_pcd("clouds/A.PCD", "1"), folder_.write("clouds/.b.pcd", "no cloud");
  EXPECT_EQ(index_recording(folder_ / "clouds").frames.size(), 1u);
  EXPECT_EQ(index_recording(folder_ / "clouds/A.PCD").frames.size(), 1u);
}

TEST_F(Recording, RefusesIncompleteFolders) {
  const auto error = [](const fs::path& path) { return refusal([&] { index_recording(path); }); };
  EXPECT_HAS(error(folder_ / "missing"), "missing: does not exist: expected");
  EXPECT_HAS(error(folder_.write("notes.txt", "")), "notes.txt: is of another kind");
  const std::string allowed =
      "expected a folder that holds depth.txt (TUM), depth/*.png or depth/*.npy, *.depth.png (7-Scenes), *.pcd or "
      "metadata.yaml with a ROS 2 bag";
  const std::string no_recording = folder_.path().string() + ": is not a recording: " + allowed;
  EXPECT_EQ(error(folder_.path()), no_recording);
  folder_.write("camera.json", kCamera);
  EXPECT_EQ(error(folder_.path()), no_recording);
  fs::create_directories(folder_ / "depth");
  expect_error("depth", "holds no .png and no .npy file");
  folder_.write_depth("depth/0000.png", 1000);
  fs::remove(folder_ / "camera.json");
  expect_error("camera.json", "is missing: depth images need {width, height, fx");
}

TEST_F(Recording, RefusesBadFiles) {
  struct Row {
    std::string part, replacement, message;  // the part is one of camera.json
  };
  const Row rows[] = {
      {R"("frame_rate_hz": 20)", R"("frame_rate_hz": 0)", "frame_rate_hz = 0: expected a number above 0"},
      {R"("frame_rate_hz": 20, )", "", "has no key 'frame_rate_hz'"},
      {R"("fx": 10)", R"("fx": -10)", "fx = -10: expected a number above 0"},
      {R"("cx": 1)", R"("cx": [])", "cx = []: expected a number"},
      {R"("width": 3)", R"("width": 3.5)", "width = 3.5: expected an integer from 1 to 65535"},
      {R"("height": 2)", R"("height": 1e12)", "height = 1000000000000.0: expected an integer"},
      {"true", "1", "colour_registered = 1: expected true, false"},
      {"true", R"(true, "depth_along": "z")", R"(depth_along = "z": expected "axis", "ray")"},
      {"colour_registered", "color\\nregistered", R"(key "color\nregistered": expected)"},
      {"{", "", "expected JSON"},
      {kCamera, "[1]", "is of type array: expected object"},
  };
  write_recording();
  for (const Row& row : rows) {
    std::string json = kCamera;
    folder_.write("camera.json", json.replace(json.find(row.part), row.part.size(), row.replacement));
    expect_error("camera.json", row.message);
  }
  write_recording();
  folder_.write_colour("rgb/0001.png", 1, 5);
  expect_error("rgb/0001.png", "has 5 x 2 pixels: expected 3 x 2");
  folder_.write_depth("depth/0001.png", 1000, 4);
  expect_error("depth/0001.png", "has 4 x 2 pixels: expected 3 x 2");
  folder_.write("depth/0000.png", "not an image");
  expect_error("depth/0000.png", "is not a whole PNG file");
  folder_.write("depth/2.npy", "");
  expect_error("depth", "holds .png and .npy files: expected one kind");
}

TEST_F(Recording, AssociatesTumStamps) {
  for (const std::string name : {"a", "b", "c"}) folder_.write_depth("depth/" + name + ".png", 5000);
  for (const std::string name : {"p", "q", "r"}) folder_.write_colour("rgb/" + name + ".png", 7);
  folder_.write("depth.txt",
                "# depth maps\n# timestamp filename\n1305031102.160407 depth/c.png\n"
                "1305031102.194330 depth/a.png\r\n\n1305031102.260407 depth/b.png\n");
  folder_.write("rgb.txt",
                "#\n1305031102.175304 rgb/p.png\n1305031102.190000 rgb/q.png\n1305031102.281407 rgb/r.png\n");
  const RecordingIndex index = index_recording(folder_.path());
  EXPECT_EQ(index.camera.width, 640);
  EXPECT_EQ(index.camera.fx, 525);
  EXPECT_EQ(index.camera.cy, 239.5);
  EXPECT_EQ(index.metres_per_unit, 1.0 / 5000);
  EXPECT_NEAR(index.frame_rate_hz, 2 / 0.1, 1e-4);
  ASSERT_EQ(index.frames.size(), 3u);
  EXPECT_EQ(index.frames[0].captured_s, 0);
  EXPECT_NEAR(index.frames[1].captured_s, 0.033923, 1e-6);
  EXPECT_EQ(index.frames[0].depth, folder_ / "depth/c.png");  // the order of the list, not of the names
  EXPECT_EQ(index.frames[0].colour, folder_ / "rgb/p.png");   // 0.0149 s
  EXPECT_EQ(index.frames[1].colour, folder_ / "rgb/q.png");   // 0.0043 s, not 0.0190 s
  EXPECT_TRUE(index.frames[2].colour.empty());                // 0.0210 s
  folder_.write("rgb.txt",
                "\xEF\xBB\xBF"
                "5.175304 rgb/p.png\n");
  expect_error("rgb.txt", "no image is within 0.02 s of one in depth.txt; the first are " +
                              (folder_ / "rgb/p.png").string() + " and " +
                              (folder_ / "depth/c.png").string());
}

TEST_F(Recording, RefusesBadTumLists) {
  folder_.write_depth("depth/a.png", 1000);
  const std::string missing = "no file " + (folder_ / "depth/b.png").string();
  for (const auto& [list, subject, message] :
       {std::array<std::string, 3>{"\xEF\xBB\xBF# nothing\n\n", "depth.txt", "lists no file"},
        {"# header\n1.0 depth/a.png\nnoon depth/a.png\n", "depth.txt:3",
         "timestamp 'noon': expected a number of seconds"},
        {"1e300 depth/a.png\n", "depth.txt:1", "timestamp '1e300'"},
        {"0 depth/a.png\n1e-9 depth/a.png\n", "depth.txt",
         "has timestamps of more than 10000 frames a second"},
        {"1.0\r\n", "depth.txt:1", "'1.0': expected one timestamp and one file name"},
        {"1.0 depth/a.png\n1.0 depth/a.png\n", "depth.txt:2", "timestamp 1.0: expected above"},
        {"1.0 depth/a.png\n2.0 depth/b.png\n", "depth.txt:2", missing}}) {
    folder_.write("depth.txt", list);
    expect_error(subject, message);
  }
  folder_.write("depth.txt", "1.0 depth/a.png\n");
  folder_.write("rgb.txt", "2.0 depth/a.png\n1.5 depth/a.png\n");
  expect_error("rgb.txt:2", "timestamp 1.5: expected above");
}

// There are 4e10 pairs of lines, so each depth image is compared only with the colour images near it.
TEST(TumLists, ManyLinesAreAssociatedQuickly) {
  std::vector<StampedFile> depth, colour;
  for (int i = 0; i < 200'000; ++i) {
    depth.push_back({0.03 * i, std::to_string(i)});
    colour.push_back({0.03 * i + (i % 2 == 0 ? 0.005 : 0.024), std::to_string(i)});
  }
  const std::vector<RecordedFrame> frames = associate_stamps(depth, colour);
  ASSERT_EQ(frames.size(), depth.size());
  for (std::size_t i = 0; i < frames.size(); ++i)
    ASSERT_EQ(frames[i].colour, i % 2 == 0 ? std::to_string(i) : "") << i;
}

// A wall at 2 m, as depths and as distances along the rays, in a NumPy file of floats.
TEST_F(Recording, DepthsAreFloatsAndDistancesIfCameraJsonSaysSo) {
  constexpr int kWidth = 6, kHeight = 4;
  const CameraIntrinsics camera{kWidth, kHeight, 5, 5, 2.5, 1.5};
  const auto wall = [&](bool along_ray) {
    std::string file = "\x93NUMPY" + std::string("\1\0", 2), values;
    const std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (4, 6), }\n";
    for (int v = 0; v < kHeight; ++v)
      for (int u = 0; u < kWidth; ++u) values += raw(along_ray ? unproject(camera, u, v, 2).norm() : 2.0);
    return file + raw(static_cast<std::uint16_t>(header.size())) + header + values;
  };
  const std::string json = R"({"width": 6, "height": 4, "fx": 5, "fy": 5, "cx": 2.5, "cy": 1.5, )"
                           R"("depth_scale_m": 1, "frame_rate_hz": 30)";
  for (const bool along_ray : {false, true}) {
    folder_.write("camera.json",
                  json + (along_ray ? R"(, "depth_along": "ray"})" : R"(, "depth_along": "axis"})"));
    folder_.write("depth/1.npy", wall(along_ray));
    const RecordingIndex index = index_recording(folder_.path());
    EXPECT_HAS(description(index, "30 Hz"), "1 frame(s) from depth NumPy at 30 Hz");
    const PointCloud cloud = read_frame(index, 0, 2.01);  // the corners are 2.3 m away
    ASSERT_EQ(cloud.size(), camera.pixels());
    for (std::size_t i = 0; i < cloud.size(); ++i) EXPECT_NEAR(cloud.z[i], 2, 1e-15);
    EXPECT_TRUE(std::isnan(read_frame(index, 0, 1.99).z[0]));
  }
  // The layouts of TUM and ScanNet.
  folder_.write("depth.txt", "1 depth/1.npy\n");
  EXPECT_NEAR(read_frame(index_recording(folder_.path()), 0, kNoLimit).z[0], 2, 1e-15);
  fs::remove(folder_ / "depth.txt"), fs::remove(folder_ / "camera.json");
  folder_.write("intrinsic/intrinsic_depth.txt", "5 0 2.5 0\n0 5 1.5 0\n0 0 1 0\n0 0 0 1\n");
  EXPECT_EQ(index_recording(folder_.path()).camera.width, kWidth);
}

TEST_F(Recording, NamesWithEqualNumbersAreANote) {
  write_pcd("frame_2.pcd", "2"), write_pcd("frame_1.pcd", "1");
  EXPECT_TRUE(index_recording(folder_.path()).notes.empty());
  write_pcd("frame_01.pcd", "1");
  EXPECT_EQ(kinds_of(index_recording(folder_.path()).notes), Kinds{"equal numbers"});
}

TEST_F(Recording, StreamsPcdFiles) {
  write_pcd("frame_10.pcd", "2"), write_pcd("frame_9.pcd", "1");
  RecordingIndex index = index_recording(folder_.path());
  EXPECT_EQ(index.kind, RecordingIndex::Kind::pcd);
  EXPECT_EQ(index.frame_rate_hz, 30);
  ASSERT_EQ(index.frames.size(), 2u);
  EXPECT_EQ(index.frames[1].captured_s, 1 / 30.0);
  EXPECT_EQ(index.frames[1].depth, folder_ / "frame_10.pcd");
  // u = fx x/z + cx with u = 0, 1 at x/z = -1/2, 1/2 in the first file.
  const PointCloud first = read_frame(index, 0, 2);
  ASSERT_TRUE(first.image);
  EXPECT_NEAR(first.image->camera.fx, 1, 1e-12);
  EXPECT_NEAR(first.image->camera.cx, 0.5, 1e-12);
  const PointCloud second = read_frame(index, 1, 2);
  ASSERT_TRUE(second.image);
  EXPECT_NEAR(second.image->camera.fx, 0.5, 1e-12);  // each file has its own fit
  EXPECT_EQ(second.point(3), Vec3(2, 1, 2));
  EXPECT_TRUE(read_frame(index, 1, 1.9).point(3).array().isNaN().all());

  folder_.write("camera.json", R"({"frame_rate_hz": 3.79})");
  EXPECT_EQ(index_recording(folder_.path()).frame_rate_hz, 3.79);
  EXPECT_EQ(index_recording(folder_ / "frame_9.pcd").frames.size(), 1u);
  folder_.write("camera.json", "{}");
  expect_error("camera.json", "has no key 'frame_rate_hz'");
  fs::remove(folder_ / "camera.json");
  folder_.write("frame_10.pcd", "VERSION 0.7\n");
  expect_error("frame_10.pcd", "the PCD header has no FIELDS entry");
}

// Colour and depth images with equal names belong together, else those with equal numbers. What has not
// exactly one partner is refused.
TEST_F(Recording, PairsColourImagesWithDepthImages) {
  using Names = std::vector<std::string>;
  struct Row {
    Names depth, rgb, colours;
    std::string refused = "", partner = "";
  };
  const Row rows[] = {
      {{"1.png", "2.png"}, {}, {"", ""}},
      {{"1.png", "2.png"}, {"2.png", "a1.png"}, {"", "2.png"}},
      {{"frame-9.depth.png", "frame-10.depth.png", "frame-11.depth.png"},
       {"f010.color.png", "f9.color.png"},
       {"f9.color.png", "f010.color.png", ""}},
      {{"k2_0001.png", "k3_0001.png"}, {"3_1.png", "2_1.png"}, {"2_1.png", "3_1.png"}},
      {{"a_1.png", "a_2.png"}, {"b_1.png"}, {"b_1.png", ""}},
      {{"k2_0001.png", "k3_0001.png"}, {"1.png"}, {}, "1.png", "k2_0001.png"},
      {{"a_1.png", "a_2.png"}, {"7.png"}, {}, "7.png", "a_1.png"},
      {{"a_1.png", "a_2.png"}, {"b_1.png", "c_01.png"}, {}, "c_01.png", "a_1.png"},
      {{"a_1.png", "a_2.png", "z_1.png"}, {"b_1.png"}, {}, "b_1.png", "z_1.png"},
  };
  const auto colours = [&] {
    Names names;
    for (const fs::path& file : colour_images(files_in_order(folder_ / "depth", ".png"), folder_ / "rgb"))
      names.push_back(file.filename().string());
    return names;
  };
  for (const Row& row : rows) {
    fs::remove_all(folder_ / "depth"), fs::remove_all(folder_ / "rgb");
    for (const std::string& name : row.depth) folder_.write("depth/" + name, "");
    for (const std::string& name : row.rgb) folder_.write("rgb/" + name, "");
    if (row.refused.empty())
      EXPECT_EQ(colours(), row.colours) << row.depth.front();
    else
      EXPECT_EQ(refusal(colours).rfind((folder_ / "rgb" / row.refused).string() +
                                           ": it is not clear whether it belongs to " +
                                           (folder_ / "depth" / row.partner).string(),
                                       0),
                0u);
  }
  fs::remove(folder_ / "rgb/b_1.png"), folder_.write("rgb/1.jpg", "");
  EXPECT_HAS(refusal(colours),
             (folder_ / "rgb").string() + ": holds no .png file: expected the colour images of ");
}

TEST_F(Recording, LinksToNothingAreRefused) {
  write_recording();
  const std::string problem = "is a link to a file that does not exist: expected a file";
  for (const char* name : {"depth/2.png", "rgb/2.png"}) {
    fs::create_symlink("nowhere", folder_ / name);
    expect_error(name, problem);
    fs::remove(folder_ / name);
  }
  fs::remove_all(folder_ / "rgb");
  fs::create_symlink("nowhere", folder_ / "rgb");
  expect_error("rgb", problem);
}

}  // namespace
}  // namespace remote_touch::recording_test
