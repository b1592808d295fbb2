#include "runners/presentation/export/ros_messages.h"

#include <gtest/gtest.h>

#include "tests/support/test_files.h"

namespace remote_touch::ros_messages_test {
namespace {

// Header of a message at 3.5 s: encoding; seconds, nanoseconds, length of the text with its zero, the text,
// and two bytes up to a multiple of four or eight. The sizes are 4 + 4 + 4 + 6 = 18, and 20 or 24.
std::string header(int padding) {
  return std::string("\0\1\0\0", 4) + raw(3) + raw(500'000'000) + raw(6) + std::string("world\0", 6) +
         std::string(static_cast<std::size_t>(padding), '\0');
}

TEST(RosMessages, EncodeAPose) {
  EXPECT_EQ(pose_message(3'500'000'000, {1, 2, 3}, Eigen::Quaterniond(0.5, 0.1, 0.2, 0.3)),
            header(6) + raw(1.0) + raw(2.0) + raw(3.0) + raw(0.1) + raw(0.2) + raw(0.3) + raw(0.5));
}

TEST(RosMessages, Wrench) {
  EXPECT_EQ(wrench_message(3'500'000'000, {1, 2, 3}, {4, 5, 6}),
            header(6) + raw(1.0) + raw(2.0) + raw(3.0) + raw(4.0) + raw(5.0) + raw(6.0));
}

TEST(RosMessages, PointCloud) {
  const std::string data = raw(1.0f) + raw(2.0f) + raw(3.0f) + raw(4.0f);
  const std::string zero3(3, '\0'), zero2(2, '\0');
  EXPECT_EQ(point_cloud_message(3'500'000'000, {{"x", kRosFloat32}, {"rgb", kRosFloat32}}, data),
            header(2) + raw(1) + raw(2) + raw(2) +                                           // 1 x 2, fields
                raw(2) + std::string("x\0", 2) + zero2 + raw(0) + "\x07" + zero3 + raw(1) +  // x
                raw(4) + std::string("rgb\0", 4) + raw(4) + "\x07" + zero3 + raw(1) +        // rgb
                std::string("\0", 1) + zero3 + raw(8) + raw(16) + raw(16) + data + "\x01");
}

}  // namespace
}  // namespace remote_touch::ros_messages_test
