// image-scan on harsh depth images.
#include "runners/experiment/hand/image_scan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/runners/experiment/hand/harsh_images.h"
#include "tests/support/test_files.h"

namespace remote_touch::image_scan_test {
namespace {

using namespace harsh_images;

// The mug is 8 cm wide; its outer parts are too steep, and 1 cm at each side is the margin.
constexpr double kMugSeconds = 0.3;  // 3 cm at 0.1 m/s

TEST(ImageScan, ScansAMugOfDenseDepth) {
  const Views scene({photographed(mug_before_wall, everywhere)});
  const ImageScan hand({}, scene);
  const Course at = course(hand, mug_before_wall, is_mug);
  EXPECT_LT(at.deepest_m, 0.01 + kEdge_m);
  EXPECT_GT(at.on_object_s, kMugSeconds);
  EXPECT_EQ(kinds(hand), Kinds{});
}

// 30 % of the pixels, as in depth that was warped to a colour camera of more pixels. A disc of 8 mm at 0.5 m
// has 55 pixels: it is empty with a probability of 3e-9. Steep parts differ more from pixel to measured
// pixel, so less of the mug is a surface.
TEST(ImageScan, ScansAMugOfSparseDepth) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const Views scene({photographed(mug_before_wall, scattered(0.3, seed))});
    const ImageScan hand({}, scene);
    const Course at = course(hand, mug_before_wall, is_mug);
    EXPECT_LT(at.deepest_m, 0.01 + kEdge_m);
    EXPECT_GT(at.on_object_s, kMugSeconds / 2);
    EXPECT_EQ(kinds(hand), Kinds{"holes bridged"});
    EXPECT_HAS(hand.notes()[0].text, "bridge_m = 8 mm");
  }
}

// The wall is dense, the mug is not: the wall alone has no object, and a hand that follows it is behind the
// mug.
TEST(ImageScan, ScansASparseMugBeforeADenseWall) {
  const Mask some = scattered(0.4, 4);
  const Views scene({photographed(mug_before_wall, [&](int u, int v) {
    const Vec3 ray = scenes::ray(kCamera, u, v);
    return !is_mug(ray.x(), ray.y()) || some(u, v);
  })});
  const ImageScan hand({}, scene);
  const Course at = course(hand, mug_before_wall, is_mug);
  EXPECT_LT(at.deepest_m, 0.01 + kEdge_m);
  EXPECT_GT(at.on_object_s, kMugSeconds / 2);
}

// 5 % of the mug's pixels: it cannot be touched, but it is there. The hand may only follow the wall beside
// it.
TEST(ImageScan, FliesInFrontOfWhatItCannotTouch) {
  const Mask few = scattered(0.05, 5);
  const Views scene({photographed(mug_before_wall, [&](int u, int v) {
    const Vec3 ray = scenes::ray(kCamera, u, v);
    return !is_mug(ray.x(), ray.y()) || few(u, v);
  })});
  const ImageScan hand({}, scene);
  const Course at = course(hand, mug_before_wall, is_mug);
  EXPECT_LT(at.deepest_m, 0.01 + kEdge_m);
  EXPECT_EQ(at.on_object_s, 0);
}

// Columns at 0.5 m are 0.95 mm apart: gaps of 5 columns are narrower than 8 mm, gaps of 11 are wider.
TEST(ImageScan, BridgesStripesUpToTheLimit) {
  const auto striped = [](int every) {
    return Views({photographed(mug, [=](int u, int) { return u % every == 0; })});
  };
  const Views narrow = striped(6), wide = striped(12);
  const ImageScan hand({}, narrow);
  const Course at = course(hand, mug, is_mug);
  EXPECT_LT(at.deepest_m, 0.01 + kEdge_m);
  EXPECT_GT(at.on_object_s, kMugSeconds / 2);  // steep parts differ more from stripe to stripe
  EXPECT_HAS(refusal([&] { ImageScan({}, wide); }), "holes above 8 mm");
  ImageScan::Settings none;
  none.bridge_m = 0;
  EXPECT_HAS(refusal([&] { ImageScan(none, narrow); }), "no surface that can be touched in this row");
}

