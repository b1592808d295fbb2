// The adapter on the real libfreenect without a Kinect plugged in.
#include <gtest/gtest.h>

#include "runners/live/devices/clock.h"
#include "runners/live/sensors/depth_source.h"
#include "tests/support/test_files.h"

namespace remote_touch::freenect_absent_test {
namespace {

TEST(FreenectAbsent, IsRefused) {
  const Availability availability = freenect_availability();
  if (availability.found) GTEST_SKIP() << "a Kinect is plugged in: " << availability.detail;
  const std::string message = refusal([] { open_freenect("0", steady_clock()); });
  if (availability.compiled_in) {
    EXPECT_HAS(message, "freenect");
    EXPECT_HAS(message, ": expected ");
    EXPECT_HAS(message, "that this user may open");
  } else {
    EXPECT_EQ(message, "freenect: not compiled in: install libfreenect-dev and build again");
    EXPECT_EQ(message, "freenect: " + availability.detail);
  }
}

}  // namespace
}  // namespace remote_touch::freenect_absent_test
