// Notes on contacts: gaps between points, where a run starts, surfaces that pass the proxy, and thin walls.
#include "runners/experiment/simulation/run_notes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "analysis/trace/contact_measures.h"
#include "analysis/trace/measures.h"
#include "core/points/neighbour_search.h"
#include "tests/runners/experiment/simulation/reported_run.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::contact_watch_test {
namespace {

// --- gaps between points, compared with every triangle of points by the definition ---

constexpr double kBall_m = 0.005, kKnown_m = 0.015;

// The centre of the circle through three points of the plane z = 0; nothing for points on a line.
std::optional<Vec3> centre_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a;
  const double d = 2 * (ab.x() * ac.y() - ab.y() * ac.x());
  if (std::abs(d) < 1e-12) return {};
  const double b2 = ab.squaredNorm(), c2 = ac.squaredNorm();
  return a + Vec3(ac.y() * b2 - ab.y() * c2, ab.x() * c2 - ac.x() * b2, 0) / d;
}

// True if no angle of the triangle is obtuse, so that the corners surround the centre of the circle through
// them.
bool holds(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b - a).dot(c - a) >= 0 && (a - b).dot(c - b) >= 0 && (a - c).dot(b - c) >= 0;
}

// The widest gap at the origin of points in the plane z = 0.
double widest_of_all_triangles(const std::vector<Vec3>& points) {
  double widest_m = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (std::size_t k = 0; k < j; ++k) {
        const auto centre = centre_of(points[i], points[j], points[k]);
        if (!centre || !holds(points[i], points[j], points[k])) continue;
        const double radius_m = (points[i] - *centre).norm();
        if (radius_m <= kBall_m || centre->norm() > radius_m || centre->norm() + radius_m > kKnown_m)
          continue;
        const bool is_empty = std::all_of(points.begin(), points.end(), [&](const Vec3& p) {
          return (p - *centre).norm() > radius_m - 1e-12;
        });
        if (is_empty) widest_m = std::max(widest_m, radius_m);
      }
  return widest_m;
}

// The points of a plane cloud that lie within kKnown_m of the origin.
std::vector<Vec3> random_points(int count, unsigned seed) {
  const PointCloud cloud = scenes::random_cloud(count, 0.02, seed);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 p(cloud.x[i], cloud.y[i], 0);
    if (p.norm() <= kKnown_m) points.push_back(p);
  }
  return points;
}

TEST(PointGap, IsTheWidestOfAllTrianglesOfPoints) {
  const Eigen::Quaterniond rotation(Eigen::AngleAxisd(1, Vec3(1, 2, 3).normalized()));
  const Vec3 position(0.1, -0.2, 0.3);
  int gaps = 0, others = 0;
  for (unsigned seed = 1; seed <= 400; ++seed) {
    const std::vector<Vec3> points = random_points(5 + static_cast<int>(seed % 56), seed);
    const double expected_m = widest_of_all_triangles(points);
    std::vector<Vec3> placed;
    for (const Vec3& p : points) placed.push_back(rotation * p + position);
    const PointGap gap = widest_gap(placed, position, kBall_m, kKnown_m);
    EXPECT_NEAR(gap.radius_m, expected_m, 1e-9) << seed;
    ++(expected_m > 0 ? gaps : others);
  }
  EXPECT_GT(gaps, 100);
  EXPECT_GT(others, 100);
}

std::vector<Vec3> grid(double columns_m, double rows_m, double from_x_m = -0.015) {
  std::vector<Vec3> points;
  for (int i = -20; i <= 20; ++i)
    for (int j = -20; j <= 20; ++j)
      if (const Vec3 p(i * columns_m, j * rows_m, 0); p.norm() <= kKnown_m && p.x() >= from_x_m)
        points.push_back(p);
  return points;
}

// Points at the border of a dense surface hold no disk beside it.
TEST(PointGap, IsNoneBesideASurface) {
  const PointGap gap = widest_gap(grid(0.0015, 0.0015, -0.001), Vec3::Zero(), kBall_m, kKnown_m);
  EXPECT_EQ(gap.radius_m, 0);
  EXPECT_FALSE(gap.is_decided) << "farther points could be on the other side";
  EXPECT_TRUE(widest_gap(grid(0.0015, 0.0015), Vec3::Zero(), kBall_m, kKnown_m).is_decided);
}

TEST(PointGap, IsNotDecidedForPointsThatDefineNoPlane) {
  const std::vector<Vec3> line = {{0, 0, 0}, {0.001, 0, 0}, {0.003, 0, 0}};
  for (const std::vector<Vec3>& points : {std::vector<Vec3>{}, {Vec3::Zero()}, line}) {
    const PointGap gap = widest_gap(points, Vec3::Zero(), kBall_m, kKnown_m);
    EXPECT_EQ(gap.radius_m, 0);
    EXPECT_FALSE(gap.is_decided);
  }
}

