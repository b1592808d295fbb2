// Hands that are planned on depth images, image-press and image-scan, on harsh images: sparse, with holes,
// with objects that move. The oracle is the analytic surface of each scene along the hand's viewing ray,
// never the image.
#include "runners/experiment/hand/image_motions.h"

#include <gtest/gtest.h>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "tests/support/depth_scenes.h"
#include "tests/support/note_kinds.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::image_motions_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kEdge_m = 0.006;  // default of edge_jump_m

// Depth that is seen along the ray (x, y, 1); NaN: nothing.
using Surface = std::function<double(double x, double y)>;
// True for a pixel that is measured.
using Mask = std::function<bool(int u, int v)>;

const CameraIntrinsics kCamera = scenes::kinect();

bool everywhere(int, int) {
  return true;
}

DepthImage photographed(const Surface& surface, const Mask& is_measured = everywhere) {
  DepthImage image{kCamera.width, kCamera.height, {}};
  for (int v = 0; v < kCamera.height; ++v)
    for (int u = 0; u < kCamera.width; ++u) {
      const Vec3 ray = scenes::ray(kCamera, u, v);
      image.z_m.push_back(is_measured(u, v) ? surface(ray.x(), ray.y()) : kNaN);
    }
  return image;
}

class Views final : public Scenario {
 public:
  explicit Views(std::vector<DepthImage> frames) : frames_(std::move(frames)) {}
  explicit Views(const Surface& surface, const Mask& is_measured = everywhere)
      : Views(std::vector{photographed(surface, is_measured)}) {}
  double frame_rate_hz() const override { return 30; }
  int frame_count() const override { return static_cast<int>(frames_.size()); }
  PointCloud cloud(int frame) const override {
    const int last = frame_count() - 1;
    return cloud_from_depth(frames_[static_cast<std::size_t>(std::min(frame, last))], kCamera,
                            RigidTransform::Identity());
  }
  double signed_distance(const Vec3&, double) const override { return kNaN; }

 private:
  const std::vector<DepthImage> frames_;
};

// Each pixel is measured with probability p, the same pixels each time.
Mask scattered(double p, unsigned seed) {
  auto measured = std::make_shared<std::vector<bool>>();
  std::mt19937 random(seed);
  for (int i = 0; i < kCamera.width * kCamera.height; ++i) measured->push_back(random() < p * 4294967296.0);
  return [measured](int u, int v) { return (*measured)[static_cast<std::size_t>(v * kCamera.width + u)]; };
}

// An upright cylinder in front of the camera: radius 4 cm, height 10 cm, front at 0.5 m.
double mug(double x, double y) {
  const double radius = 0.04, centre = 0.54, a = x * x + 1;
  const double root = centre * centre - a * (centre * centre - radius * radius);
  const double z = (centre - std::sqrt(root)) / a;  // x^2 z^2 + (z - c)^2 = r^2
  return std::abs(z * y) <= 0.05 ? z : kNaN;        // NaN too where the root is of a negative number
}

double nearer(double a, double b) {
  return std::isnan(a) || b < a ? b : a;
}

double mug_before_wall(double x, double y) {
  return nearer(mug(x, y), 0.7);
}

// A plate that fills a rectangle, at one depth.
double plate(double x, double y, double z, double x_from, double x_to, double y_half) {
  return z * x >= x_from && z * x <= x_to && std::abs(z * y) <= y_half ? z : kNaN;
}

struct Course {
  double deepest_m = -1e9;   // farthest behind the surface
  double on_object_s = 0;    // time spent 5 mm or more inside the object of is_object()
  double farthest_m = -1e9;  // largest depth of the hand
};

// Follows the path in steps of 1 ms.
Course course(const Trajectory& hand, double duration_s, const std::function<Surface(double)>& surface_at,
              const std::function<bool(double, double)>& is_object) {
  Course course;
  for (double t = 0; t < duration_s; t += 0.001) {
    const Vec3 p = hand.at(t).position_W;
    const double x = p.x() / p.z(), y = p.y() / p.z(), behind = p.z() - surface_at(t)(x, y);
    if (behind > course.deepest_m) course.deepest_m = behind;  // false if nothing is seen there
    if (behind > 0.005 && is_object(x, y)) course.on_object_s += 0.001;
    course.farthest_m = std::max(course.farthest_m, p.z());
  }
  return course;
}

Course course(const ImageScan& hand, const Surface& surface,
              const std::function<bool(double, double)>& is_object) {
  return course(
      hand, hand.duration_s() + 0.1, [&](double) { return surface; }, is_object);
}

bool is_mug(double x, double y) {
  return std::isfinite(mug(x, y));
}

