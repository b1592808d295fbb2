// Frames whose size or camera is not that of the first, for a hand that follows a pixel. The oracle is a
// plane whose points are computed for each camera.
#include "runners/experiment/hand/image_frames.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "runners/experiment/hand/image_press.h"
#include "tests/support/test_files.h"

namespace remote_touch::image_frames_test {
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

TEST(ImageFrames, RefusesAFrameOfAnotherSize) {
  const CameraIntrinsics half{50, 40, 50, 50, 24.5, 19.5}, turned{80, 100, 100, 100, 39.5, 49.5};
  EXPECT_EQ(
      refusal_of_second(plane(0.5, half)),
      "trajectory.name = image-press: frame 1 has 50 x 40 pixels: expected 100 x 80 pixels, as frame 0 has");
  EXPECT_HAS(refusal_of_second(plane(0.5, turned)), "frame 1 has 80 x 100 pixels");
  EXPECT_HAS(refusal_of_second(without_image(plane(0.5, half))), "frame 1 has 2000 points");
  PointCloud cut = plane(0.5);
  cut.x.resize(3000), cut.y.resize(3000), cut.z.resize(3000);
  EXPECT_HAS(refusal_of_second(cut), "frame 1 has 3000 points") << "fewer points than its layout promises";
}

// The ray of the last column moves by 2.5 pixels with f = 105; one pixel is allowed for the fit of a camera.
TEST(ImageFrames, RefusesAFrameOfAnotherCamera) {
  CameraIntrinsics longer = kCamera, shifted = kCamera, fitted = kCamera;
  longer.fx = 105, shifted.cy += 1.1, fitted.cx += 0.5, fitted.fx = 100.5;
  EXPECT_HAS(
      refusal_of_second(plane(0.5, longer)),
      "frame 1 has another camera (f = 105, 100, c = 49.5, 39.5): expected that of frame 0 (f = 100, 100");
  EXPECT_HAS(refusal_of_second(plane(0.5, shifted)), "frame 1 has another camera");
  EXPECT_EQ(refusal_of_second(plane(0.5, fitted)), "no InputError");
  EXPECT_HAS(refusal_of_second(without_image(plane(0.5, longer))), "frame 1 is not an image");
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

// A camera on a path, or a scene beyond the range of the sensor, may see nothing.
TEST(ImageFrames, RefusesAFirstFrameWithoutADepth) {
  EXPECT_EQ(refusal([&] {
              ImagePress({}, Frames({plane(kNaN), plane(0.5)}));
            }),
            "trajectory.name = image-press: no pixel of the first frame has a depth: expected a camera that "
            "sees a surface");
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

// Rows and columns alone are no image: an organised cloud of a PCD file may be mirrored.
TEST(ImageFrames, RefusesAFirstFrameThatNoCameraSees) {
  PointCloud organised = without_image(plane(0.5));
  EXPECT_EQ(refusal([&] { first_image(Frames({organised}, "read a.pcd"), "x"); }),
            "x: the frames are not images: expected a recording with a camera");
  organised.grid_columns = kCamera.width;
  EXPECT_EQ(refusal([&] { first_image(Frames({organised}, "read a.pcd"), "x"); }),
            "x: the rows and columns of the recording are no image of a camera: expected clouds in the frame "
            "of the camera that are not mirrored");
}

// A simulated scene with rows and columns, such as moving-lift, reads no file.
TEST(ImageFrames, RefusesASceneWithoutACameraByThoseThatHaveOne) {
  PointCloud grid = without_image(plane(0.5));
  for (const int columns : {0, kCamera.width}) {
    grid.grid_columns = columns;
    EXPECT_EQ(refusal([&] { first_image(Frames({grid}), "x"); }),
              "x: the scene has no camera: expected a scenario with one (recording, mesh-scene, "
              "camera-scene, beating-heart, valve-tank)");
  }
}

TEST(ImageFrames, TheFirstFrameHasAPointForEachPixel) {
  PointCloud cut = plane(0.5);
  cut.x.resize(3000), cut.y.resize(3000), cut.z.resize(3000);
  const Frames scene({cut});
  EXPECT_HAS(refusal([&] { first_image(scene, "x"); }),
             "x: frame 0 has 3000 points: expected 100 x 80 pixels");
}

}  // namespace
}  // namespace remote_touch::image_frames_test