// --- where a run starts, where points are too far apart, and where a fast surface passes the proxy ---

std::string flat(const std::string& spacing_m) {
  return R"({"name": "flat-grid", "rows": 41, "columns": 41, "spacing_m": )" + spacing_m + "}";
}

std::string press_from(double x_m, double y_m, double z_m = 0.0001) {
  return R"({"name": "press", "press_at_s": 0.1, "depth_m": 0.01, "start_m": [)" + std::to_string(x_m) + "," +
         std::to_string(y_m) + "," + std::to_string(z_m) + "]}";
}

std::string straight_down(double x_m, double z_m) {
  const std::string x = "[" + std::to_string(x_m) + ", ", z = ", " + std::to_string(z_m) + ", ";
  return R"({"name": "waypoints", "waypoints": [)" + x + "0.02" + z + "0], " + x + "-0.02" + z + "0.2]]}";
}

// The contact radius is 5 mm.
TEST(ContactWatch, ReportsAHandThatStartsInContact) {
  for (const double height_m : {0.02, 0.0051})
    EXPECT_EQ(run_of(flat("0.0015"), press_from(0.0003, height_m)).kinds(), Kinds{}) << height_m;
  for (const double height_m : {0.0049, 0.0002, 0.0, -0.0002, -0.008}) {
    const ReportedRun made = run_of(flat("0.0015"), press_from(0.0003, height_m));
    EXPECT_TRUE(made.has("starts in contact")) << height_m;
  }
  EXPECT_HAS(
      run_of(flat("0.0015"), press_from(0, 0.002)).report.notes.front().text,
      "when the first frame arrives, at 0 s, the hand is 2 mm in front of the true surface, nearer than "
      "the contact radius of 5 mm");
  EXPECT_HAS(run_of(flat("0.0015"), press_from(0, -0.002)).report.notes.front().text,
             "when the first frame arrives, at 0 s, the hand is 2 mm behind the true surface");
}

// No renderer can hold a surface that it has not received. The hand goes through the surface and back in 0.1
// s, and then through it again at 0.3 s.
TEST(ContactWatch, WhatHappensBeforeTheFirstFrameIsNoPopThrough) {
  const std::string to_and_fro = R"({"name": "waypoints",
      "waypoints": [[0, 0.02, 0, 0], [0, -0.005, 0, 0.5], [0, 0.02, 0, 0.5], [0, -0.005, 0, 0.1]]})";
  const auto made = [&](const std::string& latency_s) {
    return run_of(flat("0.0015"), to_and_fro, R"("duration_s": 0.6, "frame_latency_s": )" + latency_s);
  };
  for (const char* latency_s : {"0.08", "0.35"}) {
    const ReportedRun late = made(latency_s);
    EXPECT_LT(late.trace.signed_distance_m[50], 0) << "the hand is behind the surface then";
    EXPECT_EQ(popped_through(late.trace), 0) << latency_s;
    EXPECT_TRUE(std::isnan(first_pop_through_tick(late.trace))) << latency_s;
  }
  EXPECT_EQ(made("0.08").kinds(), Kinds{});
  EXPECT_HAS(made("0.35").report.notes.front().text,
             "when the first frame arrives, at 0.35 s, the hand is 5 mm behind the true surface");
}

// Single points have no sides, so that their distance alone counts. A plate that the sensor does not see,
// because it is too high, is not touched. A slab that begins 0.2 mm deep is 10 mm thick.
TEST(ContactWatch, ReportsAStartAtWhatTheSensorSees) {
  const std::string points = R"({"name": "points", "points": [[0, 0.016, 0]]})";
  EXPECT_TRUE(run_of(points, straight_down(0, 0)).has("starts in contact"));
  EXPECT_FALSE(run_of(points, straight_down(0.0035, 0)).has("starts in contact")) << "5.3 mm away";
  const std::string hidden =
      R"({"name": "plates", "plates": [[0, 0.03, 0, 0.2, 0.2, 0, 0, 0, 0]], "max_height_m": 0.01})";
  EXPECT_FALSE(run_of(hidden, straight_down(0, 0)).has("starts in contact"));
  const auto of_tool = [](const std::string& height_m) {
    return run_of(R"({"name": "moving-plane", "start_height_m": )" + height_m + R"(, "wait_s": 0.05})",
                  R"({"name": "poses", "poses": [[0, 0, 0, 0, 0, 0, 0]]})", R"("duration_s": 0.1)",
                  R"(tool", "tool_mesh": "slab-10)");
  };
  EXPECT_TRUE(of_tool("-0.0048").has("starts in contact"));
  EXPECT_FALSE(of_tool("-0.02").has("starts in contact"));
}

