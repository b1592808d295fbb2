// The fraction of a motion after which a point touches, and the continuous rule that uses it.
#include "core/dissertation/tool_motion/contact_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <tuple>

#include "tests/support/box_tool.h"
#include "tests/support/cloud_form.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace remote_touch::continuous_contacts_test {
namespace {

VoxelTool made(const TriangleMesh& mesh, double voxel_m = 5e-4) {
  ToolReport report;
  return make_voxel_tool(mesh, {.voxel_m = voxel_m, .outer_field = true}, report);
}

double field(const VoxelTool& tool, const Vec3& p_T) {
  return sample_field(tool, p_T).distance_m;
}

Vector6 shift(const Vec3& by) {
  Vector6 a_g = Vector6::Zero();
  a_g.head<3>() = by;
  return a_g;
}

class OfABox : public testing::Test {
 protected:
  double fraction(const Vec3& p_T, const Vector6& a_g) const {
    return way_.fraction({ToolPose{}, a_g}, p_T, field(tool_, p_T));
  }
  static const VoxelTool& box() {
    static const VoxelTool tool = made(box_mesh({0.03, 0.02, 0.01}));
    return tool;
  }
  const VoxelTool& tool_ = box();
  const ClearWay way_{tool_};
};

// Closed form of a motion towards a face: it ends where the point is kTouch_m outside.
TEST_F(OfABox, EndsWhereAPointTouches) {
  for (const double distance_m : {2e-6, 1e-5, 2e-4, 7e-4, 2e-3})
    for (const double motion_m : {3e-4, 1e-3, 3e-3}) {
      const Vec3 p_T(0.002, -0.001, 0.005 + distance_m);
      const double expected = std::min(1.0, (distance_m - ClearWay::kTouch_m) / motion_m);
      const double accuracy = 1e-5 + 2e-8 / motion_m;  // 1e-5 of the way, and 2e-8 m of the field
      EXPECT_NEAR(fraction(p_T, shift({0, 0, motion_m})), expected, accuracy)
          << distance_m << " " << motion_m;
      EXPECT_LE(fraction(p_T, shift({0, 0, motion_m})), expected + 1e-7);
    }
}

// A point nearer than kTouch_m touches, even if the motion ends before the surface.
TEST_F(OfABox, EndsBeforeAMotionThatWouldEndAHairOutside) {
  for (const double distance_m : {2e-4, 7e-4, 2e-3}) {
    const Vec3 p_T(0.002, -0.001, 0.005 + distance_m);
    const double motion_m = distance_m - 0.5 * ClearWay::kTouch_m;
    EXPECT_LE(fraction(p_T, shift({0, 0, motion_m})) * motion_m, distance_m - 0.9 * ClearWay::kTouch_m)
        << distance_m;
  }
}

TEST_F(OfABox, AMotionAlongAwayOrFarFromAFaceIsWhole) {
  const Vec3 at_face(0.002, -0.001, 0.005 + 2e-6);
  const std::tuple<const char*, Vec3, Vec3, double> cases[] = {
      {"along the face", at_face, {1e-3, 3e-4, 0}, 1},
      {"away from it", at_face, {1e-3, 3e-4, -1e-3}, 1},
      {"from the surface itself", {0.002, -0.001, 0.005}, {1e-3, 0, -1e-6}, 1},
      {"a point in the tool", {0, 0, 0.004}, {0, 0, 1e-3}, 1},
      {"out of the tool", {0, 0, 0.0049}, {0, 0, -1e-3}, 1},
      {"a hair inside counts as touching", {0, 0, 0.005 - 1e-6}, {0, 0, 1e-3}, 0},
      {"a far point", {0, 0, 0.05}, {0, 0, 1e-3}, 1},
      {"a point beyond the motion", {0, 0, 0.0105}, {0, 0, 1e-3}, 1}};
  for (const auto& [what, p_T, by, expected] : cases) EXPECT_EQ(fraction(p_T, shift(by)), expected) << what;
}

// A fraction below the limit is the same as without one; one above it is only known to be above it.
TEST_F(OfABox, FractionsUpToALimitAreThoseWithoutOne) {
  std::mt19937 random(29);
  std::uniform_real_distribution<double> any(-1, 1);
  int below = 0, above = 0;
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p_T = Vec3(0.016, 0.011, 0.006).cwiseProduct(Vec3(any(random), any(random), any(random)));
    Vector6 a_g;
    for (int k = 0; k < 6; ++k) a_g[k] = (k < 3 ? 1e-3 : 0.03) * any(random);
    const ClearWay::Motion motion({}, a_g);
    const double distance_m = field(tool_, p_T), exact = way_.fraction(motion, p_T, distance_m);
    if (exact == 1) continue;
    for (const double limit : {exact, 0.5 * (any(random) + 1), exact + 1e-6 * any(random)}) {
      const double found = way_.fraction(motion, p_T, distance_m, limit);
      EXPECT_TRUE(exact <= limit ? found == exact : found > limit) << found << " " << exact << " " << limit;
      ++(exact <= limit ? below : above);
    }
  }
  EXPECT_GT(below, 1000);
  EXPECT_GT(above, 500);
}

