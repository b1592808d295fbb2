// Spheres packed into a tool, their penetration volume, and the motion that it causes, against closed forms.
#include "core/rivals/inner_sphere_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/dissertation/tool_motion/tool_renderer.h"
#include "core/mesh/triangle_mesh.h"
#include "core/mesh/triangle_tree.h"
#include "core/parameters/parameter.h"
#include "core/points/vector.h"
#include "runners/evaluation/contract/allocation_counter.h"
#include "tests/core/dissertation/tool_motion/free_space.h"
#include "tests/support/box_tool.h"
#include "tests/support/scenes.h"

namespace remote_touch::inner_spheres_test {
namespace {

constexpr double kRounding_m = 1e-9;
const Vec3 kHalf_m(0.02, 0.005, 0.01);

VoxelTool tool_of(const std::string& name, double voxel_m = 5e-4) {
  ToolReport report;
  return make_voxel_tool(find_generated_tool(name)->make(), {.voxel_m = voxel_m}, report);
}

const std::shared_ptr<const VoxelTool>& tool() {
  static const std::shared_ptr<const VoxelTool> made = scenes::box_tool(kHalf_m);
  return made;
}

const std::shared_ptr<const InnerSpheres>& spheres() {
  static const auto made = std::make_shared<const InnerSpheres>(make_inner_spheres(*tool(), 400));
  return made;
}

const InnerSpheres& in_box() {
  return *spheres();
}

// Sum over all spheres of their parts below the plane y = 0, for a tool that is not turned.
double below_m3(const InnerSpheres& of, double height_m) {
  double volume_m3 = 0;
  for (const Sphere& sphere : of.spheres)
    volume_m3 += cap_behind(sphere.radius_m, sphere.centre.y() + height_m).volume_m3;
  return volume_m3;
}

double gap_m(const Sphere& a, const Sphere& b) {
  return (a.centre - b.centre).norm() - a.radius_m - b.radius_m;
}

void expect_no_overlap(const std::vector<Sphere>& spheres) {
  double smallest_m = 1;
  for (std::size_t i = 0; i < spheres.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) smallest_m = std::min(smallest_m, gap_m(spheres[i], spheres[j]));
  EXPECT_GT(smallest_m, -kRounding_m);
}

TEST(InnerSpheres, DoNotOverlap) {
  ASSERT_GT(in_box().spheres.size(), 300u);
  expect_no_overlap(in_box().spheres);
  expect_no_overlap(make_inner_spheres(tool_of("fork", 1e-3), 300).spheres);
}

// The winding number says which side of the mesh a centre is on.
TEST(InnerSpheres, LieInsideABoxAndAMeshThatIsNotConvex) {
  const VoxelTool fork = tool_of("fork", 1e-3), box = *scenes::box_tool(kHalf_m);
  for (const VoxelTool* tool : {&fork, &box}) {
    const TriangleTree tree(tool->mesh);
    for (const Sphere& sphere : make_inner_spheres(*tool, 300).spheres) {
      EXPECT_GT(tree.winding_number(sphere.centre), 0.9);
      EXPECT_GE(std::sqrt(tree.nearest(sphere.centre, 0).squared_m2), sphere.radius_m - kRounding_m);
      EXPECT_GE(sphere.radius_m, 0.9 * tool->grid.size_m);
    }
  }
}

// The largest sphere in a cube of half side a has the radius a. The next eight touch it and three faces:
// r = a (sqrt 3 - 1) / (sqrt 3 + 1).
TEST(InnerSpheres, AreTheLargestThatFitIntoACube) {
  constexpr double a = 0.01;
  const std::vector<Sphere> spheres = make_inner_spheres(*scenes::box_tool({a, a, a}), 9).spheres;
  ASSERT_EQ(spheres.size(), 9u);
  EXPECT_NEAR(spheres[0].radius_m, a, 1e-6);
  EXPECT_NEAR(spheres[0].centre.norm(), 0, 1e-6);
  const double root = std::sqrt(3.0), r = a * (root - 1) / (root + 1);
  for (std::size_t i = 1; i < 9; ++i) {
    EXPECT_NEAR(spheres[i].radius_m, r, 0.02 * r) << i;
    EXPECT_NEAR((spheres[i].centre.cwiseAbs() - Vec3::Constant(a - r)).norm(), 0, 0.05 * r) << i;
  }
}

// Equal spheres in a cubic lattice fill 52 % of space.
TEST(InnerSpheres, CoverageIsTheirShareOfTheVolume) {
  double volume_m3 = 0;
  for (const Sphere& s : in_box().spheres) volume_m3 += 4 * std::numbers::pi / 3 * std::pow(s.radius_m, 3);
  EXPECT_NEAR(in_box().coverage, volume_m3 / (8 * kHalf_m.prod()), 1e-12);
  EXPECT_GT(in_box().coverage, 0.6);
}

TEST(InnerSpheres, EqualTheirMirrorImagesInABox) {
  const std::vector<Sphere>& spheres = in_box().spheres;
  const std::size_t complete = spheres.size() < 400 ? spheres.size() : 400 - 8;  // the last may lack images
  for (std::size_t i = 0; i < complete; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 image = spheres[i].centre;
      image[axis] = -image[axis];
      EXPECT_TRUE(std::any_of(spheres.begin(), spheres.end(),
                              [&](const Sphere& other) {
                                return other.centre == image && other.radius_m == spheres[i].radius_m;
                              }))
          << i << " " << axis;
    }
}

TEST(InnerSpheres, NeighboursAreThePairsWithSmallGaps) {
  const InnerSpheres& made = in_box();
  const auto count = static_cast<std::uint32_t>(made.spheres.size());
  for (std::uint32_t i = 0; i < count; ++i)
    for (std::uint32_t j = 0; j < count; ++j) {
      const auto of_i = made.neighbours(i), of_j = made.neighbours(j);
      const bool is_listed = std::binary_search(of_i.begin(), of_i.end(), j);
      EXPECT_EQ(is_listed, std::binary_search(of_j.begin(), of_j.end(), i));
      if (i != j && gap_m(made.spheres[i], made.spheres[j]) <= 5e-4) {
        EXPECT_TRUE(is_listed);
      }
    }
}

// Thirty spheres in a key lie so far apart that few of them are neighbours by their gaps.
TEST(InnerSpheres, EverySphereCanBeReached) {
  for (const InnerSpheres& made : {in_box(), make_inner_spheres(tool_of("key", 1e-3), 30)}) {
    std::vector<std::uint32_t> reached{0};
    std::vector<bool> is_reached(made.spheres.size(), false);
    is_reached[0] = true;
    for (std::size_t i = 0; i < reached.size(); ++i)
      for (const std::uint32_t to : made.neighbours(reached[i])) {
        if (!is_reached[to]) reached.push_back(to);
        is_reached[to] = true;
      }
    EXPECT_EQ(reached.size(), made.spheres.size());
  }
}

TEST(InnerSpheres, AskForASmallerVoxelIfNoneFits) {
  VoxelTool tool = *scenes::box_tool({0.002, 0.002, 0.002});
  for (float& distance : tool.distance_m) distance = std::abs(distance) + 1e-6f;
  EXPECT_THROW(make_inner_spheres(tool, 10), InputError);
}

TEST(InnerSpheres, TextRoundsTheCoverageDown) {
  InnerSpheres made;
  made.spheres.resize(12);
  made.coverage = 0.70599;
  EXPECT_EQ(text(made), "12 inner spheres fill 70.5 % of the tool");
}

// Compares with a search through all spheres.
TEST(SphereLocator, FindsTheSphereThatContainsAPosition) {
  const std::vector<Sphere>& spheres = in_box().spheres;
  const SphereLocator locator(spheres);
  const PointCloud positions = scenes::random_cloud(20000, 0.021, 3);
  int found = 0;
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const Vec3 p = positions.point(k);
    std::optional<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < spheres.size() && !expected; ++i)
      if ((p - spheres[i].centre).squaredNorm() < spheres[i].radius_m * spheres[i].radius_m) expected = i;
    EXPECT_EQ(locator.at(p), expected);
    found += expected ? 1 : 0;
  }
  EXPECT_GT(found, 1000);
  EXPECT_LT(found, 19000);
  EXPECT_FALSE(locator.at({0, std::nan(""), 0}));
  EXPECT_FALSE(locator.at({1e300, 0, 0}));
}

