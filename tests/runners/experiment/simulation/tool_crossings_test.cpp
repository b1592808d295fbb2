// Audits every tick of the experiments with a tool for points that got into it between two frames. The ticks
// in which a frame comes are left out, because its points can be anywhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "analysis/trace/trace.h"
#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/mesh/triangle_mesh.h"
#include "core/mesh/triangle_tree.h"
#include "core/parameters/parameter.h"
#include "core/points/point_cloud.h"
#include "runners/evaluation/figures/figure_pictures.h"
#include "runners/experiment/simulation/simulation.h"
#include "scenarios/recordings/recording.h"
#include "tests/support/recorded_data.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"
#include "tests/support/test_name.h"

namespace remote_touch::tool_crossings_test {
namespace {

// A point less deep than this is no collision for the look-ahead rule (look_ahead_motion.h).
constexpr double kLookAhead_m = 1e-4;
constexpr double kContinuous_m = 1e-5;
// The printed rule lets points into the shell: a point of it is within 1.5 sqrt(3) voxels of the centre of a
// free voxel, which is outside.
constexpr double kVoxels_m = 2.5981 * 5e-4;

// --- the auditor ---

// An auditor certifies, tick by tick, that no point of a cloud got into a tool on its way: conservative
// advancement of every point on the exact distance to the tool's mesh. It shares nothing with the renderers'
// contact rules: no grid, no disks, no constraints.
//
// The distance to a solid, negative inside, changes by no more than the point moves. Let it be s at the
// middle of an interval of the way, and let the point move by at most l in half of the interval. The point is
// then nowhere deeper than l - s. If that is above the tolerance, the interval is halved, until all of it is
// certified or a position is found at which the point is deeper.

struct ToolAudit {
  std::int64_t point_ticks = 0;  // number of points times ticks
  std::int64_t inside = 0;       // number of them that begin with the point deeper than the tolerance
  std::int64_t entered = 0;      // number that begin outside and get deeper on the way: missed crossings
  double deepest_m = 0;          // greatest depth that was found among the points that entered
};

class ToolAuditor {
 public:
  // mesh: closed, in the tool frame.
  ToolAuditor(const TriangleMesh& mesh, double tolerance_m);

  // Replaces the points by those of this cloud. Points that are not finite are left out.
  void on_frame(const PointCloud& cloud);
  // Moves the points to those of this cloud, each on a line, while the tool moves from one pose to the other
  // as in tick(). pre: as many points as before, in their order.
  void tick_with_frame(const PointCloud& cloud, const ToolPose& from, const ToolPose& to);
  // Moves the tool from one pose to the other: its origin along a line, its orientation about one axis, both
  // evenly. pre: `from` is the pose at which the tick before ended, if the points are the same.
  void tick(const ToolPose& from, const ToolPose& to);

  const ToolAudit& audit() const { return audit_; }

 private:
  struct Point {
    Vec3 p_W;
    double clear_m = 0;  // lower bound of the distance to the tool; below 0: not known
    bool is_inside = false, is_known = false;
    int face = 0;  // the face that was nearest at the last query
  };
  struct Way;
  void check(Point& point, const Way& way, double max_m);
  double depth_on(const Way& way, double from, double until, double max_m, int& face);
  double signed_distance_m(const Vec3& p_T, int& face) const;

  TriangleTree tree_;
  double tolerance_m_, reach_m_ = 0;
  std::vector<Point> points_;
  ToolAudit audit_;
};

// Halving ends at this length: no interval would be short enough for a point exactly as deep as the
// tolerance.
constexpr double kRounding_m = 1e-12;

// Position of a point in the tool frame while the tool moves; s from 0 to 1.
struct ToolAuditor::Way {
  const ToolPose& from;
  const Vec3 shift_W, turn_W;
  const Vec3 p_W;
  const Vec3 point_shift_W = Vec3::Zero();