TEST_F(OfABox, NoOtherPointIsInsideAfterASafeMotion) {
  const double safe_m = way_.safe_motion_m(2e-3);
  EXPECT_GT(safe_m, 1e-3);
  EXPECT_LE(safe_m, 2e-3);
  EXPECT_LE(way_.safe_motion_m(0.005), 3e-3);
  std::mt19937 random(23);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto vector = [&] { return Vec3(any(random), any(random), any(random)); };
  int tried = 0;
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p_T = vector().cwiseProduct(Vec3(0.019, 0.014, 0.009));
    if (field(tool_, p_T) < 2e-3 || field(tool_, p_T) > 2.5e-3) continue;
    const Vec3 by = safe_m * vector().normalized();
    EXPECT_GT(field(tool_, p_T - by), 0);
    EXPECT_EQ(fraction(p_T, shift(by)), 1);
    ++tried;
  }
  EXPECT_GT(tried, 500);
}

// Compared with dense samples of the true motion through moved(): the way never ends too late, and hardly too
// early.
TEST(ClearWay, IsNoLaterThanDenseSamples) {
  const VoxelTool tools[] = {
      made(find_generated_tool("bar")->make()), made(meshes::any_body("ball"), 1e-3),
      made(meshes::moved(find_generated_tool("fork")->make(), meshes::rotated(), Vec3::Zero()), 1e-3)};
  std::mt19937 random(17);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto vector = [&] { return Vec3(any(random), any(random), any(random)); };
  int stopped = 0, tried = 0;
  double early_m = 0;
  for (const VoxelTool& tool : tools) {
    const ClearWay way(tool);
    for (int n = 0; n < 1500; ++n) {
      const auto& face = tool.mesh.triangles[random() % tool.mesh.triangles.size()];
      const double s = 0.5 * (any(random) + 1);
      const Vec3 p_T = tool.mesh.vertices[face[0]] +
                       s * (tool.mesh.vertices[face[1]] - tool.mesh.vertices[face[0]]) + 7e-4 * vector();
      const double start_m = field(tool, p_T);
      if (start_m < ClearWay::kTouch_m) continue;
      const ToolPose pose{0.2 * vector(), rotation(2 * vector())};
      Vector6 a_g;
      a_g << 1.2e-3 * vector(), 0.03 * vector();
      const Vec3 p_W = pose.p_W + pose.q_WT * p_T;
      const double found = way.fraction({pose, a_g}, p_T, start_m);
      const auto at = [&](double part) {
        const ToolPose there = moved(pose, part * a_g);
        return field(tool, there.q_WT.conjugate() * (p_W - there.p_W));
      };
      double first = 1;  // first sample at which the field is below kTouch_m
      for (int i = 1; i <= 400 && first == 1; ++i)
        if (at(i / 400.0) < ClearWay::kTouch_m - 1e-12) first = i / 400.0;
      ASSERT_LE(found, first) << "of " << start_m;
      ++tried;
      if (found == 1) continue;
      ++stopped;
      // The remaining distance at the stop is hardly more than the bend of the point's path.
      early_m = std::max(early_m, at(found));
    }
  }
  EXPECT_GT(tried, 2000);
  EXPECT_GT(stopped, 300);
  EXPECT_LT(early_m, 8e-5);
}

constexpr double kLength_m = 0.006, kShorter_m = 3e-4, kApart_m = 1e-3;