// --- the penetration volume, against the closed form for half-spaces, in a ball and in a box ---

// A tool with its spheres.
class Probe {
 public:
  Probe(std::shared_ptr<const VoxelTool> tool, int spheres)
      : made_(std::make_shared<const InnerSpheres>(make_inner_spheres(*tool, spheres))),
        finder_(tool, scenes::kernels()),
        query_(made_) {}

  SpherePenetration in(const PointCloud& cloud, const ToolPose& pose) {
    const auto tiles = std::make_shared<TiledCloud>();
    tiles->assign(cloud);
    finder_.on_frame(tiles);
    return query_.penetration(pose, finder_);
  }
  SpherePenetration again(const ToolPose& pose) { return query_.penetration(pose, finder_); }
  const InnerSpheres& spheres() const { return *made_; }

 private:
  std::shared_ptr<const InnerSpheres> made_;
  TouchFinder finder_;
  PenetrationQuery query_;
};

Probe ball() {
  ToolReport report;
  return {std::make_shared<const VoxelTool>(make_voxel_tool(find_generated_tool("ball")->make(), {}, report)),
          1000};
}
Probe& box() {
  static Probe probe(scenes::box_tool(kHalf_m), 1000);
  return probe;
}

// Points at y = 0, 0.4 mm apart, with normals along y. They are symmetric about x = 0 and z = 0. Only those
// with x from low_x_m to high_x_m are there.
PointCloud sheet(double low_x_m = -1, double high_x_m = 1) {
  constexpr double spacing_m = 4e-4;
  PointCloud cloud;
  for (int k = -33; k < 33; ++k)
    for (int i = -63; i < 63; ++i) {
      const Vec3 p = spacing_m * Vec3(i + 0.5, 0, k + 0.5);
      if (p.x() > low_x_m && p.x() < high_x_m) cloud.append(p, Vec3::UnitY());
    }
  return cloud;
}

