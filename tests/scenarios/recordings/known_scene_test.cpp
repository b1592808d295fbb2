// One known scene, written in every layout of depth images and with the usual mistakes of poses: all layouts
// give the same bits, and each mistake is refused or noted with its cause.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/points/vector.h"
#include "scenarios/objects/mesh_scene.h"
#include "scenarios/recordings/recorded_scene.h"
#include "tests/support/meshes.h"
#include "tests/support/note_kinds.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::known_scene_test {
namespace {

constexpr int kFrames = 12, kHole = 100;  // frames; a pixel that measured nothing
const CameraIntrinsics kCamera = {96, 72, 90, 91, 47.25, 35.5};
using Poses = std::vector<RigidTransform>;
using Change = std::function<RigidTransform(const RigidTransform&)>;

RigidTransform pose(const Vec3& position_m, const Vec3& turn) {
  return Eigen::Translation3d(position_m) * rotation(turn);
}

// A tetrahedron, which no rotation maps to itself, before a wall and beside a box.
TriangleMesh object() {
  return meshes::tetrahedron({-0.11, -0.06, -0.05}, {0.15, -0.05, 0.02}, {-0.03, 0.14, 0.03}, {0.02, 0, 0.1});
}
const RigidTransform kX_first = pose({0.5, -0.3, 0.2}, {0.3, -0.4, 0.2});  // first camera to world frame
const RigidTransform kX_WO = kX_first * pose({-0.05, 0.03, 0.7}, {0.6, -0.8, 0.5});

Poses camera_poses() {
  Poses X_WC;
  for (int i = 0; i < kFrames; ++i)
    X_WC.push_back(kX_first * pose(i * Vec3(0.012, -0.006, 0.008), i * Vec3(0.003, 0.012, 0.002)));
  return X_WC;
}

// Poses of the object in the camera frame, whose translations in millimetres are short decimal numbers.
Poses object_poses() {
  Poses X_CO;
  for (const RigidTransform& X_WC : camera_poses()) {
    X_CO.push_back(X_WC.inverse() * kX_WO);
    auto t = X_CO.back().translation();
    for (int axis = 0; axis < 3; ++axis) t[axis] = std::round(1e4 * t[axis]) / 10 / 1000;
  }
  return X_CO;
}

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

// Returns a number of six digits.
std::string six(int i) {
  const std::string digits = std::to_string(i);
  return std::string(6 - digits.size(), '0') + digits;
}

std::string matrix_text(const RigidTransform& X, const char* after_row) {
  std::string text;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) text += number(X.matrix()(row, column)) + " ";
    text += after_row;
  }
  return text;
}

std::string matrices(
    const Poses& poses, const Change& change = [](const auto& X) { return X; }) {
  std::string text;
  for (const RigidTransform& X : poses) text += matrix_text(change(X), "") + "\n";
  return text;
}

std::string row(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += number(value) + " ";
  return text;
}

std::string quaternion_text(const RigidTransform& X) {
  const Eigen::Quaterniond q(X.linear());
  const Vec3 t = X.translation();
  return row({t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()});
}

