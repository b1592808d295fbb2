#include "scenarios/simulated/panel_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "scenarios/simulated/grid_scenes.h"
#include "tests/support/scenes.h"

namespace remote_touch::panel_scenes_test {
namespace {

// A panel whose axes are not those of the world.
FlatPanel askew() {
  const Vec3 normal = Vec3(1, 2, 2) / 3, u = Vec3(2, 1, -2) / 3;
  return {{0.1, 0.2, -0.3}, normal, u, 0.0301, 0.02};
}

TEST(FlatPanel, PointsAreAGridOnItWithItsNormal) {
  const FlatPanel panel = askew();
  PointCloud cloud;
  append(cloud, panel, {0.01, 0.002, 0});
  // -0.028, -0.018, ... 0.022 along u, and -0.02 .. 0.02 along v, the border included.
  ASSERT_EQ(cloud.size(), 6u * 5u);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 from_centre = cloud.point(i) - panel.centre;
    EXPECT_NEAR(from_centre.dot(panel.normal), 0, 1e-16);
    EXPECT_NEAR(from_centre.dot(panel.u), -0.028 + 0.01 * static_cast<double>(i % 6), 1e-15);
    EXPECT_NEAR(from_centre.dot(panel.v()), -0.02 + 0.01 * static_cast<double>(i / 6), 1e-15);
    EXPECT_EQ(cloud.normal(i), panel.normal);
  }
}

TEST(FlatPanel, DistanceIsToTheNearestOfManySamples) {
  const FlatPanel panel = askew();
  PointCloud dense;
  append(dense, panel, {0.0005});
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-0.06, 0.06);
  int behind = 0, beside = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = panel.centre + Vec3(place(random), place(random), place(random));
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < dense.size(); ++j) nearest = std::min(nearest, (dense.point(j) - p).norm());
    const double got = signed_distance({&panel, 1}, p);
    const Vec3 from_centre = p - panel.centre;
    const bool is_behind = panel.normal.dot(from_centre) < 0;
    const bool is_beside = std::abs(from_centre.dot(panel.u)) > panel.half_u_m ||
                           std::abs(from_centre.dot(panel.v())) > panel.half_v_m;
    EXPECT_EQ(std::isnan(got), is_behind && is_beside);
    beside += std::isnan(got);
    if (std::isnan(got)) continue;
    EXPECT_EQ(got < 0, is_behind);
    behind += got < 0;
    EXPECT_LE(std::abs(got), nearest + 1e-15);
    EXPECT_GE(std::abs(got), nearest - 0.0005);  // half a diagonal of the samples, and the border beyond them
  }
  EXPECT_GT(behind, 10);
  EXPECT_GT(beside, 100);
}

// Two walls of a corner, whose inside is free. The edge belongs to both walls.
TEST(FlatPanel, CornersHaveOneInside) {
  const std::vector<FlatPanel> corner = {{{1, 0, 0}, Vec3::UnitY(), Vec3::UnitX(), 1, 1},
                                         {{0, 1, 0}, Vec3::UnitX(), Vec3::UnitY(), 1, 1}};
  EXPECT_DOUBLE_EQ(signed_distance(corner, {0.3, 0.2, 0}), 0.2);
  EXPECT_DOUBLE_EQ(signed_distance(corner, {0.2, 0.3, 0}), 0.2);
  EXPECT_DOUBLE_EQ(signed_distance(corner, {-0.3, -0.4, 0}), -0.5);
  EXPECT_DOUBLE_EQ(signed_distance(corner, {-0.3, 0.4, 0}), -0.3);
  // Below one wall, beyond the edge, and 1e-12 m on the free side of the other wall.
  EXPECT_DOUBLE_EQ(signed_distance(corner, {1e-12, -0.4, 0}), -0.4);
  EXPECT_EQ(signed_distance({}, {0, 0, 0}), std::numeric_limits<double>::infinity());
}