  Vec3 at(double s) const {
    const Eigen::Quaterniond q_WT = rotation(s * turn_W) * from.q_WT;
    return q_WT.conjugate() * (p_W + s * point_shift_W - from.p_W - s * shift_W);
  }
};

ToolAuditor::ToolAuditor(const TriangleMesh& mesh, double tolerance_m)
    : tree_(mesh), tolerance_m_(tolerance_m) {
  for (const Vec3& v : mesh.vertices) reach_m_ = std::max(reach_m_, v.norm());
}

void ToolAuditor::on_frame(const PointCloud& cloud) {
  points_.clear();
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (cloud.point(i).allFinite()) points_.push_back({cloud.point(i)});
}

double ToolAuditor::signed_distance_m(const Vec3& p_T, int& face) const {
  const TriangleTree::Nearest nearest = tree_.nearest(p_T, face);
  face = nearest.face;
  const double distance_m = std::sqrt(nearest.squared_m2);
  return tree_.winding_number(p_T) > 0.5 ? -distance_m : distance_m;
}

// Returns the depth of a position on this part of the way that is deeper than the tolerance, 0 if none is.
// max_m: upper bound of the point's motion on the whole way.
double ToolAuditor::depth_on(const Way& way, double from, double until, double max_m, int& face) {
  const double middle = 0.5 * (from + until), half_m = 0.5 * (until - from) * max_m;
  const double distance_m = signed_distance_m(way.at(middle), face);
  if (distance_m < -tolerance_m_) return -distance_m;
  if (distance_m + tolerance_m_ >= half_m || half_m < kRounding_m) return 0;
  const double before = depth_on(way, from, middle, max_m, face);
  return before > 0 ? before : depth_on(way, middle, until, max_m, face);
}

void ToolAuditor::check(Point& point, const Way& way, double max_m) {
  if (!point.is_known) {
    point.is_inside = signed_distance_m(way.at(0), point.face) < -tolerance_m_;
    point.is_known = true;
  }
  if (point.is_inside) {
    ++audit_.inside;
  } else if (const double depth_m = depth_on(way, 0, 1, max_m, point.face); depth_m > 0) {
    ++audit_.entered;
    audit_.deepest_m = std::max(audit_.deepest_m, depth_m);
  }
  const double end_m = signed_distance_m(way.at(1), point.face);
  point.is_inside = end_m < -tolerance_m_;
  point.clear_m = end_m;
}

void ToolAuditor::tick_with_frame(const PointCloud& cloud, const ToolPose& from, const ToolPose& to) {
  const Vec3 shift_W = to.p_W - from.p_W;
  const Vec3 turn_W = rotation_vector(to.q_WT * from.q_WT.conjugate());
  std::size_t next = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.point(i).allFinite()) continue;
    Point& point = points_.at(next++);
    const Vec3 point_shift_W = cloud.point(i) - point.p_W;
    const double relative_m = (shift_W - point_shift_W).norm();
    point.is_known = false;
    ++audit_.point_ticks;
    check(point, {from, shift_W, turn_W, point.p_W, point_shift_W},
          relative_m + turn_W.norm() * ((point.p_W - from.p_W).norm() + relative_m));
    point.p_W = cloud.point(i), point.clear_m = 0;
  }
}

void ToolAuditor::tick(const ToolPose& from, const ToolPose& to) {
  const Vec3 shift_W = to.p_W - from.p_W;
  const Vec3 turn_W = rotation_vector(to.q_WT * from.q_WT.conjugate());
  const double shift_m = shift_W.norm(), turn_rad = turn_W.norm();
  audit_.point_ticks += static_cast<std::int64_t>(points_.size());
  for (Point& point : points_) {
    const double from_centre_m = (point.p_W - from.p_W).norm();
    const double max_m = shift_m + turn_rad * (from_centre_m + shift_m);
    point.clear_m = std::max(point.clear_m - max_m, from_centre_m - shift_m - reach_m_);
    if (point.clear_m > 0)
      point.is_known = true, point.is_inside = false;
    else
      check(point, {from, shift_W, turn_W, point.p_W}, max_m);
  }
}

// --- the auditor on motions of a bar whose crossings are known ---

const Vec3 kSides_m(0.08, 0.02, 0.01);  // edges of the bar

ToolAudit of_bar(const Vec3& p_W, const ToolPose& from, const ToolPose& to) {
  ToolAuditor auditor(box_mesh(kSides_m), kContinuous_m);
  auditor.on_frame(scenes::cloud_of({p_W}));
  auditor.tick(from, to);
  return auditor.audit();
}

// Signed distance to the bar, in closed form.
double to_bar_m(const Vec3& p_T) {
  const Vec3 q = p_T.cwiseAbs() - 0.5 * kSides_m;
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
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
    if (distance_m(0) < 0 || std::abs(lowest_m) < 2 * kContinuous_m) continue;
    (lowest_m < 0 ? crossed : clear) += 1;
    EXPECT_EQ(of_bar(p_W, from, to).entered, lowest_m < 0 ? 1 : 0) << i << " " << lowest_m;
  }
  EXPECT_GT(crossed, 20);
  EXPECT_GT(clear, 100);
}

// --- experiments ---

ToolPose pose_at(const Trace& trace, std::size_t tick) {
  return {trace.proxy_position_m[tick], trace.tool_orientation[tick]};
}

// The treatment of the ticks in which a frame comes.
enum class Frames { left_out, followed };

ToolAudit audited(const Trace& trace, const std::map<int, PointCloud>& clouds, ToolAuditor auditor,
                  Frames frames) {
  int shown = -1;
  for (std::size_t i = 1; i < trace.length(); ++i) {
    if (trace.frame_index[i] == shown) {
      auditor.tick(pose_at(trace, i - 1), pose_at(trace, i));
      continue;
    }
    const bool is_first = shown < 0;
    shown = trace.frame_index[i];
    if (is_first || frames == Frames::left_out)
      auditor.on_frame(clouds.at(shown));
    else
      auditor.tick_with_frame(clouds.at(shown), pose_at(trace, i - 1), pose_at(trace, i));
  }
  return auditor.audit();
}