// Two pins of half a millimetre side by side, one of them shorter at its lower end.
std::shared_ptr<const VoxelTool> two_pins() {
  auto tool = std::make_shared<VoxelTool>(*scenes::box_tool({1.25e-3, kLength_m, 2.5e-4}, 1.25e-4));
  const VoxelGrid& grid = tool->grid;
  std::size_t node = 0;
  for (int k = 0; k <= grid.cells[2]; ++k)
    for (int j = 0; j <= grid.cells[1]; ++j)
      for (int i = 0; i <= grid.cells[0]; ++i) {
        const Vec3 p_T = grid.origin_T + grid.size_m * Vec3(i, j, k), half_m(2.5e-4, kLength_m, 2.5e-4);
        const double longer_m = scenes::box_distance(half_m, p_T),
                     shorter_m = scenes::box_distance(half_m, p_T - Vec3(kApart_m, kShorter_m, 0));
        tool->distance_m[node++] = static_cast<float>(std::min(longer_m, shorter_m));
      }
  return tool;
}

// One merged disk replaces many points of a dense flat surface. Its search finds only the pin towards which
// the field falls. Points in the other pin are found all the same.
TEST(ContinuousContacts, PointsInThePartThatADiskDoesNotFindAreFound) {
  constexpr double kDepth_m = 2e-4;
  const auto pin = two_pins();
  const PointCloud cloud = scenes::dense_plane();
  ToolParameters p;
  p.contact_rule = ContactRule::continuous;
  ContactList points(pin, p, scenes::kernels());
  points.on_frame(in_form<TiledCloud>(cloud, used_merged_disk_m(p)));
  ContinuousContacts contacts(p, *pin);
  contacts.begin(points);
  int not_told = 0;
  for (int j = 0; j < 10; ++j)
    for (int i = 0; i < 10; ++i) {
      ToolPose pose{{2e-4 * i, kLength_m - kDepth_m, 2e-4 * j}, Eigen::Quaterniond::Identity()};
      not_told += contacts.near(pose, 0).deepest_m <= ContinuousContacts::kGap_m ? 1 : 0;
      EXPECT_TRUE(contacts.has_points_inside(pose)) << i << " " << j;
      pose.p_W.y() = kLength_m + kDepth_m;
      EXPECT_FALSE(contacts.has_points_inside(pose)) << i << " " << j;
    }
  EXPECT_GT(not_told, 0);
}

// A motion away from one surface stops where the tool meets another surface ahead. A surface inside the tool
// stops it at once. A surface that the tool only slides along does not stop it.
TEST(ContinuousContacts, ASurfaceAheadStopsAMotionUnlessItOnlyTouches) {
  const Vec3 half_m(0.005, 0.003, 0.004);
  const auto tool = scenes::box_tool(half_m, 2.5e-4);
  ToolParameters p;
  p.contact_rule = ContactRule::continuous;
  ContactList points(tool, p, scenes::kernels());
  points.on_frame(in_form<TiledCloud>(scenes::dense_plane(), 0.0));
  ContinuousContacts contacts(p, *tool);
  contacts.begin(points);
  const auto fraction = [&](double height_m, const Vec3& shift_W, double side) {
    return contacts.fraction_ahead({{0, half_m.y() + height_m, 0}, Eigen::Quaterniond::Identity()},
                                   shift(shift_W), side);
  };
  EXPECT_NEAR(fraction(2e-4, {0, -4e-4, 0}, 1), (2e-4 - ClearWay::kTouch_m) / 4e-4, 1e-3);
  EXPECT_EQ(fraction(2e-4, {0, -1e-4, 0}, 1), 1);
  EXPECT_EQ(fraction(1.5e-6, {3e-4, -3e-7, 0}, 1), 1) << "along it";
  EXPECT_EQ(fraction(-1e-4, {3e-4, -3e-7, 0}, 1), 0) << "in it";
  for (const double height_m : {2e-4, -1e-4}) {
    EXPECT_EQ(fraction(height_m, {0, 4e-4, 0}, 1), 1) << "away from it";
    EXPECT_EQ(fraction(height_m, {0, -4e-4, 0}, -1), 1) << "its back";
  }
}

}  // namespace
}  // namespace remote_touch::continuous_contacts_test
