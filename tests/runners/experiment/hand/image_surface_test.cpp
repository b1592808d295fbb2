// The surface that a hand may touch in a depth image: frames that do not fit the first one, the pixels that a
// device can touch, and closed holes.
#include "runners/experiment/hand/image_motions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "tests/support/test_files.h"

namespace remote_touch::image_surface_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr CameraIntrinsics kCamera{100, 80, 100, 100, 49.5, 39.5};

// A plane at a depth, as the camera sees it from X_WC.
PointCloud plane(double depth_m, const CameraIntrinsics& camera = kCamera,
                 const RigidTransform& X_WC = RigidTransform::Identity()) {
  const auto pixels = camera.pixels();
  return cloud_from_depth({camera.width, camera.height, std::vector<double>(pixels, depth_m)}, camera, X_WC);
}

PointCloud without_image(PointCloud cloud) {
  cloud.image.reset();
  return cloud;
}

class Frames final : public Scenario {
 public:
  explicit Frames(std::vector<PointCloud> frames, std::string input = "")
      : frames_(std::move(frames)), input_(std::move(input)) {}
  std::string input() const override { return input_; }
  double frame_rate_hz() const override { return 10; }
  int frame_count() const override { return static_cast<int>(frames_.size()); }
  PointCloud cloud(int frame) const override { return frames_[static_cast<std::size_t>(frame)]; }
  double signed_distance(const Vec3&, double) const override { return kNaN; }

 private:
  const std::vector<PointCloud> frames_;
  const std::string input_;
};

constexpr double kInFirst_s = 0.05, kInSecond_s = 0.15;

std::string refusal_of_second(PointCloud second) {
  const Frames scene({plane(0.5), std::move(second)});
  const ImagePress hand({.row = 40, .column = 50}, scene);
  hand.at(kInFirst_s);
  return refusal([&] { hand.at(kInSecond_s); });
}

PointCloud cut(PointCloud cloud) {
  cloud.x.resize(3000), cloud.y.resize(3000), cloud.z.resize(3000);
  return cloud;
}

// The ray of the last column moves by 2.5 pixels with f = 105; one pixel is allowed for the fit of a camera.
TEST(ImageFrames, RefusesAFrameOfAnotherSizeOrCamera) {
  const CameraIntrinsics half{50, 40, 50, 50, 24.5, 19.5}, turned{80, 100, 100, 100, 39.5, 49.5};
  CameraIntrinsics longer = kCamera, shifted = kCamera, fitted = kCamera;
  longer.fx = 105, shifted.cy += 1.1, fitted.cx += 0.5, fitted.fx = 100.5;
  const std::pair<PointCloud, const char*> rows[] = {
      {plane(0.5, half),
       "trajectory.name = image-press: frame 1 has 50 x 40 pixels: expected 100 x 80 pixels, as frame 0 has"},
      {plane(0.5, turned), "frame 1 has 80 x 100 pixels"},
      {without_image(plane(0.5, half)), "frame 1 has 2000 points"},
      {cut(plane(0.5)), "frame 1 has 3000 points"},  // fewer points than its layout promises
      {plane(0.5, longer),
       "frame 1 has another camera (f = 105, 100, c = 49.5, 39.5): expected that of frame 0 (f = 100, 100"},
      {plane(0.5, shifted), "frame 1 has another camera"},
      {plane(0.5, fitted), "no InputError"},
      {without_image(plane(0.5, longer)), "frame 1 is not an image"}};
  for (const auto& [second, expected] : rows) EXPECT_HAS(refusal_of_second(second), expected);
}

// Few points may not suffice to fit a camera to a frame of a PCD recording. Their positions show that they
// lie on the rays.
TEST(ImageFrames, AcceptsPointsOnTheRaysOfTheFirstFrame) {
  EXPECT_EQ(refusal_of_second(without_image(plane(0.6))), "no InputError");
  const Frames scene({plane(0.5), without_image(plane(0.6))});
  const ImagePress hand({.row = 40, .column = 50, .press_at_s = 10}, scene);
  EXPECT_NEAR(hand.at(kInSecond_s).position_W.z(), 0.6 - 0.03, 1e-12);
}