// The rows are 12.5 mm apart, the points of a row 1.6 mm: every point has near neighbours.
std::string scan_lines(double rows_m) {
  std::string points;
  for (int row = -8; row <= 8; ++row)
    for (int i = -30; i <= 30; ++i)
      points += (points.empty() ? "[" : ", [") + std::to_string(0.0016 * i) + ", 0, " +
                std::to_string(row * rows_m) + "]";
  return R"({"name": "points", "points": [)" + points + "]}";
}

// A ball that falls through the middle of a cell touches nothing. A single point has no spacing. A surface at
// rest whose points are too far apart loses no proxy by its motion.
TEST(ContactWatch, ReportsPointsFarApart) {
  const struct {
    std::string scenario, trajectory;
    Kinds kinds;
    const char* text;  // a part of the last note
  } rows[] = {{scan_lines(0.0125),
               straight_down(0.0007, 0.003),
               {"wide spacing"},
               "a gap of radius 6.3 mm at the first contact"},
              {scan_lines(0.02), straight_down(0.0007, 0), {"wide spacing"}, ""},
              {scan_lines(0.0095), straight_down(0.0007, 0.003), {}, ""},
              {flat("0.012"),
               straight_down(0.006, 0.006),
               {"no contact", "wide spacing"},
               "where the proxy came nearest to them"},
              {flat("0.0015"), straight_down(0.04, 0), {"no contact"}, ""},  // beside the grid
              {flat("0.0075"), press_from(0.0003, 0.02), {"wide spacing"}, ""},
              {R"({"name": "points", "points": [[0, 0, 0]]})", straight_down(0.001, 0), {}, ""}};
  for (const auto& row : rows) {
    const ReportedRun made = run_of(row.scenario, row.trajectory);
    ASSERT_EQ(made.kinds(), row.kinds) << row.scenario.substr(0, 100) << row.trajectory;
    if (!row.kinds.empty()) {
      EXPECT_HAS(made.report.notes.back().text, row.text);
    }
  }
}

// A renderer that holds its proxy up to 1 mm behind the surface loses it only beyond that, see
// contact_measures.h.
TEST(ContactWatch, AProxyIsLostBeyondItsHeldDepth) {
  PointCloud corners;
  for (const double x : {-0.006, 0.006})
    for (const double z : {-0.006, 0.006}) corners.append({x, 0, z});
  const ContactWatch::Points points = make_search(std::move(corners));
  RenderOutput out;
  out.nearest_distance_m = std::numeric_limits<double>::infinity();
  ContactWatch watch(0.001);
  const auto notes_at = [&](double distance_m) {
    watch.add(0, out.proxy_W, out, points, distance_m);
    return watch.spacing_notes(0.005, scenes::kernels()).size();
  };
  EXPECT_EQ(notes_at(0.0001), 0u);
  EXPECT_EQ(notes_at(-0.0009), 0u);
  EXPECT_EQ(notes_at(-0.0011), 1u);
  EXPECT_EQ(notes_at(-0.0009), 0u) << "it is back";
}

TEST(ContactWatch, OnlyAProxyThatSinglePointsHoldHasANoteOnSpacing) {
  const auto is_noted = [](const char* renderer) {
    return run_of(flat("0.008"), press_from(0.0003, 0.02), R"("duration_s": 0.3)", renderer)
        .has("wide spacing");
  };
  for (const char* name : {"god-object", "density-proxy", "surfels", "mls-surface", "implicit-surface",
                           "penalty", "tracked-sheet"})
    EXPECT_FALSE(is_noted(name)) << name;
  for (const char* name : {"proxy", "averaged-proxy", "oracle-proxy"}) EXPECT_TRUE(is_noted(name)) << name;
}

std::string lift(double velocity_m_per_s, double wait_s, const std::string& more = "") {
  return R"({"name": "moving-lift", "rows": 41, "columns": 41, "noise_sigma_m": 0, "start_depth_m": 0.03, "rise_s": 0.6, )" +
         more + R"("start_velocity_m_per_s": )" + std::to_string(velocity_m_per_s) + R"(, "wait_s": )" +
         std::to_string(wait_s) + "}";
}
const char* const kRest = R"({"name": "waypoints", "waypoints": [[0, 0, 0, 0]]})";