ToolPose at(double height_m, const Vec3& turn = Vec3::Zero()) {
  return {{0, height_m, 0}, rotation(turn)};
}

TEST(BallCap, HasTheVolumeOfItsSlices) {
  constexpr double r = 0.007;
  constexpr int slices = 100000;
  for (const double height : {-0.008, -0.007, -0.003, 0.0, 0.002, 0.0069, 0.007, 0.009}) {
    double volume = 0;
    for (int i = 0; i < slices; ++i) {
      const double y = r * ((2 * i + 1.0) / slices - 1);
      if (y < -height) volume += std::numbers::pi * (r * r - y * y) * 2 * r / slices;
    }
    EXPECT_NEAR(cap_behind(r, height).volume_m3, volume, 1e-4 * r * r * r) << height;
    const double disk = std::max(0.0, std::numbers::pi * (r * r - height * height));
    EXPECT_NEAR(cap_behind(r, height).disk_m2, disk, 1e-12) << height;
  }
}

TEST(SpherePenetration, IsThatOfAHalfSpaceInABall) {
  Probe probe = ball();
  ASSERT_EQ(probe.spheres().spheres.size(), 1u);
  const Sphere& sphere = probe.spheres().spheres[0];
  EXPECT_NEAR(sphere.radius_m, 0.01, 1e-4);
  for (const double height : {0.009, 0.005, 0.0003, -0.004, -0.009}) {
    const SpherePenetration found = probe.in(sheet(), at(height));
    const BallCap cap = cap_behind(sphere.radius_m, height + sphere.centre.y());
    EXPECT_NEAR(found.volume_m3, cap.volume_m3, 1e-6 * cap.volume_m3) << height;
    EXPECT_NEAR(found.wrench_T[1], cap.volume_m3, 1e-6 * cap.volume_m3) << height;
    EXPECT_NEAR(found.slope_T(1, 1), cap.disk_m2, 1e-6 * cap.disk_m2) << height;
    EXPECT_EQ(found.spheres, 1);
  }
}