class KnownScene : public testing::Test {
 protected:
  // Writes the images; name: the file of a frame.
  void write_images(const std::function<std::string(int)>& name, double units_per_m,
                    std::uint16_t hole = 0) const {
    const TriangleMesh tetrahedron = object(), box = box_mesh({0.2, 0.15, 0.3});
    const TriangleMesh wall = {{{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}}, {{0, 2, 1}, {0, 3, 2}}};
    const Poses X_WC = camera_poses(), X_CO = object_poses();
    for (int i = 0; i < kFrames; ++i) {
      const RigidTransform X_C_first = X_WC[i].inverse() * kX_first;
      const std::vector<RasterMesh> seen = {
          {tetrahedron.vertices, tetrahedron.triangles, X_CO[i]},
          {box.vertices, box.triangles, X_C_first * pose({0.25, -0.1, 0.9}, {0.4, 0.3, 0})},
          {wall.vertices, wall.triangles, X_C_first * pose({0, 0, 1.3}, {0.2, 0.4, 0}), false}};
      std::vector<std::uint16_t> units;
      for (const double z : depth_raster(kCamera, seen).depth.z_m)
        units.push_back(std::isfinite(z) ? static_cast<std::uint16_t>(std::lround(z * units_per_m)) : hole);
      units[kHole] = hole;
      folder_.write_png(name(i), kCamera.width, kCamera.height, PNG_FORMAT_LINEAR_Y, units.data());
    }
  }
  void write_camera(const std::string& folder, double metres_per_unit) const {
    folder_.write(
        folder + "/camera.json",
        R"({"width": 96, "height": 72, "fx": 90, "fy": 91, "cx": 47.25, "cy": 35.5, "frame_rate_hz": 30,)"
        R"( "depth_scale_m": )" +
            number(metres_per_unit) + "}");
  }
  void write_own(const std::string& folder, double units_per_m = 1000) const {
    write_images([&](int i) { return folder + "/depth/" + six(i) + ".png"; }, units_per_m);
    write_camera(folder, 1 / units_per_m);
  }
  RecordedScene::Settings settings(const std::string& folder, const std::string& camera_poses = "") const {
    RecordedScene::Settings s;
    s.path = (folder_ / folder).string(), s.camera_poses = camera_poses;
    return s;
  }
  static RecordedScene scene(const RecordedScene::Settings& s) {
    const MeshReader reader = [](const std::filesystem::path& file) {
      const bool is_millimetres = file.extension() == ".ply";
      TriangleMesh mesh = object();
      for (Vec3& vertex : mesh.vertices) vertex *= 1000;
      for (Vec3& vertex : mesh.vertices) vertex *= is_millimetres ? 1 : 1e-3;
      return mesh;
    };
    return RecordedScene(s, {}, scenes::kernels(), reader);
  }
  static void expect_equal(const RecordedScene& scene, const RecordedScene& own) {
    ASSERT_EQ(scene.frame_count(), kFrames);
    for (int i = 0; i < kFrames; ++i) {
      const PointCloud cloud = scene.cloud(i), expected = own.cloud(i);
      EXPECT_TRUE(scenes::same_clouds(cloud, expected)) << i;
      EXPECT_FALSE(cloud.is_measured(kHole));
      EXPECT_EQ(cloud.image->camera, expected.image->camera);
      EXPECT_EQ(cloud.image->X_WC.matrix(), expected.image->X_WC.matrix()) << i;
      EXPECT_EQ(scene.captured_s(i), own.captured_s(i));
      for (const double depth : {0.55, 0.6, 0.65, 0.7}) {
        const Vec3 p_W = cloud.image->X_WC * Vec3(-0.05, 0.03, depth);
        const double distance = scene.signed_distance(p_W, scene.captured_s(i));
        const double expected_distance = own.signed_distance(p_W, scene.captured_s(i));
        EXPECT_TRUE(distance == expected_distance || (std::isnan(distance) && std::isnan(expected_distance)));
      }
    }
  }
  // The kinds and the texts of the notes after all frames were read.
  static std::map<std::string, std::string> notes_of(const RecordedScene& scene) {
    for (int i = 0; i < kFrames; ++i) scene.cloud(i);
    std::map<std::string, std::string> notes;
    for (const Note& note : scene.input_notes()) notes[note.kind] += note.text + "\n";
    return notes;
  }

  const TestFolder folder_{"known_scene_test"};
};

TEST_F(KnownScene, IsReadInTheLayoutOfTum) {
  write_own("own", 5000);
  write_images([](int i) { return "tum/depth/" + std::to_string(i) + ".png"; }, 5000);
  write_camera("tum", 1.0 / 5000);
  std::string list, truth = "# ground truth trajectory\n# timestamp tx ty tz qx qy qz qw\n";
  std::string own = "# tx ty tz qx qy qz qw\n";
  for (int i = 0; i < kFrames; ++i) {
    const std::string pose = quaternion_text(camera_poses()[i]) + "\n";
    list += number(i / 30.0) + " depth/" + std::to_string(i) + ".png\n";
    truth += number(i / 30.0) + " " + pose, own += pose;
  }
  folder_.write("tum/depth.txt", list), folder_.write("tum/groundtruth.txt", truth);
  folder_.write("own/poses.txt", own);
  const RecordedScene tum = scene(settings("tum", "groundtruth.txt"));
  expect_equal(tum, scene(settings("own", "poses.txt")));
  EXPECT_TRUE(notes_of(tum).empty());
  EXPECT_HAS(tum.input(), "f = 90, 91, c = 47.25, 35.5 (camera.json)");
  EXPECT_HAS(tum.input(),
             "; camera_poses: groundtruth.txt, 12 poses over 0.367 s at 30 Hz, 0.172 m long, at most 0.");
  folder_.write("tum/other.txt", "1305031102.1 0 0 0 0 0 0 1\n");
  EXPECT_HAS(refusal([&] { scene(settings("tum", "other.txt")); }),
             "expected stamps of one clock, in seconds");
}