ToolAudit audited(const std::string& name, const std::string& rule, double tolerance_m,
                  std::vector<std::string> overrides = {}, Frames frames = Frames::left_out) {
  overrides.push_back("renderer.contact_rule=" + rule);
  const Experiment experiment = Experiment::load(name, overrides);
  std::map<int, PointCloud> clouds;
  SimulationOptions options;
  options.on_frame = [&](const Frame& frame) {
    PointCloud buffer;
    clouds[frame.index] = frame.points->every_point(scenes::kernels(), buffer);
  };
  const Trace trace = simulate(experiment, options);
  const ToolAudit audit = audited(trace, clouds, {tool_of(experiment)->mesh, tolerance_m}, frames);
  std::printf("%s, %s: of %lld point-ticks %lld entered the tool by more than %g mm\n", name.c_str(),
              rule.c_str(), static_cast<long long>(audit.point_ticks), static_cast<long long>(audit.entered),
              1e3 * tolerance_m);
  return audit;
}

class ToolCrossings : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Experiments, ToolCrossings, testing::Values("fig6.3", "tool-slab", "tool-slot"),
                         [](const auto& experiment) { return test_name(experiment.param); });
// Only scripts/test --evidence runs it.
INSTANTIATE_TEST_SUITE_P(LongExperiments, ToolCrossings,
                         testing::Values("tool-walk", "fig6.4", "fig6.4-organ", "fig6.4-box"),
                         [](const auto& experiment) { return test_name(experiment.param); });

void expect_none(const std::string& name, const std::string& rule, double tolerance_m) {
  set_data_folder(data_root().string());
  try {
    const ToolAudit audit = audited(name, rule, tolerance_m);
    EXPECT_GT(audit.point_ticks, 1'000'000);
    EXPECT_EQ(audit.entered, 0) << audit.deepest_m;
  } catch (const InputError& missing) {
    ASSERT_TRUE(contains(missing.what(), "no such recording")) << missing.what();
    GTEST_SKIP() << missing.what();
  }
}

TEST_P(ToolCrossings, ThereAreNone) {
  for (const auto& [rule, tolerance_m] :
       {std::pair("look-ahead", kLookAhead_m), {"continuous", kContinuous_m}, {"voxels", kVoxels_m}}) {
    SCOPED_TRACE(rule);
    expect_none(GetParam(), rule, tolerance_m);
  }
}

// Points are so dense here that one disk stands for many. Each motion is still checked against every point.
TEST(ToolCrossings, ThereAreNoneWherePointsAreMerged) {
  const ToolAudit audit = audited("fig6.3", "continuous", kContinuous_m, {"scenario.spacing_m=0.0005"});
  EXPECT_GT(audit.point_ticks, 10'000'000);
  EXPECT_EQ(audit.entered, 0) << audit.deepest_m;
}

// The tool comes from the back of a surface. The printed rule pulls it through.
TEST(ToolCrossings, VoxelsPullAToolThroughFromTheBack) {
  EXPECT_EQ(audited("tool-sheet", "look-ahead", kLookAhead_m).entered, 0);
  EXPECT_EQ(audited("tool-sheet", "continuous", kContinuous_m).entered, 0);
  EXPECT_GT(audited("tool-sheet", "voxels", kVoxels_m).entered, 0);
}

// Points are followed through frames, too, because the position of each point in the frame before is known. A
// surface that rises by more than the plate's thickness in every frame carries the plate along and does not
// pass through it.
TEST(ToolCrossings, ThereAreNoneAtFramesByTheContinuousRuleWhereASurfaceRises) {
  for (const char* surface : {"scenario.shape=flat", "scenario.tilt_deg=30", "scenario.tilt_deg=-45"}) {
    const auto entered = [&](const std::string& rule) {
      return audited("tool-lift", rule, kContinuous_m,
                     {"renderer.tool_mesh=slab-5", "scenario.start_velocity_m_per_s=0.24",
                      "scenario.rise_s=0.13333333333333333", "duration_s=0.65", surface},
                     Frames::followed)
          .entered;
    };
    EXPECT_EQ(entered("continuous"), 0) << surface;
    EXPECT_GT(entered("look-ahead"), 10) << surface;
  }
}

// Walls that close to less than the tool's thickness: no pose keeps their points out.
TEST(ToolCrossings, TheContinuousRuleMovesIntoNoPointsBetweenClosingWalls) {
  EXPECT_EQ(audited("tool-wedge", "continuous", kContinuous_m).entered, 0);
  EXPECT_GT(audited("tool-wedge", "look-ahead", kLookAhead_m).entered, 0);
  EXPECT_GT(audited("tool-wedge", "voxels", kVoxels_m).entered, 0);
}

}  // namespace
}  // namespace remote_touch::tool_crossings_test