// The walls are those of CornersHaveOneInside. The edge at which they meet is no border. Its ends and the
// other edges are borders.
TEST(FlatPanel, HasNoBackBesideItsBorder) {
  const std::vector<FlatPanel> corner = {{{1, 0, 0}, Vec3::UnitY(), Vec3::UnitX(), 1, 1},
                                         {{0, 1, 0}, Vec3::UnitX(), Vec3::UnitY(), 1, 1}};
  EXPECT_DOUBLE_EQ(signed_distance(corner, {-0.3, -0.4, 0.999}), -0.5);
  EXPECT_TRUE(std::isnan(signed_distance(corner, {-0.3, -0.4, 1.001}))) << "beyond the end of the edge";
  EXPECT_DOUBLE_EQ(signed_distance(corner, {1.9, -0.4, 0}), -0.4);
  EXPECT_TRUE(std::isnan(signed_distance(corner, {2.1, -0.4, 0})));
  EXPECT_TRUE(std::isnan(signed_distance(corner, {-0.3, 2.4, 0})));
  EXPECT_DOUBLE_EQ(signed_distance(corner, {2.3, 0.4, 0}), 0.5) << "above the border";
  // A third panel makes the end of the edge a corner: there is no way round it.
  std::vector<FlatPanel> closed = corner;
  closed.push_back({{1, 1, 1}, -Vec3::UnitZ(), Vec3::UnitX(), 1, 1});
  EXPECT_DOUBLE_EQ(signed_distance(closed, {-0.2, -0.3, 1.6}), -0.7);
}

// The scenes of chapter 6 that are made of panels, and the slab that lifts.

const double kPi = std::acos(-1.0);

template <class Made>
Made made(const typename Made::Settings& settings = {}) {
  return Made(settings, NoiseKey{3}, scenes::kernels());
}

// Checks that every point lies on the surface, and that a step along its normal leads to the free side.
void expect_on_surface(const Scenario& scene, int frame) {
  const PointCloud cloud = scene.cloud(frame);
  const double time_s = scene.captured_s(frame);
  ASSERT_GT(cloud.size(), 100u);
  ASSERT_TRUE(cloud.has_normals());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ASSERT_NEAR(cloud.normal(i).norm(), 1, 1e-15);
    ASSERT_LT(std::abs(scene.signed_distance(cloud.point(i), time_s)), 1e-15);
    ASSERT_GT(scene.signed_distance(cloud.point(i) + 1e-6 * cloud.normal(i), time_s), -1e-15);
  }
}

TEST(OpenBox, HasItsSizeAndSpacing) {
  const OpenBox box = made<OpenBox>();
  expect_on_surface(box, 0);
  // Columns at whole multiples of 3 mm around the middle of each side: -45 .. 45, -18 .. 18, -54 .. 54.
  EXPECT_EQ(box.cloud(0).size(), 2u * (31 * 13) + 2u * (37 * 13) + 37u * 31u);
  EXPECT_EQ(box.frame_count(), 1);
  EXPECT_NEAR(box.signed_distance({0, 0, 0}, 0), 0.020, 1e-15);
  EXPECT_NEAR(box.signed_distance({0.045, 0, 0}, 0), 0.010, 1e-15);
  EXPECT_NEAR(box.signed_distance({0, 0.010, -0.040}, 0), 0.005, 1e-15);
  EXPECT_NEAR(box.signed_distance({0.058, 0, 0}, 0), -0.003, 1e-15);
  EXPECT_NEAR(box.signed_distance({0.01, -0.025, 0.01}, 0), -0.005, 1e-15);
  // Above the opening, the nearest point is on a rim.
  EXPECT_NEAR(box.signed_distance({0.015, 0.05, 0}, 0), 0.05, 1e-15);
  EXPECT_GT(box.signed_distance({0, 1, 0}, 0), 0.9);
  // The distance is negative behind walls and floor, up to the rim. Beyond the rim the box has no back.
  EXPECT_NEAR(box.signed_distance({0.059, -0.023, 0}, 0), -0.005, 1e-15);
  EXPECT_NEAR(box.signed_distance({0.4, 0.019, 0}, 0), -0.345, 1e-15);
  EXPECT_TRUE(std::isnan(box.signed_distance({0.4, 0.021, 0}, 0)));
  EXPECT_TRUE(std::isnan(box.signed_distance({0.4, 0.021, 0.4}, 0)));
}

TEST(OpenBox, TheFloorCanBeLeftOut) {
  OpenBox::Settings s;
  s.floor = false;
  const OpenBox walls = made<OpenBox>(s);
  EXPECT_EQ(walls.panels(0).size(), 4u);
  const PointCloud cloud = walls.cloud(0);
  EXPECT_EQ(cloud.size(), 2u * (31 * 13) + 2u * (37 * 13));
  for (std::size_t i = 0; i < cloud.size(); ++i) EXPECT_EQ(cloud.ny[i], 0);
  EXPECT_NEAR(walls.signed_distance({0, -0.020, 0}, 0), 0.045, 1e-15);
  s.size_m.y() = 0;
  EXPECT_NE(validate(s), "");
}