// The hand waits in front of the surface of the last frame.
TEST(ImageFrames, AFrameWithoutPointsIsAnImageOfHoles) {
  for (const PointCloud& nothing : {PointCloud{}, without_image(plane(kNaN)), plane(kNaN)}) {
    const Frames scene({plane(0.5), nothing});
    const ImagePress hand({.row = 40, .column = 50, .press_at_s = 0, .approach_m_per_s = 10}, scene);
    EXPECT_NEAR(hand.at(kInFirst_s).position_W.z(), 0.51, 1e-12);
    EXPECT_NEAR(hand.at(kInSecond_s).position_W.z(), 0.47, 1e-12);
  }
}

// A camera that is carried along faces the ray of the pixel from its new position.
TEST(ImageFrames, TheCameraMayMove) {
  RigidTransform X_WC = RigidTransform::Identity();
  X_WC.linear() << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  X_WC.translation() = Vec3(1, 2, 3);
  const Frames scene({plane(0.5), plane(0.6, kCamera, X_WC)});
  const ImagePress hand({.row = 20, .column = 70, .press_at_s = 10}, scene);
  const Vec3 expected_W = X_WC * (0.57 * Vec3((70 - 49.5) / 100, (20 - 39.5) / 100, 1));
  EXPECT_LT((hand.at(kInSecond_s).position_W - expected_W).norm(), 1e-12);
}

// A camera on a path, or a scene beyond the range of the sensor, may see nothing. Rows and columns alone are
// no image: an organised cloud of a PCD file may be mirrored. A simulated scene with rows and columns, such
// as moving-lift, reads no file.
TEST(ImageFrames, RefusesAFirstFrameThatIsNoImageOrShowsNothing) {
  EXPECT_EQ(refusal([&] {
              ImagePress({}, Frames({plane(kNaN), plane(0.5)}));
            }),
            "trajectory.name = image-press: no pixel of the first frame has a depth: expected a camera that "
            "sees a surface");
  const PointCloud list = without_image(plane(0.5));
  PointCloud organised = list;
  organised.grid_columns = kCamera.width;
  const char* const no_camera =
      "x: the scene has no camera: expected a scenario with one (recording, mesh-scene, camera-scene, "
      "beating-heart, valve-tank)";
  const struct {
    PointCloud cloud;
    const char *input, *expected;
  } rows[] = {{list, "read a.pcd", "x: the frames are not images: expected a recording with a camera"},
              {organised, "read a.pcd",
               "x: the rows and columns of the recording are no image of a camera: expected clouds in the "
               "frame of the camera that are not mirrored"},
              {list, "", no_camera},
              {organised, "", no_camera},
              {cut(plane(0.5)), "", "x: frame 0 has 3000 points: expected 100 x 80 pixels"}};
  for (const auto& row : rows)
    EXPECT_HAS(refusal([&] { first_image(Frames({row.cloud}, row.input), "x"); }), row.expected);
}

// --- pixels at which a device can touch, compared with plain loops over all pixels ---

constexpr double kFocal_px = 250;
const CameraIntrinsics kSquare{.fx = kFocal_px, .fy = kFocal_px};
const CameraIntrinsics kUnequal{.fx = kFocal_px, .fy = kFocal_px / 2};

std::size_t pixel(const DepthImage& image, int u, int v) {
  return static_cast<std::size_t>(v) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(u);
}

// Uneven by less than 4 mm, with a step of 1 cm at column 24 and a hole.
DepthImage uneven(double z_m) {
  DepthImage image{40, 31, std::vector<double>(40 * 31)};
  for (int v = 0; v < image.height; ++v)
    for (int u = 0; u < image.width; ++u)
      image.z_m[pixel(image, u, v)] = z_m + 5e-4 * ((7 * u + 3 * v) % 8) + (u < 24 ? 0 : 0.01);
  image.z_m[pixel(image, 9, 15)] = kNaN;
  return image;
}

