// image-press on harsh depth images, and what it shares with image-scan: reports, proposals, closed holes.

#include "runners/experiment/hand/image_motions.h"

#include <gtest/gtest.h>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <random>

#include "tests/runners/experiment/hand/harsh_images.h"
#include "tests/support/test_files.h"

namespace remote_touch::image_press_test {
namespace {

using namespace harsh_images;

TEST(ImagePress, PressesOnSparseDepth) {
  // Other pixels are measured in each frame.
  std::vector<DepthImage> frames;
  for (unsigned seed = 10; seed < 20; ++seed)
    frames.push_back(photographed(mug_before_wall, scattered(0.3, seed)));
  const Views scene(std::move(frames));
  const ImagePress hand({}, scene);
  const Course at = course(
      hand, 0.4, [](double) { return mug_before_wall; }, is_mug);
  EXPECT_LT(at.deepest_m, 0.01 + kEdge_m);
  EXPECT_GT(at.on_object_s, 0.05);  // 5 mm inside after 0.1 s + 35 mm / 0.2 m/s = 0.275 s
  EXPECT_EQ(kinds(hand), Kinds{"holes bridged"});
}

// Frame 9 to 14: fingers come between, each too thin to be touched.
TEST(ImagePress, LiftsInFrontOfWhatComesBetween) {
  const Surface plate_only = [](double x, double y) { return plate(x, y, 0.6, -0.2, 0.2, 0.15); };
  const Surface fingers = [&](double x, double y) {
    const bool is_finger = std::fmod(std::abs(x) * 0.4, 0.012) < 0.006;
    return nearer(is_finger ? plate(x, y, 0.4, -0.1, 0.1, 0.1) : kNaN, plate_only(x, y));
  };
  std::vector<DepthImage> frames;
  for (int frame = 0; frame < 20; ++frame)
    frames.push_back(photographed(frame >= 9 && frame < 15 ? fingers : plate_only, everywhere));
  const Views scene(std::move(frames));
  const ImagePress hand({}, scene);
  const auto surface_at = [&](double t) {
    const double frame = std::floor(t * 30 + 1e-4);
    return frame >= 9 && frame < 15 ? fingers : plate_only;
  };
  const Course at = course(hand, 0.66, surface_at, [](double, double) { return true; });
  EXPECT_LT(at.deepest_m, 0.01 + 1e-6);
  EXPECT_GT(at.on_object_s, 0.1);
  // The fingers are within the margin of the pixel; the hand is a clearance in front of them.
  EXPECT_NEAR(hand.at(0.4).position_W.z(), 0.4 - 0.03, 1e-6);
  EXPECT_TRUE(hand.surface_plan(0.4)->touches);
  EXPECT_FALSE(hand.surface_plan(0.2)->touches) << "30 mm take until 0.25 s";
}

// A flat ring around the axis of the camera, 5 cm wide.
double ring(double x, double y) {
  const double r = std::hypot(0.5 * x, 0.5 * y);
  return r > 0.05 && r < 0.1 ? 0.5 : kNaN;
}

TEST(ImagePress, ChoosesATouchablePixelOnlyWhereNoneIsGiven) {
  const Views scene({photographed(ring, everywhere)});
  ImagePress::Settings s;
  s.row = 240, s.column = 320;
  EXPECT_HAS(refusal([&] { ImagePress(s, scene); }),
             "trajectory.row = 240, column = 320: the first frame has no surface");
  s.column = -1;
  const ImagePress hand(s, scene);
  EXPECT_EQ(hand.row(), 240);
  // The margin of 1 cm is 10 pixels; the ring begins 52.5 pixels from the middle.
  EXPECT_NEAR(std::abs(hand.column() - 319.5), 52.5 + 10 + 1.5, 2.5);
}

// A box at 0.6 m whose pixels join diagonally only, so that no patch of it fills 1 % of the image, and a cube
// of 4 cm that is too small.
double see_through(double x, double y, int u, int v) {
  const bool is_box = std::abs(0.6 * x) < 0.1 && std::abs(0.6 * y) < 0.08 && (u + v) % 3 != 0;
  return is_box ? 0.6 : 1;
}
double small_cube(double x, double y, int, int) {
  return std::abs(0.5 * x) < 0.02 && std::abs(0.5 * y) < 0.02 ? 0.5 : 0.9;
}

DepthImage photographed_by_pixel(double (*depth_m)(double x, double y, int u, int v)) {
  DepthImage image{kCamera.width, kCamera.height, {}};
  for (int v = 0; v < kCamera.height; ++v)
    for (int u = 0; u < kCamera.width; ++u) {
      const Vec3 ray = scenes::ray(kCamera, u, v);
      image.z_m.push_back(depth_m(ray.x(), ray.y(), u, v));
    }
  return image;
}

TEST(ImagePress, NotesThatSomethingNearerIsNotPressed) {
  const Views box({photographed_by_pixel(see_through)});
  const ImagePress on_wall({}, box);
  EXPECT_NEAR(on_wall.at(5).position_W.z(), 1.01, 1e-9) << "the hand presses the wall";
  ASSERT_EQ(kinds(on_wall), Kinds{"object not pressed"});
  EXPECT_HAS(on_wall.notes()[0].text, "is nearer, at 600 mm");
  // 4 cm are 42 pixels: 0.6 % of the image. The hand presses the middle of the wall, beside a cube that is
  // not in the middle.
  const Views cube(
      {photographed_by_pixel([](double x, double y, int u, int v) { return small_cube(x - 0.2, y, u, v); })});
  const ImagePress beside({}, cube);
  EXPECT_NEAR(beside.at(5).position_W.z(), 0.91, 1e-9);
  ASSERT_EQ(kinds(beside), Kinds{"object not pressed"});
  EXPECT_HAS(beside.notes()[0].text, "an object at row 240, column 425 is nearer, at 500 mm");
  const ImageScan scan({}, cube);
  EXPECT_EQ(kinds(scan), Kinds{"object not scanned"});
  EXPECT_HAS(scan.notes()[0].text, "is scanned, but an object at row 240, column 425 is nearer, at 500 mm");
}

// The near part of a tilted table is nearer than its middle, and belongs to what is touched. Single pixels
// that are wrong are no object. A pixel that the user gives is what the user means.
TEST(ImagePress, HasNoNoteIfTheNearestObjectIsPressed) {
  const auto table = [](double, double y) { return 0.8 / (1 + 0.8 * y); };
  const Views alone({photographed(table, everywhere)});
  EXPECT_EQ(kinds(ImagePress({}, alone)), Kinds{});
  EXPECT_EQ(kinds(ImageScan({}, alone)), Kinds{});
  DepthImage flying = photographed(table, everywhere);
  std::mt19937 random(11);
  for (double& z : flying.z_m)
    if (random() % 1000 == 0) z -= 0.2;
  const Views noisy({flying});
  EXPECT_EQ(kinds(ImagePress({.margin_m = 0.003}, noisy)), Kinds{});
  const Views mug({photographed(mug_before_wall, everywhere)});
  EXPECT_EQ(kinds(ImagePress({}, mug)), Kinds{});
  const Views box({photographed_by_pixel(see_through)});
  EXPECT_EQ(kinds(ImagePress({.row = 240, .column = 100}, box)), Kinds{});
}

// A table that rises from the lower edge of the image to the upper one, with a hollow 3 cm deep at its near
// edge and a box at its far edge. The hollow is nearer to the camera than the box.
TEST(ImagePress, AHollowOfTheTableIsNoObject) {
  const auto table = [](double x, double y) {
    const bool is_hollow = y > 0.3 && std::abs(x)<0.3, is_box = y> - 0.3 && y < -0.2 && std::abs(x) < 0.15;
    return is_box ? 0.85 : 0.8 / (1 + 0.8 * y) + (is_hollow ? 0.03 : 0);
  };
  const Views scene({photographed(table, everywhere)});
  EXPECT_NEAR(ImagePress({}, scene).at(5).position_W.z(), 0.86, 1e-9) << "the hand presses the box";
  EXPECT_HAS(ImageScan({}, scene).aim(), "at depth 0.850 to 0.850 m");
}

// A ring before a wall: in the given row of its middle the ring is touched, in a row above it the wall.
TEST(ImagePress, NotesThatTheObjectHasNoPixelInTheGivenRow) {
  const Surface ring = [](double x, double y) {
    const double r = std::hypot(0.5 * x, 0.5 * y);
    return nearer(r > 0.05 && r < 0.1 ? 0.5 : kNaN, wall(0.75));
  };
  const Views scene({photographed(ring, everywhere)});
  EXPECT_EQ(kinds(ImagePress({.row = 240}, scene)), Kinds{});
  const ImagePress above({.row = 60}, scene);
  EXPECT_NEAR(above.at(5).position_W.z(), 0.76, 1e-9);
  ASSERT_EQ(kinds(above), Kinds{"object not pressed"});
  EXPECT_HAS(above.notes()[0].text, "row 60, column 3");
}

// Columns of the plates, from their edges: (0.02, 0.12) m at 0.5 m are columns 340.5 to 445.5, and 1 cm is 10
// pixels. Each pixel of the square is compared with the one to its left.
TEST(ImageTrajectories, ReportWhichPixelsTheyFollow) {
  const Surface plates = [](double x, double y) {
    return nearer(plate(x, y, 0.5, -0.12, -0.02, 0.1), plate(x, y, 0.6, 0.024, 0.144, 0.1));
  };
  const Views scene({photographed(plates, everywhere)});
  ImageScan::Settings s;
  s.row = 240;
  EXPECT_EQ(
      ImageScan(s, scene).aim(),
      "image-scan, row 240, columns 205 to 288 at depth 0.500 to 0.500 m, columns 350 to 437 at depth 0.600 "
      "to 0.600 m");
  EXPECT_EQ(ImagePress({.row = 240, .column = 250}, scene).aim(),
            "image-press, row 240, column 250 at depth 0.500 m");
  const ImagePress chosen({}, scene);
  EXPECT_HAS(chosen.aim(),
             "row " + std::to_string(chosen.row()) + ", column " + std::to_string(chosen.column()));
}

// Both proposals of the message can be used: the pixel, and -1 for both.
TEST(ImagePress, ProposesAPixelThatCanBeTouched) {
  const Views scene({photographed(ring, everywhere)});
  ImagePress::Settings s;
  s.row = 240, s.column = 320;
  const std::string message = refusal([&] { ImagePress(s, scene); });
  EXPECT_HAS(message,
             "expected -1 for both (the nearest object), the nearest pixel that can be touched, row ");
  const char* const found = std::strstr(message.c_str(), "touched, row ");
  ASSERT_NE(found, nullptr);
  ASSERT_EQ(std::sscanf(found, "touched, row %d, column %d", &s.row, &s.column), 2);
  EXPECT_EQ(refusal([&] { ImagePress(s, scene); }), "no InputError");
  EXPECT_EQ(refusal([&] { ImagePress({}, scene); }), "no InputError");
  s.margin_m = 0.04, s.row = 240, s.column = 320;  // the ring is 5 cm wide
  EXPECT_HAS(refusal([&] { ImagePress(s, scene); }), "expected a smaller margin_m or a larger bridge_m");
  ImageScan::Settings scan;
  scan.row = 10;
  EXPECT_HAS(refusal([&] { ImageScan(scan, scene); }), "expected -1 (the nearest object: row ");
}

// bridged() compared with a plain search over all measured pixels for each hole.
TEST(Bridging, ClosesHolesUpToTheLimit) {
  std::mt19937 random(7);
  for (const double p : {0.02, 0.3, 0.9}) {
    DepthImage image{50, 40, {}};
    for (int i = 0; i < 50 * 40; ++i)
      image.z_m.push_back(random() < p * 4294967296.0 ? 0.3 + 0.1 * (random() % 4) : kNaN);
    // Reaches of 6.8, 5.1, 4.08 and 3.4 pixels along a row, half as many along a column: no distance is
    // equal.
    const double focal = 510, hole = 0.008;
    const DepthImage closed = bridged(image, {.fx = focal, .fy = focal / 2}, hole);
    int filled = 0;
    for (int v = 0; v < 40; ++v)
      for (int u = 0; u < 50; ++u) {
        const auto at = [&](const DepthImage& i, int x, int y) {
          return i.z_m[static_cast<std::size_t>(y * 50 + x)];
        };
        const double got = at(closed, u, v);
        if (std::isfinite(at(image, u, v))) {
          ASSERT_EQ(got, at(image, u, v));
          continue;
        }
        double best = kNaN, least = 1e9;
        for (int y = 0; y < 40; ++y)
          for (int x = 0; x < 50; ++x) {
            const double z = at(image, x, y), d = std::hypot(x - u, 2 * (y - v));
            bool is_rim = false;
            for (int b = std::max(0, y - 1); b <= std::min(39, y + 1); ++b)
              for (int a = std::max(0, x - 1); a <= std::min(49, x + 1); ++a)
                is_rim = is_rim || std::isnan(at(image, a, b));
            if (!is_rim || !(d * z / focal <= hole / 2)) continue;
            if (d < least || (d == least && z < best)) least = d, best = z;
          }
        ASSERT_TRUE(got == best || (std::isnan(got) && std::isnan(best))) << u << " " << v << ": " << got;
        filled += std::isfinite(best);
      }
    EXPECT_GT(filled, 100);
  }
}

}  // namespace
}  // namespace remote_touch::image_press_test

// image-scan on harsh depth images.
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