// A bar of 80 x 10 mm touches both walls, 40 mm apart, with its corners: 40 sin + 5 cos = 20, at 22.62
// degrees.
TEST(Slot, CornersOfTheBarMeetTheWallsHalfWayBetweenColumns) {
  const double angle = std::asin(5.0 / 13);
  EXPECT_NEAR(angle * 180 / kPi, 22.62, 0.001);
  EXPECT_NEAR(0.040 * std::sin(angle) + 0.005 * std::cos(angle), 0.020, 1e-15);
  EXPECT_NEAR(0.040 * std::cos(angle) - 0.005 * std::sin(angle), 0.035, 1e-15);
  for (const auto& [spacing, phase] : {std::pair(0.002, 0.0), {0.001, 0.0005}, {0.005, 0.0025}}) {
    Slot::Settings s;
    s.spacing_m = spacing, s.phase_m = phase;
    const Slot slot = made<Slot>(s);
    expect_on_surface(slot, 0);
    const PointCloud cloud = slot.cloud(0);
    for (const double corner : {-0.035, 0.035}) {
      double nearest = 1;
      for (const double x : cloud.x) nearest = std::min(nearest, std::abs(x - corner));
      EXPECT_NEAR(nearest, 0.5 * spacing, 1e-15) << spacing;
    }
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      EXPECT_NEAR(std::abs(cloud.z[i]), 0.020, 1e-15);
      EXPECT_EQ(cloud.nz[i], cloud.z[i] > 0 ? -1 : 1);
    }
  }
  const Slot slot = made<Slot>();
  EXPECT_NEAR(slot.signed_distance({0.01, 0.01, 0.015}, 0), 0.005, 1e-15);
  EXPECT_NEAR(slot.signed_distance({0.01, 0.01, -0.026}, 0), -0.006, 1e-15);
  EXPECT_TRUE(std::isnan(slot.signed_distance({0.061, 0.01, -0.026}, 0))) << "beyond the end of the wall";
  EXPECT_TRUE(std::isnan(slot.signed_distance({0.01, 0.031, 0.026}, 0))) << "and above it";
}

TEST(Wedge, ClosesAndOpensEvenly) {
  const Wedge wedge = made<Wedge>();
  EXPECT_EQ(wedge.gap_m(0), 0.05);
  EXPECT_EQ(wedge.gap_m(1), 0.05);
  EXPECT_NEAR(wedge.gap_m(1.25), 0.0375, 1e-16);
  EXPECT_EQ(wedge.gap_m(2), 0);
  EXPECT_EQ(wedge.gap_m(2.9), 0);
  EXPECT_NEAR(wedge.gap_m(3.5), 0.025, 1e-16);
  EXPECT_EQ(wedge.gap_m(4), 0.05);
  EXPECT_EQ(wedge.gap_m(100), 0.05);
  EXPECT_EQ(wedge.frame_count(), 121);
  for (const int frame : {0, 35, 101, 120}) expect_on_surface(wedge, frame);
  // A wall meets its lower edge at 30 degrees from the vertical; between frames it moves on.
  const Vec3 p(0, 0.03, 0);
  for (const double t : {0.0, 1.3, 1.31, 2.5, 3.7})
    EXPECT_NEAR(wedge.signed_distance(p, t), 0.03 * 0.5 + 0.5 * wedge.gap_m(t) * std::sqrt(0.75), 1e-15) << t;
  EXPECT_LT(wedge.signed_distance({0, 0, 0.03}, 0), 0);
  // Below the closed walls is their back; below the open ones is the gap between them.
  EXPECT_NEAR(wedge.signed_distance({0, -0.02, 0}, 2.5), -0.02, 1e-15);
  EXPECT_TRUE(std::isnan(wedge.signed_distance({0, -0.1, 0.02}, 0)));
}

TEST(Wedge, CanBeShiftedTiltedAndParallel) {
  Wedge::Settings s;
  s.offset_m = 0.01, s.tilt_deg = 20, s.angle_deg = 0, s.closed_gap_m = 0.02;
  const Wedge plates = made<Wedge>(s);
  expect_on_surface(plates, 0), expect_on_surface(plates, 70);
  const Vec3 up(0, std::cos(kPi / 9), std::sin(kPi / 9)), across(0, -std::sin(kPi / 9), std::cos(kPi / 9));
  const Vec3 middle = Vec3(0, 0, 0.01) + 0.06 * up;
  EXPECT_NEAR(plates.signed_distance(middle, 0), 0.025, 1e-15);
  EXPECT_NEAR(plates.signed_distance(middle + 0.006 * across, 2.5), 0.004, 1e-15);
  EXPECT_NEAR(plates.signed_distance(middle - 0.012 * across, 2.5), -0.002, 1e-15);
  EXPECT_EQ(validate(s), "");
  s.open_start_s = 1.5;
  EXPECT_NE(validate(s), "");
}

