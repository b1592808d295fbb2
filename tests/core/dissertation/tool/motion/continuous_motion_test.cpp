// A frame may take a surface past the tool. Only the continuous rule then keeps the tool on its side.
#include "core/dissertation/tool/motion/continuous_motion.h"

#include <gtest/gtest.h>

#include <random>

#include "core/dissertation/tool/motion/tool_renderer.h"
#include "core/geometry/rotation.h"
#include "tests/support/box_tool.h"
#include "tests/support/scenes.h"

namespace remote_touch::continuous_motion_test {
namespace {

const Vec3 kHalf_m(0.015, 0.0025, 0.01);  // a plate of 5 mm

PointCloud sheet(double height_m, double facing = 1, double spacing_m = 0.0013) {
  PointCloud cloud;
  for (int j = 0; j < 41; ++j)
    for (int i = 0; i < 41; ++i)
      cloud.append({(i - 20) * spacing_m, height_m, (j - 20) * spacing_m}, {0, facing, 0});
  return cloud;
}

struct Ride {
  explicit Ride(ToolParameters p)
      : renderer(with_rule(p), scenes::outer_box_tool(kHalf_m), scenes::kernels()) {}
  static ToolParameters with_rule(ToolParameters p) {
    p.contact_rule = ContactRule::continuous;
    return p;
  }
  // Runs ten ticks of one frame with the device at a height. Returns the height of the tool.
  double frame(const PointCloud& cloud, double device_m) {
    renderer.on_frame(scenes::frame(cloud, index++));
    for (int tick = 0; tick < 10; ++tick) {
      out = renderer.step({{0, device_m, 0}, Eigen::Quaterniond::Identity()}, 0);
      most_detections = std::max(most_detections, out.tool->detections);
    }
    return out.proxy_W.y();
  }

  ToolRenderer renderer;
  RenderOutput out;
  int index = 0, most_detections = 0;
};

// A surface that rises in every frame carries the plate along if the rise is no more than frame_reach_m.
TEST(ContinuousMotion, IsCarriedAsFarAsItsReach) {
  for (const double reach_m : {0.004, 0.01, 0.02}) {
    ToolParameters p;
    p.frame_reach_m = reach_m;
    for (const double fraction : {0.2, 0.9, 1.1}) {
      Ride ride(p);
      double height_m = 0;
      EXPECT_NEAR(ride.frame(sheet(0), 0.0), kHalf_m.y(), 1e-4);
      for (int n = 0; n < 6; ++n) ride.frame(sheet(height_m += fraction * reach_m), 0);
      // Any rule keeps the side if the rise is less than the plate's thickness.
      const bool kept = fraction < 1 || fraction * reach_m < 2 * kHalf_m.y();
      EXPECT_NEAR(ride.out.proxy_W.y(), kept ? height_m + kHalf_m.y() : 0.0, 1e-4) << reach_m << fraction;
      EXPECT_EQ(ride.out.force_N.norm() > 1, kept);
    }
  }
}

// The lengths of the steps are rounded differently in each direction.
TEST(ContinuousMotion, IsCarriedInAnyDirection) {
  for (const double angle : {0.0, 0.17, 0.5, 1.1, 2.0, 2.9}) {
    const Eigen::Quaterniond turn = rotation(angle * Vec3(0.3, 0.2, 0.9).normalized());
    const auto turned = [&](double height_m) {
      PointCloud cloud;
      const PointCloud level = sheet(height_m);
      for (std::size_t i = 0; i < level.size(); ++i)
        cloud.append(turn * level.point(i), turn * level.normal(i));
      return cloud;
    };
    ToolRenderer renderer(Ride::with_rule({}), scenes::outer_box_tool(kHalf_m), scenes::kernels());
    RenderOutput out;
    for (int frame = 0; frame < 12; ++frame) {
      renderer.on_frame(scenes::frame(turned(0.0067 * frame), frame));
      for (int tick = 0; tick < 10; ++tick) out = renderer.step({Vec3::Zero(), turn}, 0);
    }
    EXPECT_NEAR((turn.conjugate() * out.proxy_W).y(), 0.0067 * 11 + kHalf_m.y(), 1e-4) << angle;
  }
}

TEST(ContinuousMotion, HoldsAndCarriesTheToolOnTheBackOfASurface) {
  Ride ride({});
  double height_m = 0;
  ride.frame({}, 0.0);
  EXPECT_NEAR(ride.frame(sheet(-0.004, -1), -0.003), -0.004 + kHalf_m.y(), 1e-4);
  for (int n = 0; n < 6; ++n) ride.frame(sheet(height_m += 0.01, -1), -0.003);
  EXPECT_NEAR(ride.out.proxy_W.y(), height_m + kHalf_m.y(), 1e-4);
}

// The tool follows a surface that sinks. A surface that did not hold the tool is not searched for.
TEST(ContinuousMotion, ASurfaceThatSinksIsFollowed) {
  Ride ride({});
  ride.frame(sheet(0), 0);
  for (double height_m = 0; height_m > -0.006; height_m -= 0.001)
    EXPECT_NEAR(ride.frame(sheet(height_m), -0.01), height_m + kHalf_m.y(), 1e-4);
  ride.frame(sheet(-0.03), -0.01);
  EXPECT_EQ(ride.out.proxy_W.y(), -0.01);
  EXPECT_EQ(ride.frame(sheet(0.0), -0.01), -0.01) << "it was free: nobody knows where the surface came from";
}

// This includes budgets that are too small for the way there and back.
TEST(ContinuousMotion, UsesNoMoreThanItsBudget) {
  for (const int budget : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 20, 60}) {
    ToolParameters p;
    p.detections_per_tick = budget;
    Ride ride(p);
    double height_m = 0;
    ride.frame(sheet(0), 0);
    for (int n = 0; n < 8; ++n) {
      ride.frame(sheet(height_m += 0.003), 0);
      EXPECT_TRUE(ride.out.proxy_W.allFinite());
    }
    EXPECT_LE(ride.most_detections, budget);
    if (budget >= 20) {
      EXPECT_NEAR(ride.out.proxy_W.y(), height_m + kHalf_m.y(), 1e-4) << budget;
    }
  }
}

PointCloud together(const PointCloud& a, const PointCloud& b) {
  PointCloud all = a;
  for (std::size_t i = 0; i < b.size(); ++i) all.append(b.point(i), b.normal(i));
  return all;
}

// The tool is held on the lower of two sheets that face up. It is never found on the upper one, whatever the
// frames do.
TEST(ContinuousMotion, KeepsTheToolOnItsOwnSheet) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 2e-4);
  for (const double rise_m : {0.0, 1e-4, 0.001, 0.003}) {
    Ride ride({});
    for (int n = 0; n < 30; ++n) {
      const double height_m = rise_m * std::min(n, 3);
      PointCloud sheets = together(sheet(height_m), sheet(height_m + 0.012));
      for (double& y : sheets.y) y += noise(random);
      EXPECT_NEAR(ride.frame(sheets, -0.001), height_m + kHalf_m.y(), 1.2e-3) << rise_m << " " << n;
    }
  }
}

