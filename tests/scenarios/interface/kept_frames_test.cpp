// Frames that are kept are made once; the frame that was used longest ago is dropped.
#include "scenarios/interface/kept_frames.h"

#include <gtest/gtest.h>

#include <map>
#include <stdexcept>
#include <thread>

#include "tests/support/scenes.h"

namespace remote_touch::kept_frames_test {
namespace {

KeptFrames::Points one_point(std::size_t frame) {
  return make_search(scenes::cloud_of({Vec3(static_cast<double>(frame), 0, 0)}));
}

double x_of(const KeptFrames::Points& points) {
  return dynamic_cast<const CloudSearch&>(*points).cloud().x.at(0);
}

TEST(KeptFrames, AreMadeOnce) {
  KeptFrames frames(2);
  std::map<std::size_t, int> made;
  const auto get = [&](std::size_t frame) {
    const KeptFrames::Points points = frames.get(frame, [&] { return ++made[frame], one_point(frame); });
    EXPECT_EQ(x_of(points), static_cast<double>(frame));
    return points;
  };
  const KeptFrames::Points first = get(0);
  EXPECT_EQ(get(0), first);
  get(1), get(0), get(1), get(0);
  EXPECT_EQ(made, (std::map<std::size_t, int>{{0, 1}, {1, 1}}));
  get(2);  // instead of 1, which was used longest ago
  get(0), get(1), get(1);
  EXPECT_EQ(made, (std::map<std::size_t, int>{{0, 1}, {1, 2}, {2, 1}}));
}

TEST(KeptFrames, AFrameThatCannotBeMadeIsNotKept) {
  KeptFrames frames(1);
  const auto fails = []() -> KeptFrames::Points { throw std::runtime_error("no frame"); };
  EXPECT_THROW(frames.get(0, fails), std::runtime_error);
  EXPECT_EQ(x_of(frames.get(0, [] { return one_point(7); })), 7);
  EXPECT_EQ(x_of(frames.get(0, fails)), 7);
}

TEST(KeptFrames, SeveralThreadsGetTheSameFrames) {
  KeptFrames frames(3);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 4; ++t)
    threads.emplace_back([&frames, t] {
      for (std::size_t i = 0; i < 500; ++i) {
        const std::size_t frame = (i + t) % 5;
        EXPECT_EQ(x_of(frames.get(frame, [&] { return one_point(frame); })), static_cast<double>(frame));
      }
    });
  for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace remote_touch::kept_frames_test