// A plate with a hole of 4 cm in its middle, with nothing or a far wall behind it.
TEST(ImageScan, FliesOverAHoleInTheMiddle) {
  for (const double behind : {kNaN, 1.5}) {
    const auto in_hole = [](double x, double y) { return std::hypot(0.5 * x, 0.5 * y) < 0.02; };
    const Surface holed = [&](double x, double y) {
      return in_hole(x, y) ? behind : nearer(plate(x, y, 0.5, -0.12, 0.12, 0.1), behind);
    };
    const Views scene({photographed(holed, everywhere)});
    const ImageScan hand({}, scene);
    const Course at = course(hand, holed, [&](double x, double y) { return !in_hole(x, y); });
    EXPECT_LT(at.deepest_m, 0.01 + 1e-6);
    EXPECT_LT(at.farthest_m, 0.51 + 1e-6) << "the wall is beyond span_m";
    EXPECT_GT(at.on_object_s, 1.2);  // 2 x 8 cm at 0.1 m/s at least
    double nearest_over_hole = 1e9, farthest_over_hole = 0;
    for (double t = 0; t < hand.duration_s(); t += 0.001) {
      const Vec3 p = hand.at(t).position_W;
      if (!in_hole(p.x() / p.z(), p.y() / p.z())) continue;
      nearest_over_hole = std::min(nearest_over_hole, p.z());
      farthest_over_hole = std::max(farthest_over_hole, p.z());
    }
    EXPECT_NEAR(nearest_over_hole, 0.47, 1e-6);
    EXPECT_NEAR(farthest_over_hole, 0.47, 1e-6);
  }
}

// Two plates, and between them a pen that is nearer but too thin to be touched.
TEST(ImageScan, PassesAThinObjectInFront) {
  const auto is_pen = [](double x, double) { return std::abs(0.42 * x) < 0.003; };
  const Surface scene_surface = [&](double x, double y) {
    const double pen = is_pen(x, y) ? plate(x, y, 0.42, -1, 1, 0.1) : kNaN;
    return nearer(pen, nearer(plate(x, y, 0.5, -0.12, -0.02, 0.1), plate(x, y, 0.5, 0.02, 0.12, 0.1)));
  };
  const Views scene({photographed(scene_surface, everywhere)});
  ImageScan::Settings s;
  s.row = 240;
  const ImageScan hand(s, scene);
  const Course at = course(hand, scene_surface, [&](double x, double y) { return !is_pen(x, y); });
  EXPECT_LT(at.deepest_m, 0.01 + 1e-6);
  EXPECT_GT(at.on_object_s, 1.2);
  double before_pen = 0;  // the largest depth of the hand where it passes
  for (double t = 0; t < hand.duration_s(); t += 0.001) {
    const Vec3 p = hand.at(t).position_W;
    if (is_pen(p.x() / p.z(), 0)) before_pen = std::max(before_pen, p.z());
  }
  EXPECT_NEAR(before_pen, 0.42 - 0.03, 1e-6) << "a clearance in front of it";
}

// A hollow object: nothing lies at the medians of the rows and of the columns of its pixels.
TEST(ImageScan, ScansAnObjectThatIsHollow) {
  const Surface ring = [](double x, double y) {
    const double r = std::hypot(0.5 * x, 0.5 * y);
    return nearer(r > 0.05 && r < 0.1 ? 0.5 : kNaN, wall(0.75));
  };
  const auto is_ring = [&](double x, double y) { return ring(x, y) < 0.6; };
  const Views scene({photographed(ring, everywhere)});
  const ImageScan scan({}, scene);
  const Course at = course(scan, ring, is_ring);
  EXPECT_LT(at.deepest_m, 0.01 + 1e-6);
  EXPECT_GT(at.on_object_s, 0.4);  // 2 x 3 cm
  const ImagePress press({}, scene);
  const Course pressed = course(
      press, 1, [&](double) { return ring; }, is_ring);
  EXPECT_NEAR(pressed.deepest_m, 0.01, 1e-6);
  EXPECT_GT(pressed.on_object_s, 0.6);
}

TEST(ImageScan, RefusesAClearanceBehindTheCamera) {
  const Views scene({photographed(mug_before_wall, everywhere)});
  ImageScan::Settings scan;
  scan.clearance_m = 0.6;
  EXPECT_HAS(refusal([&] { ImageScan(scan, scene); }), "behind the camera");
  ImagePress::Settings press;
  press.depth_m = -0.6;
  EXPECT_HAS(refusal([&] { ImagePress(press, scene); }), "behind the camera");
}

}  // namespace
}  // namespace remote_touch::image_scan_test