// Stamps between those of the frames: the camera is where it was on the way.
TEST_F(KnownScene, HasPosesAtTheTimesOfItsFrames) {
  write_images([](int i) { return "tum/depth/" + std::to_string(i) + ".png"; }, 5000);
  write_camera("tum", 1.0 / 5000);
  std::string list;
  for (int i = 0; i < kFrames; ++i) list += number(100 + 0.1 * i) + " depth/" + std::to_string(i) + ".png\n";
  folder_.write("tum/depth.txt", list);
  folder_.write("tum/path.txt", "99.95 0 0 0 0 0 0 1\n100.05 1 0 0 0 0 0 1\n101.0 1 1 0 0 0 0 1\n");
  const RecordedScene tum = scene(settings("tum", "path.txt"));
  EXPECT_TRUE(tum.cloud(0).image->X_WC.translation().isApprox(Vec3(0.5, 0, 0), 1e-9));
  EXPECT_TRUE(tum.cloud(1).image->X_WC.translation().isApprox(Vec3(1, 0.05 / 0.95, 0), 1e-9));
  EXPECT_HAS(refusal([&] { tum.cloud(11); }), "path.txt: has no pose for frame 11")
      << "it is 0.1 s after the last pose";
}

TEST_F(KnownScene, IsReadInTheLayoutOf7Scenes) {
  write_own("own");
  folder_.write("own/poses.txt", matrices(camera_poses()));
  write_images([](int i) { return "seq-01/frame-" + six(i) + ".depth.png"; }, 1000, 65535);
  for (int i = 0; i < kFrames; ++i) {
    folder_.write("seq-01/frame-" + six(i) + ".pose.txt", matrix_text(camera_poses()[i], "\n"));
    folder_.write_colour("seq-01/frame-" + six(i) + ".color.png", 7);
  }
  EXPECT_HAS(refusal([&] { scene(settings("seq-01")); }), "has 96 x 72 pixels: expected 640 x 480");
  const RecordingIndex index = index_recording(folder_ / "seq-01");
  EXPECT_EQ(index.camera, (CameraIntrinsics{640, 480, 585, 585, 320, 240}));
  write_camera("seq-01", 0.001);
  const RecordedScene seven = scene(settings("seq-01", "."));
  expect_equal(seven, scene(settings("own", "poses.txt")));
  EXPECT_HAS(seven.input(), "; camera_poses: seq-01, 12 poses");
  const auto notes = notes_of(seven);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_HAS(notes.at("colours missing"), "the images of 7-Scenes are not registered");
  EXPECT_EQ(files_of(input_files(settings("seq-01", "."))).size(), 2u * kFrames + 1);
}

TEST_F(KnownScene, IsReadInTheLayoutOfScanNet) {
  write_own("own");
  folder_.write("own/poses.txt", matrices(camera_poses()));
  write_images([](int i) { return "scan/depth/" + std::to_string(i) + ".png"; }, 1000);
  for (int i = 0; i < kFrames; ++i)
    folder_.write("scan/pose/" + std::to_string(i) + ".txt", matrix_text(camera_poses()[i], "\n"));
  folder_.write("scan/intrinsic/intrinsic_depth.txt", "90 0 47.25 0\n0 91 35.5 0\n0 0 1 0\n0 0 0 1\n");
  folder_.write("scan/color/0.jpg", "");
  const RecordedScene scan = scene(settings("scan", "pose"));
  expect_equal(scan, scene(settings("own", "poses.txt")));
  EXPECT_HAS(scan.input(), "c = 47.25, 35.5 (intrinsic_depth.txt)");
  EXPECT_EQ(notes_of(scan).count("colours missing"), 1u);
  const std::string lost = "-inf -inf -inf -inf\n";
  folder_.write("scan/pose/3.txt", lost + lost + lost + lost);
  const RecordedScene with_gap = scene(settings("scan", "pose"));
  EXPECT_HAS(refusal([&] { with_gap.cloud(3); }), "has no pose for frame 3");
}

