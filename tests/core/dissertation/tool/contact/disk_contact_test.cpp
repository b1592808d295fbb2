#include "core/dissertation/tool/contact/disk_contact.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/box_tool.h"

namespace remote_touch::disk_contact_test {
namespace {

constexpr double kMissed_m = 5e-5;  // error of a search along two lines, at a corner

// Nineteen voxels high, so that its middle is the middle of a cell.
const auto kPlate = scenes::box_tool({0.01, 0.00475, 0.01});

SurfaceDisk disk_at(const Vec3& p_T, const Vec3& n_T, double radius_m = 1e-3) {
  return {p_T, n_T, radius_m, sample_field(*kPlate, p_T)};
}

TEST(DiskContact, ADiskBelowAFaceIsMetInItsPlane) {
  const SurfaceDisk disk = disk_at({0.001, -0.00485, 0.002}, Vec3::UnitY());
  const ToolContact contact = near_contact(*kPlate, disk, nearest_position(*kPlate, disk), 0);
  EXPECT_EQ(contact.n_T, Vec3(0, 1, 0));
  EXPECT_EQ(contact.side, 1);
  EXPECT_NEAR(contact.depth_m, -1e-4, 1e-9);
}

// The same disk faces away from the tool, so the tool is behind the surface.
TEST(DiskContact, TurnsThePlaneIfTheDiskFacesAway) {
  const SurfaceDisk disk = disk_at({0.001, -0.00485, 0.002}, -Vec3::UnitY());
  const ToolContact contact = near_contact(*kPlate, disk, nearest_position(*kPlate, disk), 0);
  EXPECT_EQ(contact.n_T, Vec3(0, 1, 0));
  EXPECT_EQ(contact.side, -1);
}

// A point that a frame puts halfway between two faces came from the sensor's side. The field has no clear
// direction there, so the normal decides.
TEST(DiskContact, TheNormalDecidesAtTheRidgeOfTheField) {
  for (const double up : {1.0, -1.0}) {
    const SurfaceDisk disk = disk_at({0.001, 0, 0.002}, {0, up, 0});
    ASSERT_LT(disk.at.gradient_T.norm(), 0.1);
    const ToolContact contact = near_contact(*kPlate, disk, nearest_position(*kPlate, disk), 0);
    EXPECT_EQ(contact.n_T, Vec3(0, up, 0));
    EXPECT_EQ(contact.side, 1);
  }
}

// A known side counts inside the tool, and nowhere else.
TEST(DiskContact, AKnownSideCountsInside) {
  const SurfaceDisk inside = disk_at({0.001, -0.00425, 0.002}, Vec3::UnitY()),
                    outside = disk_at({0.001, -0.00485, 0.002}, Vec3::UnitY());
  EXPECT_EQ(near_contact(*kPlate, inside, nearest_position(*kPlate, inside), -1).n_T, Vec3(0, -1, 0));
  EXPECT_EQ(near_contact(*kPlate, outside, nearest_position(*kPlate, outside), -1).n_T, Vec3(0, 1, 0));
}

// The disk lies beside the plate, edge-on and within reach of its rim: it touches the tool at the rim.
TEST(DiskContact, ADiskSeenEdgeOnIsMetAtItsRim) {
  const SurfaceDisk disk = disk_at({0.0112, 0.001, 0.002}, Vec3::UnitZ());
  const DiskPosition nearest = nearest_position(*kPlate, disk);
  EXPECT_TRUE(nearest.at_rim);
  EXPECT_NEAR((nearest.p_T - disk.p_T).norm(), disk.radius_m, 1e-12);
  const ToolContact contact = near_contact(*kPlate, disk, nearest, 0);
  EXPECT_NEAR(contact.depth_m, -2e-4, 1e-9);
  EXPECT_NEAR(contact.n_T.x(), -1, 1e-9);
  EXPECT_EQ(contact.side, 0);
}

// A corner of the plate lies above a disk. A dense scan of the disk finds no position that is nearer by more
// than a search along two lines can miss.
TEST(DiskContact, NoPlaceOfADiskBelowACornerIsNearer) {
  const Vec3 n = Vec3(1, -1, 1).normalized(), corner(0.01, -0.00475, 0.01);
  const Vec3 u = Vec3(1, 1, 0).normalized(), v = n.cross(u);
  for (const double off_m : {-6e-4, -3e-4, 0.0, 4e-4}) {
    const SurfaceDisk disk = disk_at(corner + 2e-4 * n + off_m * u, -n);
    double min_m = 1;
    for (int i = -50; i <= 50; ++i)
      for (int j = -50; j <= 50; ++j)
        if (i * i + j * j <= 2500)
          min_m = std::min(min_m,
                           sample_field(*kPlate, disk.p_T + disk.radius_m / 50 * (i * u + j * v)).distance_m);
    const DiskPosition nearest = nearest_position(*kPlate, disk);
    EXPECT_LE(nearest.at.distance_m, disk.at.distance_m);
    EXPECT_NEAR(nearest.at.distance_m, min_m, kMissed_m) << off_m;
    EXPECT_LE(lower_bound_m(disk), min_m);
  }
}

// The field over the disk of one point is flat if its slope is small. A merged disk also needs a small rise
// of the field across it.
TEST(DiskContact, FlatFieldDependsOnSlopeDepthAndExtent) {
  const double slope = 0.9 * disk_search::kFlatSlope, steep = 1.1 * disk_search::kFlatSlope;
  const double small_m = 0.9 * disk_search::kFlatDepth_m / slope,
               large_m = 1.1 * disk_search::kFlatDepth_m / slope;
  for (const double extent_m : {0.0, 1e-3}) {
    EXPECT_TRUE(is_flat(slope, small_m, extent_m));
    EXPECT_FALSE(is_flat(steep, small_m, extent_m));
    EXPECT_EQ(is_flat(slope, large_m, extent_m), extent_m == 0);
  }
}

TEST(DiskContact, FarAwayItIsTheMiddleWithTheBoundAsDistance) {
  const SurfaceDisk disk = disk_at({0.001, -0.00625, 0.002}, Vec3(1, 2, 0).normalized());
  const ToolContact contact = far_contact(disk, lower_bound_m(disk));
  EXPECT_EQ(contact.r_T, disk.p_T);
  EXPECT_NEAR((contact.n_T - Vec3::UnitY()).norm(), 0, 1e-6);
  EXPECT_EQ(contact.side, 1);
  EXPECT_LT(contact.depth_m, 0);
  EXPECT_GT(contact.depth_m, -disk.at.distance_m);
}

}  // namespace
}  // namespace remote_touch::disk_contact_test
