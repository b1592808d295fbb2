// The times at which the frames of a recording are shown.
#include "scenarios/recordings/frame_times.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/test_files.h"

namespace remote_touch::frame_times_test {
namespace {

using Playback = FrameTimes::Playback;

RecordingIndex stamped(const std::vector<double>& times_s) {
  RecordingIndex index;
  for (const double time_s : times_s) index.frames.push_back({time_s, {}, {}});
  index.is_stamped = true;
  index.frame_rate_hz = times_s.size() > 1 ? static_cast<double>(times_s.size() - 1) / times_s.back() : 30;
  return index;
}

RecordingIndex steady(int frames, double rate_hz) {
  RecordingIndex index;
  for (int j = 0; j < frames; ++j) index.frames.push_back({j / rate_hz, {}, {}});
  index.frame_rate_hz = rate_hz;
  return index;
}

std::vector<double> times_of(const FrameTimes& times, int frames) {
  std::vector<double> all;
  for (int i = 0; i < frames; ++i) all.push_back(times.captured_s(i));
  return all;
}

std::vector<std::size_t> sources_of(const FrameTimes& times, int frames) {
  std::vector<std::size_t> all;
  for (int i = 0; i < frames; ++i) all.push_back(times.source(i));
  return all;
}

// Frames 1 to 3 of four, 0.25 and 0.75 s apart: 2 Hz on average, so that a loop takes 1 + 0.5 s.
TEST(FrameTimes, AreTheStampsAlsoWhereThePartIsPlayedAgain) {
  const RecordingIndex index = stamped({0, 8, 8.25, 9});
  const RecordingPart part{"x", 1, -1};
  const FrameTimes hold(index, part, Playback::hold, 0), loop(index, part, Playback::loop, 0),
      ping_pong(index, part, Playback::ping_pong, 0);
  EXPECT_EQ(times_of(hold, 3), (std::vector<double>{0, 0.25, 1}));
  EXPECT_EQ(times_of(loop, 7), (std::vector<double>{0, 0.25, 1, 1.5, 1.75, 2.5, 3}));
  EXPECT_EQ(sources_of(loop, 7), (std::vector<std::size_t>{1, 2, 3, 1, 2, 3, 1}));
  EXPECT_EQ(times_of(ping_pong, 7), (std::vector<double>{0, 0.25, 1, 1.75, 2, 2.25, 3}));
  EXPECT_EQ(sources_of(ping_pong, 7), (std::vector<std::size_t>{1, 2, 3, 2, 1, 2, 3}));
  EXPECT_EQ(hold.rate_hz(), 2) << "the mean of the part, not of the recording";
}

TEST(FrameTimes, AreMultiplesOfThePeriodOfASteadyRecording) {
  const FrameTimes loop(steady(3, 30), {"x", 0, -1}, Playback::loop, 0);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(loop.captured_s(i), i / 30.0);
  EXPECT_FALSE(loop.follows_stamps());
}

TEST(FrameTimes, IgnoreTheStampsIfARateIsChosen) {
  for (const Playback playback : {Playback::hold, Playback::loop, Playback::ping_pong}) {
    const FrameTimes chosen(stamped({0, 1, 5}), {"x", 0, -1}, playback, 10);
    EXPECT_EQ(times_of(chosen, 3), (std::vector<double>{0, 1 / 10.0, 2 / 10.0}));
    EXPECT_EQ(chosen.rate_hz(), 10);
    EXPECT_EQ(chosen.text(), "10 Hz (recorded at 0.4 Hz)");
    EXPECT_FALSE(chosen.follows_stamps());
  }
}

TEST(FrameTimes, ASingleFrameIsAtTimeZero) {
  for (const Playback playback : {Playback::hold, Playback::loop, Playback::ping_pong}) {
    const FrameTimes single(stamped({0, 1, 5}), {"x", 1, 1}, playback, 0);
    EXPECT_EQ(single.captured_s(0), 0);
    EXPECT_EQ(single.source(0), 1u);
    EXPECT_FALSE(single.follows_stamps());
  }
}

// A pause is a time between frames that is nearer to two periods than to one, because a frame is missing.
TEST(FrameTimes, ReportTheRateThatIsPlayed) {
  const auto text = [](const RecordingIndex& index, double chosen_hz = 0) {
    return FrameTimes(index, {"x", 0, -1}, Playback::hold, chosen_hz).text();
  };
  EXPECT_EQ(text(steady(3, 30)), "30 Hz");
  EXPECT_EQ(text(steady(3, 30), 30), "30 Hz");
  EXPECT_EQ(text(stamped({0, 0.1, 0.2, 0.34})), "8.82353 Hz") << "uneven, but none is missing";
  EXPECT_EQ(text(stamped({0, 0.25, 0.5, 1.5, 1.75, 2})), "4 Hz with pauses of up to 1 s (2.5 Hz on average)");
}

TEST(FrameTimes, HaveAUsualRateThatAPauseDoesNotChange) {
  EXPECT_EQ(FrameTimes(stamped({0, 0.25, 0.5, 60, 60.25}), {"x", 0, -1}, Playback::hold, 0).usual_rate_hz(),
            4);
}

TEST(FrameTimes, APartThatIsTooFastIsRefused) {
  const RecordingIndex index = stamped({0, 1, 1 + 1.0 / 16384, 4});
  EXPECT_HAS(refusal([&] {
               FrameTimes(index, {"x", 1, 2}, Playback::hold, 0);
             }),
             "x: frames 1 to 2 have timestamps of more than 10000 frames a second: expected seconds");
}

}  // namespace
}  // namespace remote_touch::frame_times_test
