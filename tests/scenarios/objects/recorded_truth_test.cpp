// The true surface in the frames of a recording, from meshes that a test provides, and what is refused; and
// the truth of recordings that are kept outside of the repository.
#include "scenarios/objects/recorded_truth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/points/point_cloud.h"
#include "runners/experiment/mesh_files/mesh_file.h"
#include "scenarios/files/depth_images.h"
#include "tests/support/meshes.h"
#include "tests/support/recorded_data.h"
#include "tests/support/test_files.h"

namespace remote_touch::recorded_truth_test {
namespace {

namespace fs = std::filesystem;

constexpr double kReach_m = 0.03;
const CameraIntrinsics kCamera = {4, 3, 10, 10, 1.5, 1};
const std::string kUnknown = "nan nan nan nan nan nan nan nan nan nan nan nan nan nan nan nan\n";

// A pose without a rotation.
std::string at(double x, double y, double z) {
  return "1 0 0 " + std::to_string(x) + " 0 1 0 " + std::to_string(y) + " 0 0 1 " + std::to_string(z) +
         " 0 0 0 1\n";
}

// A square of 1 m in the plane z = 0 that points towards the camera, which is on the side of -z.
TriangleMesh sheet() {
  return {{{-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}}, {{0, 2, 1}, {0, 3, 2}}};
}

class Truths : public testing::Test {
 protected:
  // Adds an object whose mesh the reader returns for the file NAME.obj.
  void add(const std::string& name, const TriangleMesh& mesh, const std::string& poses,
           std::optional<bool> closed = {}) {
    meshes_[name] = mesh;
    truth_.objects.push_back({name, folder_ / (name + ".obj"), folder_.write(name + ".txt", poses), closed});
  }
  RecordedTruth read(std::size_t frames) const {
    const MeshReader reader = [this](const fs::path& file) { return meshes_.at(file.stem().string()); };
    return RecordedTruth(truth_, std::vector<std::string>(frames), kReach_m, reader, kCamera);
  }
  void expect_refused(const std::string& file, const std::string& part) const {
    const std::string text = refusal([&] { read(1); });
    EXPECT_EQ(text.rfind((folder_ / file).string() + ": ", 0), 0u) << text << "\nis not about " << file;
    EXPECT_HAS(text, part);
  }
  // Expects a refusal of a single object.
  void expect_mesh_refused(const TriangleMesh& mesh, std::optional<bool> closed, const std::string& part) {
    truth_.objects.clear();
    add("mesh", mesh, at(0, 0, 1), closed);
    expect_refused("mesh.obj", part);
  }