Kinds kinds(const Trajectory& hand) {
  return kinds_of(hand.notes());
}

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
    frames.push_back(photographed(frame >= 9 && frame < 15 ? fingers : plate_only));
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

// The ring before a wall: nothing lies at the medians of the rows and of the columns of its pixels.
double ring_before_wall(double x, double y) {
  return nearer(ring(x, y), 0.75);
}

// Both proposals of the message can be used: the pixel, and -1 for both.
TEST(ImagePress, ProposesAPixelThatCanBeTouched) {
  const Views scene(ring);
  ImagePress::Settings s;
  s.row = 240, s.column = 320;
  const std::string message = refusal([&] { ImagePress(s, scene); });
  EXPECT_HAS(message, "trajectory.row = 240, column = 320: the first frame has no surface");
  EXPECT_HAS(message,
             "expected -1 for both (the nearest object), the nearest pixel that can be touched, row ");
  const char* const found = std::strstr(message.c_str(), "touched, row ");
  ASSERT_NE(found, nullptr);
  ASSERT_EQ(std::sscanf(found, "touched, row %d, column %d", &s.row, &s.column), 2);
  EXPECT_EQ(refusal([&] { ImagePress(s, scene); }), "no InputError");
  EXPECT_EQ(refusal([&] { ImagePress({}, scene); }), "no InputError");
  const ImagePress in_row({.row = 240}, scene);
  EXPECT_EQ(in_row.row(), 240);
  // The margin of 1 cm is 10 pixels; the ring begins 52.5 pixels from the middle.
  EXPECT_NEAR(std::abs(in_row.column() - 319.5), 52.5 + 10 + 1.5, 2.5);
  s.margin_m = 0.04, s.row = 240, s.column = 320;  // the ring is 5 cm wide
  EXPECT_HAS(refusal([&] { ImagePress(s, scene); }), "expected a smaller margin_m or a larger bridge_m");
  ImageScan::Settings scan;
  scan.row = 10;
  EXPECT_HAS(refusal([&] { ImageScan(scan, scene); }), "expected -1 (the nearest object: row ");
}

// A box at 0.6 m before a wall at 1 m. Its pixels join diagonally only, so that no patch of it fills 1 % of
// the image.
DepthImage see_through_box() {
  DepthImage image =
      photographed([](double x, double y) { return nearer(plate(x, y, 0.6, -0.1, 0.1, 0.08), 1); });
  for (int v = 0; v < image.height; ++v)
    for (int u = 0; u < image.width; ++u)
      if ((u + v) % 3 == 0) image.z_m[static_cast<std::size_t>(v * image.width + u)] = 1;
  return image;
}

TEST(ImagePress, NotesThatSomethingNearerIsNotPressed) {
  const Views box({see_through_box()});
  const ImagePress on_wall({}, box);
  EXPECT_NEAR(on_wall.at(5).position_W.z(), 1.01, 1e-9) << "the hand presses the wall";
  ASSERT_EQ(kinds(on_wall), Kinds{"object not pressed"});
  EXPECT_HAS(on_wall.notes()[0].text, "is nearer, at 600 mm");
  // A cube of 4 cm, 42 pixels: 0.6 % of the image. The hand presses the middle of the wall, beside a cube
  // that is not in the middle.
  const Views cube([](double x, double y) { return nearer(plate(x, y, 0.5, 0.08, 0.12, 0.02), 0.9); });
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
  const Views alone(table);
  EXPECT_EQ(kinds(ImagePress({}, alone)), Kinds{});
  EXPECT_EQ(kinds(ImageScan({}, alone)), Kinds{});
  DepthImage flying = photographed(table);
  std::mt19937 random(11);
  for (double& z : flying.z_m)
    if (random() % 1000 == 0) z -= 0.2;
  const Views noisy({flying});
  EXPECT_EQ(kinds(ImagePress({.margin_m = 0.003}, noisy)), Kinds{});
  const Views mug(mug_before_wall);
  EXPECT_EQ(kinds(ImagePress({}, mug)), Kinds{});
  const Views box({see_through_box()});
  EXPECT_EQ(kinds(ImagePress({.row = 240, .column = 100}, box)), Kinds{});
}

// A table that rises from the lower edge of the image to the upper one, with a hollow 3 cm deep at its near
// edge and a box at its far edge. The hollow is nearer to the camera than the box.
TEST(ImagePress, AHollowOfTheTableIsNoObject) {
  const auto table = [](double x, double y) {
    const bool is_hollow = y > 0.3 && std::abs(x)<0.3, is_box = y> - 0.3 && y < -0.2 && std::abs(x) < 0.15;
    return is_box ? 0.85 : 0.8 / (1 + 0.8 * y) + (is_hollow ? 0.03 : 0);
  };
  const Views scene(table);
  EXPECT_NEAR(ImagePress({}, scene).at(5).position_W.z(), 0.86, 1e-9) << "the hand presses the box";
  EXPECT_HAS(ImageScan({}, scene).aim(), "at depth 0.850 to 0.850 m");
}