TEST_F(KnownScene, IsReadInTheLayoutOfBop) {
  const Poses X_CO = object_poses();
  std::vector<std::uint8_t> mask(kCamera.pixels(), 0);
  std::fill(mask.begin() + 96 * 30, mask.end(), 255);
  write_own("own");
  folder_.write("own/truth/obj_5.obj", ""), folder_.write("own/truth/poses.txt", matrices(X_CO));
  write_images([](int i) { return "set/test/000001/depth/" + six(i) + ".png"; }, 1000);
  std::string cameras, poses;
  for (int i = 0; i < kFrames; ++i) {
    const std::string key = (i > 0 ? ", \"" : "\"") + std::to_string(i) + "\": ";
    cameras += key + R"({"cam_K": [90, 0, 47.25, 0, 91, 35.5, 0, 0, 1], "depth_scale": 1.0})";
    std::string R, t;
    for (int k = 0; k < 9; ++k) R += (k > 0 ? ", " : "") + number(X_CO[i].linear()(k / 3, k % 3));
    for (int k = 0; k < 3; ++k)
      t += (k > 0 ? ", " : "") + number(std::round(1e4 * X_CO[i].translation()[k]) / 10);
    poses += key + "[{\"cam_R_m2c\": [" + R + "], \"cam_t_m2c\": [" + t + "], \"obj_id\": 5}]";
    for (const char* place : {"own/truth/mask", "set/test/000001/mask_visib"})
      folder_.write_png(place + ("/" + six(i)) + "_000000.png", kCamera.width, kCamera.height,
                        PNG_FORMAT_GRAY, mask.data());
  }
  folder_.write("set/test/000001/scene_camera.json", "{" + cameras + "}");
  folder_.write("set/test/000001/scene_gt.json", "{" + poses + "}");
  folder_.write("set/models/obj_000005.ply", "");
  const RecordedScene bop = scene(settings("set/test/000001")), own = scene(settings("own"));
  expect_equal(bop, own);
  EXPECT_EQ(bop.truth_text(), "meshes of scene_gt.json (obj_5), uncertainty not stated");
  EXPECT_TRUE(notes_of(bop).empty() && notes_of(own).empty());
  int known = 0;
  for (int i = 0; i < kFrames; ++i)
    known += std::isfinite(bop.signed_distance(bop.camera_at(i / 30.0) * Vec3(-0.05, 0.03, 0.65), i / 30.0))
                 ? 1
                 : 0;
  EXPECT_GT(known, 0) << "the comparison is not one of unknown truths";
  EXPECT_EQ(files_of(input_files(settings("set/test/000001"))).size(), 2u * kFrames + 3);
  folder_.write("set/test/000001/scene_camera.json",
                R"({"0": {"cam_K": [90, 0, 47.25, 0, 91, 35.5, 0, 0, 1], "depth_scale": 1.0}})");
  EXPECT_HAS(refusal([&] { scene(settings("set/test/000001")); }),
             "scene_camera.json: has no camera of image 1");
}

// --- mistakes ---

const RigidTransform kFlip = [] {
  RigidTransform flip = RigidTransform::Identity();
  flip.linear().diagonal() = Vec3(1, -1, -1);
  return flip;
}();

const Change kAsIs = [](const RigidTransform& X) { return X; };
const Change kInverse = [](const RigidTransform& X) { return X.inverse(); };
const Change kTransposed = [](RigidTransform X) {
  X.linear().transposeInPlace();
  return X;
};
const Change kFlipped = [](const RigidTransform& X) { return X * kFlip; };
Change scaled(double factor) {
  return [factor](RigidTransform X) {
    X.translation() *= factor;
    return X;
  };
}
Change behind(const RigidTransform& other) {
  return [other](const RigidTransform& X) { return other * X; };
}

TEST_F(KnownScene, FramesThatItsPosesDoNotFitAreReported) {
  write_own("own");
  const auto note = [&](const std::string& poses, PoseDirection direction = PoseDirection::camera_to_world) {
    folder_.write("own/poses.txt", poses);
    RecordedScene::Settings s = settings("own", "poses.txt");
    s.pose_direction = direction;
    const auto notes = notes_of(scene(s));
    return notes.contains("poses do not fit") ? notes.at("poses do not fit") : std::string();
  };
  const Poses X_WC = camera_poses();
  EXPECT_EQ(note(matrices(X_WC)), "");
  EXPECT_EQ(note(matrices(X_WC, kInverse), PoseDirection::world_to_camera), "");
  EXPECT_HAS(note(matrices(X_WC, kInverse)), "scenario.pose_direction may be the other one");
  EXPECT_HAS(note(matrices(X_WC), PoseDirection::world_to_camera),
             "scenario.pose_direction may be the other one");
  EXPECT_HAS(note(matrices(X_WC, scaled(1000))), "with positions in millimetres by");
  EXPECT_HAS(note(matrices(X_WC, kTransposed)), "with transposed rotations by");
  EXPECT_HAS(note(matrices(X_WC, kFlipped)), "with y and z of the body reversed (as in OpenGL) by");
  std::string w_first;
  for (int i = 0; i < kFrames; ++i) {
    const Eigen::Quaterniond q(X_WC[i].linear());
    const Vec3 t = X_WC[i].translation();
    w_first += row({i / 30.0, t.x(), t.y(), t.z(), q.w(), q.x(), q.y(), q.z()}) + "\n";
  }
  EXPECT_HAS(note(w_first), "with quaternions with qw first by");
  EXPECT_EQ(note("# t tx ty tz qw qx qy qz\n" + w_first), "");
  EXPECT_HAS(note(matrices(Poses(X_WC.rbegin(), X_WC.rend()))), "with these poses the frames differ by");
}