// Spheres that the plane cuts contain points; those below contain none and take over a plane. The tool is
// symmetric, so it is balanced.
TEST(SpherePenetration, IsThatOfAHalfSpaceInABox) {
  for (const double depth : {-0.0001, 0.0005, 0.001, 0.003, 0.005, 0.008}) {
    const SpherePenetration found = box().in(sheet(), at(kHalf_m.y() - depth));
    const double expected = below_m3(box().spheres(), kHalf_m.y() - depth), rounding = 1e-6 * expected;
    EXPECT_LE(found.volume_m3, (1 + 1e-6) * expected) << depth;
    EXPECT_GE(found.volume_m3, 0.95 * expected) << depth;
    EXPECT_LE(found.volume_m3, 4 * kHalf_m.x() * kHalf_m.z() * std::max(depth, 0.0)) << depth;
    EXPECT_NEAR(found.wrench_T[1], found.volume_m3, rounding) << depth;
    EXPECT_NEAR(std::hypot(found.wrench_T[0], found.wrench_T[2]), 0, rounding) << depth;
    EXPECT_NEAR(found.wrench_T.tail<3>().norm(), 0, rounding * kHalf_m.x()) << depth;
  }
}

// The derivative of the wrench, by differences, is the slope.
TEST(SpherePenetration, SlopeIsTheDecreaseOfTheWrench) {
  constexpr double small = 1e-6;
  const ToolPose pose = at(0.0035, {0.1, 0.2, 0});
  const SpherePenetration here = box().in(sheet(), pose);
  const Vec3 up_W = Vec3::UnitY() * small, up_T = pose.q_WT.conjugate() * up_W;
  const SpherePenetration above = box().again({pose.p_W + up_W, pose.q_WT});
  Vector6 displacement_T;
  displacement_T << up_T, Vec3::Zero();
  const Vector6 expected = here.slope_T * displacement_T;
  EXPECT_NEAR((here.wrench_T - above.wrench_T - expected).norm(), 0, 0.05 * expected.norm());
}

// The part over the sheet is pushed up, so the tool turns about z.
TEST(SpherePenetration, DoesNotSpreadBeyondTheEdgeOfASheet) {
  const double height_m = kHalf_m.y() - 0.001;
  const double whole_m3 = box().in(sheet(), at(height_m)).volume_m3;
  const SpherePenetration half = box().in(sheet(-1, 0), at(height_m));
  EXPECT_NEAR(half.volume_m3, 0.5 * whole_m3, 0.15 * whole_m3);
  EXPECT_LT(half.wrench_T[5], -0.5 * 0.005 * half.volume_m3);
}

TEST(SpherePenetration, OfTwoOppositeWallsIsNoForce) {
  PointCloud walls;
  const PointCloud below = sheet();
  for (std::size_t i = 0; i < below.size(); ++i) {
    walls.append(below.point(i) - Vec3(0, 0.0045, 0), Vec3::UnitY());
    walls.append(below.point(i) + Vec3(0, 0.0045, 0), -Vec3::UnitY());
  }
  const SpherePenetration found = box().in(walls, at(0));
  EXPECT_GT(found.volume_m3, 0);
  EXPECT_LT(found.wrench_T.head<3>().norm(), 1e-6 * found.volume_m3);
  EXPECT_GT(found.slope_T(1, 1), 0);
}

