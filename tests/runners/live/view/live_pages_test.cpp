// The pages of a live run: one has the hand, and all receive the state of the run.
#include "runners/live/view/live_pages.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/runners/live/view/page_bytes.h"
#include "tests/support/scenes.h"

namespace remote_touch::live_pages_test {
namespace {

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

  const std::shared_ptr<HandPoses> poses_ = std::make_shared<HandPoses>();
  const std::shared_ptr<LiveControls> controls_ = std::make_shared<LiveControls>(
      Experiment::load("fig4.12"), scenes::kernels(), LiveControls::Camera::other);
  LivePages pages_{1000, DevicePlacement(LiveSettings()), scenes::kernels(), poses_, controls_, 0.02};
};

const nlohmann::json kHand = {{"hand", true}}, kWatches = {{"hand", false}};

TEST_F(LivePagesTest, TheFirstPageHasTheHandAndTheOthersWatch) {
  LiveChannel &first = open("a"), &second = open("b");
  EXPECT_EQ(texts(first), std::vector{kHand});
  EXPECT_EQ(texts(second), std::vector{kWatches});
  EXPECT_FALSE(pages_.receive(second, hand_at(0.2)));
  EXPECT_FALSE(pages_.receive(second, change_to(450)));
  EXPECT_FALSE(poses_->take()) << "the hand is the other page's";
  EXPECT_FALSE(controls_->has_changed());
  EXPECT_TRUE(pages_.receive(first, hand_at(0.5))) << "where this page begins to count";
  EXPECT_TRUE(pages_.receive(first, hand_at(0.6)));
  ASSERT_TRUE(poses_->take());
  EXPECT_NEAR(poses_->front().position_W.x(), 0.1, 1e-12);
}

TEST_F(LivePagesTest, APageThatWatchesTakesTheHandOverAndTheOtherWatches) {
  LiveChannel &first = open("a"), &second = open("b"), &third = open("c");
  texts(first), texts(second), texts(third);
  EXPECT_FALSE(pages_.receive(first, hand_request_bytes())) << "it has the hand";
  EXPECT_TRUE(pages_.receive(second, hand_request_bytes()));
  EXPECT_EQ(texts(first), std::vector{kWatches});
  EXPECT_EQ(texts(second), std::vector{kHand});
  EXPECT_TRUE(texts(third).empty());
  EXPECT_FALSE(pages_.receive(first, hand_at(0.3)));
  EXPECT_FALSE(pages_.receive(first, change_to(450)));
  EXPECT_FALSE(poses_->take());
  EXPECT_TRUE(pages_.receive(second, hand_at(0.3)));
  EXPECT_TRUE(pages_.receive(second, change_to(450)));
  EXPECT_TRUE(pages_.receive(first, hand_request_bytes())) << "and back";
  EXPECT_TRUE(first.has_hand());
  EXPECT_FALSE(second.has_hand());
}

// The first page drags the hand with its button down. The second one believes that the hand is elsewhere.
TEST_F(LivePagesTest, ATakeOverStopsTheHandWhereTheRunHasIt) {
  LiveChannel &first = open("a"), &second = open("b");
  EXPECT_TRUE(pages_.receive(first, hand_at(0)));
  EXPECT_TRUE(pages_.receive(first, hand_at(0.4, 1)));
  LiveTick now;
  now.device.position_W = Vec3(0.1, 0.2, 0.3);
  pages_.take(now);
  EXPECT_TRUE(pages_.receive(second, hand_request_bytes()));
  ASSERT_TRUE(poses_->take());
  EXPECT_EQ(poses_->front().position_W, Vec3(0.1, 0.2, 0.3)) << "not on its way to 0.4 m";
  EXPECT_EQ(poses_->front().buttons, 0u);
  EXPECT_TRUE(pages_.receive(second, hand_at(-5)));
  ASSERT_TRUE(poses_->take());
  EXPECT_NEAR((poses_->front().position_W - Vec3(0.1, 0.2, 0.3)).norm(), 0, 1e-12);
  EXPECT_TRUE(pages_.receive(second, hand_at(-4.99)));
  ASSERT_TRUE(poses_->take());
  EXPECT_NEAR((poses_->front().position_W - Vec3(0.11, 0.2, 0.3)).norm(), 0, 1e-12);
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

TEST_F(LivePagesTest, ThePageThatWatchedLongestGetsTheHand) {
  LiveChannel &first = open("a"), &second = open("b"), &third = open("c");
  texts(second), texts(third);
  EXPECT_TRUE(pages_.receive(first, hand_at(0.1, 1)));
  ASSERT_TRUE(poses_->take());
  pages_.close(first);
  ASSERT_TRUE(poses_->take());
  EXPECT_EQ(poses_->front().buttons, 0u) << "nobody holds the button";
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

TEST_F(LivePagesTest, MorePagesThanItsMaximumAreNotOpened) {
  std::vector<LiveChannel*> open_pages;
  for (std::size_t i = 0; i < LivePages::kMax; ++i) {
    EXPECT_FALSE(pages_.is_full("f"));
    open_pages.push_back(&open(std::string(1, static_cast<char>('a' + i))));
  }
  EXPECT_TRUE(pages_.is_full("f"));
  EXPECT_EQ(pages_.open("f"), nullptr);
  pages_.close(*open_pages[2]);
  EXPECT_EQ(texts(open("f")), std::vector{kWatches});
}

// A network that fails for a moment closes no connection.
TEST_F(LivePagesTest, AllPagesConnectAgainBeforeTheirOlderConnectionsAreClosed) {
  const std::vector<std::string> names = {"a", "b", "c", "d"};
  ASSERT_EQ(names.size(), LivePages::kMax);
  std::vector<LiveChannel*> older;
  for (const std::string& name : names) older.push_back(&open(name));
  for (const std::string& name : names) {
    EXPECT_FALSE(pages_.is_full(name));
    EXPECT_EQ(open(name).has_hand(), name == "a");
  }
  EXPECT_EQ(pages_.open("f"), nullptr);
  for (LiveChannel* channel : older) pages_.close(*channel);
  EXPECT_TRUE(pages_.is_full("f"));
}

TEST_F(LivePagesTest, EveryPageGetsChangedParameters) {
  LiveChannel &first = open("a"), &second = open("b");
  texts(first), texts(second);
  EXPECT_TRUE(pages_.receive(first, change_to(450)));
  for (LiveChannel* page : {&first, &second}) {
    const auto told = texts(*page);
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(told[0]["values"][3], 450);
  }
  EXPECT_TRUE(pages_.receive(first, change_to(-1)));
  EXPECT_EQ(texts(first).size(), 1u) << "why it was refused";
  EXPECT_TRUE(texts(second).empty()) << "nothing has changed";
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

}  // namespace
}  // namespace remote_touch::live_pages_test
