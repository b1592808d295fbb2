// Frames on their way from a sensor to the haptic loop: what is counted, dropped and handed over.
#include "runners/live/loop/servo.h"

#include <gtest/gtest.h>
#include <memory>
#include <utility>
#include <vector>

#include "runners/experiment/catalog/catalog.h"
#include "tests/doubles/simulated_clock.h"
#include "tests/runners/live/loop/simulated_run.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::camera_feed_test {
namespace {

constexpr int kWidth = 8, kHeight = 4;

// Sends the given frames, one a call, and then returns the given state.
class ListedFrames final : public DepthSource {
 public:
  ListedFrames(std::vector<SensorFrame> frames, SensorState then, bool has_colour = false)
      : frames_(std::move(frames)), then_(then) {
    view_.camera = {kWidth, kHeight, 10, 10, 3.5, 1.5};
    view_.has_colour = has_colour;
    failure_ = "it was pulled out";
  }
  SensorState next(SensorFrame& frame, double) override {
    if (next_ < frames_.size()) {
      frame = frames_[next_++];
      return SensorState::frame;
    }
    return then_;
  }

 private:
  std::vector<SensorFrame> frames_;
  const SensorState then_;
  std::size_t next_ = 0;
};

SensorFrame frame(int number, double captured_s, std::uint16_t depth = 500) {
  return {number, captured_s, std::vector<std::uint16_t>(kWidth * kHeight, depth), {}};
}

constexpr double kRecording_s = 0.002;

struct Loop {
  SimulatedClock clock;
  TripleBuffer<LiveFrame> frames;
  ProxyRenderer renderer = scenes::renderer();
  int recorded = 0;
  bool has_capacity = true;
  std::unique_ptr<CameraFeed> camera;

  explicit Loop(std::unique_ptr<DepthSource> source) {
    clock.sleep_s(kStart_s);
    camera = std::make_unique<CameraFeed>(std::move(source), FrameProcessing{}, renderer,
                                          RigidTransform::Identity(), clock, clock.now_ns(), frames,
                                          [this](const SensorFrame&, const Frame&, std::uint64_t) {
                                            recorded += has_capacity ? 1 : 0;
                                            clock.sleep_s(kRecording_s);
                                            return has_capacity;
                                          });
  }
  CameraCounts step(int times) {
    for (int i = 0; i < times; ++i) camera->step(0);
    return camera->counts();
  }