  const TestFolder folder_{"recorded_truth_test"};
  std::map<std::string, TriangleMesh> meshes_;
  TruthFolder truth_;
};

void expect_unknown(const NearestOnObjects& nearest) {
  EXPECT_TRUE(std::isnan(nearest.distance_m));
  EXPECT_TRUE(nearest.normal.array().isNaN().all());
  EXPECT_EQ(nearest.object, -1);
}

// The front of the box is at z = 0.9 in frame 0, and at z = 0.8 and x from 0.4 to 0.6 in frame 1.
TEST_F(Truths, FollowTheirPosesAndStayApart) {
  add("box", box_mesh({0.2, 0.2, 0.2}), at(0, 0, 1) + at(0.5, 0, 0.9) + kUnknown + at(0, 0, 1));
  add("table", sheet(), kUnknown + kUnknown + at(0, 0, 0.86) + at(0, 0, 0.89));
  const RecordedTruth truth = read(4);
  EXPECT_EQ(truth.objects().at(1).name, "table");
  EXPECT_TRUE(truth.poses(0)[0] && !truth.poses(0)[1] && !truth.poses(2)[0] && truth.poses(2)[1]);
  EXPECT_EQ(truth.poses(3)[1]->translation(), Vec3(0, 0, 0.89));
  const Vec3 p_C(0.05, 0.02, 0.88);
  EXPECT_TRUE(truth.at(0, p_C).normal.isApprox(-Vec3::UnitZ(), 1e-15));
  expect_unknown(truth.at(1, p_C));
  expect_unknown(truth.at(0, {0, 0.02, 0.869}));  // beyond the reach
  struct Row {
    std::size_t frame;
    Vec3 p_C;
    double distance_m;
    int object;
  };
  const Row rows[] = {{0, p_C, 0.02, 0},
                      {0, {0.05, 0.02, 0.91}, -0.01, 0},
                      {1, {0.55, 0.02, 0.79}, 0.01, 0},
                      {2, p_C, -0.02, 1},
                      {3, p_C, 0.01, 1}};
  for (const Row& row : rows) {
    EXPECT_NEAR(truth.at(row.frame, row.p_C).distance_m, row.distance_m, 1e-15) << row.frame;
    EXPECT_EQ(truth.at(row.frame, row.p_C).object, row.object) << row.frame;
  }
}

TEST_F(Truths, HoldInsideTheMask) {
  add("table", sheet(), at(0, 0, 1) + at(0, 0, 1));
  truth_.masks = folder_ / "mask";
  const std::vector<std::uint8_t> left = {255, 255, 0, 0, 255, 255, 0, 0, 255, 255, 0, 0};
  const std::vector<std::uint8_t> none(12, 0);
  folder_.write_png("mask/0000.png", 4, 3, PNG_FORMAT_GRAY, left.data());
  folder_.write_png("mask/0001.png", 4, 3, PNG_FORMAT_GRAY, none.data());
  const RecordedTruth truth = read(2);
  EXPECT_NEAR(truth.at(0, unproject(kCamera, 1, 1, 0.99)).distance_m, 0.01, 1e-15);
  expect_unknown(truth.at(0, unproject(kCamera, 2, 1, 0.99)));
  expect_unknown(truth.at(1, unproject(kCamera, 1, 1, 0.99)));
}

// An object is a solid if its mesh is one, unless it is stated to be a sheet.
TEST_F(Truths, AreClosedAsStatedOrAsTheMeshIs) {
  const TriangleMesh box = box_mesh({1, 1, 1});
  add("stated", box, at(0, 0, 1), true);
  add("unstated", box, at(0, 0, 1));
  add("room", meshes::inside_out(box), at(0, 0, 1), false);
  add("sheet", sheet(), at(0, 0, 1), false);
  const RecordedTruth truth = read(1);
  EXPECT_TRUE(truth.objects()[0].is_closed);
  EXPECT_TRUE(truth.objects()[1].is_closed);
  EXPECT_FALSE(truth.objects()[2].is_closed);
  EXPECT_FALSE(truth.objects()[3].is_closed);
}

// Reconstruction leaves such a fin on an edge of a box.
TEST_F(Truths, AreClosedInSpiteOfASmallFin) {
  TriangleMesh box = box_mesh({1, 1, 1});
  const auto [a, b, c] = box.triangles.front();
  box.vertices.push_back(1.0001 * (box.vertices[a] + box.vertices[b]) / 2);
  box.triangles.push_back({a, b, 8});
  add("stated", box, at(0, 0, 1), true);
  add("unstated", box, at(0, 0, 1));
  const RecordedTruth truth = read(1);
  EXPECT_TRUE(truth.objects()[0].is_closed);
  EXPECT_TRUE(truth.objects()[1].is_closed);
  expect_mesh_refused(meshes::inside_out(box), {}, "expected triangles counter-clockwise seen from outside");
}

TEST_F(Truths, AreRefusedIfAMeshIsNoSolidInMetres) {
  struct Row {
    TriangleMesh mesh;
    std::optional<bool> closed;
    std::string text;
  };
  const TriangleMesh box = box_mesh({0.2, 0.2, 0.2}), inverted = meshes::inside_out(box),
                     slab = box_mesh({0.4, 0.2, 0.4}), post = box_mesh({0.1, 0.1, 0.1}, {0, 0.1, 0});
  TriangleMesh open = box;
  open.triangles.pop_back();
  const std::string order = "expected triangles counter-clockwise";
  const Row rows[] = {
      {{}, {}, "no triangles: expected a mesh of triangles"},
      {{{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}}, {}, "1 triangle with a corner that is not a vertex"},
      {{{{0, 0, 0}, {1, 0, 0}, {NAN, 1, 0}}, {{0, 1, 2}}}, {}, "1 vertex that is not finite"},
      {{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}, {}, "no triangle has an area"},
      {box_mesh({85, 85, 85}),
       {},
       "its bounding box has a diagonal of 147.224319 m: metres expected, these may be millimetres"},
      {open, true, "not closed: 3 boundary edges (1 part, 11 triangles): expected a closed mesh"},
      {inverted, true, "inside out): " + order},
      {inverted, {}, "inside out): " + order},
      {meshes::together(slab, meshes::inside_out(post)), {}, "a part of the mesh is inside out: " + order},
  };
  for (const Row& row : rows) expect_mesh_refused(row.mesh, row.closed, row.text);
  truth_.objects.clear();
  add("long", box_mesh({9.99, 0.1, 0.1}), at(0, 0, 1));
  TriangleMesh stray = box;
  stray.vertices.emplace_back(0, 0, 5000);  // no triangle uses it
  add("stray", stray, at(0, 0, 1));
  EXPECT_EQ(read(1).objects().size(), 2u);
}

TEST_F(Truths, AreRefusedWithAnotherNumberOfPosesThanFrames) {
  add("box", box_mesh({0.2, 0.2, 0.2}), at(0, 0, 1) + at(0, 0, 1));
  expect_refused("box.txt", "2 poses for 1 frames");
  EXPECT_HAS(refusal([&] { read(3); }), "2 poses for 3 frames: expected one line for each frame");
  truth_.objects.clear();
  add("box", box_mesh({0.2, 0.2, 0.2}), at(0, 0, 1));
  add("table", sheet(), "# no pose\n");
  expect_refused("table.txt", "0 poses for 1 frames");
  truth_.objects.clear();
  add("box", box_mesh({0.2, 0.2, 0.2}), "1 0 0\n");
  expect_refused("box.txt:1", "has 3 words");
}

TEST_F(Truths, AreRefusedOutOfView) {
  add("box", box_mesh({0.2, 0.2, 0.2}), kUnknown + at(2, 0, 1) + at(0, 0, -1));
  const std::string place =
      "box.txt: no object is in the image of any frame: box is at x 2, y 0, z 1 m in frame 1";
  EXPECT_HAS(refusal([&] { read(3).require_view(kCamera, ""); }),
             place + ": expected object frame to camera");
  EXPECT_HAS(refusal([&] { read(3).require_view(kCamera, "; a cause"); }), place + "; a cause: expected");
  read(3).require_view({}, "");
  add("table", sheet(), kUnknown + kUnknown + at(0, 0, 1));
  read(3).require_view(kCamera, "");
}

TEST_F(Truths, PassOnTheRefusalOfAReader) {
  truth_.objects.push_back({"gone", folder_ / "gone.obj", folder_.write("gone.txt", at(0, 0, 1)), {}});
  const MeshReader reader = [](const fs::path& file) -> TriangleMesh {
    throw InputError(file.string(), "no such file");
  };
  EXPECT_HAS(refusal([&] { RecordedTruth(truth_, {"0.png"}, kReach_m, reader, kCamera); }),
             "gone.obj: no such file");
}

}  // namespace
}  // namespace remote_touch::recorded_truth_test

