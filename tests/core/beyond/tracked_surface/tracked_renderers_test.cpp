// Renderers on tracked sheets: how long a sheet that is lost is held, noise, and surfaces that move and turn.
#include "core/beyond/tracked_surface/tracked_renderers.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/points/vector.h"
#include "runners/evaluation/contract/allocation_counter.h"
#include "tests/support/box_tool.h"
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

// A tool on tracked sheets: the effect of noise, and how the tool follows surfaces that move and turn.
namespace remote_touch::tracked_tool_renderer_test {
namespace {

const Vec3 kHalf_m(0.02, 0.005, 0.02);
constexpr double kUnit_m = 0.005, kSpacing_m = 0.0015, kFrames_hz = 30;
constexpr int kTicks = 33;  // ticks from frame to frame

// Points of square panels, with noise and without normals.
class Panels {
 public:
  explicit Panels(double sigma_m, unsigned seed = 1)
      : noise_m_(0, sigma_m > 0 ? sigma_m : 1), sigma_m_(sigma_m), random_(seed) {}
  // Adds a grid of n x n points around middle_W. Its normal is the rotated y axis.
  Panels& add(const Vec3& middle_W, const Eigen::Quaterniond& turn, int n = 80) {
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const Vec3 p_S((i - 0.5 * (n - 1)) * kSpacing_m, 0, (j - 0.5 * (n - 1)) * kSpacing_m);
        const Vec3 p_W = middle_W + turn * p_S + noise();
        cloud_.append(p_W, turn * Vec3::UnitY());
      }
    return *this;
  }
  PointCloud take() { return std::exchange(cloud_, {}); }