// The hand rests over a point of a plane that rises at constant velocity. The fraction of lost proxies over
// the time at which the motion starts is that of the study first-touch: (max(0, d - r_1) + max(0, d + r_1 - 2
// r_c)) / d, where d is how far the plane moves from frame to frame.
TEST(ContactWatch, ReportsProxiesThatTheFirstTouchLoses) {
  constexpr int kPhases = 20;
  constexpr double kR1_m = 0.00499, kRc_m = 0.005;
  for (const double velocity_m_per_s : {0.13, 0.2, 0.25, 0.4}) {
    const double moved_m = velocity_m_per_s / 30;
    const double lost =
        (std::max(0.0, moved_m - kR1_m) + std::max(0.0, moved_m + kR1_m - 2 * kRc_m)) / moved_m;
    int noted = 0;
    for (int phase = 0; phase < kPhases; ++phase) {
      const ReportedRun made =
          run_of(lift(velocity_m_per_s, (phase + 0.5) / kPhases / 30), kRest, R"("duration_s": 0.5)");
      noted += made.has("lost at the first touch") ? 1 : 0;
      EXPECT_EQ(made.has("lost at the first touch"), popped_through(made.trace) == 1) << velocity_m_per_s;
    }
    EXPECT_NEAR(noted / double{kPhases}, std::min(1.0, lost), 1.01 / kPhases) << velocity_m_per_s;
  }
}

// One frame shows the plane 5 mm below the proxy, and the next 5.013 mm higher. The limit is r_c f_c = 0.15.
TEST(ContactWatch, VelocitiesThatDifferHaveDifferentTexts) {
  const ReportedRun made = run_of(lift(0.1504, 0.000444), kRest, R"("duration_s": 0.5)");
  EXPECT_HAS(text_of(made.report), "it moved at 0.1504 m/s towards the proxy");
  EXPECT_HAS(text_of(made.report), "safe only up to 0.15 m/s over a point, and less between points");
}

// The acceleration is above r_1 f_c^2 = 4.5 m/s^2, (4.14). It loses the proxy long after the first touch.
TEST(ContactWatch, ALaterLossIsNoneAtTheFirstTouch) {
  const ReportedRun made = run_of(lift(0.1, 0, R"("acceleration_m_per_s2": 20, "acceleration_s": 0.2, )"),
                                  kRest, R"("duration_s": 0.9)");
  EXPECT_EQ(popped_through(made.trace), 1);
  EXPECT_EQ(made.kinds(), Kinds{});
}

// --- walls ---

// Two walls of 5 mm: from y = 0 down to -5 mm, and from -25 to -30 mm.
class Walls final : public Scenario {
 public:
  explicit Walls(bool have_meshes) : have_meshes_(have_meshes) {}
  double frame_rate_hz() const override { return 30; }
  int frame_count() const override { return 1; }
  PointCloud cloud(int) const override { return {}; }
  double signed_distance(const Vec3& p_W, double) const override {
    const double y = p_W.y();
    return std::min(std::abs(y + 0.0025), std::abs(y + 0.0275)) - 0.0025;
  }
  std::vector<PosedMesh> true_meshes(double) const override {
    return have_meshes_ ? std::vector<PosedMesh>(1) : std::vector<PosedMesh>();
  }

 private:
  bool have_meshes_;
};

// A position goes down through both walls, and up again. It has a side until it passes the middle of the
// first wall, and again after it has come back through this middle.
TEST(WallWatch, APositionBehindTheMiddleOfAWallHasNoSide) {
  for (const double step_m : {0.0002, 0.0007, 0.003}) {
    const Walls walls(true);
    WallWatch watch(walls, "the hand");
    const int down = static_cast<int>(0.045 / step_m);
    for (int i = 0; i <= 2 * down; ++i) {
      const double y = 0.01 - step_m * (i <= down ? i : 2 * down - i), time_s = 0.001 * i;
      const double distance_m = walls.signed_distance({0, y, 0}, 0),
                   side_m = watch.side_m({0, y, 0}, distance_m, time_s);
      if (y > -0.0023) {
        EXPECT_EQ(side_m, distance_m) << step_m << " " << y << " " << i;
      } else if (y < -0.0027) {
        EXPECT_TRUE(std::isnan(side_m)) << step_m << " " << y << " " << i;
      }
    }
    ASSERT_EQ(watch.notes().size(), 1u);
    EXPECT_EQ(watch.notes().front().kind, "thin object");
    const Walls open(false);
    WallWatch none(open, "the hand");
    for (int i = 0; i <= down; ++i) EXPECT_EQ(none.side_m({0, 0.01 - step_m * i, 0}, 0.5 - i, 0), 0.5 - i);
    EXPECT_TRUE(none.notes().empty());
  }
}

}  // namespace
}  // namespace remote_touch::contact_watch_test
