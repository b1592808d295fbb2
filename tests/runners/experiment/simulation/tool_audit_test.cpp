// The auditor on motions whose crossings are known.
#include "tests/runners/experiment/simulation/tool_audit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/mesh/triangle_mesh.h"

namespace remote_touch::tool_audit_test {
namespace {

constexpr double kTolerance_m = 1e-5;
const Vec3 kSides_m(0.08, 0.02, 0.01);  // edges of the bar

PointCloud one_point(const Vec3& p_W) {
  PointCloud cloud;
  cloud.append(p_W);
  return cloud;
}

ToolAudit of_bar(const Vec3& p_W, const ToolPose& from, const ToolPose& to) {
  ToolAuditor auditor(box_mesh(kSides_m), kTolerance_m);
  auditor.on_frame(one_point(p_W));
  auditor.tick(from, to);
  return auditor.audit();
}

// Signed distance to the bar, in closed form.
double to_bar_m(const Vec3& p_T) {
  const Vec3 q = p_T.cwiseAbs() - 0.5 * kSides_m;
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

TEST(ToolAuditor, KnowsTheDistanceToASolid) {
  ToolAuditor auditor(box_mesh(kSides_m), kTolerance_m);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-0.06, 0.06);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p(place(random), place(random), place(random));
    EXPECT_NEAR(auditor.signed_distance_m(p), to_bar_m(p), 1e-12) << p.transpose();
  }
}

// The point is outside before and after, far on both sides. Only the motion in between crosses it.
TEST(ToolAuditor, FindsAPointThatIsCrossedBetweenTwoPoses) {
  const ToolAudit audit = of_bar(Vec3::Zero(), {{0, 0.03, 0}, {1, 0, 0, 0}}, {{0, -0.03, 0}, {1, 0, 0, 0}});
  EXPECT_EQ(audit.entered, 1);
  EXPECT_EQ(audit.inside, 0);
  EXPECT_GT(audit.deepest_m, kTolerance_m);
}

TEST(ToolAuditor, FindsAPointThatATurningEndSweepsOver) {
  const ToolPose from{Vec3::Zero(), rotation({0, 0, 0})}, to{Vec3::Zero(), rotation({0, 2, 0})};
  const Vec3 on_its_way(0.035 * std::cos(1.0), 0, -0.035 * std::sin(1.0));
  EXPECT_EQ(of_bar(on_its_way, from, to).entered, 1);
  EXPECT_EQ(of_bar(1.2 * on_its_way, from, to).entered, 0);  // beyond the end of the bar
}

// Points that move from frame to frame: with the tool, through it, and past it.
TEST(ToolAuditor, FollowsPointsThroughAFrame) {
  const ToolPose from{{0, 0.03, 0}, {1, 0, 0, 0}}, up{{0, 0.09, 0}, {1, 0, 0, 0}};
  const auto entered = [&](const Vec3& before, const Vec3& after, const ToolPose& to) {
    ToolAuditor auditor(box_mesh(kSides_m), kTolerance_m);
    auditor.on_frame(one_point(before));
    auditor.tick_with_frame(one_point(after), from, to);
    auditor.tick(to, to);
    EXPECT_EQ(auditor.audit().point_ticks, 2);
    return auditor.audit().entered;
  };
  EXPECT_EQ(entered({0, 0, 0}, {0, 0.06, 0}, up), 0);
  EXPECT_EQ(entered({0, 0, 0}, {0, 0.06, 0}, from), 1);
  EXPECT_EQ(entered({0.05, 0, 0}, {0.05, 0.06, 0}, from), 0);
  EXPECT_EQ(entered({0.05, 0.03, 0}, {-0.05, 0.03, 0}, from), 1);
  EXPECT_EQ(entered({0, 0, 0}, {0, 0.019, 0}, from), 0) << "up to the tool";
  EXPECT_EQ(entered({0, 0, 0}, {0, 0.021, 0}, from), 1) << "into it";
}

TEST(ToolAuditor, ATouchIsNoCrossing) {
  const ToolPose from{{-0.06, 0.01, 0}, {1, 0, 0, 0}}, to{{0.03, 0.01, 0}, {1, 0, 0, 0}};
  EXPECT_EQ(of_bar(Vec3::Zero(), from, to).entered, 0);                          // slides along the bar
  EXPECT_EQ(of_bar({0, 2 * kTolerance_m, 0}, from, to).entered, 1);              // twice the tolerance deep
  EXPECT_EQ(of_bar({0, 0.5 * kTolerance_m, 0}, from, to).entered, 0);            // half the tolerance deep
  EXPECT_EQ(of_bar({0, 0.001, 0}, {{0, 0.01, 0}, {1, 0, 0, 0}}, to).inside, 1);  // begins in the bar
  EXPECT_EQ(of_bar(Vec3::Constant(std::nan("")), {{0, 0, 0}, {1, 0, 0, 0}}, to).point_ticks, 0);
}

// The reference for whether a motion crosses a point is the deepest of 4001 positions on the way.
TEST(ToolAuditor, AgreesWithDenseSamplesOfRandomMotions) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  const auto vector = [&](double scale) {
    return Vec3(scale * Vec3(normal(random), normal(random), normal(random)));
  };
  int crossed = 0, clear = 0;
  for (int i = 0; i < 400; ++i) {
    const ToolPose from{vector(0.02), rotation(vector(1))};
    const ToolPose to{from.p_W + vector(0.02), rotation(vector(0.5)) * from.q_WT};
    const Vec3 p_W = vector(0.02), turn = rotation_vector(to.q_WT * from.q_WT.conjugate());
    double lowest_m = 1;
    const auto distance_m = [&](double s) {
      const Eigen::Quaterniond q_WT = rotation(s * turn) * from.q_WT;
      return to_bar_m(q_WT.conjugate() * (p_W - from.p_W - s * (to.p_W - from.p_W)));
    };
    for (int s = 0; s <= 4000; ++s) lowest_m = std::min(lowest_m, distance_m(s / 4000.0));
    if (distance_m(0) < 0 || std::abs(lowest_m) < 2 * kTolerance_m) continue;
    (lowest_m < 0 ? crossed : clear) += 1;
    EXPECT_EQ(of_bar(p_W, from, to).entered, lowest_m < 0 ? 1 : 0) << i << " " << lowest_m;
  }
  EXPECT_GT(crossed, 20);
  EXPECT_GT(clear, 100);
}

// The auditor keeps its knowledge of a point from tick to tick.
TEST(ToolAuditor, FollowsAPointThroughATool) {
  ToolAuditor auditor(box_mesh(kSides_m), kTolerance_m);
  auditor.on_frame(one_point(Vec3::Zero()));
  ToolPose pose{{0, 0.0505, 0}, {1, 0, 0, 0}};
  for (int i = 0; i < 100; ++i) {
    const ToolPose next{pose.p_W - Vec3(0, 0.001, 0), pose.q_WT};
    auditor.tick(pose, next);
    pose = next;
  }
  EXPECT_EQ(auditor.audit().point_ticks, 100);
  EXPECT_EQ(auditor.audit().entered, 1);
  EXPECT_EQ(auditor.audit().inside, 20);  // 20 mm thick, a millimetre a tick
}

}  // namespace
}  // namespace remote_touch::tool_audit_test
