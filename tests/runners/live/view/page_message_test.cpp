#include "runners/live/view/page_message.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>
#include <string>

namespace remote_touch::page_message_test {
namespace {

std::string hand(const Vec3& p, const Eigen::Vector4d& wxyz, std::uint32_t buttons = 0) {
  std::string bytes("\1\0\0\0", 4);
  bytes.append(reinterpret_cast<const char*>(&buttons), 4);
  bytes.append(reinterpret_cast<const char*>(p.data()), 24);
  bytes.append(reinterpret_cast<const char*>(wxyz.data()), 32);
  return bytes;
}

std::string acknowledgement(std::uint32_t number) {
  std::string bytes("\2\0\0\0", 4);
  return bytes.append(reinterpret_cast<const char*>(&number), 4);
}

TEST(PageMessage, AHandIsReadWithItsButtons) {
  const auto message = page_message(hand({0.1, -0.2, 3}, {0.6, 0, 0.8, 0}, 5));
  ASSERT_TRUE(message);
  const HandPose pose = std::get<HandPose>(*message);
  EXPECT_EQ(pose.position_W, Vec3(0.1, -0.2, 3));
  EXPECT_NEAR(pose.orientation_W.angularDistance(Eigen::Quaterniond(0.6, 0, 0.8, 0)), 0, 1e-12);
  EXPECT_EQ(pose.buttons, 5u);
}

TEST(PageMessage, AQuaternionThatIsNearlyUnitIsMadeSo) {
  const auto message = page_message(hand(Vec3::Zero(), {1.005, 0, 0, 0}));
  ASSERT_TRUE(message);
  EXPECT_DOUBLE_EQ(std::get<HandPose>(*message).orientation_W.norm(), 1);
}

TEST(PageMessage, AnAcknowledgementIsRead) {
  const auto message = page_message(acknowledgement(4000000000u));
  ASSERT_TRUE(message);
  EXPECT_EQ(std::get<PageAcknowledgement>(*message).number, 4000000000u);
}

TEST(PageMessage, InvalidPosesAreRefused) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(),
                   kInfinity = std::numeric_limits<double>::infinity();
  const Eigen::Vector4d straight(1, 0, 0, 0);
  for (const double wrong : {kNaN, kInfinity, -kInfinity, 10.001, -1e300})
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 p = Vec3::Zero();
      p[axis] = wrong;
      EXPECT_FALSE(page_message(hand(p, straight))) << wrong << " along axis " << axis;
    }
  for (const Eigen::Vector4d& q :
       {Eigen::Vector4d(0, 0, 0, 0), Eigen::Vector4d(kNaN, 0, 0, 0), Eigen::Vector4d(1.02, 0, 0, 0),
        Eigen::Vector4d(0.98, 0, 0, 0), Eigen::Vector4d(1, kInfinity, 0, 0)})
    EXPECT_FALSE(page_message(hand(Vec3::Zero(), q))) << q.transpose();
}

std::string changes(std::uint32_t count, std::size_t there, std::uint32_t padding = 0) {
  std::string bytes("\3\0\0\0", 4);
  bytes.append(reinterpret_cast<const char*>(&count), 4);
  for (std::size_t i = 0; i < there; ++i) {
    const auto parameter = static_cast<std::int32_t>(i) - 1;
    const double value = 0.5 * static_cast<double>(i);
    bytes.append(reinterpret_cast<const char*>(&parameter), 4)
        .append(reinterpret_cast<const char*>(&padding), 4);
    bytes.append(reinterpret_cast<const char*>(&value), 8);
  }
  return bytes;
}

// The reader does not check that a parameter exists: -1 passes.
TEST(PageMessage, UpToFourChangesAreReadTogether) {
  const auto message = page_message(changes(4, 4));
  ASSERT_TRUE(message);
  const auto read = std::get<ParameterChanges>(*message);
  ASSERT_EQ(read.count, 4u);
  EXPECT_EQ(read.list[0].parameter, -1);
  EXPECT_EQ(read.list[3].parameter, 2);
  EXPECT_EQ(read.list[3].value, 1.5);
}

TEST(PageMessage, ChangesThatAreNotThereAreNone) {
  EXPECT_TRUE(page_message(changes(1, 1)));
  EXPECT_FALSE(page_message(changes(0, 0)));
  EXPECT_FALSE(page_message(changes(2, 1)));
  EXPECT_FALSE(page_message(changes(1, 2)));
  EXPECT_FALSE(page_message(changes(5, 5)));
  EXPECT_FALSE(page_message(changes(0x10000001, 1)));
  EXPECT_FALSE(page_message(changes(1, 1, 1)));
}

TEST(PageMessage, OtherLengthsKindsAndPaddingAreRefused) {
  const std::string whole = hand(Vec3::Zero(), {1, 0, 0, 0});
  ASSERT_TRUE(page_message(whole));
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_FALSE(page_message(whole.substr(0, length))) << length;
  EXPECT_FALSE(page_message(whole + "x"));
  EXPECT_FALSE(page_message(acknowledgement(1) + "x"));
  for (std::size_t i = 0; i < 4; ++i) {
    std::string other = whole;
    other[i] = 3;
    EXPECT_FALSE(page_message(other)) << i;
  }
}

// Every message that is accepted as a hand holds a valid pose.
TEST(PageMessage, RandomBytesDoNoHarm) {
  std::mt19937 random(1);
  for (int i = 0; i < 200000; ++i) {
    std::string bytes(random() % 70, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    if (bytes.size() > 3 && i % 2 == 0) bytes.replace(0, 4, std::string("\1\0\0\0", 4));
    const auto message = page_message(bytes);
    if (!message) continue;
    if (const auto* pose = std::get_if<HandPose>(&*message)) {
      EXPECT_LE(pose->position_W.lpNorm<Eigen::Infinity>(), kMaxHandDistance_m);
      EXPECT_NEAR(pose->orientation_W.norm(), 1, 1e-12);
    }
  }
}

}  // namespace
}  // namespace remote_touch::page_message_test
