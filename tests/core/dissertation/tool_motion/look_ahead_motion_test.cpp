// The motion that the nearest contacts allow compared with that of all contacts, and the continuous rule on
// surfaces that frames take past the tool.
#include "core/dissertation/tool_motion/look_ahead_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <tuple>
#include <vector>

#include "core/dissertation/tool_motion/contact_list.h"
#include "core/dissertation/tool_motion/tool_renderer.h"
#include "core/mesh/triangle_mesh.h"
#include "core/points/vector.h"
#include "tests/core/dissertation/tool_motion/free_space.h"
#include "tests/support/box_tool.h"
#include "tests/support/cloud_form.h"
#include "tests/support/scenes.h"

namespace remote_touch::look_ahead_motion_test {
namespace {

// LookAheadProgram queries the nearest contacts first and finds the motion that all contacts allow.

const auto kTool = scenes::box_tool({0.005, 0.003, 0.004});
const ToolPose kPose{{0.001, -0.002, 0.003}, rotation({1, 2, -0.5})};
constexpr double kSame_m = 1e-10;

// Contact planes around a tool, given by the test. Records the distances for which it is queried.
class Planes final : public NearContactSource {
 public:
  explicit Planes(std::vector<ToolContact> all) : all_(std::move(all)) {}
  using NearContactSource::near;
  NearContacts near(const ToolPose&, double, double within_m) override {
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    asked_m.push_back(within_m);
    NearContacts found{{}, -kInfinite, within_m < kLookAhead_m ? within_m : kInfinite};
    listed_.clear();
    for (const ToolContact& contact : all_) {
      if (-contact.depth_m > std::min(within_m, kLookAhead_m)) continue;
      listed_.push_back(contact);
      found.deepest_m = std::max(found.deepest_m, contact.depth_m);
    }
    found.contacts = listed_;
    return found;
  }

  std::vector<double> asked_m;

 private:
  static constexpr double kLookAhead_m = 2e-3;
  std::vector<ToolContact> all_, listed_;
};

// Contact planes up to a look-ahead away, pressed in by depth_m. They lie on one side of the tool or, with
// from_all_sides, all around it.
std::vector<ToolContact> planes_around(std::mt19937& random, int count, double depth_m, bool from_all_sides) {
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<ToolContact> all;
  for (int i = 0; i < count; ++i) {
    const Vec3 outside =
        Vec3(unit(random), unit(random) - (from_all_sides ? 0 : 1.5), unit(random)).normalized();
    all.push_back({0.007 * outside, -outside, depth_m - std::pow(unit(random), 2) * 2e-3, 1});
  }
  return all;
}

Vector6 random_motion(std::mt19937& random, double size_m) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Vector6 a_gu;
  for (int k = 0; k < 6; ++k) a_gu[k] = size_m * unit(random) * (k < 3 ? 1 : 50);
  return a_gu;
}

// The reference by definition: one program with all contacts.
ConstrainedMotion allowed_by_all(const VoxelTool& tool, NearContactSource& source, const Vector6& a_gu) {
  MotionProgram program({}, tool);
  const NearContacts near = source.near(kPose, 0);
  const Vector6 desired_T = rotated(kPose.q_WT.conjugate(), a_gu);
  const bool collides = near.deepest_m > LookAheadProgram::kCollision_m;
  ConstrainedMotion motion = program.solve(collides ? Vector6(Vector6::Zero()) : desired_T, near.contacts);
  if (collides && motion.is_relaxed) motion = program.solve(desired_T, near.contacts);
  return motion;
}

TEST(LookAheadProgram, FindsTheMotionThatAllContactsAllow) {
  std::mt19937 random(7);
  int in_part = 0, relaxed = 0, held = 0;
  for (const double depth_m : {-5e-5, 5e-5, 5e-4})
    for (int scene = 0; scene < 200; ++scene) {
      Planes planes(planes_around(random, 1 + scene % 40, depth_m, scene % 4 == 0));
      LookAheadProgram program({}, *kTool, kTool->reach_m);
      for (const double size_m : {1e-5, 1e-4, 1e-3, 1e-2}) {
        const Vector6 a_gu = random_motion(random, size_m);
        const ConstrainedMotion expected = allowed_by_all(*kTool, planes, a_gu);
        planes.asked_m.clear();
        const LookAheadProgram::Detection detection = program.detect(kPose, a_gu, planes, 0);
        if (detection.near.contacts.empty()) continue;
        const double error_m = max_point_displacement_m(detection.motion.a_g - expected.a_g, kTool->reach_m);
        EXPECT_LE(error_m, kSame_m) << scene << " " << size_m;
        EXPECT_EQ(detection.motion.is_relaxed, expected.is_relaxed);
        EXPECT_LE((detection.motion.push_T - expected.push_T).norm(), kSame_m);
        EXPECT_EQ(rotated(kPose.q_WT, detection.motion.a_g), detection.a_g);
        in_part += std::isfinite(detection.near.within_m) ? 1 : 0;
        relaxed += expected.is_relaxed ? 1 : 0, held += expected.active_count > 0 ? 1 : 0;
      }
    }
  EXPECT_GT(in_part, 300);
  EXPECT_GT(relaxed, 10);
  EXPECT_GT(held, 300);
}

TEST(LookAheadProgram, QueriesAllPointsBeforeItReportsThatNoneIsNear) {
  Planes planes({{Vec3(0, -0.003, 0), Vec3::UnitY(), -1.9e-3, 1}});
  LookAheadProgram program({}, *kTool, kTool->reach_m);
  Vector6 a_gu = Vector6::Zero();
  a_gu[0] = 1e-5;
  EXPECT_EQ(program.detect(kPose, a_gu, planes, 0).near.contacts.size(), 1u);

  Planes none({});
  a_gu[0] = 1;
  const LookAheadProgram::Detection free = program.detect(kPose, a_gu, none, 0);
  EXPECT_TRUE(free.near.contacts.empty());
  EXPECT_NEAR(free.a_g.head<3>().norm(), ToolParameters().look_ahead_m, 1e-15);
  EXPECT_FALSE(std::isfinite(none.asked_m.back()));
}

// The motion is zero because the program failed, not because the contacts hold the tool.
TEST(LookAheadMotion, AToolIsNotAtRestIfItsProgramFailed) {
  const std::vector<ToolContact> below{{Vec3(0, -0.003, 0), Vec3::UnitY(), 0, 1}};
  for (const double length_m : {1e-3, 1e200}) {
    Planes planes(below);
    LookAheadMotion motion({}, *kTool, kTool->reach_m);
    ToolPose pose;
    const ToolPose device{{0, -length_m, 0}, Eigen::Quaterniond::Identity()};
    EXPECT_EQ(motion.move(pose, device, planes, false).at_rest, length_m == 1e-3) << length_m;
    EXPECT_LT(pose.p_W.norm(), 1e-9);
  }
}

// Points outside a tool, with normals roughly towards it.
PointCloud around(const VoxelTool& tool, std::size_t count, double radius_m) {
  const PointCloud all = scenes::random_cloud(count, radius_m, 21),
                   directions = scenes::random_cloud(count, 1, 22);
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 p_T = kPose.q_WT.conjugate() * (all.point(i) - kPose.p_W);
    const FieldSample at = sample_field(tool, p_T);
    if (at.distance_m < 1e-4) continue;
    const Vec3 n_T = -at.gradient_T + 0.3 * directions.point(i);
    cloud.append(all.point(i), kPose.q_WT * n_T.normalized());
  }
  return cloud;
}