TEST_F(KnownScene, TrueObjectsThatAreElsewhereAreRefusedOrReported) {
  write_own("own");
  folder_.write("own/truth/object.obj", "");
  const auto outcome = [&](const Change& change) {
    folder_.write("own/truth/poses.txt", matrices(object_poses(), change));
    std::string text;
    const std::string refused = refusal([&] {
      const auto notes = notes_of(scene(settings("own")));
      text = notes.contains("truth elsewhere") ? notes.at("truth elsewhere") : "nothing";
    });
    return text.empty() ? refused : text;
  };
  RigidTransform unknown;
  unknown.matrix().setConstant(std::nan(""));
  const std::pair<Change, std::string> rows[] = {
      {kAsIs, "nothing"},
      {scaled(1000),
       " m from what the camera measured there (median of the depth); with positions in "
       "millimetres it is "},
      {scaled(0.001), "; with positions 1000 times as large it is "},
      {kTransposed, "; with transposed rotations it is "},
      {kFlipped, "; with y and z of the body reversed (as in OpenGL) it is "},
      {kInverse, "poses.txt: no object is in the image of any frame: object is at x "},
      {kInverse, "; with the inverse poses, object is "},
      {behind(kFlip), "; with y and z of the parent frame reversed (as in OpenGL), object is "},
      {behind(pose({0, 0, -2}, {1, 0.5, 0})), " m in frame 0: expected"},  // no cause explains it
      {behind(pose({0.5, 0, 0}, Vec3::Zero())), "the true object object is "},
      {[&](const RigidTransform&) { return unknown; }, "poses.txt: has no known pose"},
  };
  for (const auto& row : rows) EXPECT_HAS(outcome(row.first), row.second);
}

// The poses of the object are those in a world V, whose origin is far from the camera.
TEST_F(KnownScene, TrueObjectsInAWorldAreRefusedWithTheirCause) {
  write_own("own");
  folder_.write("own/truth/object.obj", "");
  const RigidTransform X_VW = pose({2, 3, -4}, {0.5, 0, 0.2});
  const Change to_V = behind(X_VW);
  const Change inverse = [&](const RigidTransform& X) { return (X_VW * X).inverse(); };
  const auto refused = [&](const Change& of_object, const Change& of_camera) {
    folder_.write("own/truth/poses.txt", matrices(Poses(kFrames, kX_WO), of_object));
    folder_.write("own/poses.txt", matrices(camera_poses(), of_camera));
    return refusal([&] { scene(settings("own", "poses.txt")); });
  };
  EXPECT_HAS(refused(to_V, to_V), "; with poses object to world, object is ");
  EXPECT_HAS(refused(inverse, to_V), "; with poses world to object, object is ");
  const std::string camera = ", and the inverse poses of the camera, object is ";
  EXPECT_HAS(refused(to_V, inverse), "; with poses object to world" + camera);
  EXPECT_HAS(refused(inverse, inverse), "; with poses world to object" + camera);
}

TEST_F(KnownScene, AWrongDepthScaleIsRefused) {
  write_own("own");
  folder_.write("own/truth/object.obj", ""), folder_.write("own/truth/poses.txt", matrices(object_poses()));
  for (const auto& [factor, text] : {std::pair(0.1, "with 10 times"), {0.2, "with 5 times"}}) {
    write_camera("own", factor / 1000);
    EXPECT_HAS(
        refusal([&] { scene(settings("own")); }),
        std::string("own: its depths do not fit its true objects; ") + text + " the depth scale, object is");
  }
}

}  // namespace
}  // namespace remote_touch::known_scene_test
