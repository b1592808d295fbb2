// Frames on their way from a sensor to the haptic loop: what is counted, dropped and handed over.
#include "runners/live/loop/camera_thread.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

#include "runners/experiment/catalog.h"
#include "runners/live/timing/steady_clock.h"
#include "tests/support/scenes.h"

namespace remote_touch::camera_thread_test {
namespace {

constexpr int kWidth = 8, kHeight = 4;

// Sends what it is given, one frame a call, and then does what its state says.
class ListedFrames final : public DepthSource {
 public:
  ListedFrames(std::vector<SensorFrame> frames, SensorState then, bool has_colour = false)
      : frames_(std::move(frames)), then_(then) {
    view_.camera = {kWidth, kHeight, 10, 10, 3.5, 1.5};
    view_.has_colour = has_colour;
  }
  const SensorView& view() const override { return view_; }
  SensorState next(SensorFrame& frame, double) override {
    if (next_ < frames_.size()) {
      frame = frames_[next_++];
      return SensorState::frame;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return then_;
  }
  std::string failure() const override { return "it was pulled out"; }

 private:
  std::vector<SensorFrame> frames_;
  const SensorState then_;
  SensorView view_;
  std::size_t next_ = 0;
};

SensorFrame frame(int number, double captured_s, std::uint16_t depth = 500) {
  return {number, captured_s, std::vector<std::uint16_t>(kWidth * kHeight, depth), {}};
}

struct Loop {
  TripleBuffer<LiveFrame> frames;
  ProxyRenderer renderer = scenes::renderer();
  double start_s = steady_s();
  int recorded = 0;
  bool has_capacity = true;
  std::unique_ptr<CameraThread> camera;

  explicit Loop(std::unique_ptr<DepthSource> source) {
    camera = std::make_unique<CameraThread>(std::move(source), FrameProcessing{}, renderer,
                                            RigidTransform::Identity(), start_s, frames,
                                            [this](const SensorFrame&, const Frame&, std::uint64_t) {
                                              recorded += has_capacity ? 1 : 0;
                                              return has_capacity;
                                            });
  }
  // Until so many frames came in.
  CameraCounts run(int received) {
    camera->start();
    for (const double until_s = steady_s() + 10;
         camera->counts().received < received && steady_s() < until_s;)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    camera->stop();
    return camera->counts();
  }
};

TEST(CameraThread, HandsOverTheNewestWithItsTimes) {
  const double now_s = steady_s();
  Loop loop(std::make_unique<ListedFrames>(std::vector{frame(7, now_s + 0.1), frame(8, now_s + 0.2, 600)},
                                           SensorState::waiting));
  const CameraCounts counts = loop.run(2);
  EXPECT_EQ(counts.overtaken, 1);
  EXPECT_EQ(loop.recorded, 2);
  ASSERT_TRUE(loop.frames.take());
  const LiveFrame& newest = loop.frames.front();
  EXPECT_EQ(newest.frame.index, 1);
  EXPECT_EQ(newest.frame.captured_s, now_s + 0.2 - loop.start_s);
  EXPECT_EQ(newest.sensed_s, now_s + 0.2);
  EXPECT_GE(newest.ready_s, now_s);
  const auto& cloud = dynamic_cast<const CloudSearch&>(*newest.frame.points).cloud();
  EXPECT_EQ(cloud.z[3], 600 * 0.001);
  EXPECT_EQ(newest.hash, frame_hash(cloud, newest.frame.captured_s));
  EXPECT_FALSE(loop.frames.take());
}

TEST(CameraThread, CountsGapsAndDropsWhatIsNotNewer) {
  Loop loop(std::make_unique<ListedFrames>(std::vector{frame(1, 1), frame(2, 2), frame(2, 2), frame(5, 3),
                                                       frame(4, 4), frame(6, 2.5), frame(7, 5)},
                                           SensorState::waiting));
  const CameraCounts counts = loop.run(7);
  EXPECT_EQ(counts.passed_over, 2 + 1);  // 3 and 4; and 6, whose stamp went back
  EXPECT_EQ(counts.reversed, 3);
  EXPECT_EQ(loop.recorded, 4);
  EXPECT_EQ(counts.max_pause_s, 2);
}

TEST(CameraThread, DropsWhatIsIncomplete) {
  SensorFrame small = frame(1, 1), coloured = frame(2, 2);
  small.depth.resize(5);
  coloured.colour.assign(kWidth * kHeight, 0xff0000);
  Loop loop(
      std::make_unique<ListedFrames>(std::vector{small, coloured, frame(3, 3)}, SensorState::waiting, true));
  const CameraCounts counts = loop.run(3);
  EXPECT_EQ(counts.incomplete, 2);
  EXPECT_EQ(loop.recorded, 1);
}

TEST(CameraThread, WhatCannotBeRecordedIsNotRenderedEither) {
  Loop loop(std::make_unique<ListedFrames>(std::vector{frame(1, 1), frame(2, 2)}, SensorState::waiting));
  loop.has_capacity = false;
  EXPECT_EQ(loop.run(2).unrecorded, 2);
  EXPECT_FALSE(loop.frames.take());
}

TEST(CameraThread, TellsHowItEnded) {
  for (const auto& [then, why] : {std::pair{SensorState::failed, "it was pulled out"},
                                  {SensorState::ended, CameraThread::kEnd},
                                  {SensorState::waiting, ""}}) {
    Loop loop(std::make_unique<ListedFrames>(std::vector{frame(1, 1)}, then));
    loop.run(1);
    EXPECT_EQ(loop.camera->ended(), why);
  }
}

// A rule that wants colours of a sensor without any: the thread ends, and nothing else does.
TEST(CameraThread, AFrameThatCannotBeProcessedEndsIt) {
  Loop loop(std::make_unique<ListedFrames>(std::vector{frame(1, 1)}, SensorState::waiting));
  std::vector<std::unique_ptr<const FixtureRule>> rules;
  rules.push_back(find_entry(fixtures(), "hue-range", "fixture").make()->build());
  CameraThread camera(std::make_unique<ListedFrames>(std::vector{frame(1, 1)}, SensorState::waiting),
                      FrameProcessing{nullptr, FixtureAssignment(std::move(rules))}, loop.renderer,
                      RigidTransform::Identity(), 0, loop.frames, {});
  camera.start();
  for (int i = 0; i < 2000 && camera.ended().empty(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_NE(camera.ended().find("colour"), std::string::npos) << camera.ended();
}

}  // namespace
}  // namespace remote_touch::camera_thread_test