// Two sheets sink by 4 mm in one frame. The tool follows the lower one, which was nearer.
TEST(ContinuousMotion, FollowsASheetThatSinksUnderAnother) {
  Ride ride({});
  EXPECT_NEAR(ride.frame(together(sheet(0), sheet(0.015)), 0), kHalf_m.y(), 1e-4);
  EXPECT_NEAR(ride.frame(together(sheet(-0.004), sheet(0.011)), -0.01), -0.004 + kHalf_m.y(), 1e-4);
}

TEST(ContinuousMotion, NeedsNoNormals) {
  const auto bare = [](PointCloud cloud) {
    cloud.nx.clear(), cloud.ny.clear(), cloud.nz.clear();
    return cloud;
  };
  Ride ride({});
  ride.frame(bare(sheet(0)), 0.02);
  EXPECT_NEAR(ride.frame(bare(sheet(0)), -0.001), kHalf_m.y(), 1e-4);
  double height_m = 0;
  for (int n = 0; n < 6; ++n) ride.frame(bare(sheet(height_m += 0.008)), -0.001);
  EXPECT_NEAR(ride.out.proxy_W.y(), height_m + kHalf_m.y(), 1e-4);
}

// The plate stays between two sheets that close on it, however often frames come.
TEST(ContinuousMotion, KeepsTheToolBetweenWallsThatClose) {
  Ride ride({});
  for (int n = 0; n < 20; ++n) {
    const double gap_m = std::max(0.006 - 0.0003 * n, 0.002);
    const PointCloud walls = together(sheet(-0.5 * gap_m, 1), sheet(0.5 * gap_m, -1));
    EXPECT_LT(std::abs(ride.frame(walls, -0.002)), 0.5 * gap_m + 1e-3) << n;
  }
}

}  // namespace
}  // namespace remote_touch::continuous_motion_test