  static constexpr double kStart_s = 0.5;
};

TEST(CameraFeed, HandsOverTheNewestWithItsTimes) {
  Loop loop(std::make_unique<ListedFrames>(std::vector{frame(7, 0.625), frame(8, 0.75, 600)},
                                           SensorState::waiting));
  const CameraCounts counts = loop.step(2);
  EXPECT_EQ(counts.overtaken, 1);
  EXPECT_EQ(loop.recorded, 2);
  ASSERT_TRUE(loop.frames.take());
  const LiveFrame& newest = loop.frames.front();
  EXPECT_EQ(newest.frame.index, 1);
  EXPECT_EQ(newest.frame.captured_s, 0.75 - Loop::kStart_s);
  EXPECT_EQ(newest.sensed_s, 0.75);
  EXPECT_DOUBLE_EQ(newest.ready_s, Loop::kStart_s + 2 * kRecording_s);
  EXPECT_EQ(loop.camera->newest_s(), newest.ready_s);
  EXPECT_DOUBLE_EQ(counts.processing_s, 2 * kRecording_s);
  const PointCloud& cloud = *newest.frame.points->stored_cloud();
  EXPECT_EQ(cloud.z[3], 600 * 0.001);
  EXPECT_EQ(newest.hash, frame_hash(cloud, newest.frame.captured_s));
  EXPECT_FALSE(loop.frames.take());
}

TEST(CameraFeed, CountsGapsAndDropsWhatIsNotNewer) {
  Loop loop(std::make_unique<ListedFrames>(std::vector{frame(1, 1), frame(2, 2), frame(2, 2), frame(5, 3),
                                                       frame(4, 4), frame(6, 2.5), frame(7, 5)},
                                           SensorState::waiting));
  const CameraCounts counts = loop.step(7);
  EXPECT_EQ(counts.skipped, 2 + 1);  // 3 and 4; and 6, whose stamp went back
  EXPECT_EQ(counts.reversed, 3);
  EXPECT_EQ(loop.recorded, 4);
  EXPECT_EQ(counts.max_pause_s, 2);
}

TEST(CameraFeed, DropsFramesThatAreIncompleteOrCannotBeRecorded) {
  SensorFrame small = frame(1, 1), coloured = frame(2, 2);
  small.depth.resize(5);
  coloured.colour.assign(kWidth * kHeight, 0xff0000);
  Loop loop(
      std::make_unique<ListedFrames>(std::vector{small, coloured, frame(3, 3)}, SensorState::waiting, true));
  EXPECT_EQ(loop.step(3).incomplete, 2);
  EXPECT_EQ(loop.recorded, 1);

  Loop full(std::make_unique<ListedFrames>(std::vector{frame(1, 1), frame(2, 2)}, SensorState::waiting));
  full.has_capacity = false;
  EXPECT_EQ(full.step(2).unrecorded, 2);
  EXPECT_FALSE(full.frames.take());
}

// A rule that needs colours receives a frame without any. There are no more frames, and the run must end.
TEST(CameraFeed, AFrameThatCannotBeProcessedEndsIt) {
  Loop loop(std::make_unique<ListedFrames>(std::vector{frame(1, 1)}, SensorState::waiting));
  std::vector<std::unique_ptr<const FixtureRule>> rules;
  rules.push_back(find_entry(fixtures(), "hue-range", "fixture").make()->build());
  CameraFeed camera(std::make_unique<ListedFrames>(std::vector{frame(1, 1)}, SensorState::waiting),
                    FrameProcessing{nullptr, FixtureAssignment(std::move(rules))}, loop.renderer,
                    RigidTransform::Identity(), loop.clock, 0, loop.frames, {});
  EXPECT_FALSE(camera.step(0));
  EXPECT_NE(camera.ended().find("colour"), std::string::npos) << camera.ended();
  EXPECT_TRUE(camera.has_refused()) << "an input error";
}

// A live run whose camera stops or is unplugged, on a simulated clock.

// The experiment's camera until so many frames were sent. Then it returns the given state.
class CameraThatStops final : public DepthSource {
 public:
  CameraThatStops(std::unique_ptr<DepthSource> camera, int frames, SensorState then)
      : camera_(std::move(camera)), left_(frames), then_(then) {
    view_ = camera_->view();
    failure_ = "it was pulled out";
  }
  SensorState next(SensorFrame& frame, double timeout_s) override {
    if (left_ == 0) return then_;
    const SensorState state = camera_->next(frame, timeout_s);
    left_ -= state == SensorState::frame ? 1 : 0;
    return state;
  }

