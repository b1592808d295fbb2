#include "core/sphere_tree/region_contacts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "core/sphere_tree/tool_spheres.h"
#include "core/tool/look_ahead_motion.h"
#include "tests/box_tool.h"
#include "tests/scenes.h"

namespace remote_touch {
namespace {

constexpr double kRadius_m = 0.04;   // of the regions, as in 7.5.1
constexpr double kSettled_m = 1e-4;  // deeper than this a tool may not end a tick

std::shared_ptr<const SphereTree> one_leaf(double radius_m) {
  auto tree = std::make_shared<SphereTree>();
  const Sphere leaf{Vec3::Zero(), radius_m};
  tree->add({&leaf, 1});
  tree->finish();
  return tree;
}

PointCloud regions_at(const std::vector<Vec3>& places, double radius_m = kRadius_m) {
  PointCloud cloud;
  for (const Vec3& place : places) cloud.append(place);
  cloud.fixture_radius_m.assign(cloud.size(), radius_m);
  return cloud;
}

ToolPose at(const Vec3& p_W) {
  return {p_W, Eigen::Quaterniond::Identity()};
}

// Points of a handwheel of 45 mm radius, a tube of 5 mm, 3 mm apart: what a camera could see of it.
PointCloud wheel() {
  std::vector<Vec3> places;
  for (int i = 0; i < 96; ++i)
    for (int j = 0; j < 8; ++j) {
      const double a = 2 * M_PI * i / 96, b = 2 * M_PI * j / 8;
      places.emplace_back((0.045 + 0.005 * std::cos(b)) * std::cos(a), 0.005 * std::sin(b),
                          (0.045 + 0.005 * std::cos(b)) * std::sin(a));
    }
  return regions_at(places);
}

// How deep any leaf is in any region, one after the other.
double deepest_m(const SphereTree& tool, const ToolPose& pose, const PointCloud& cloud) {
  double deepest = -1;
  for (const Sphere& leaf : tool.leaves())
    for (std::size_t i = 0; i < cloud.size(); ++i)
      deepest = std::max(deepest, leaf.radius_m + cloud.fixture_radius_m[i] -
                                      (pose.p_W + pose.q_WT * leaf.centre - cloud.point(i)).norm());
  return deepest;
}

struct Held {
  std::shared_ptr<const VoxelTool> tool;
  std::shared_ptr<const SphereTree> leaves;
  RegionContacts contacts;
  LookAheadMotion motion;
  ToolPose pose;

  Held(std::shared_ptr<const VoxelTool> tool_, std::shared_ptr<const SphereTree> leaves_)
      : tool(tool_),
        leaves(leaves_),
        contacts(leaves, ToolParameters{}.look_ahead_m),
        motion({}, *tool, 0.05) {}
  void frame(const PointCloud& cloud) { contacts.on_frame(cloud), updated = true; }
  // Ticks until the tool rests.
  void move_to(const ToolPose& device) {
    for (int tick = 0; tick < 200; ++tick)
      if (motion.move(pose, device, contacts, std::exchange(updated, false)).at_rest) return;
    FAIL() << "does not come to rest";
  }
  bool updated = false;
};

const auto kBox = scenes::box_tool({0.02, 0.005, 0.01});

std::shared_ptr<const SphereTree> spheres_of_box() {
  static const auto spheres = std::make_shared<const SphereTree>(make_tool_spheres(*kBox, 112).spheres);
  return spheres;
}

// A ball against one region stops where the line from the region to the device leaves it, (7.4).
TEST(RegionContacts, ABallStopsAtTheNearestPlaceOfARegion) {
  Held held(kBox, one_leaf(0.01));
  held.frame(regions_at({{0, 0, 0}}));
  held.pose.p_W = {0, 0.1, 0};
  held.move_to(at({0.005, 0.01, 0.002}));
  const Vec3 expected = Vec3(0.005, 0.01, 0.002).normalized();
  EXPECT_NEAR(held.pose.p_W.norm(), 0.05, kSettled_m);
  EXPECT_NEAR((held.pose.p_W.normalized() - expected).norm(), 0, 0.004);  // a fifth of a millimetre
}

// Between two regions it comes to lie in the crease: as far from both as the radii add up to.
TEST(RegionContacts, ABallLiesInTheCreaseOfTwoRegions) {
  Held held(kBox, one_leaf(0.01));
  held.frame(regions_at({{-0.03, 0, 0}, {0.03, 0, 0}}));
  held.pose.p_W = {0.01, 0.1, 0};
  held.move_to(at({0.002, 0, 0}));
  EXPECT_NEAR(held.pose.p_W.y(), 0.04, 1e-4);  // 30, 40, 50 mm
  EXPECT_NEAR(held.pose.p_W.x(), 0, 1e-4);
}

// The same where both lines are alike: one of the two must not hide the other.
TEST(RegionContacts, ABallLiesInAnObtuseCrease) {
  Held held(kBox, one_leaf(0.01));
  const Vec3 a = Vec3(1, 0.05, 0.05).normalized(), b = Vec3(1, 0.85, 0.85).normalized();
  held.frame(regions_at({-0.05 * a, -0.05 * b}));  // the ball touches both with its middle in the origin
  held.pose.p_W = 0.05 * (a + b);
  held.move_to(at(-0.005 * (a + b)));
  EXPECT_NEAR(held.pose.p_W.norm(), 0, 2e-4);
}

TEST(RegionContacts, WithoutRegionsTheToolFollows) {
  Held held(kBox, spheres_of_box());
  const ToolPose device{{0.3, 0.2, 0.1}, rotation({1, 0.5, 0})};
  held.move_to(device);
  EXPECT_EQ(held.pose, device);
}

// Wherever the device goes, no leaf ends a tick inside a region: against all pairs, one after the other.
TEST(RegionContacts, NoLeafEndsInsideARegion) {
  const PointCloud cloud = wheel();
  Held held(kBox, spheres_of_box());
  held.frame(cloud);
  held.pose.p_W = {0, 0.15, 0};
  const PointCloud ways = scenes::random_cloud(60, 0.08, 4), turns = scenes::random_cloud(60, 1.5, 5);
  double touching = 0;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    held.move_to({ways.point(i), rotation(turns.point(i))});
    const double deep_m = deepest_m(*held.leaves, held.pose, cloud);
    EXPECT_LT(deep_m, kSettled_m) << i;
    touching += deep_m > -kSettled_m ? 1 : 0;
  }
  EXPECT_GT(touching, 20);
}

// A frame that swallows the tool pushes it out, and not to where the regions are.
TEST(RegionContacts, AFrameThatSwallowsTheToolPushesItOut) {
  const PointCloud cloud = wheel();
  for (const double y_m : {0.03, 0.02, 0.01, -0.02}) {
    Held held(kBox, spheres_of_box());
    held.pose = {{0.04, y_m, 0.01}, rotation({0.3, 0.2, 0.1})};
    const ToolPose device = held.pose;
    held.frame(cloud);
    EXPECT_GT(deepest_m(*held.leaves, held.pose, cloud), 0.015);
    held.move_to(device);
    EXPECT_LT(deepest_m(*held.leaves, held.pose, cloud), kSettled_m) << y_m;
  }
}

}  // namespace
}  // namespace remote_touch
