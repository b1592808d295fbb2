// Panels against samples and closed forms, the scenes that are made of them, and plates seen from above.
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

// The scenes of chapter 6 that are made of panels.

template <class Made>
Made made(const typename Made::Settings& settings = {}) {
  return Made(settings, NoiseKey{3}, scenes::kernels());
}

// Checks that every point lies on the surface, and that a step along its normal leads to the free side.
void expect_on_surface(const Scenario& scene, const std::vector<int>& frames, std::size_t count) {
  for (const int frame : frames) {
    const PointCloud cloud = scene.cloud(frame);
    const double time_s = scene.captured_s(frame);
    ASSERT_EQ(cloud.size(), count);
    ASSERT_TRUE(cloud.has_normals());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      ASSERT_NEAR(cloud.normal(i).norm(), 1, 1e-15);
      ASSERT_LT(std::abs(scene.signed_distance(cloud.point(i), time_s)), 1e-15);
      ASSERT_GT(scene.signed_distance(cloud.point(i) + 1e-6 * cloud.normal(i), time_s), -1e-15);
    }
  }
}

// Columns at whole multiples of 3 mm around the middle of each side: -45 .. 45, -18 .. 18, -54 .. 54.
TEST(OpenBox, HasWallsAndPerhapsAFloor) {
  OpenBox::Settings s;
  const OpenBox box = made<OpenBox>(s);
  expect_on_surface(box, {0}, 2u * (31 * 13) + 2u * (37 * 13) + 37u * 31u);
  EXPECT_NEAR(box.signed_distance({0, 0, 0}, 0), 0.020, 1e-15);
  EXPECT_NEAR(box.signed_distance({0.015, 0.05, 0}, 0), 0.05, 1e-15) << "above the opening, from a rim";
  EXPECT_NEAR(box.signed_distance({0.4, 0.019, 0}, 0), -0.345, 1e-15) << "behind the wall, up to the rim";
  EXPECT_TRUE(std::isnan(box.signed_distance({0.4, 0.021, 0}, 0)));
  s.floor = false;
  expect_on_surface(made<OpenBox>(s), {0}, 2u * (31 * 13) + 2u * (37 * 13));
  EXPECT_NEAR(made<OpenBox>(s).signed_distance({0, -0.020, 0}, 0), 0.045, 1e-15);
}

// A wall meets its lower edge at 30 degrees from the vertical; between frames it moves on.
TEST(Wedge, ClosesAndOpensEvenly) {
  const Wedge wedge = made<Wedge>();
  EXPECT_EQ(wedge.frame_count(), 121);
  expect_on_surface(wedge, {0, 35, 101, 120}, wedge.cloud(0).size());
  for (const auto& [time_s, gap_m] : {std::pair(0.0, 0.05),
                                      {1, 0.05},
                                      {1.25, 0.0375},
                                      {2, 0},
                                      {2.9, 0},
                                      {3.5, 0.025},
                                      {4, 0.05},
                                      {100, 0.05}}) {
    EXPECT_NEAR(wedge.gap_m(time_s), gap_m, 1e-16) << time_s;
    EXPECT_NEAR(wedge.signed_distance({0, 0.03, 0}, time_s), 0.03 * 0.5 + 0.5 * gap_m * std::sqrt(0.75),
                1e-15);
  }
  EXPECT_NEAR(wedge.signed_distance({0, -0.02, 0}, 2.5), -0.02, 1e-15) << "behind the closed walls";
  EXPECT_TRUE(std::isnan(wedge.signed_distance({0, -0.1, 0.02}, 0))) << "below the gap";
  Wedge::Settings s;
  s.close_end_s = s.close_start_s = 1, s.open_start_s = s.open_end_s = 2;
  const Wedge jumps = made<Wedge>(s);
  for (const auto& [time_s, gap_m] : {std::pair(0.999, 0.05), {1, 0}, {1.999, 0}, {2, 0.05}})
    EXPECT_EQ(jumps.gap_m(time_s), gap_m) << time_s;
}

TEST(Wedge, CanBeShiftedTiltedAndParallel) {
  Wedge::Settings s;
  s.offset_m = 0.01, s.tilt_deg = 20, s.angle_deg = 0, s.closed_gap_m = 0.02;
  const Wedge plates = made<Wedge>(s);
  expect_on_surface(plates, {0, 70}, plates.cloud(0).size());
  const double kPi = std::acos(-1.0);
  const Vec3 up(0, std::cos(kPi / 9), std::sin(kPi / 9)), across(0, -std::sin(kPi / 9), std::cos(kPi / 9));
  const Vec3 middle = Vec3(0, 0, 0.01) + 0.06 * up;
  EXPECT_NEAR(plates.signed_distance(middle, 0), 0.025, 1e-15);
  EXPECT_NEAR(plates.signed_distance(middle + 0.006 * across, 2.5), 0.004, 1e-15);
  EXPECT_NEAR(plates.signed_distance(middle - 0.012 * across, 2.5), -0.002, 1e-15);
}

TEST(SinglePanel, FacesItsNormal) {
  SinglePanel::Settings s;
  s.centre_m = {0.1, 0.2, 0.3};
  for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(-0.5, 0.25, 1)}) {
    s.normal = normal;
    const SinglePanel scene = made<SinglePanel>(s);
    expect_on_surface(scene, {0}, 75u * 75u);
    for (const double height_m : {0.02, -0.02})
      EXPECT_NEAR(scene.signed_distance(s.centre_m + height_m * normal.normalized(), 0), height_m, 1e-15);
  }
}

}  // namespace
}  // namespace remote_touch::panel_scenes_test

namespace remote_touch::plates_test {
namespace {

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
  EXPECT_EQ(plates.frame_count(), 16) << "0.5 s is frame 15";
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

// Plates too near to the camera only hide what is below; between plates there is nothing.
TEST(Plates, SomeRaysMeetNoPlate) {
  Plates::Settings s = passing();
  const PointCloud all = made(s).cloud(9);
  s.max_height_m = 0.04;
  const PointCloud less = made(s).cloud(9);
  int hidden = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(less.is_measured(i), all.y[i] == 0);
    hidden += less.is_measured(i) ? 0 : 1;
  }
  EXPECT_GT(hidden, 200);
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

}  // namespace
}  // namespace remote_touch::plates_test
