// The link of frames: it judges a frame by where the slave was at its capture, and passes on what it sends.
#include "runners/experiment/teleoperation/frame_link.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <vector>

#include "core/kernels/isa.h"

namespace remote_touch::frame_link_test {
namespace {

class Receiver final : public Renderer {
 public:
  void on_frame(const Frame& frame) override { frames.push_back(frame.index); }
  RenderOutput step(const DeviceState& device, double) override {
    RenderOutput out;
    out.proxy_W = device.position_W;
    return out;
  }
  std::vector<int> frames;
};

// A plane over x < 0 at rest and one over x > 0 that rises by 3 mm a frame, 4 mm between the points.
Frame frame(int index, double captured_s) {
  PointCloud cloud;
  for (int i = -20; i < 20; ++i)
    for (int k = -10; k < 10; ++k) {
      cloud.x.push_back(0.004 * i + 0.002), cloud.z.push_back(0.004 * k);
      cloud.y.push_back(i < 0 ? 0 : 0.003 * index);
    }
  Frame made;
  made.index = index, made.captured_s = captured_s, made.points = make_search(std::move(cloud));
  return made;
}

TEST(FrameLink, JudgesByWhereTheSlaveWasWhenTheFrameWasCaptured) {
  Receiver receiver;
  FrameLink link({.least_motion_m = 0.001, .near_m = 0.02}, receiver, kernels_for(best_isa()));
  // The slave is over the part at rest until 0.1 s, and then over the part that rises.
  for (int tick = 0; tick < 200; ++tick)
    link.observe_slave(Vec3(tick < 100 ? -0.04 : 0.04, 0, 0), 0.001 * tick);
  for (int i = 0; i < 6; ++i) link.on_frame(frame(i, 0.03 * i));
  EXPECT_EQ(receiver.frames, (std::vector<int>{0, 4, 5}));
  EXPECT_EQ(link.sent(), 3);
}

// Before the slave starts its position is NaN, and frames are sent. With jitter some frames overtake others:
// they show nothing new, because the surface is at rest.
TEST(FrameLink, SendsNothingTwiceIfFramesOvertakeEachOther) {
  Receiver receiver;
  FrameLink link({.least_motion_m = 0.5, .near_m = 0.02}, receiver, kernels_for(best_isa()));
  link.observe_slave(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()), 0);
  link.on_frame(frame(0, 0));
  link.on_frame(frame(0, 0.001));
  for (int tick = 2; tick < 1000; ++tick) link.observe_slave(Vec3(-0.04, 0, 0), 0.001 * tick);
  for (int i = 1; i < 10; ++i)
    for (const int late : {0, 2, 1}) link.on_frame(frame(0, 0.1 * i - 0.03 * late));
  EXPECT_EQ(link.sent(), 2);
}

TEST(FrameLink, StepsTheRenderer) {
  Receiver receiver;
  FrameLink link({}, receiver, kernels_for(best_isa()));
  EXPECT_EQ(link.step({{1, 2, 3}}, 0).proxy_W, Vec3(1, 2, 3));
  for (int i = 0; i < 3; ++i) link.on_frame(frame(0, 0.03 * i));
  EXPECT_EQ(receiver.frames.size(), 3u);  // every frame is passed on without a dead-band
}

}  // namespace
}  // namespace remote_touch::frame_link_test