// Median of the depths of the rectangle. NaN unless every pixel of it is joined to those to its left and
// above it.
double plain_depth(const DepthImage& image, int u, int v, int across, int down, double edge_jump_m) {
  const auto at = [&](int x, int y) {
    const bool is_inside = x >= 0 && y >= 0 && x < image.width && y < image.height;
    return is_inside ? image.z_m[pixel(image, x, y)] : kNaN;
  };
  std::vector<double> seen;
  for (int y = v - down; y <= v + down; ++y)
    for (int x = u - across; x <= u + across; ++x) {
      const bool is_joined = std::abs(at(x, y) - at(x - 1, y)) <= edge_jump_m &&
                             std::abs(at(x, y) - at(x, y - 1)) <= edge_jump_m;
      if (!is_joined) return kNaN;
      seen.push_back(at(x, y));
    }
  std::sort(seen.begin(), seen.end());
  return seen[seen.size() / 2];
}

// 1 cm is 6 pixels across and 3 down at 0.4 m, 2 and 1 at 1 m, and less than one, which counts as one, at
// 5 m. If any jump is allowed, a pixel that is read outside the image is no edge, so no pixel outside may be
// read.
TEST(SurfaceSupport, IsTheMedianOfASquareWithoutHolesEdgesAndBorders) {
  const struct {
    double z_m;
    int across, down;
  } cases[] = {{0.4, 6, 3}, {1, 2, 1}, {5, 1, 1}};
  for (const auto& c : cases)
    for (const double edge_jump_m : {0.006, std::numeric_limits<double>::infinity()}) {
      const DepthImage image = uneven(c.z_m);
      int supported = 0;
      for (int v = 0; v < image.height; ++v)
        for (int u = 0; u < image.width; ++u) {
          const double got = supported_depth(image, u, v, kUnequal, {edge_jump_m, 0.01});
          const double expected = plain_depth(image, u, v, c.across, c.down, edge_jump_m);
          EXPECT_TRUE(got == expected || (std::isnan(got) && std::isnan(expected)))
              << got << " instead of " << expected << " at " << u << ", " << v << ", " << c.z_m << " m";
          supported += std::isfinite(expected);
        }
      EXPECT_GT(supported, 100);
    }
}

// The image is followed by rows that are not its own.
TEST(SurfaceSupport, HasNoDepthOutsideTheImageAndAtTheLens) {
  DepthImage image{9, 9, std::vector<double>(9 * 12, 1.0)};
  EXPECT_EQ(supported_depth(image, 4, 6, kSquare, {}), 1);
  for (const auto& [u, v] : {std::pair(-1, 4), {9, 4}, {4, -1}, {4, 9}, {4, 7}})
    EXPECT_TRUE(std::isnan(supported_depth(image, u, v, kSquare, {}))) << u << ", " << v;
  for (const double z_m : {1e-300, 0.0, -1.0}) {  // the margin would be more pixels than an int holds
    image.z_m[pixel(image, 4, 4)] = z_m;
    EXPECT_TRUE(std::isnan(supported_depth(image, 4, 4, kSquare, {0.01, 0.01}))) << z_m;
  }
}

// Compared with the distances of all pixels that the plain loop supports.
TEST(SurfaceSupport, FindsTheNearestPixelThatCanBeTouched) {
  const DepthImage image = uneven(1);
  for (const ImagePixel& to : {ImagePixel{15, 9}, {15, 24}, {0, 0}, {30, 39}, {14, 30}}) {
    const auto squared = [&](int u, int v) {
      return (u - to.column) * (u - to.column) + (v - to.row) * (v - to.row);
    };
    int least = std::numeric_limits<int>::max();
    for (int v = 0; v < image.height; ++v)
      for (int u = 0; u < image.width; ++u)
        if (std::isfinite(plain_depth(image, u, v, 2, 2, 0.006))) least = std::min(least, squared(u, v));
    const auto found = nearest_supported(image, to, kSquare, {0.006, 0.01});
    ASSERT_TRUE(found);
    EXPECT_TRUE(std::isfinite(plain_depth(image, found->column, found->row, 2, 2, 0.006)));
    EXPECT_EQ(squared(found->column, found->row), least) << to.row << ", " << to.column;
  }
  EXPECT_FALSE(nearest_supported(image, {15, 9}, kSquare, {0.006, 0.1})) << "25 pixels in every direction";
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
}  // namespace remote_touch::image_surface_test
