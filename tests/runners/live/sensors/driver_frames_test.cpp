#include "runners/live/sensors/driver_frames.h"

#include <gtest/gtest.h>

#include <cmath>

namespace remote_touch::driver_frames_test {
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

TEST(SensorClock, BeginsAnewWhenStampsGoBackOrStandStill) {
  SensorClock clock;
  EXPECT_EQ(clock.captured_s(100, 10), 10);
  EXPECT_EQ(clock.captured_s(0, 10.5), 10.5);
  EXPECT_EQ(clock.captured_s(0.5, 20), 20);
}

// The sensor sends no frame for ten minutes. The offset is then trusted no more than the drift allows.
TEST(SensorClock, SurvivesAPauseOfTheSensor) {
  SensorClock clock;
  clock.captured_s(0, kOffset_s);
  EXPECT_NEAR(clock.captured_s(600, kOffset_s + 600.03), kOffset_s + 600.03, 1e-9);
}

// Rows of pixels from drivers.

using Depth = std::vector<std::uint16_t>;
using Colour = std::vector<std::uint32_t>;

const CameraIntrinsics kCamera{3, 2, 1, 1, 1, 0.5};
// Two rows of three pixels, each followed by a pixel that does not belong to the image.
const Depth kDriver{1, 2, 3, 99, 4, 5, 6, 99};

TEST(PixelRows, ReadDepthWithGapsAndMirrored) {
  Depth depth{7};
  ASSERT_TRUE(copy_depth({kDriver.data(), 16, 3, 2, 8}, kCamera, depth));
  EXPECT_EQ(depth, (Depth{1, 2, 3, 4, 5, 6}));
  ASSERT_TRUE(copy_depth({kDriver.data(), 16, 3, 2, 8, true}, kCamera, depth));
  EXPECT_EQ(depth, (Depth{3, 2, 1, 6, 5, 4}));
}

TEST(PixelRows, ColourIsPacked) {
  const std::vector<std::uint8_t> bytes{1, 2, 3, 4, 5, 6, 7, 8, 9, 255, 0, 128, 0, 255, 0, 10, 11, 12};
  Colour colour;
  ASSERT_TRUE(copy_rgb({bytes.data(), 18, 3, 2, 9}, kCamera, colour));
  EXPECT_EQ(colour, (Colour{0x010203, 0x040506, 0x070809, 0xff0080, 0x00ff00, 0x0a0b0c}));
  ASSERT_TRUE(copy_rgb({bytes.data(), 18, 3, 2, 9, true}, kCamera, colour));
  EXPECT_EQ(colour, (Colour{0x070809, 0x040506, 0x010203, 0x0a0b0c, 0x00ff00, 0xff0080}));
}

// The last row needs no gap behind it.
TEST(PixelRows, AcceptTheLeastNumberOfBytes) {
  Depth depth;
  EXPECT_TRUE(copy_depth({kDriver.data(), 14, 3, 2, 8}, kCamera, depth));
  EXPECT_FALSE(copy_depth({kDriver.data(), 13, 3, 2, 8}, kCamera, depth));
}

TEST(PixelRows, OtherSizesAreRefused) {
  Depth depth{7};
  for (const PixelRows& rows :
       {PixelRows{kDriver.data(), 16, 2, 2, 8}, PixelRows{kDriver.data(), 16, 3, 1, 8},
        PixelRows{kDriver.data(), 16, -3, 2, 8}, PixelRows{kDriver.data(), 16, 3, 2, 5},
        PixelRows{kDriver.data(), 16, 3, 2, 0}, PixelRows{kDriver.data(), 0, 3, 2, 8},
        PixelRows{nullptr, 16, 3, 2, 8}, PixelRows{}})
    EXPECT_FALSE(copy_depth(rows, kCamera, depth));
  EXPECT_EQ(depth, Depth{7});
  EXPECT_FALSE(copy_depth(PixelRows{}, CameraIntrinsics{}, depth));
}

}  // namespace
}  // namespace remote_touch::driver_frames_test
