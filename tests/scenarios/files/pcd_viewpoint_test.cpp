// The position of the camera of a PCD file.
#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/files/pcd_file.h"
#include "tests/support/test_files.h"

namespace remote_touch::pcd_viewpoint_test {
namespace {

PcdCloud read_text(const std::string& bytes) {
  const TestFolder folder("pcd_viewpoint_test");
  return read_pcd(folder.write("cloud.pcd", bytes));
}

std::string refusal_of(const std::string& bytes) {
  return refusal([&] { read_text(bytes); });
}

// Returns the point of pixel (u, v) in the camera's frame.
Vec3 seen_by(int u, int v) {
  return {0.2 * (u - 1.5), 0.2 * (v - 1), 2 + 0.1 * u};
}

// Returns a file with a wall in 4 x 3 pixels before a camera at X_FC. The colours identify the pixels, which
// are stored from left to right or from right to left.
std::string wall_before(const RigidTransform& X_FC, const std::string& viewpoint, bool right_to_left) {
  std::string pcd = pcd_header("x y z rgb", "4 4 4 4", "F F F U", "1 1 1 1", "4", "3", "12", "ascii");
  for (int i = 0; i < 12; ++i) {
    const int u = right_to_left ? 3 - i % 4 : i % 4, v = i / 4;
    const Vec3 p = X_FC * seen_by(u, v);
    for (const double value : {p.x(), p.y(), p.z()}) pcd += std::to_string(value) + " ";
    pcd += std::to_string(10 * v + u) + "\n";
  }
  return seen_from(pcd, viewpoint);
}

TEST(PcdViewpoint, IsWhereTheCameraIs) {
  const RigidTransform X_FC =
      Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitY());
  for (const bool right_to_left : {false, true})
    for (const char* turn :
         {"0.70710678 0 0.70710678 0", "0 0.70710678 0 -0.70710678"}) {  // along z, against it
      const PcdCloud file = read_text(wall_before(X_FC, std::string("1 2 3 ") + turn, right_to_left));
      ASSERT_TRUE(file.cloud.image) << turn;
      EXPECT_FALSE(file.has_unused_viewpoint);
      EXPECT_TRUE(file.X_FC.isApprox(X_FC, 1e-6));
      for (std::size_t i = 0; i < 12; ++i) {
        const int u = static_cast<int>(i % 4), v = static_cast<int>(i / 4);
        EXPECT_EQ(file.cloud.colour[i], static_cast<std::uint32_t>(10 * v + u));
        EXPECT_TRUE(file.cloud.point(i).isApprox(seen_by(u, v), 1e-5));
      }
    }
}

TEST(PcdViewpoint, IsNotUsedWhereTheImageIsSeenFromTheOrigin) {
  const CameraIntrinsics camera{16, 12, 20, 25, 7.25, 5.5};
  const std::string at_origin = organised_pcd(camera, 0);
  const PcdCloud expected = read_text(at_origin), other = read_text(seen_from(at_origin, "0 0.5 -2 1 0 0 0"));
  EXPECT_TRUE(other.has_unused_viewpoint);
  EXPECT_TRUE(other.X_FC.matrix().isIdentity(0));
  ASSERT_TRUE(other.cloud.image);
  EXPECT_EQ(other.cloud.x[3], expected.cloud.x[3]);
  // A sensor at the origin may have its own frame turned in any way: the points are the same, bit for bit.
  const PcdCloud turned = read_text(seen_from(at_origin, "0 0 0 0 1 0 0"));
  EXPECT_FALSE(turned.has_unused_viewpoint);
  EXPECT_EQ(turned.cloud.x[3], expected.cloud.x[3]);
  EXPECT_EQ(turned.cloud.image->camera.fx, expected.cloud.image->camera.fx);
  EXPECT_TRUE(
      read_text(seen_from(xyz_header("1", "ascii") + "1 2 3\n", "0 0 1 1 0 0 0")).has_unused_viewpoint);
}

TEST(PcdViewpoint, FramesWithoutAnyPointHaveNothingToTurn) {
  const std::string holes = xyz_header("2", "ascii") + "nan nan nan\nnan nan nan\n";
  EXPECT_FALSE(read_text(seen_from(holes, "0 0.5 -2 1 0 0 0")).has_unused_viewpoint);
}

// The axes of the sensor are not those of the file: the points form an image along x, against z, and so on.
TEST(PcdViewpoint, ATurnAtTheOriginTurnsTheCamera) {
  const std::vector<std::pair<RigidTransform, std::string>> turns = {
      {RigidTransform(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitY())), "0.70710678 0 0.70710678 0"},
      {RigidTransform(Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitX())), "0 1 0 0"}};
  for (const auto& [X_FC, turn] : turns) {
    const PcdCloud file = read_text(wall_before(X_FC, "0 0 0 " + turn, false));
    ASSERT_TRUE(file.cloud.image) << turn;
    EXPECT_FALSE(file.has_unused_viewpoint);
    EXPECT_TRUE(file.X_FC.isApprox(X_FC, 1e-6));
    EXPECT_TRUE(file.cloud.point(6).isApprox(seen_by(2, 1), 1e-5));
  }
}

// The image is seen along z, but the VIEWPOINT says that the camera looks elsewhere; points in no order are
// no image at all.
TEST(PcdViewpoint, ATurnAwayFromTheImageIsReported) {
  const CameraIntrinsics camera{16, 12, 20, 25, 7.25, 5.5};
  const PcdCloud turned = read_text(seen_from(organised_pcd(camera, 0), "0 0 0 0.70710678 0 0.70710678 0"));
  EXPECT_TRUE(turned.has_unused_viewpoint);
  EXPECT_TRUE(turned.X_FC.matrix().isIdentity(0));
  EXPECT_TRUE(turned.cloud.image);
  const std::string unorganised = xyz_header("1", "ascii") + "1 2 3\n";
  EXPECT_TRUE(read_text(seen_from(unorganised, "0 0 0 0 1 0 0")).has_unused_viewpoint);
  EXPECT_FALSE(read_text(seen_from(unorganised, "0 0 0 0 0 0 0")).has_unused_viewpoint)
      << "zeros for unknown";
  EXPECT_FALSE(read_text(seen_from(unorganised, "0 0 0 -1 0 0 0")).has_unused_viewpoint)
      << "no rotation, too";
}

TEST(PcdViewpoint, IsRefusedIfItIsNotSevenNumbers) {
  const std::string good = xyz_header("1", "ascii") + "1 2 3\n";
  EXPECT_HAS(refusal_of(seen_from(good, "0 0 1")), "VIEWPOINT has 3 values: expected 7");
  EXPECT_HAS(refusal_of(seen_from(good, "0 0 one 1 0 0 0")), "VIEWPOINT has 'one': expected numbers");
  EXPECT_HAS(refusal_of(seen_from(good, "0 0 inf 1 0 0 0")), "VIEWPOINT has 'inf': expected numbers");
  EXPECT_HAS(refusal_of(seen_from(good, "0 0 1 1 0 0 1")), "a quaternion of length 1.414214: expected 1");
}

}  // namespace
}  // namespace remote_touch::pcd_viewpoint_test