// The tool leaves a point that is near its lower side downwards, so it is pushed up.
TEST(SpherePenetration, PointsWithoutANormalPushOutOfTheNearestSide) {
  PointCloud bare = sheet();
  bare.nx.clear(), bare.ny.clear(), bare.nz.clear();
  const ToolPose pose = at(kHalf_m.y() - 0.001);
  const SpherePenetration with = box().in(sheet(), pose), without = box().in(bare, pose);
  EXPECT_NEAR(without.wrench_T[1], with.wrench_T[1], 0.2 * with.wrench_T[1]);
  EXPECT_LT(std::hypot(without.wrench_T[0], without.wrench_T[2]), 0.05 * with.wrench_T[1]);
}

TEST(SpherePenetration, DependsOnThePoseOnlyAndAllocatesNothing) {
  const SpherePenetration before = box().in(sheet(), at(0.004));
  std::size_t allocated = 0;
  for (const double height : {0.002, -0.002, 0.02, 0.004}) {
    const std::size_t count = allocation_count();
    const SpherePenetration found = box().again(at(height, {0.2, height, 0}));
    allocated += allocation_count() - count;
    EXPECT_TRUE(found.wrench_T.allFinite());
  }
  EXPECT_EQ(allocated, 0u);
  EXPECT_EQ(box().again(at(0.004)).wrench_T, before.wrench_T);
}

// --- the motion, against the balance of the coupling and the penetration volume ---

ToolRenderer renderer(const InnerSphereParameters& p = {}) {
  return {tool_parameters(p), tool(), scenes::kernels(),
          std::make_unique<InnerSphereMotion>(p, *tool(), spheres())};
}

DeviceState device(double lower_side_m) {
  return {{0, kHalf_m.y() + lower_side_m, 0}, Eigen::Quaterniond::Identity()};
}

// Output after 49 ticks with the device at a pose whose lower side is at this height.
RenderOutput pressed(const PointCloud& cloud, double lower_side_m, const InnerSphereParameters& p = {}) {
  ToolRenderer r = renderer(p);
  r.on_frame(scenes::frame(cloud));
  r.step(device(0.001), 0);
  RenderOutput out;
  for (int i = 1; i < 50; ++i) out = r.step(device(lower_side_m), 0.001 * i);
  return out;
}

TEST(InnerSphereMotion, ToolIsTheDeviceInFreeSpace) {
  ToolRenderer r = renderer();
  r.on_frame(scenes::frame(sheet()));
  expect_free(r);
}

// k (y - y_device) = k_V V(y) for the height y of the tool.
TEST(InnerSphereMotion, SinksUntilVolumeAndSpringBalance) {
  constexpr double k = 600;
  for (const double k_v : {1e7, 1e8, 1e9})
    for (const double depth_m : {0.002, 0.01}) {
      InnerSphereParameters p;
      p.volume_stiffness_N_per_m3 = k_v;
      const RenderOutput out = pressed(sheet(), -depth_m, p);
      double low_m = kHalf_m.y() - depth_m, high_m = kHalf_m.y();
      for (int i = 0; i < 60; ++i) {
        const double y_m = 0.5 * (low_m + high_m);
        const bool is_too_low = k_v * below_m3(in_box(), y_m) > k * (y_m - kHalf_m.y() + depth_m);
        (is_too_low ? low_m : high_m) = y_m;
      }
      EXPECT_NEAR(out.proxy_W.y(), low_m, 5e-5) << k_v << ", " << depth_m;
      EXPECT_NEAR(out.force_N.y(), k * (low_m - kHalf_m.y() + depth_m), 0.03) << k_v << ", " << depth_m;
      EXPECT_NEAR(std::hypot(out.force_N.x(), out.force_N.z()), 0, 1e-2);
      EXPECT_NEAR(out.tool->torque_Nm.norm(), 0, 1e-3);
      EXPECT_TRUE(out.converged);
    }
}