TEST(Wedge, JumpsIfTheScheduleHasNoDuration) {
  Wedge::Settings s;
  s.close_end_s = s.close_start_s = 1, s.open_start_s = s.open_end_s = 2;
  const Wedge wedge = made<Wedge>(s);
  EXPECT_EQ(wedge.gap_m(0.999), 0.05);
  EXPECT_EQ(wedge.gap_m(1), 0);
  EXPECT_EQ(wedge.gap_m(1.999), 0);
  EXPECT_EQ(wedge.gap_m(2), 0.05);
}

TEST(SinglePanel, FacesItsNormal) {
  SinglePanel::Settings s;
  s.centre_m = {0.1, 0.2, 0.3};
  for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(-0.5, 0.25, 1)}) {
    s.normal = normal;
    const SinglePanel scene = made<SinglePanel>(s);
    expect_on_surface(scene, 0);
    const Vec3 n = normal.normalized();
    EXPECT_NEAR(scene.signed_distance(s.centre_m + 0.02 * n, 0), 0.02, 1e-15);
    EXPECT_NEAR(scene.signed_distance(s.centre_m - 0.02 * n, 0), -0.02, 1e-15);
    EXPECT_EQ(scene.cloud(0).size(), 75u * 75u);
    const FlatPanel panel = scene.panels(0)[0];
    EXPECT_NEAR(panel.u.dot(n), 0, 1e-16);
    EXPECT_NEAR(panel.u.norm(), 1, 1e-15);
  }
  s.normal.setZero();
  EXPECT_NE(validate(s), "");
}

TEST(MovingPlane, WaitsRisesAndRests) {
  MovingPlane::Settings s;
  s.acceleration_m_per_s2 = 0.6;
  const MovingPlane plane = made<MovingPlane>(s);
  const auto height = [&](double t) { return plane.surface_height(0, 0, t); };
  EXPECT_EQ(height(0), -0.06);
  EXPECT_EQ(height(1), -0.06);
  EXPECT_NEAR(height(1.1), -0.06 + 0.01 + 0.003, 1e-15);
  // 0.1 t + 0.3 t^2 = 0.1
  const double end = (-0.1 + std::sqrt(0.01 + 0.12)) / 0.6;
  EXPECT_NEAR(height(1 + end - 1e-9), 0.04, 1e-9);
  EXPECT_EQ(height(1 + end + 1e-12), -0.06 + 0.1);
  EXPECT_EQ(plane.frame_count(), 1 + static_cast<int>(std::ceil((1 + end) * 30)));
  EXPECT_NEAR(plane.signed_distance({0.09, -0.05, 0.02}, 1.1), -0.05 + 0.047, 1e-15);
  EXPECT_NEAR(plane.signed_distance({1, -0.04, 2}, 1.1), -0.04 + 0.047, 1e-15);
  EXPECT_TRUE(std::isnan(plane.signed_distance({1, -0.05, 2}, 1.1))) << "beside the cloud";
  for (const int frame : {0, 31, 40, plane.frame_count() - 1}) {
    expect_on_surface(plane, frame);
    EXPECT_EQ(plane.cloud(frame).ny[7], 1);
  }
  s.speed_m_per_s = s.acceleration_m_per_s2 = 0;
  EXPECT_NE(validate(s), "");
  s.rise_height_m = 0;
  EXPECT_EQ(validate(s), "");
  EXPECT_EQ(made<MovingPlane>(s).frame_count(), 1);
}

// It rises for 1e8 s, which is 1e12 frames.
TEST(MovingPlane, LimitsItsFramesToTheLargestInt) {
  MovingPlane::Settings s;
  s.frame_rate_hz = 10000, s.speed_m_per_s = 1e-6, s.rise_height_m = 100;
  EXPECT_EQ(validate(s), "");
  EXPECT_EQ(made<MovingPlane>(s).frame_count(), std::numeric_limits<int>::max());
}

}  // namespace
}  // namespace remote_touch::panel_scenes_test