// The ring is touched in the row of its middle, the wall in a row above it.
TEST(ImagePress, NotesThatTheObjectHasNoPixelInTheGivenRow) {
  const Views scene(ring_before_wall);
  EXPECT_EQ(kinds(ImagePress({.row = 240}, scene)), Kinds{});
  const ImagePress above({.row = 60}, scene);
  EXPECT_NEAR(above.at(5).position_W.z(), 0.76, 1e-9);
  ASSERT_EQ(kinds(above), Kinds{"object not pressed"});
  EXPECT_HAS(above.notes()[0].text, "row 60, column 3");
}

// --- image-scan ---

// The mug is 8 cm wide; its outer parts are too steep, and 1 cm at each side is the margin.
constexpr double kMugSeconds = 0.3;  // 3 cm at 0.1 m/s

// The whole scene, or the mug before a dense wall, is measured in some of its pixels. With 30 % of the
// pixels, as in depth that was warped to a colour camera of more pixels, a disc of 8 mm at 0.5 m has 55
// pixels: it is empty with a probability of 3e-9. Steep parts differ more from pixel to measured pixel, so
// less of the mug is a surface. With 5 % it cannot be touched, but it is there: the hand may only follow the
// wall beside it.
TEST(ImageScan, ScansAMugAsFarAsItIsASurface) {
  const auto of_mug = [](Mask some) -> Mask {
    return [=](int u, int v) {
      const Vec3 ray = scenes::ray(kCamera, u, v);
      return !is_mug(ray.x(), ray.y()) || some(u, v);
    };
  };
  const struct {
    const char* what;
    Mask is_measured;
    double touched_s;
    std::optional<Kinds> notes;
  } rows[] = {{"dense", everywhere, kMugSeconds, Kinds{}},
              {"sparse, seed 1", scattered(0.3, 1), kMugSeconds / 2, Kinds{"holes bridged"}},
              {"sparse, seed 2", scattered(0.3, 2), kMugSeconds / 2, Kinds{"holes bridged"}},
              {"sparse, seed 3", scattered(0.3, 3), kMugSeconds / 2, Kinds{"holes bridged"}},
              {"a sparse mug", of_mug(scattered(0.4, 4)), kMugSeconds / 2, {}},
              {"hardly any mug", of_mug(scattered(0.05, 5)), 0, {}}};
  for (const auto& row : rows) {
    SCOPED_TRACE(row.what);
    const Views scene(mug_before_wall, row.is_measured);
    const ImageScan hand({}, scene);
    const Course at = course(hand, mug_before_wall, is_mug);
    EXPECT_LT(at.deepest_m, 0.01 + kEdge_m);
    if (row.touched_s > 0) {
      EXPECT_GT(at.on_object_s, row.touched_s);
    } else {
      EXPECT_EQ(at.on_object_s, 0);
    }
    if (row.notes) {
      EXPECT_EQ(kinds(hand), *row.notes);
    }
  }
}

// Columns at 0.5 m are 0.95 mm apart: gaps of 5 columns are narrower than 8 mm, gaps of 11 are wider.
TEST(ImageScan, BridgesStripesUpToTheLimit) {
  const auto striped = [](int every) { return Views(mug, [=](int u, int) { return u % every == 0; }); };
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
    const Views scene(holed);
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

TEST(ImageScan, ScansAnObjectThatIsHollow) {
  const auto is_ring = [](double x, double y) { return std::isfinite(ring(x, y)); };
  const Views scene(ring_before_wall);
  const ImageScan scan({}, scene);
  const Course at = course(scan, ring_before_wall, is_ring);
  EXPECT_LT(at.deepest_m, 0.01 + 1e-6);
  EXPECT_GT(at.on_object_s, 0.4);  // 2 x 3 cm
}

TEST(ImageScan, RefusesAClearanceBehindTheCamera) {
  const Views scene(mug_before_wall);
  ImageScan::Settings scan;
  scan.clearance_m = 0.6;
  EXPECT_HAS(refusal([&] { ImageScan(scan, scene); }), "behind the camera");
  ImagePress::Settings press;
  press.depth_m = -0.6;
  EXPECT_HAS(refusal([&] { ImagePress(press, scene); }), "behind the camera");
}

}  // namespace
}  // namespace remote_touch::image_motions_test