// The sheet supports the side of positive x only, so the hand feels a torque that lifts this side.
TEST(InnerSphereMotion, ASheetUnderOneSideTurnsTheTool) {
  const RenderOutput out = pressed(sheet(0.002), -0.003);
  EXPECT_GT(out.force_N.y(), 0.1);
  EXPECT_GT(out.tool->torque_Nm.z(), 1e-3);
  EXPECT_GT(out.tool->orientation_W.z(), 0);
}

// The cloud says nothing about its inside: what is behind the points is pushed out to their side. Farther
// behind the sheet the tool is free.
TEST(InnerSphereMotion, PushesAToolFromTheBackThroughTheSheet) {
  ToolRenderer r = renderer();
  r.on_frame(scenes::frame(sheet()));
  RenderOutput out = r.step(device(-0.03), 0);
  EXPECT_EQ(out.force_N, Vec3::Zero());
  EXPECT_EQ(out.proxy_W, device(-0.03).position_W);
  for (int i = 0; i < 100; ++i) out = r.step(device(-0.02 + 1.2e-4 * i), 0.001 + 0.001 * i);
  EXPECT_GT(out.proxy_W.y(), kHalf_m.y() - 0.002);
  EXPECT_GT(out.force_N.y(), 0.5);
}

// A step moves no point by more than half a voxel, so a tick moves the tool no farther than its steps do.
TEST(InnerSphereMotion, ReportsWhenItsStepsDoNotSuffice) {
  InnerSphereParameters p;
  p.steps_per_tick = 4;
  ToolRenderer r = renderer(p);
  r.on_frame(scenes::frame(sheet()));
  r.step({{0, 0.1, 0}, Eigen::Quaterniond::Identity()}, 0);
  const RenderOutput out = r.step({{0, 0.08, 0}, Eigen::Quaterniond::Identity()}, 0.001);
  EXPECT_NEAR(out.proxy_W.y(), 0.099, 1e-12);
  EXPECT_TRUE(out.tool->budget_exhausted);
  EXPECT_FALSE(out.converged);
}

// Noise of 1 mm moves the balance to and fro: a point enters a sphere, pushes the tool up and leaves the
// sphere.
TEST(InnerSphereMotion, EndsItsTicksOnNoisyPoints) {
  PointCloud cloud = sheet();
  const PointCloud noise = scenes::random_cloud(static_cast<int>(cloud.size()), 1, 4);
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.y[i] = 1e-3 * noise.y[i];
  ToolRenderer r = renderer();
  r.on_frame(scenes::frame(cloud));
  int exhausted = 0;
  for (int i = 0; i < 60; ++i) {
    const double down_m = std::min(0.003, 2e-4 * i);
    const RenderOutput out =
        r.step({{1e-4 * i, kHalf_m.y() + 0.002 - down_m, 0}, Eigen::Quaterniond::Identity()}, 0.001 * i);
    exhausted += out.tool->budget_exhausted ? 1 : 0;
    if (i == 59) {
      EXPECT_GT(out.force_N.y(), 0.5);
    }
  }
  EXPECT_LE(exhausted, 3);
}

TEST(InnerSphereMotion, PacksTheSpheresItself) {
  InnerSphereParameters p;
  p.inner_spheres = 400;
  ToolRenderer a = renderer(p);
  ToolRenderer b(tool_parameters(p), tool(), scenes::kernels(),
                 std::make_unique<InnerSphereMotion>(p, *tool()));
  for (ToolRenderer* r : {&a, &b}) r->on_frame(scenes::frame(sheet()));
  RenderOutput out;
  for (int i = 0; i < 20; ++i) {
    out = a.step(device(0.001 - 2e-4 * i), 0.001 * i);
    EXPECT_EQ(b.step(device(0.001 - 2e-4 * i), 0.001 * i).force_N, out.force_N);
  }
  EXPECT_GT(out.force_N.y(), 0.5);
}

}  // namespace
}  // namespace remote_touch::inner_spheres_test