// There are fewer points than a program accepts, so that none is omitted. A fork is not convex, so a disk in
// it can be nearer than its lower bound.
TEST(LookAheadProgram, FindsTheMotionThatAllPointsAllow) {
  ToolReport report;
  const auto fork =
      std::make_shared<const VoxelTool>(make_voxel_tool(find_generated_tool("fork")->make(), {}, report));
  for (const auto& [tool, count, reach_m] : {std::tuple(kTool, 800u, 0.012), std::tuple(fork, 4000u, 0.03)}) {
    ContactList list(tool, {}, scenes::kernels());
    list.on_frame(in_form<TiledCloud>(around(*tool, count, reach_m)));
    LookAheadProgram program({}, *tool, tool->reach_m);
    std::mt19937 random(8);
    int in_part = 0;
    for (int i = 0; i < 100; ++i) {
      const Vector6 a_gu = random_motion(random, i % 2 == 0 ? 1e-4 : 1e-3);
      const Vector6 expected = allowed_by_all(*tool, list, a_gu).a_g;
      EXPECT_LT(list.near(kPose, 0).contacts.size(), 256u);
      const LookAheadProgram::Detection detection = program.detect(kPose, a_gu, list, 0);
      EXPECT_LE(max_point_displacement_m(detection.motion.a_g - expected, tool->reach_m), kSame_m) << i;
      in_part += std::isfinite(detection.near.within_m) ? 1 : 0;
    }
    EXPECT_GT(in_part, 20) << count;
  }
}

// A frame may take a surface past the tool. Only the continuous rule then keeps the tool on its side.

const Vec3 kHalf_m(0.015, 0.0025, 0.01);  // a plate of 5 mm

PointCloud sheet(double height_m, double facing = 1) {
  return sheet_of({.spacing_m = 0.0013, .y_m = height_m, .normal = {0, facing, 0}});
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

}  // namespace
}  // namespace remote_touch::look_ahead_motion_test
