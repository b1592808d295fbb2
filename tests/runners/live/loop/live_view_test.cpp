// The page server of a live run: the requests that it answers, the messages of its pages, and the pages
// together: one has the hand, and all receive the state of the run.
#include "runners/live/loop/live_view.h"

#include <gtest/gtest.h>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/doubles/simulated_clock.h"
#include "tests/runners/live/loop/page_bytes.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::live_view_test {
namespace {

TEST(RequestCheck, OnlyLoopbackNamesWithAnyPortAreAnswered) {
  for (const char* host : {"127.0.0.1:40123", "localhost:40123", "localhost:8000", "127.0.0.1:1",
                           "[::1]:65535", "localhost", "127.0.0.1"})
    EXPECT_TRUE(is_loopback_host(host)) << host;
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

TEST(PageMessage, AHandIsReadWithItsButtonsAndAUnitQuaternion) {
  const auto message = page_message(hand_bytes({0.1, -0.2, 3}, 5, 1.005 * Eigen::Vector4d(0.6, 0, 0.8, 0)));
  ASSERT_TRUE(message);
  const DeviceState pose = std::get<DeviceState>(*message);
  EXPECT_EQ(pose.position_W, Vec3(0.1, -0.2, 3));
  EXPECT_NEAR(pose.orientation_W.angularDistance(Eigen::Quaterniond(0.6, 0, 0.8, 0)), 0, 1e-7);
  EXPECT_DOUBLE_EQ(pose.orientation_W.norm(), 1);
  EXPECT_EQ(pose.buttons, 5u);
}

TEST(PageMessage, AnAcknowledgementAndARequestForTheHandAreRead) {
  const auto acknowledged = page_message(acknowledgement_bytes(4000000000u));
  ASSERT_TRUE(acknowledged);
  EXPECT_EQ(std::get<PageAcknowledgement>(*acknowledged).number, 4000000000u);
  const auto requested = page_message(hand_request_bytes());
  ASSERT_TRUE(requested);
  EXPECT_TRUE(std::holds_alternative<HandRequest>(*requested));
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
  EXPECT_TRUE(page_message(changes(1, 1)));
  for (const std::string& wrong :
       {changes(0, 0), changes(2, 1), changes(1, 2), changes(5, 5), changes(0x10000001, 1), changes(1, 1, 1)})
    EXPECT_FALSE(page_message(wrong));
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

// The pages of a live run: one has the hand, and all receive the state of the run.

std::string hand_at(double x_m, std::uint32_t buttons = 0) {
  return hand_bytes({x_m, 0, 0}, buttons);
}

// A change of parameter 3, the stiffness.
std::string change_to(double value) {
  return page_bytes(3, 1) + change_bytes(3, value);
}

class LivePagesTest : public testing::Test {
 protected:
  // Returns the texts that wait for a page, except the columns, which come first.
  static std::vector<nlohmann::json> texts(LiveChannel& channel) {
    std::vector<nlohmann::json> list;
    for (LiveChannel::Message message; channel.next(message);)
      if (message.is_text && !message.bytes.starts_with("{\"columns\""))
        list.push_back(nlohmann::json::parse(message.bytes));
    return list;
  }
  LiveChannel& open(const std::string& name) {
    LiveChannel* const channel = pages_.open(name);
    EXPECT_NE(channel, nullptr) << name;
    pages_.take(LiveTick());
    return *channel;
  }

  // Returns the hand in the world after so many ticks of the loop, whose rows do not reach the pages.
  DeviceReading hand_after(int ticks) {
    DeviceReading reading;
    for (int i = 0; i < ticks; ++i) {
      clock_.sleep_s(0.001);
      EXPECT_FALSE(device_.read(reading));
    }
    return reading;
  }

  const std::shared_ptr<HandPoses> poses_ = std::make_shared<HandPoses>();
  const std::shared_ptr<LiveControls> controls_ = std::make_shared<LiveControls>(
      Experiment::load("fig4.12"), scenes::kernels(), LiveControls::Camera::other);
  LivePages pages_{1000, DevicePlacement(LiveSettings()), scenes::kernels(), poses_, controls_, 0.02};
  SimulatedClock clock_;
  BrowserDevice device_{poses_, {}, DevicePlacement(LiveSettings()), 1000, clock_};
};

const nlohmann::json kHand = {{"hand", true}}, kWatches = {{"hand", false}};

TEST_F(LivePagesTest, TheFirstPageHasTheHandAndTheOthersWatch) {
  LiveChannel &first = open("a"), &second = open("b");
  EXPECT_EQ(texts(first), std::vector{kHand});
  EXPECT_EQ(texts(second), std::vector{kWatches});
  EXPECT_FALSE(pages_.receive(second, hand_at(0.2)));
  EXPECT_FALSE(pages_.receive(second, change_to(450)));
  EXPECT_EQ(hand_after(500).position_m, Vec3::Zero()) << "the hand is the other page's";
  EXPECT_FALSE(controls_->has_changed());
  EXPECT_TRUE(pages_.receive(first, hand_at(0.5))) << "where this page begins to count";
  EXPECT_TRUE(pages_.receive(first, hand_at(0.6)));
  EXPECT_NEAR(hand_after(500).position_m.x(), 0.1, 1e-9);
}

TEST_F(LivePagesTest, APageThatWatchesTakesTheHandOverAndTheOtherWatches) {
  LiveChannel &first = open("a"), &second = open("b"), &third = open("c");
  texts(first), texts(second), texts(third);
  EXPECT_FALSE(pages_.receive(first, hand_request_bytes())) << "it has the hand";
  EXPECT_TRUE(pages_.receive(second, hand_request_bytes()));
  EXPECT_EQ(texts(first), std::vector{kWatches});
  EXPECT_EQ(texts(second), std::vector{kHand});
  EXPECT_TRUE(texts(third).empty());
  hand_after(1);
  EXPECT_FALSE(pages_.receive(first, hand_at(0.3)));
  EXPECT_FALSE(pages_.receive(first, change_to(450)));
  EXPECT_FALSE(poses_->take());
  EXPECT_TRUE(pages_.receive(second, hand_at(0.3)));
  EXPECT_TRUE(pages_.receive(second, change_to(450)));
  EXPECT_TRUE(pages_.receive(first, hand_request_bytes())) << "and back";
  EXPECT_TRUE(first.has_hand());
  EXPECT_FALSE(second.has_hand());
}

// A stalled disk delays the rows: the pages know only where the hand was 40 ms ago, 40 mm back. The second
// page believes that the hand is elsewhere and turned otherwise. The hand comes to rest where it was at the
// take-over, and its first pose moves it no more than that of the first page did.
TEST_F(LivePagesTest, ATakeOverStopsTheHandWhereItIsEvenIfTheRowsAreLate) {
  LiveChannel &first = open("a"), &second = open("b");
  hand_after(1);
  const Eigen::Vector4d turned(std::cos(0.4), 0, 0, std::sin(0.4));
  EXPECT_TRUE(pages_.receive(first, hand_at(0)));
  EXPECT_TRUE(pages_.receive(first, hand_bytes({1, 0, 0}, 3, turned)));
  LiveTick late;
  late.device.position_W = hand_after(50).position_m;
  pages_.take(late);
  const DeviceReading there = hand_after(40);
  EXPECT_EQ(there.buttons, 3u);
  EXPECT_GT(there.orientation.angularDistance(Eigen::Quaterniond::Identity()), 0.1);
  ASSERT_GT(there.position_m.x(), late.device.position_W.x() + 0.039);
  EXPECT_TRUE(pages_.receive(second, hand_request_bytes()));
  EXPECT_TRUE(pages_.receive(second, hand_at(-5)));
  for (int i = 0; i < 500; ++i)
    EXPECT_NEAR(hand_after(1).position_m.x(), there.position_m.x(), 1e-9) << i << " ms";
  EXPECT_NEAR(hand_after(1).orientation.angularDistance(there.orientation), 0, 1e-7);
  EXPECT_EQ(hand_after(1).buttons, 0u);
  EXPECT_TRUE(pages_.receive(second, hand_bytes({-4.99, 0, 0}, 2, turned)));
  const DeviceReading moved = hand_after(1000);
  EXPECT_NEAR(moved.position_m.x(), there.position_m.x() + 0.01, 1e-9);
  EXPECT_NEAR(moved.orientation.angularDistance(there.orientation), 0.8, 1e-6);
  EXPECT_EQ(moved.buttons, 2u);
}

// Two pages that take the hand from each other, and a network that sends nothing.
TEST_F(LivePagesTest, TakeOversDoNotFillTheQueueOfASlowPage) {
  LiveChannel &first = open("a"), &second = open("b");
  for (int i = 0; i < 1000; ++i) {
    EXPECT_TRUE(pages_.receive(second, hand_request_bytes()));
    EXPECT_TRUE(pages_.receive(first, hand_request_bytes()));
  }
  EXPECT_EQ(texts(first), std::vector{kHand}) << "the newest only";
  EXPECT_EQ(texts(second), std::vector{kWatches});
}

// The pages have shown nothing since these changes: only the newest values, and each refusal, wait for them.
TEST_F(LivePagesTest, ChangesOfParametersDoNotFillTheQueueOfASlowPage) {
  LiveChannel &first = open("a"), &second = open("b");
  texts(first), texts(second);
  for (const double value : {450.0, -1.0, 460.0, 470.0, 480.0}) pages_.receive(first, change_to(value));
  const auto waiting = texts(second);
  ASSERT_EQ(waiting.size(), 1u);
  EXPECT_EQ(waiting[0]["values"][3], 480);
  const auto own = texts(first);
  ASSERT_EQ(own.size(), 2u);
  EXPECT_NE(own[0]["refused"], "");
  EXPECT_EQ(own[1]["values"][3], 480);
}

TEST_F(LivePagesTest, ThePageThatWatchedLongestGetsTheHand) {
  LiveChannel &first = open("a"), &second = open("b"), &third = open("c");
  texts(second), texts(third);
  EXPECT_TRUE(pages_.receive(first, hand_at(0.1, 1)));
  ASSERT_TRUE(poses_->take());
  pages_.close(first);
  ASSERT_TRUE(poses_->take());
  EXPECT_EQ(poses_->front().to.buttons, 0u) << "nobody holds the button";
  EXPECT_EQ(texts(second), std::vector{kHand});
  EXPECT_TRUE(texts(third).empty());
  EXPECT_TRUE(pages_.receive(second, hand_at(0.3)));
  pages_.close(third);
  EXPECT_TRUE(texts(second).empty()) << "it has the hand already";
}

// The network has not reported yet that the older connection is lost.
TEST_F(LivePagesTest, APageThatConnectsAgainKeepsTheHand) {
  LiveChannel &first = open("a"), &watching = open("b");
  texts(watching);
  LiveChannel& again = open("a");
  EXPECT_NE(&again, &first);
  EXPECT_EQ(texts(again), std::vector{kHand});
  EXPECT_TRUE(first.is_over()) << "the server closes the older connection";
  EXPECT_FALSE(pages_.receive(first, hand_at(0.5)));
  pages_.close(first);
  EXPECT_TRUE(texts(watching).empty());
  EXPECT_TRUE(pages_.receive(again, hand_at(0.1)));
}

// A network that fails for a moment closes no connection: all pages connect again before their older
// connections are closed.
TEST_F(LivePagesTest, MorePagesThanItsMaximumAreNotOpened) {
  const std::vector<std::string> names = {"a", "b", "c", "d"};
  ASSERT_EQ(names.size(), LivePages::kMax);
  std::vector<LiveChannel*> older;
  for (const std::string& name : names) {
    EXPECT_FALSE(pages_.is_full("f"));
    older.push_back(&open(name));
  }
  LiveChannel* newest = nullptr;
  for (const std::string& name : names) {
    EXPECT_FALSE(pages_.is_full(name));
    newest = &open(name);
    EXPECT_EQ(newest->has_hand(), name == "a");
  }
  EXPECT_EQ(pages_.open("f"), nullptr);
  for (LiveChannel* channel : older) pages_.close(*channel);
  EXPECT_TRUE(pages_.is_full("f"));
  EXPECT_EQ(pages_.open("f"), nullptr);
  pages_.close(*newest);
  EXPECT_EQ(texts(open("f")), std::vector{kWatches});
}

TEST_F(LivePagesTest, EveryPageReceivesThePresentFaults) {
  LiveChannel& first = open("a");
  texts(first);
  pages_.tell({"no frame for 0.2 s: the last cloud is still rendered", ""});
  const nlohmann::json told = {
      {"trouble", {{"camera", "no frame for 0.2 s: the last cloud is still rendered"}, {"force", ""}}}};
  EXPECT_EQ(texts(first), std::vector{told});
  EXPECT_EQ(texts(open("b")), (std::vector{kWatches, told})) << "a page that comes later, too";
  pages_.tell({"", "\xff is no UTF-8"});
  EXPECT_EQ(texts(first).size(), 1u);
}

// The reason is sent even before the first tick, and to a page that connects, or connects again, before the
// program ends.
TEST_F(LivePagesTest, EveryPageGetsWhyTheRunHasEnded) {
  LiveChannel& first = *pages_.open("a");
  EXPECT_EQ(pages_.ended(), "");
  pages_.end("its duration has elapsed");
  pages_.end("another reason");
  EXPECT_EQ(pages_.ended(), "its duration has elapsed");
  const nlohmann::json told = {{"ended", "its duration has elapsed"}};
  EXPECT_FALSE(first.is_over());
  EXPECT_EQ(texts(first), std::vector{told});
  EXPECT_TRUE(first.is_over()) << "the server closes the connection";
  LiveChannel& late = *pages_.open("b");
  EXPECT_EQ(texts(late), std::vector{told});
  EXPECT_TRUE(late.is_over());
}

TEST(ViewMessages, TheStateSaysWhyThereIsNoChannel) {
  const nlohmann::json running = nlohmann::json::parse(state_message("", true));
  EXPECT_EQ(running, (nlohmann::json{{"protocol", kViewProtocol}, {"ended", ""}, {"full", true}}));
  const nlohmann::json ended = nlohmann::json::parse(state_message("stopped by a signal", false));
  EXPECT_EQ(ended["ended"], "stopped by a signal");
}

// The file that leads a browser to the page of a live run.

namespace fs = std::filesystem;

constexpr const char* kAddress = "http://127.0.0.1:40123/0123456789abcdef0123456789abcdef/";

// A browser in a snap reads no file whose name begins with a dot.
TEST(RedirectPage, IsAFileWithTheAddressThatOnlyTheUserCanRead) {
  const TestFolder folder("redirect");
  const RedirectPage page(kAddress, {folder.path()});
  const auto names = files_in(folder.path());
  ASSERT_EQ(names.size(), 1u);
  EXPECT_EQ(page.file(), (folder / names[0]).string());
  EXPECT_TRUE(names[0].starts_with("remote-touch-live-") && names[0].ends_with(".html")) << names[0];
  EXPECT_EQ(fs::status(page.file()).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_HAS(bytes_of(page.file()), std::string("url=") + kAddress + "\"");
}

TEST(RedirectPage, IsInTheFirstFolderThatAllowsItAndRemovedAtTheEndAlsoAfterAMove) {
  const TestFolder folder("redirect");
  EXPECT_TRUE(RedirectPage(kAddress, {folder / "none"}).file().empty());
  {
    RedirectPage kept;
    kept = RedirectPage(kAddress, {folder / "none", folder.path()});
    EXPECT_EQ(fs::path(kept.file()).parent_path(), folder.path());
    EXPECT_EQ(files_in(folder.path()).size(), 1u) << "moved, not removed";
  }
  EXPECT_TRUE(files_in(folder.path()).empty());
}

}  // namespace
}  // namespace remote_touch::live_view_test
