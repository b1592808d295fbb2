#include "core/beyond/tracked_surface/tracked_sheet_renderer.h"

#include <gtest/gtest.h>

#include "tests/support/scenes.h"

namespace remote_touch::tracked_sheet_renderer_test {
namespace {

constexpr double kInterval_s = 0.25;

Frame frame_at(int index, const PointCloud& cloud) {
  Frame frame = scenes::frame(cloud, index);
  frame.captured_s = frame.arrives_s = index * kInterval_s;
  return frame;
}

// A hand presses 5 mm into a flat cloud at rest, which is in the frames 0 and 1.
class PressedSheet : public testing::Test {
 protected:
  void SetUp() override {
    p_.proxy.stiffness_N_per_m = 500;
    p_.sheet.max_missed_frames = 2;
    renderer_ = std::make_unique<TrackedSheetRenderer>(p_, 1000, scenes::kernels());
    renderer_->reserve(20000);
    renderer_->on_frame(frame_at(0, seen_));
    for (double y = 0.01; y > -0.005; y -= 2e-4) step(y, 0.1);
    renderer_->on_frame(frame_at(1, seen_));
    pressed_N_ = step(-0.005, 0.3);
    ASSERT_GT(pressed_N_, 1);
  }
  double step(double y, double time_s) {
    return renderer_->step({.position_W = Vec3(0, y, 0)}, time_s).force_N.norm();
  }

  const PointCloud seen_ = scenes::flat_grid(60);
  TrackedSheetParameters p_;
  std::unique_ptr<TrackedSheetRenderer> renderer_;
  double pressed_N_ = 0;
};

// Frame 2 and later frames no longer contain the cloud.
class LostSheet : public PressedSheet {
 protected:
  void SetUp() override {
    PressedSheet::SetUp();
    renderer_->on_frame(frame_at(2, {}));
  }
};

TEST_F(LostSheet, IsHeldForExactlyTheGivenNumberOfFrames) {
  const double until_s = (2 + 2) * kInterval_s;  // two frames after frame 2, the first one that missed it
  EXPECT_NEAR(step(-0.005, std::nextafter(until_s, 0.0)), pressed_N_, 1e-3);
  EXPECT_EQ(step(-0.005, until_s), 0);
}

TEST_F(LostSheet, ContinuesWhenItIsSeenAgain) {
  renderer_->on_frame(frame_at(3, seen_));
  EXPECT_NEAR(step(-0.005, 2.0), pressed_N_, 1e-3);
}

// Only the first missed frame begins the time.
TEST_F(LostSheet, FurtherMissedFramesDoNotProlongIt) {
  renderer_->on_frame(frame_at(3, {}));
  EXPECT_EQ(step(-0.005, 4 * kInterval_s), 0);
}

// The first frame after a minute without frames misses the sheet, and no other frame follows. The sheet is
// held for two of the longest intervals that do not count as a pause, not for two minutes.
TEST_F(PressedSheet, APauseDoesNotProlongTheTimeForWhichALostSheetIsHeld) {
  Frame late = scenes::frame({}, 2);
  late.captured_s = late.arrives_s = 60;
  renderer_->on_frame(late);
  const double until_s = 60 + 2 * UsualInterval::kMaxRatio * kInterval_s;
  EXPECT_GT(step(-0.005, std::nextafter(until_s, 0.0)), 1);
  EXPECT_EQ(step(-0.005, until_s), 0);
}

}  // namespace
}  // namespace remote_touch::tracked_sheet_renderer_test