namespace remote_touch::plates_test {
namespace {

// Tests the points of plates that are seen from above against their expected positions.

// A table at rest, and a plate of 3 x 4 cm, 5 cm above it, that passes from x = -0.06 m on at 0.3 m/s.
Plates::Settings passing() {
  Plates::Settings s;
  s.grid = {61, 41, 0.002, 0, 0};
  s.plates = {0,     0,    0, 0.2,  0.2,  0,   0, 0,   0,  // the table
              -0.06, 0.05, 0, 0.03, 0.04, 0.3, 0, 0.1, 0.5};
  return s;
}

Plates made(const Plates::Settings& s) {
  return Plates(s, NoiseKey{3, 1, 2}, scenes::kernels());
}

TEST(Plates, ARaySeesTheHighestPlateAtItsNode) {
  const Plates plates = made(passing());
  for (const int frame : {0, 3, 9, 20}) {
    const double x = -0.06 + 0.3 * std::clamp(frame / 30.0 - 0.1, 0.0, 0.4);
    const PointCloud cloud = plates.cloud(frame);
    ASSERT_EQ(cloud.size(), 61u * 41u);
    EXPECT_EQ(cloud.columns(), 61);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      EXPECT_NEAR(cloud.x[i], (static_cast<double>(i % 61) - 30) * 0.002, 1e-15) << "rays stand still";
      const double beside = std::abs(cloud.x[i] - x) - 0.015, ahead = std::abs(cloud.z[i]) - 0.02;
      if (std::abs(beside) > 1e-9 && std::abs(ahead) > 1e-9) {
        EXPECT_EQ(cloud.y[i], beside < 0 && ahead < 0 ? 0.05 : 0) << frame << " " << cloud.x[i];
      }
    }
  }
}

TEST(Plates, PlatesTooNearToTheCameraOnlyHide) {
  Plates::Settings s = passing();
  s.max_height_m = 0.04;
  const PointCloud all = made(passing()).cloud(9), less = made(s).cloud(9);
  int hidden = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(less.is_measured(i), all.y[i] == 0);
    hidden += less.is_measured(i) ? 0 : 1;
  }
  EXPECT_GT(hidden, 200);
}

TEST(Plates, GapsBetweenPlatesHaveNoPoints) {
  Plates::Settings s = passing();
  s.plates = {-0.05, 0, 0, 0.1, 0.2, -0.1, 0, 0, 0.2, 0.05, 0, 0, 0.1, 0.2, 0.1, 0, 0, 0.2};
  const PointCloud cloud = made(s).cloud(6);  // 0.2 s: a gap of 4 cm
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (std::abs(std::abs(cloud.x[i]) - 0.02) > 1e-9) {
      EXPECT_EQ(cloud.is_measured(i), std::abs(cloud.x[i]) > 0.02);
    }
  }
}

TEST(Plates, TheFirstPlateIsTheTruth) {
  Plates::Settings s = passing();
  s.plates = {0, 0.01, 0, 0.1, 0.1, 0.2, 0.3, 0, 10, 0, 0.05, 0, 0.1, 0.1, 0, 0, 0, 0};
  const Vec3 p(0.01, 0.04, 0.02);
  EXPECT_NEAR(made(s).signed_distance(p, 0), 0.03, 1e-15);
  EXPECT_NEAR(made(s).signed_distance(p, 0.09), 0.03 - 0.3 * 2 / 30, 1e-15) << "the frame of 1/15 s";
  EXPECT_NEAR(made(s).surface_height(0, 0, 0.09), 0.01 + 0.3 * 0.09, 1e-15);
  s.truth = SurfaceTime::moving;
  EXPECT_NEAR(made(s).signed_distance(p, 0.09), 0.03 - 0.3 * 0.09, 1e-15);
  EXPECT_NEAR(made(s).signed_distance({0.05 + 0.018 + 0.3, 0.01 + 0.027 + 0.4, 0}, 0.09), 0.5, 1e-12)
      << "beyond the border, to the border";
  EXPECT_TRUE(std::isnan(made(s).signed_distance({0.05 + 0.018 + 0.3, 0.01 + 0.027 - 0.4, 0}, 0.09)))
      << "below its plane, beside it";
}

TEST(Plates, HaveFramesForAsLongAsSomethingChanges) {
  EXPECT_EQ(made(passing()).frame_count(), 16) << "0.5 s is frame 15";
  Plates::Settings s = passing();
  s.noise_sigma_m = 0.001;
  EXPECT_EQ(made(s).frame_count(), std::numeric_limits<int>::max());
  EXPECT_NE(made(s).cloud(20).y[0], made(s).cloud(21).y[0]);
  EXPECT_EQ(made(Plates::Settings{}).frame_count(), 1);
}

TEST(Plates, RefuseSizesOfZero) {
  Plates::Settings s;
  s.plates = {0, 0, 0, 0.2, 0, 0, 0, 0, 0};
  EXPECT_NE(validate(s).find("row 1"), std::string::npos);
  s.plates.clear();
  EXPECT_FALSE(validate(s).empty());
}

}  // namespace
}  // namespace remote_touch::plates_test