 private:
  Vec3 noise() {
    if (sigma_m_ == 0) return Vec3::Zero();
    const double x = noise_m_(random_), y = noise_m_(random_), z = noise_m_(random_);
    return {x, y, z};
  }
  std::normal_distribution<double> noise_m_;
  double sigma_m_;
  std::mt19937 random_;
  PointCloud cloud_;
};

Frame frame_at(int index, PointCloud cloud) {
  Frame frame = scenes::frame(std::move(cloud), index);
  frame.captured_s = frame.arrives_s = index / kFrames_hz;
  return frame;
}

TrackedToolRenderer renderer(TrackedToolParameters p = {}) {
  p.tool.max_force_N = 1000, p.tool.max_torque_Nm = 100;
  return TrackedToolRenderer(p, scenes::box_tool(kHalf_m), scenes::kernels());
}

// Renders the ticks until the next frame and returns the last output.
template <class Renderer>
RenderOutput ticks(Renderer& r, int frame, const DeviceState& device) {
  RenderOutput out;
  for (int i = 0; i < kTicks; ++i) out = r.step(device, frame / kFrames_hz + 0.001 * i);
  return out;
}

DeviceState device(const Vec3& p_W, const Eigen::Quaterniond& q = Eigen::Quaterniond::Identity()) {
  return {p_W, q};
}

// Device pose on an approach along up_W: 4 cm before the end pose in frame 0, and at it from frame 4 on. An
// end pose a few millimetres below a surface thus presses from frame 4 on.
DeviceState approaching(int frame, const Vec3& up_W, const DeviceState& end) {
  return device(end.position_W + std::max(0, 4 - frame) * 0.01 * up_W, end.orientation_W);
}

// The rim is equally high on all sides, so the middle of the tool's lowest positions is over the hole, where
// no sheet is seen. The plate lies on measured points over a wide hole, within their noise.
TEST(TrackedTool, LiesOnTheRimOfAHole) {
  for (const double radius_m : {0.01, 0.014, 0.018}) {
    TrackedToolRenderer r = renderer();
    const double sigma_m = 0.3 * kUnit_m;
    Panels panels(sigma_m, 6);
    for (int frame = 0; frame < 20; ++frame) {
      const PointCloud floor = panels.add({0, 0, 0}, Eigen::Quaterniond::Identity(), 100).take();
      PointCloud rim;
      for (std::size_t i = 0; i < floor.size(); ++i)
        if (std::hypot(floor.x[i], floor.z[i]) > radius_m) rim.append(floor.point(i), Vec3::UnitY());
      r.on_frame(frame_at(frame, rim));
      const RenderOutput out =
          ticks(r, frame, approaching(frame, Vec3::UnitY(), device({0.0005 * frame, -0.003, 0})));
      ASSERT_TRUE(out.proxy_W.allFinite()) << frame;
      if (frame < 10) continue;
      EXPECT_NEAR(out.proxy_W.y(), kHalf_m.y(), 3 * sigma_m) << radius_m << " " << frame;
    }
  }
}

// The output equals that of the tool of chapter 6 bit for bit if the scene has no noise and is at rest.
TEST(TrackedTool, EqualsThePlainToolAtRestWithoutNoise) {
  TrackedToolRenderer r = renderer();
  ToolParameters p;
  p.max_force_N = 1000, p.max_torque_Nm = 100;
  ToolRenderer plain(p, scenes::box_tool(kHalf_m), scenes::kernels());
  Panels panels(0);
  const PointCloud floor = panels.add({0, 0, 0}, Eigen::Quaterniond::Identity()).take();
  for (int frame = 0; frame < 20; ++frame) {
    r.on_frame(frame_at(frame, floor)), plain.on_frame(frame_at(frame, floor));
    const Vec3 at_W(0.0007 * frame, -0.001 * frame, 0.0003 * frame);
    const DeviceState hand = approaching(frame, Vec3::UnitY(), device(at_W, rotation({0.01 * frame, 0, 0})));
    const RenderOutput out = ticks(r, frame, hand), expected = ticks(plain, frame, hand);
    EXPECT_EQ(out.proxy_W, expected.proxy_W) << frame;
    EXPECT_EQ(out.tool->orientation_W.coeffs(), expected.tool->orientation_W.coeffs()) << frame;
    EXPECT_EQ(out.force_N, expected.force_N) << frame;
    EXPECT_EQ(out.tool->torque_Nm, expected.tool->torque_Nm) << frame;
  }
}

// The plate lies on a plane that rises and turns about z by 2 degrees a frame. The plate turns with it.
TEST(TrackedTool, ATiltingPlaneTakesThePlateAlong) {
  for (const double sigma : {0.0, 0.5}) {
    TrackedToolRenderer r = renderer();
    Panels panels(sigma * kUnit_m, 3);
    for (int frame = 0; frame < 22; ++frame) {
      const int moved = std::max(0, frame - 8);
      const Eigen::Quaterniond turn = rotation({0, 0, 0.035 * moved});
      const Vec3 middle_W(0, 0.004 * moved, 0);
      r.on_frame(frame_at(frame, panels.add(middle_W, turn, 100).take()));
      const Vec3 n_W = turn * Vec3::UnitY();
      const RenderOutput out =
          ticks(r, frame, approaching(frame, Vec3::UnitY(), device({0, middle_W.y() - 0.003, 0})));
      if (frame < 8) continue;
      const Vec3 up_W = out.tool->orientation_W * Vec3::UnitY();
      EXPECT_NEAR((up_W - n_W).norm(), 0, 0.005 + 0.02 * sigma) << sigma << " in frame " << frame;
      EXPECT_NEAR((out.proxy_W - middle_W).dot(n_W), kHalf_m.y(), 2e-4 + 6e-4 * sigma)
          << sigma << " in frame " << frame;
    }
  }
}

// The plane rises by 5 mm a frame and the hand stays 3 mm below it: the force has no step at a frame. The
// torque has no step either if the plane also turns. The plate then slides down the slope, so the force along
// the slope changes.
TEST(TrackedTool, ForceAndTorqueHaveNoStepsOnAnEvenMotion) {
  for (const double turn_rad : {0.0, 0.02}) {
    TrackedToolRenderer r = renderer();
    Panels panels(0);
    RenderOutput last;
    for (int tick = 0, frame = -1; tick < 700; ++tick) {
      const double time_s = 0.001 * tick;
      const bool is_new = static_cast<int>(time_s * kFrames_hz) > frame;
      const auto rise_m = [](double moved) { return 0.005 * std::max(0.0, moved - 8); };
      if (is_new) {
        ++frame;
        panels.add({0, rise_m(frame), 0}, rotation({0, 0, turn_rad * std::max(0, frame - 8)}));
        r.on_frame(frame_at(frame, panels.take()));
      }
      const double hand_m = std::max(0.03 - 0.2 * time_s, -0.003) + rise_m(time_s * kFrames_hz);
      const RenderOutput out = r.step(device({0, hand_m, 0}), time_s);
      if (is_new && frame > 11) {  // steps of 3 N and 0.011 N m if (4.15) is off
        if (turn_rad == 0) {
          EXPECT_LT((out.force_N - last.force_N).norm(), 0.25) << frame;
        }
        EXPECT_LT((out.tool->torque_Nm - last.tool->torque_Nm).norm(), 0.0015) << frame;
      }
      last = out;
    }
  }
}

// A noisy floor and a noisy wall, which both move. The tool keeps its distance from both. A point of the
// corner that belongs to neither sheet holds the tool off by up to 3.5 sigma in single frames.
TEST(TrackedTool, AFloorAndAWallAreTwoSheets) {
  const double sigma_m = 0.2 * kUnit_m;
  TrackedToolRenderer r = renderer();
  Panels panels(sigma_m, 9);
  std::vector<double> errors_m;
  for (int frame = 0; frame < 34; ++frame) {
    const double moved_m = 0.002 * std::max(0, frame - 14);
    panels.add({0.03, moved_m, 0}, Eigen::Quaterniond::Identity(), 100);
    panels.add({-0.05 + moved_m, 0.06 + moved_m, 0}, rotation({0, 0, -0.5 * M_PI}), 80);
    r.on_frame(frame_at(frame, panels.take()));
    const DeviceState end = device({-0.035 + moved_m, moved_m - 0.003, 0});
    const RenderOutput out = ticks(r, frame, approaching(frame, Vec3(1, 1, 0), end));
    if (frame < 14) continue;
    errors_m.push_back(std::abs(out.proxy_W.y() - moved_m - kHalf_m.y()));
    errors_m.push_back(std::abs(out.proxy_W.x() - moved_m + 0.05 - kHalf_m.x()));
  }
  std::sort(errors_m.begin(), errors_m.end());
  EXPECT_LT(errors_m[errors_m.size() / 2], 0.5 * sigma_m);
  EXPECT_LT(errors_m.back(), 3.5 * sigma_m);
  int tracked = 0;
  for (std::size_t i = 0; i < r.patches().size(); ++i) tracked += r.patches().tracks(i) ? 1 : 0;
  EXPECT_EQ(tracked, 2);
}

// A plane that moves at 1 m/s, 3 cm a frame, sweeps over a free plate of 1 cm. It carries the plate along,
// with or without noise.
TEST(TrackedTool, ASheetThatSweepsOverAFreeToolTakesItAlong) {
  for (const double sigma : {0.0, 0.4}) {
    TrackedToolRenderer r = renderer();
    Panels panels(sigma * kUnit_m, 2);
    RenderOutput out;
    double height_m = 0;
    for (int frame = 0; frame < 12; ++frame) {
      height_m = -0.12 + frame / kFrames_hz;
      r.on_frame(frame_at(frame, panels.add({0, height_m, 0}, Eigen::Quaterniond::Identity(), 100).take()));
      out = ticks(r, frame, device({0, 0, 0}));
    }
    EXPECT_NEAR(out.proxy_W.y() - height_m, kHalf_m.y(), 5e-4 + 1e-3 * sigma) << sigma;
  }
}

// The tool bridges one frame without points. After that it is released.
TEST(TrackedTool, AMissingSurfaceHoldsForOneFrame) {
  TrackedToolRenderer r = renderer();
  Panels panels(0);
  const PointCloud floor = panels.add({0, 0, 0}, Eigen::Quaterniond::Identity()).take();
  const auto held_m = [&](int frame) {
    return ticks(r, frame, approaching(frame, Vec3::UnitY(), device({0, -0.003, 0}))).proxy_W.y();
  };
  for (int frame = 0; frame < 10; ++frame) {
    r.on_frame(frame_at(frame, frame == 7 ? PointCloud{} : floor));
    const double height_m = held_m(frame);
    if (frame > 4) {
      EXPECT_NEAR(height_m, kHalf_m.y(), 1e-4) << frame;
    }
  }
  r.on_frame(frame_at(10, {}));
  EXPECT_NEAR(held_m(10), kHalf_m.y(), 1e-4);
  r.on_frame(frame_at(11, {}));
  EXPECT_EQ(held_m(11), -0.003);
}

// A minute passes without frames. Then one frame arrives without the surface, and no other follows. The
// surface is held for three frames, not for another minute.
TEST(TrackedTool, APauseDoesNotProlongTheTimeForWhichAMissingSurfaceIsHeld) {
  TrackedToolRenderer r = renderer();
  Panels panels(0);
  const PointCloud floor = panels.add({0, 0, 0}, Eigen::Quaterniond::Identity()).take();
  for (int frame = 0; frame < 6; ++frame) {
    r.on_frame(frame_at(frame, floor));
    ticks(r, frame, approaching(frame, Vec3::UnitY(), device({0, -0.003, 0})));
  }
  r.on_frame(frame_at(1800, {}));
  EXPECT_NEAR(ticks(r, 1802, device({0, -0.003, 0})).proxy_W.y(), kHalf_m.y(), 1e-4);
  EXPECT_EQ(ticks(r, 1804, device({0, -0.003, 0})).proxy_W.y(), -0.003);
}

TEST(TrackedTool, FramesAndTicksAllocateNothing) {
  TrackedToolRenderer r = renderer();
  Panels panels(0.4 * kUnit_m, 4);
  std::vector<Frame> frames;
  for (int i = 0; i < 12; ++i) {
    panels.add({0.03, 0.001 * i, 0}, Eigen::Quaterniond::Identity(), 60);
    panels.add({-0.03, 0.05, 0}, rotation({0, 0, -0.5 * M_PI}), 50);
    frames.push_back(frame_at(i, panels.take()));
    r.prepare(frames.back());
  }
  r.reserve(frames[0].points->size());
  r.on_frame(frames[0]);
  ticks(r, 0, approaching(0, Vec3::UnitY(), device({0, -0.003, 0})));
  const std::size_t before = allocation_count();
  for (int i = 1; i < 12; ++i) {
    r.on_frame(frames[static_cast<std::size_t>(i)]);
    ticks(r, i, approaching(i, Vec3::UnitY(), device({0.002 * i - 0.03, -0.003, 0})));
  }
  EXPECT_EQ(allocation_count(), before);
}

}  // namespace
}  // namespace remote_touch::tracked_tool_renderer_test
