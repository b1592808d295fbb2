#include "runners/live/view/page_requests.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <string>

#include "tests/runners/live/view/page_bytes.h"
#include "tests/support/test_files.h"

namespace remote_touch::page_requests_test {
namespace {

// The page server answers some requests, and says to the others why it does not.

TEST(RequestCheck, LoopbackNamesWithAnyPortAreAnswered) {
  for (const char* host : {"127.0.0.1:40123", "localhost:40123", "localhost:8000", "127.0.0.1:1",
                           "[::1]:65535", "localhost", "127.0.0.1"})
    EXPECT_TRUE(is_loopback_host(host)) << host;
}

TEST(RequestCheck, OtherNamesAreRefused) {
  for (const char* host :
       {"", "example.org", "example.org:8000", "localhost.example.org", "localhost:8000.example.org",
        "127.0.0.1.example.org:8000", "127.0.0.1:", "localhost:80a0", "localhost:8000;x", "localhost:123456",
        "127.0.0.2:8000", "10.0.0.1:8000", "user@localhost:8000", " localhost", "localhost:8000 "})
    EXPECT_FALSE(is_loopback_host(host)) << host;
}

// Another program on this machine may serve a page, too: its port differs.
TEST(RequestCheck, OnlyThePageOfThisServerOpensAChannel) {
  EXPECT_TRUE(is_own_origin("http://127.0.0.1:40123", "127.0.0.1:40123"));
  EXPECT_TRUE(is_own_origin("http://localhost:8000", "localhost:8000")) << "through ssh -L";
  EXPECT_FALSE(is_own_origin("http://127.0.0.1:40124", "127.0.0.1:40123"));
  EXPECT_FALSE(is_own_origin("http://localhost:40123", "127.0.0.1:40123"));
  EXPECT_FALSE(is_own_origin("http://example.org", "example.org")) << "DNS rebinding";
  EXPECT_FALSE(is_own_origin("https://127.0.0.1:40123", "127.0.0.1:40123"));
  EXPECT_FALSE(is_own_origin("null", "127.0.0.1:40123"));
  EXPECT_FALSE(is_own_origin("", "127.0.0.1:40123"));
  EXPECT_FALSE(is_own_origin("http://127.0.0.1:40123/", "127.0.0.1:40123"));
}

TEST(RequestCheck, EveryRefusalSaysWhatToDo) {
  EXPECT_HAS(refusal_text(403, "40123"), "ssh -L 8000:127.0.0.1:40123 ");
  EXPECT_HAS(refusal_text(404, "40123"), "open the whole address");
  EXPECT_HAS(refusal_text(409, "40123"), "Close one of them");
  EXPECT_HAS(refusal_text(405, "40123"), "Open the address that the terminal prints");
}

TEST(PageMessage, AHandIsReadWithItsButtons) {
  const auto message = page_message(hand_bytes({0.1, -0.2, 3}, 5, {0.6, 0, 0.8, 0}));
  ASSERT_TRUE(message);
  const DeviceState pose = std::get<DeviceState>(*message);
  EXPECT_EQ(pose.position_W, Vec3(0.1, -0.2, 3));
  EXPECT_NEAR(pose.orientation_W.angularDistance(Eigen::Quaterniond(0.6, 0, 0.8, 0)), 0, 1e-12);
  EXPECT_EQ(pose.buttons, 5u);
}

TEST(PageMessage, AQuaternionThatIsNearlyUnitIsMadeSo) {
  const auto message = page_message(hand_bytes(Vec3::Zero(), 0, {1.005, 0, 0, 0}));
  ASSERT_TRUE(message);
  EXPECT_DOUBLE_EQ(std::get<DeviceState>(*message).orientation_W.norm(), 1);
}

TEST(PageMessage, AnAcknowledgementIsRead) {
  const auto message = page_message(acknowledgement_bytes(4000000000u));
  ASSERT_TRUE(message);
  EXPECT_EQ(std::get<PageAcknowledgement>(*message).number, 4000000000u);
}

TEST(PageMessage, ARequestForTheHandIsRead) {
  const auto message = page_message(hand_request_bytes());
  ASSERT_TRUE(message);
  EXPECT_TRUE(std::holds_alternative<HandRequest>(*message));
  EXPECT_FALSE(page_message(page_bytes(4, 1)));
  EXPECT_FALSE(page_message(hand_request_bytes() + std::string(1, '\0')));
}

TEST(PageMessage, InvalidPosesAreRefused) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(),
                   kInfinity = std::numeric_limits<double>::infinity();
  for (const double wrong : {kNaN, kInfinity, -kInfinity, 10.001, -1e300})
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 p = Vec3::Zero();
      p[axis] = wrong;
      EXPECT_FALSE(page_message(hand_bytes(p))) << wrong << " along axis " << axis;
    }
  for (const Eigen::Vector4d& q :
       {Eigen::Vector4d(0, 0, 0, 0), Eigen::Vector4d(kNaN, 0, 0, 0), Eigen::Vector4d(1.02, 0, 0, 0),
        Eigen::Vector4d(0.98, 0, 0, 0), Eigen::Vector4d(1, kInfinity, 0, 0)})
    EXPECT_FALSE(page_message(hand_bytes(Vec3::Zero(), 0, q))) << q.transpose();
}

std::string changes(std::uint32_t count, int there, std::uint32_t padding = 0) {
  std::string bytes = page_bytes(3, count);
  for (int i = 0; i < there; ++i) bytes += change_bytes(i - 1, 0.5 * i, padding);
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
  const std::string whole = hand_bytes(Vec3::Zero());
  ASSERT_TRUE(page_message(whole));
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_FALSE(page_message(whole.substr(0, length))) << length;
  EXPECT_FALSE(page_message(whole + "x"));
  EXPECT_FALSE(page_message(acknowledgement_bytes(1) + "x"));
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
    if (const auto* pose = std::get_if<DeviceState>(&*message)) {
      EXPECT_LE(pose->position_W.lpNorm<Eigen::Infinity>(), kMaxHandDistance_m);
      EXPECT_NEAR(pose->orientation_W.norm(), 1, 1e-12);
    }
  }
}

}  // namespace
}  // namespace remote_touch::page_requests_test