 private:
  const std::unique_ptr<DepthSource> camera_;
  int left_;
  const SensorState then_;
};

class CameraLoss : public testing::Test {
 protected:
  // Thirty frames, the last of them at 967 ms. The hand is lifted at 1.6 s and presses to another depth at
  // 1.7 s.
  LiveResult run_with_loss(SensorState then, int frames = 30) {
    hold(kAbove_m);
    clock_.at(kPressed_s, [&] { hold(kBelow_m); });
    clock_.at(1.6, [&] { hold(kAbove_m); });
    clock_.at(1.7, [&] { hold(2 * kBelow_m); });
    SimulatedRun run(
        clock_, press_experiment(),
        [](const Experiment&, Clock& clock) { return kForceDimension.open("", clock); },
        [=](const Experiment& experiment, Clock& clock) {
          return std::make_unique<CameraThatStops>(SimulatedRun::scenario_camera(experiment, clock), frames,
                                                   then);
        });
    run.options.duration_s = 2;
    run.options.on_trouble = [this](const LiveTrouble& trouble) { troubles_.push_back(trouble); };
    LiveResult result = run.run();
    reported_ = run.reported();
    return result;
  }
  void hold(double above_m) { put(*double_, kForceDimension, {0, height_m_ + above_m, 0}); }
  // Checks that the last cloud stays: the force is as before, there is none in free space, and another one at
  // another depth.
  void expect_the_last_cloud_to_hold() const {
    const ForceOverTime force = force_of(*double_);
    const double pressed_N = force.at(ms(900));
    EXPECT_GT(pressed_N, 1);
    EXPECT_NEAR(force.at(ms(1500)), pressed_N, 0.02 * pressed_N);
    EXPECT_EQ(force.at(ms(1690)), 0);
    EXPECT_NEAR(force.at(ms(1900)), pressed_N - 600 * kBelow_m, 0.02 * pressed_N) << "600 N/m and 2 mm";
  }

  SimulatedClock clock_;
  DoubleInstalled double_{kForceDimension, &clock_};
  const double height_m_ = table_height_m();
  std::vector<SimulatedRun::ReportedLine> reported_;
  std::vector<LiveTrouble> troubles_;
};

// The frame of 29 / 30 s arrives at 967 ms. It is older than 0.2 s from 1167 ms on, and the next check is at
// 1170 ms.
TEST_F(CameraLoss, ACameraThatStopsSendingLeavesItsLastCloud) {
  const LiveResult result = run_with_loss(SensorState::waiting);
  ASSERT_EQ(reported_.size(), 1u);
  EXPECT_EQ(reported_[0].at_ns, ms(1170));
  expect_the_last_cloud_to_hold();
  EXPECT_EQ(result.counts.camera.received, 30);
  EXPECT_EQ(result.log.stale_ticks, 2000 - 1168);
  ASSERT_EQ(troubles_.size(), 1u) << "a page gets what the terminal gets";
  EXPECT_EQ(troubles_[0].camera, reported_[0].line);
  EXPECT_EQ(troubles_[0].force, "");
}

struct Loss {
  SensorState then;
  int frames;
  const char* line;
};
class CameraLosses : public CameraLoss, public testing::WithParamInterface<Loss> {};

// There is no last cloud that could stay if there was no frame.
TEST_P(CameraLosses, AreReportedAndAFailureOnlyIfTheCameraFailed) {
  const auto& [then, frames, line] = GetParam();
  const LiveResult result = run_with_loss(then, frames);
  ASSERT_EQ(reported_.size(), 1u);
  EXPECT_EQ(reported_[0].line, line);
  EXPECT_EQ(result.failed, then == SensorState::failed);
  EXPECT_EQ(result.refused, "") << "a camera that was lost is no input error";
  EXPECT_EQ(result.ended, "its duration has elapsed");
  if (then == SensorState::waiting || frames == 0) return;
  EXPECT_EQ(reported_[0].at_ns, ms(970));
  expect_the_last_cloud_to_hold();
}

INSTANTIATE_TEST_SUITE_P(
    All, CameraLosses,
    testing::Values(
        Loss{SensorState::waiting, 30, "no frame for 0.2 s: the last cloud is still rendered"},
        Loss{SensorState::ended, 30,
             "no more frames (the recording has ended): the last cloud is still rendered"},
        Loss{SensorState::failed, 30, "no more frames (it was pulled out): the last cloud is still rendered"},
        Loss{SensorState::waiting, 0, "no frame has arrived yet: there is nothing to touch"},
        Loss{SensorState::failed, 0, "no more frames (it was pulled out): there is nothing to touch"}));

}  // namespace
}  // namespace remote_touch::camera_feed_test
