// The parts that the adapters of depth cameras share: the clock of a sensor, rows of pixels, and the
// undistortion.
#include "runners/live/sensors/depth_source.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>

#include "tests/doubles/camera_double.h"
#include "tests/support/test_files.h"

namespace remote_touch::depth_source_test {
namespace {

// Stamps of a sensor on the clock of the host.

constexpr double kPeriod_s = 1.0 / 30;
constexpr double kOffset_s = 1234.5;  // offset of the host's clock from the sensor's
constexpr double kMinDelay_s = 0.02;

// The delay is 20 ms and up to 10 ms of jitter, which is zero in every seventh frame.
double delay_s(int frame) {
  return kMinDelay_s + 0.01 * ((frame * 3) % 7) / 6;
}

TEST(SensorClock, JitterOfArrivalsHasNoEffectAfterTheFirstPunctualFrame) {
  SensorClock clock;
  double before_s = 0;
  for (int frame = 0; frame < 300; ++frame) {
    const double stamp_s = frame * kPeriod_s, arrived_s = stamp_s + kOffset_s + delay_s(frame + 1);
    const double captured_s = clock.captured_s(stamp_s, arrived_s);
    EXPECT_LE(captured_s, arrived_s);
    EXPECT_GT(captured_s, before_s);
    before_s = captured_s;
    if (frame < 7) continue;
    EXPECT_NEAR(captured_s, stamp_s + kOffset_s + kMinDelay_s, 1e-4) << frame;
  }
}

// A clock that runs too slowly by 50 millionths would be 0.18 s behind after an hour.
TEST(SensorClock, FollowsAClockThatDrifts) {
  for (const double rate : {1 - 50e-6, 1 + 50e-6}) {
    SensorClock clock;
    for (int frame = 0; frame < 108000; ++frame) {
      const double taken_s = frame * kPeriod_s;
      const double captured_s = clock.captured_s(rate * taken_s, taken_s + kOffset_s + delay_s(frame));
      if (frame < 7) continue;
      ASSERT_NEAR(captured_s, taken_s + kOffset_s + kMinDelay_s, 1e-4) << rate << " " << frame;
    }
  }
}

// The first frame was delayed by 0.1 s, so the second would seem older.
TEST(SensorClock, NeverTurnsFramesRound) {
  SensorClock clock;
  const double first_s = clock.captured_s(0, 10.1);
  const double second_s = clock.captured_s(kPeriod_s, 10.101);
  EXPECT_GT(second_s, first_s);
  EXPECT_LE(second_s, 10.101);
  EXPECT_NEAR(clock.captured_s(6 * kPeriod_s, 10 + 6 * kPeriod_s), 10 + 6 * kPeriod_s, 1e-9);
}

// The sensor may send no frame for ten minutes. The offset is then trusted no more than the drift allows.
TEST(SensorClock, BeginsAnewWhenStampsGoBackOrStandStillAndSurvivesAPause) {
  SensorClock clock;
  EXPECT_EQ(clock.captured_s(100, 10), 10);
  EXPECT_EQ(clock.captured_s(0, 10.5), 10.5);
  EXPECT_EQ(clock.captured_s(0.5, 20), 20);
  EXPECT_NEAR(clock.captured_s(600.5, 620.03), 620.03, 1e-9);
}

// Rows of pixels from drivers.

using Depth = std::vector<std::uint16_t>;
using Colour = std::vector<std::uint32_t>;

const CameraIntrinsics kCamera{3, 2, 1, 1, 1, 0.5};
// Two rows of three pixels, each followed by a pixel that does not belong to the image.
const Depth kDriver{1, 2, 3, 99, 4, 5, 6, 99};

TEST(PixelRows, ColourIsPacked) {
  const std::vector<std::uint8_t> bytes{1, 2, 3, 4, 5, 6, 7, 8, 9, 255, 0, 128, 0, 255, 0, 10, 11, 12};
  Colour colour;
  ASSERT_TRUE(copy_rgb({bytes.data(), 18, 3, 2, 9}, kCamera, colour));
  EXPECT_EQ(colour, (Colour{0x010203, 0x040506, 0x070809, 0xff0080, 0x00ff00, 0x0a0b0c}));
  ASSERT_TRUE(copy_rgb({bytes.data(), 18, 3, 2, 9, true}, kCamera, colour));
  EXPECT_EQ(colour, (Colour{0x070809, 0x040506, 0x010203, 0x0a0b0c, 0x00ff00, 0xff0080}));
}

// The last row needs no gap behind it.
TEST(PixelRows, ReadDepthWithGapsAndMirroredAndRefuseOtherSizes) {
  Depth depth{7};
  for (const PixelRows& rows :
       {PixelRows{kDriver.data(), 13, 3, 2, 8}, PixelRows{kDriver.data(), 16, 2, 2, 8},
        PixelRows{kDriver.data(), 16, 3, 1, 8}, PixelRows{kDriver.data(), 16, -3, 2, 8},
        PixelRows{kDriver.data(), 16, 3, 2, 5}, PixelRows{kDriver.data(), 16, 3, 2, 0},
        PixelRows{kDriver.data(), 0, 3, 2, 8}, PixelRows{nullptr, 16, 3, 2, 8}, PixelRows{}})
    EXPECT_FALSE(copy_depth(rows, kCamera, depth));
  EXPECT_EQ(depth, Depth{7});
  EXPECT_FALSE(copy_depth(PixelRows{}, CameraIntrinsics{}, depth));
  ASSERT_TRUE(copy_depth({kDriver.data(), 14, 3, 2, 8}, kCamera, depth));
  EXPECT_EQ(depth, (Depth{1, 2, 3, 4, 5, 6}));
  ASSERT_TRUE(copy_depth({kDriver.data(), 16, 3, 2, 8, true}, kCamera, depth));
  EXPECT_EQ(depth, (Depth{3, 2, 1, 6, 5, 4}));
}

// Depth images without the distortion of their lens, against closed forms.

using Eigen::Vector2d;
using Eigen::Vector3d;
using Image = std::vector<std::uint16_t>;

Lens described(const CameraLens& lens) {
  return {[lens](const Vector2d& ray) { return lens.pixel_of(ray); },
          [lens](const Vector2d& pixel) { return lens.ray_of(pixel); }};
}

Undistortion undistortion_of(const CameraLens& lens) {
  return {"camera", lens.width, lens.height, described(lens)};
}

// A lens that distorts as strongly as the Azure Kinect's in its wide mode. Its corners see nothing.
CameraLens wide_lens() {
  return {256, 256, 126, 126.2, 129.1, 125.4, {0.52, 0.16, 0.008, 0.86, 0.26, 0.04}, 1e-4, -2e-4, 1.7};
}
// Barrel distortion, with the tangential part of a lens that is out of line.
CameraLens narrow_lens() {
  return {320, 240, 250, 251, 158.2, 121.7, {-0.2, 0.05, 0.01, 0, 0, 0}, 2e-3, -3e-3, 1.7};
}

double plane_depth(const Vector2d& ray, const Vector3d& normal, double distance) {
  return distance / normal.dot(Vector3d(ray.x(), ray.y(), 1));
}

Image seen_by(const CameraLens& lens, const std::function<double(const Vector2d&)>& depth_at) {
  Image image;
  for (int v = 0; v < lens.height; ++v)
    for (int u = 0; u < lens.width; ++u) {
      const auto ray = lens.ray_of({u, v});
      image.push_back(ray ? static_cast<std::uint16_t>(std::lround(depth_at(*ray))) : 0);
    }
  return image;
}

Vector2d ray_of(const CameraIntrinsics& camera, int u, int v) {
  return {(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy};
}

Image pinhole(const CameraLens& lens, const Undistortion& undistortion,
              const std::function<double(const Vector2d&)>& depth_at) {
  Image depth;
  undistortion.apply(seen_by(lens, depth_at), depth);
  return depth;
}

TEST(Undistortion, ChangesNothingForAPinholeCamera) {
  CameraLens lens = narrow_lens();
  lens.k = {}, lens.p1 = lens.p2 = 0;
  const Undistortion undistortion = undistortion_of(lens);
  EXPECT_NEAR(undistortion.camera().fx, lens.fx, 1e-9);
  EXPECT_NEAR(undistortion.camera().fy, lens.fy, 1e-9);
  EXPECT_NEAR(undistortion.camera().cx, lens.cx, 1e-9);
  EXPECT_NEAR(undistortion.camera().cy, lens.cy, 1e-9);
  Image seen, depth;
  for (int i = 0; i < lens.width * lens.height; ++i) seen.push_back(static_cast<std::uint16_t>(i * 7919));
  undistortion.apply(seen, depth);
  EXPECT_TRUE(depth == seen);
}

// The depth that a pixel of the result must have on a surface: that of its own ray if the four pixels around
// its position were seen, otherwise that of the nearest pixel's ray.
double expected_depth(const CameraLens& lens, const Vector2d& ray,
                      const std::function<double(const Vector2d&)>& depth_at) {
  const Vector2d place = *lens.pixel_of(ray);
  const Vector2d corner(std::clamp(std::floor(place.x()), 0.0, lens.width - 2.0),
                        std::clamp(std::floor(place.y()), 0.0, lens.height - 2.0));
  bool is_inside = true;
  for (const Vector2d& step : {Vector2d(0, 0), Vector2d(1, 0), Vector2d(0, 1), Vector2d(1, 1)})
    is_inside = is_inside && lens.ray_of(corner + step);
  return depth_at(is_inside ? ray : *lens.ray_of({std::round(place.x()), std::round(place.y())}));
}

// A plane has depth distance / (normal . ray). The camera rounds it, by half a unit at most, and so does the
// result. The depth is nearly linear between pixels.
TEST(Undistortion, KeepsAPlane) {
  for (const CameraLens& lens : {wide_lens(), narrow_lens()}) {
    const Undistortion undistortion = undistortion_of(lens);
    for (const Vector3d& normal : {Vector3d(0, 0, 1), Vector3d(0.1, -0.15, 1)}) {
      const auto depth_at = [&](const Vector2d& ray) { return plane_depth(ray, normal, 1000); };
      const Image depth = pinhole(lens, undistortion, depth_at);
      int present = 0;
      for (int v = 0; v < lens.height; ++v)
        for (int u = 0; u < lens.width; ++u) {
          const std::uint16_t z = depth[static_cast<std::size_t>(v * lens.width + u)];
          if (z == 0) continue;
          ++present;
          const Vector2d ray = ray_of(undistortion.camera(), u, v);
          ASSERT_NEAR(z, expected_depth(lens, ray, depth_at), 1.1) << u << " " << v;
        }
      EXPECT_GT(present, 0.7 * lens.width * lens.height);
    }
  }
}

// The ends of the middle row and of the middle column have the rays that they have in the camera's image.
TEST(Undistortion, KeepsTheFieldOfView) {
  for (const CameraLens& lens : {wide_lens(), narrow_lens()}) {
    const Undistortion undistortion = undistortion_of(lens);
    const CameraIntrinsics& camera = undistortion.camera();
    const int u = (lens.width - 1) / 2, v = (lens.height - 1) / 2;
    EXPECT_NEAR(ray_of(camera, 0, v).x(), lens.ray_of({0, v})->x(), 1e-9);
    EXPECT_NEAR(ray_of(camera, lens.width - 1, v).x(), lens.ray_of({lens.width - 1, v})->x(), 1e-9);
    EXPECT_NEAR(ray_of(camera, u, 0).y(), lens.ray_of({u, 0})->y(), 1e-9);
    EXPECT_NEAR(ray_of(camera, u, lens.height - 1).y(), lens.ray_of({u, lens.height - 1})->y(), 1e-9);
  }
}

// Two planes, one behind the other. All depths are those of one of them.
TEST(Undistortion, PutsNoDepthBetweenTwoSurfaces) {
  const CameraLens lens = narrow_lens();
  const Undistortion undistortion = undistortion_of(lens);
  const Image depth = pinhole(lens, undistortion,
                              [](const Vector2d& ray) { return ray.x() + 0.3 * ray.y() < 0.05 ? 500 : 900; });
  int near = 0, far = 0;
  for (const std::uint16_t z : depth) {
    EXPECT_TRUE(z == 0 || z == 500 || z == 900) << z;
    near += z == 500, far += z == 900;
  }
  EXPECT_GT(near, 10000);
  EXPECT_GT(far, 10000);
}

// A missing pixel stays missing: the output pixels to which it is the nearest are missing, and no others.
TEST(Undistortion, KeepsMissingPixelsAndTheLargestDepths) {
  const CameraLens lens = narrow_lens();
  const Undistortion undistortion = undistortion_of(lens);
  Image seen(static_cast<std::size_t>(lens.width * lens.height), 700), depth;
  seen[100 * 320 + 57] = 0;
  undistortion.apply(seen, depth);
  const Vector2d hole(57, 100);
  int holes = 0;
  for (int v = 0; v < lens.height; ++v)
    for (int u = 0; u < lens.width; ++u) {
      const auto place = lens.pixel_of(ray_of(undistortion.camera(), u, v));
      const double away = place ? (*place - hole).cwiseAbs().maxCoeff() : 9;
      const std::uint16_t z = depth[static_cast<std::size_t>(v * lens.width + u)];
      if (away < 0.499) {
        EXPECT_EQ(z, 0);
        ++holes;
      } else if (away > 0.501 && away < 9) {
        const bool is_seen = place->x() >= 0 && place->y() >= 0 && place->x() <= 319 && place->y() <= 239;
        EXPECT_EQ(z, is_seen ? 700 : 0) << u << " " << v;
      }
    }
  EXPECT_GE(holes, 1);
  const Image nothing(seen.size(), 0), farthest(seen.size(), 65535);
  undistortion.apply(nothing, depth);
  EXPECT_TRUE(depth == nothing);
  undistortion.apply(farthest, depth);
  for (const std::uint16_t z : depth) EXPECT_TRUE(z == 0 || z == 65535) << z;
}

TEST(Undistortion, RefusesUnusableCalibrations) {
  using Ray = std::optional<Vector2d>;
  const Lens good = described(narrow_lens());
  const auto nothing = [](const Vector2d&) { return Ray(); };
  const auto not_finite = [](const Vector2d&) { return Ray(Vector2d(NAN, NAN)); };
  const auto scaled = [&](double factor) {
    return [&good, factor](const Vector2d& pixel) { return Ray(factor * *good.ray_of_pixel(pixel)); };
  };
  struct Refused {
    Lens lens;
    const char* message;
    int width = 320, height = 240;
  };
  for (const Refused& each :
       {Refused{{good.pixel_of_ray, nothing}, "has no calibration that can be used"},
        Refused{{good.pixel_of_ray, not_finite}, "has no calibration that can be used"},
        Refused{{good.pixel_of_ray, scaled(-1)}, "has no calibration that can be used"},
        Refused{{nothing, good.ray_of_pixel}, "has a calibration that contradicts itself"},
        Refused{{not_finite, good.ray_of_pixel}, "has a calibration that contradicts itself"},
        Refused{{good.pixel_of_ray, scaled(1.01)}, "has a calibration that contradicts itself"},
        Refused{good, "has images of 1 x 240 pixels: expected 2 to 8192 on a side", 1},
        Refused{good, "expected 2 to 8192 on a side", 320, 2147483647}})
    EXPECT_HAS(refusal([&] { Undistortion("camera", each.width, each.height, each.lens); }), each.message);
}

}  // namespace
}  // namespace remote_touch::depth_source_test