// Against the depth images of the recordings; skipped where they are missing.
namespace remote_touch::real_truth_test {
namespace {

namespace fs = std::filesystem;

constexpr double kReach_m = 0.03;

#define SKIP_WITHOUT(path) \
  if (!fs::exists(path)) GTEST_SKIP() << "recorded data are missing: " << (path)

const MeshReader kReader = [](const fs::path& file) { return read_mesh(file); };

// The points of every seventh pixel that has a depth, in the camera frame.
std::vector<Vec3> points_of(const fs::path& recording, int frame, const CameraIntrinsics& camera,
                            double metres_per_unit) {
  char name[16];
  std::snprintf(name, sizeof name, "%04d.png", frame);
  const DepthImage depth =
      read_depth_png(recording / "depth" / name, metres_per_unit, std::numeric_limits<double>::infinity());
  std::vector<Vec3> points_C;
  for (std::size_t i = 0; i < depth.z_m.size(); i += 7)
    if (!std::isnan(depth.z_m[i]))
      points_C.push_back(unproject(camera, static_cast<double>(i % static_cast<std::size_t>(depth.width)),
                                   static_cast<double>(i / static_cast<std::size_t>(depth.width)),
                                   depth.z_m[i]));
  return points_C;
}

double quantile(std::vector<double> values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

// The box was rendered without noise. Its depth was stored in half floats, cut off towards the camera in
// steps of up to 0.49 mm. A wrong axis, row order or unit would be off by centimetres.
TEST(RecordedData, RenderedBoxIsAtItsTruth) {
  const fs::path recording = data_root() / "rgbd/visp_teabox_synthetic";
  SKIP_WITHOUT(recording);
  const CameraIntrinsics camera = {640, 480, 600, 600, 320, 240};
  const TruthFolder folder = find_truth(recording).value();
  ASSERT_EQ(folder.objects.size(), 1u);
  const RecordedTruth truth(folder, std::vector<std::string>(49), kReach_m, kReader, camera);
  EXPECT_TRUE(truth.objects()[0].is_closed);
  std::vector<double> distances_m, sizes_m;
  for (const int frame : {0, 20, 48})
    for (const Vec3& p_C : points_of(recording, frame, camera, 1e-4)) {
      const NearestOnObjects nearest = truth.at(static_cast<std::size_t>(frame), p_C);
      ASSERT_FALSE(std::isnan(nearest.distance_m)) << frame << ": " << p_C.transpose();
      distances_m.push_back(nearest.distance_m), sizes_m.push_back(std::abs(nearest.distance_m));
    }
  EXPECT_GT(distances_m.size(), 15000u);
  EXPECT_GT(quantile(distances_m, 0.5), 0);
  EXPECT_LT(quantile(distances_m, 0.5), 0.0003);
  EXPECT_LT(quantile(sizes_m, 0.9), 0.0005);
  EXPECT_LT(quantile(sizes_m, 1), 0.0006);
}

// The README of the recording states the errors along z: a median of -3.0 and a p90 of 5.0 mm for the cube in
// the frames in which the camera is still. They are smaller across the faces.
TEST(RecordedData, MeasuredCubeIsMillimetresFromItsTruth) {
  const fs::path recording = data_root() / "rgbd/visp_cube_dragon";
  SKIP_WITHOUT(recording);
  const CameraIntrinsics camera = {640, 480, 607.178467, 607.234253, 321.391296, 241.918228};
  const RecordedTruth truth(find_truth(recording).value(), std::vector<std::string>(70), kReach_m, kReader,
                            camera);
  ASSERT_EQ(truth.objects().size(), 3u);
  EXPECT_TRUE(truth.objects()[0].is_closed && truth.objects()[1].is_closed) << "apart from three fins";
  EXPECT_EQ(truth.objects()[2].name, "table");
  EXPECT_FALSE(truth.objects()[2].is_closed);
  std::vector<double> distances_m;
  for (const Vec3& p_C : points_of(recording, 0, camera, 1e-3)) {
    const NearestOnObjects nearest = truth.at(0, p_C);
    const bool is_above_the_table = (truth.poses(0)[0]->inverse() * p_C).z() > -0.035;
    if (nearest.object == 0 && is_above_the_table && std::abs(nearest.distance_m) < 0.02)
      distances_m.push_back(nearest.distance_m);
  }
  EXPECT_GT(distances_m.size(), 1500u);
  EXPECT_NEAR(quantile(distances_m, 0.5), 0.0021, 0.0005);
  EXPECT_NEAR(quantile(distances_m, 0.9), 0.0036, 0.001);
}

}  // namespace
}  // namespace remote_touch::real_truth_test
