// The messages that a page receives from a live run, and what it sends to it.
#include "runners/live/loop/live_view.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/runners/live/loop/page_bytes.h"
#include "tests/support/scenes.h"

namespace remote_touch::live_channel_test {
namespace {

// The messages that a page receives from a live run, and the changes that it can make to the run.

constexpr double kRate_hz = 1000;

template <class T>
T number_at(const std::string& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

LiveTick tick(std::int64_t number) {
  LiveTick tick;
  tick.number = number;
  tick.device.position_W = Vec3(1, 2, static_cast<double>(number));
  return tick;
}

// Returns the numbers of each column, by the columns that were sent before.
std::map<std::string, std::vector<double>> rows_of(const std::string& columns, const std::string& ticks) {
  std::map<std::string, std::vector<double>> rows;
  const std::size_t count = number_at<std::uint32_t>(ticks, 8);
  std::size_t at = 16;
  const nlohmann::json list = nlohmann::json::parse(columns).at("columns");
  for (const auto& column : list)
    for (std::size_t i = 0; i < count * column["width"].get<std::size_t>(); ++i, at += 8)
      rows[column["name"].get<std::string>()].push_back(number_at<double>(ticks, at));
  EXPECT_EQ(at, ticks.size());
  return rows;
}

class LiveChannelTest : public testing::Test {
 protected:
  // Returns the next message except the page's role, which live_view_test.cpp tests.
  bool take_next(LiveChannel::Message& message) {
    while (channel_.next(message))
      if (message.bytes != role_message(PageRole::hand)) return true;
    return false;
  }
  LiveChannel::Message next() {
    LiveChannel::Message message;
    EXPECT_TRUE(take_next(message));
    return message;
  }
  bool has_next() {
    LiveChannel::Message message;
    return take_next(message);
  }
  void acknowledge(std::uint32_t number) { EXPECT_TRUE(channel_.receive(acknowledgement_bytes(number))); }

  const std::shared_ptr<HandPoses> poses_ = std::make_shared<HandPoses>();
  const std::shared_ptr<LiveControls> controls_ = std::make_shared<LiveControls>(
      Experiment::load("fig4.12"), scenes::kernels(), LiveControls::Camera::other);
  LiveSettings placed_ = [] {
    LiveSettings settings;
    settings.device_rotation_deg = Vec3(0, 90, 0);
    return settings;
  }();
  static constexpr double kNear_m = 0.02;
  LiveChannel channel_{kRate_hz,          DevicePlacement(placed_),
                       scenes::kernels(), std::make_shared<PageHand>(poses_),
                       controls_,         kNear_m};
};

TEST_F(LiveChannelTest, SendsTheColumnsAndThenTheTicks) {
  channel_.open();
  channel_.take(tick(7));
  channel_.take(tick(8));
  const LiveChannel::Message columns = next();
  EXPECT_TRUE(columns.is_text);
  const LiveChannel::Message ticks = next();
  EXPECT_FALSE(ticks.is_text);
  EXPECT_EQ(number_at<std::uint32_t>(ticks.bytes, 0), 1u);
  EXPECT_EQ(number_at<std::uint32_t>(ticks.bytes, 8), 2u);
  EXPECT_EQ(number_at<double>(ticks.bytes, 16), 0.007) << "time is the first column";
  auto rows = rows_of(columns.bytes, ticks.bytes);
  EXPECT_EQ(rows["time"], (std::vector<double>{0.007, 0.008}));
  EXPECT_EQ(rows["hip_position"], (std::vector<double>{1, 2, 7, 1, 2, 8}));
}

// The renderer commands 19 N, the hand is to feel 0.5 N of a slave, and the safety gate lets 5 N pass. The
// columns of a slave are sent only if there is one, and so is the commanded force: it is the renderer's.
TEST_F(LiveChannelTest, SendsTheForcesBeforeAndAfterTheGate) {
  LiveTick limited = tick(1);
  limited.out.force_N = Vec3(0, 19, 0);
  limited.command.force_N = Vec3(0, 0.5, 0);
  limited.written.force_N = DevicePlacement(placed_).to_device({Vec3(0, 3, 4), Vec3::Zero()}).force_N;
  limited.gate = GateState::engaged;
  limited.since_last_tick_s = 0.25F;
  for (const bool has_slave : {false, true}) {
    if (has_slave) limited.slave = SlaveState{};
    channel_.open();
    channel_.take(limited);
    const std::string columns = next().bytes;
    auto row = rows_of(columns, next().bytes);
    EXPECT_EQ(row["force"], (std::vector<double>{0, 19, 0}));
    ASSERT_EQ(row["device_force"].size(), 3u);
    EXPECT_TRUE(Vec3(row["device_force"].data()).isApprox(Vec3(0, 3, 4), 1e-12)) << "in the world";
    EXPECT_EQ(row["tick_interval"], std::vector<double>{0.25});
    EXPECT_EQ(row["gate"], std::vector<double>{2});
    EXPECT_EQ(nlohmann::json::parse(columns)["columns"].back()["names"][2], "engaged");
    for (const char* name :
         {"received_command", "slave_position", "slave_force", "slave_clearance", "commanded_force"})
      EXPECT_EQ(row.count(name), has_slave ? 1u : 0u) << name;
    if (has_slave) {
      EXPECT_EQ(row["commanded_force"], (std::vector<double>{0, 0.5, 0}));
    }
    channel_.close();
  }
}

// The message of a frame, as a page reads it.
struct ShownFrame {
  std::int32_t index;
  std::uint32_t flags;
  double step_m;
  std::vector<Vec3> points;
  std::string colours;
  float first_radius_m = 0;

  explicit ShownFrame(const std::string& bytes)
      : index(number_at<std::int32_t>(bytes, 8)),
        flags(number_at<std::uint32_t>(bytes, 16)),
        step_m(number_at<double>(bytes, 24)),
        points(number_at<std::uint32_t>(bytes, 12)) {
    EXPECT_EQ(number_at<std::uint32_t>(bytes, 0), 2u) << "no frame";
    std::size_t at = 56;
    for (Vec3& point : points)
      for (int axis = 0; axis < 3; ++axis, at += 2)
        point[axis] = number_at<double>(bytes, 32 + 8 * static_cast<std::size_t>(axis)) +
                      step_m * number_at<std::uint16_t>(bytes, at);
    at = (at + 7) / 8 * 8;
    if (flags != 3) return;
    colours = bytes.substr(at, 3 * points.size());
    first_radius_m = number_at<float>(bytes, (at + colours.size() + 7) / 8 * 8);
  }
  std::size_t within(const Vec3& centre, double reach_m) const {
    return static_cast<std::size_t>(std::count_if(
        points.begin(), points.end(), [&](const Vec3& p) { return (p - centre).norm() <= reach_m; }));
  }
};

TEST_F(LiveChannelTest, AFrameHasItsPointsColoursAndRegions) {
  PointCloud cloud = scenes::random_cloud(500, 0.1, 3);
  cloud.colour.resize(cloud.size(), 0x112233);
  cloud.fixture_radius_m.resize(cloud.size(), 0.004);
  cloud.y[5] = std::numeric_limits<double>::quiet_NaN();
  channel_.take(scenes::frame(cloud, 12));
  channel_.open();
  channel_.take(tick(1));
  next();
  const ShownFrame frame(next().bytes);
  EXPECT_EQ(frame.index, 12);
  ASSERT_EQ(frame.points.size(), 499u) << "one is not measured";
  EXPECT_EQ(frame.flags, 3u);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    EXPECT_EQ(frame.within(cloud.point(i), 0.9 * frame.step_m) > 0, i != 5) << i;
  EXPECT_EQ(frame.colours.substr(0, 3), "\x11\x22\x33");
  EXPECT_EQ(frame.first_radius_m, 0.004f);
}

// A grid of 800 x 800 points, 1 mm apart, of which every third is sent. About the HIP and about the proxy all
// points within the reach are sent, and the reach grows with the contact radius.
TEST_F(LiveChannelTest, ALargeFrameKeepsAllPointsNearTheHand) {
  PointCloud grid;
  for (int i = 0; i < 800; ++i)
    for (int k = 0; k < 800; ++k) grid.append(Vec3(0.001 * i, 0, 0.001 * k));
  const Vec3 hip(0.2, 0, 0.2), proxy(0.5, 0, 0.5), elsewhere(0.2, 0, 0.6);
  const auto all_within = [&](const Vec3& centre, double reach_m) {
    std::size_t within = 0;
    for (std::size_t i = 0; i < grid.size(); ++i)
      within += (grid.point(i) - centre).norm() < reach_m - 1e-6 ? 1 : 0;
    return within;
  };
  LiveTick now = tick(1);
  now.device.position_W = hip, now.out.proxy_W = proxy;
  channel_.take(scenes::frame(grid));
  channel_.open();
  channel_.take(now);
  next();
  constexpr double kRounding_m = 2e-5;  // largest error of sent positions
  const ShownFrame shown(next().bytes);
  EXPECT_LE(shown.points.size(), LiveChannel::kMaxPoints);
  EXPECT_GT(shown.points.size(), LiveChannel::kMaxPoints / 2);
  for (const Vec3& centre : {hip, proxy})
    EXPECT_GE(shown.within(centre, kNear_m + kRounding_m), all_within(centre, kNear_m));
  EXPECT_LT(shown.within(elsewhere, kNear_m), all_within(elsewhere, kNear_m) / 2);
  EXPECT_LT(shown.within(hip, 2 * kNear_m), all_within(hip, 2 * kNear_m)) << "beyond the reach";

  std::string twice = page_bytes(3, 3);
  for (std::size_t i = 0; i < 3; ++i)
    twice += change_bytes(static_cast<std::int32_t>(i), 2 * controls_->parameters()[i].value);
  ASSERT_EQ(controls_->parameters()[0].name, "renderer.r1_m");
  EXPECT_TRUE(channel_.receive(twice));
  channel_.take(scenes::frame(grid, 1));
  acknowledge(1);
  next();  // the parameters
  next();  // the tick
  acknowledge(2);
  channel_.take(now);
  EXPECT_GE(ShownFrame(next().bytes).within(hip, 2 * kNear_m + kRounding_m), all_within(hip, 2 * kNear_m));
}

TEST_F(LiveChannelTest, APageThatAcknowledgesNothingGetsTwoMessages) {
  channel_.open();
  channel_.take(tick(1));
  next();  // the columns
  next();
  channel_.take(tick(2));
  next();
  channel_.take(tick(3));
  EXPECT_FALSE(has_next());
  acknowledge(1);
  EXPECT_TRUE(has_next());
}

// The page sleeps. The run keeps a bounded number of ticks and one frame for it.
TEST_F(LiveChannelTest, ASlowPageLosesFrames) {
  channel_.open();
  channel_.take(tick(0));
  next(), next();
  for (int i = 1; i <= 20; ++i) channel_.take(scenes::frame(scenes::flat_grid(10), i));
  for (std::int64_t i = 1; i <= 12000; ++i) channel_.take(tick(i));
  acknowledge(1);
  const std::string frame = next().bytes;
  EXPECT_EQ(number_at<std::int32_t>(frame, 8), 20) << "the newest";
  acknowledge(2);
  const std::string ticks = next().bytes;
  EXPECT_EQ(number_at<std::uint32_t>(ticks, 0), 1u);
  EXPECT_LE(number_at<std::uint32_t>(ticks, 8), LiveChannel::kMaxRows);
}

// A camera that is faster than the page does not keep the ticks away from it.
TEST_F(LiveChannelTest, FramesAndTicksTakeTurns) {
  channel_.open();
  channel_.take(tick(0));
  next();
  std::string kinds;
  for (std::uint32_t i = 1; i <= 6; ++i) {
    channel_.take(scenes::frame(scenes::flat_grid(10), static_cast<int>(i)));
    channel_.take(tick(i));
    kinds += std::to_string(number_at<std::uint32_t>(next().bytes, 0));
    acknowledge(i);
  }
  EXPECT_EQ(kinds, "212121");
}

TEST_F(LiveChannelTest, TheNextPageGetsTheColumnsAndTheNewestFrameAgain) {
  channel_.take(scenes::frame(scenes::flat_grid(10), 4));
  for (int page = 0; page < 2; ++page) {
    channel_.open();
    channel_.take(tick(page));
    EXPECT_TRUE(next().is_text);
    EXPECT_EQ(number_at<std::uint32_t>(next().bytes, 0), 2u);
    EXPECT_EQ(number_at<std::uint32_t>(next().bytes, 0), 1u);
    channel_.close();
  }
  channel_.take(tick(5));
  EXPECT_FALSE(has_next());
  channel_.open();
  EXPECT_FALSE(has_next()) << "ticks are not kept while no page is open";
}

TEST_F(LiveChannelTest, AHandGoesToTheLoopAndAllElseIsRefused) {
  channel_.open();
  EXPECT_FALSE(poses_->take());
  EXPECT_FALSE(channel_.receive("hello"));
  EXPECT_FALSE(channel_.receive(acknowledgement_bytes(1))) << "nothing was sent";
  EXPECT_FALSE(channel_.receive(hand_request_bytes())) << "LivePages decides who has the hand";
  EXPECT_TRUE(channel_.receive(hand_bytes({0.1, 0.2, 0.3})));
  ASSERT_TRUE(poses_->take());
  EXPECT_EQ(poses_->front().to.position_W, Vec3(0.1, 0.2, 0.3));
}

// The values and the reason of a refusal come back as JSON, also to the page that is opened next.
TEST_F(LiveChannelTest, ChangesOfParametersGoToTheLoopAndAreAnswered) {
  const auto change = [&](double value) {
    return channel_.receive(page_bytes(3, 1) + change_bytes(3, value));
  };
  const auto answer = [&] {
    const LiveChannel::Message message = next();
    EXPECT_TRUE(message.is_text);
    return nlohmann::json::parse(message.bytes);
  };
  channel_.open();
  channel_.take(tick(1));
  EXPECT_TRUE(change(450));
  EXPECT_TRUE(answer().contains("columns"));
  nlohmann::json now = answer();
  EXPECT_EQ(now["values"][3], 450);
  EXPECT_EQ(now["refused"], "");
  ASSERT_NE(controls_->requested().oldest(), nullptr);
  EXPECT_EQ(controls_->requested().oldest()->list[0].value, 450);
  EXPECT_TRUE(change(-1));
  now = answer();
  EXPECT_EQ(now["values"][3], 450);
  EXPECT_NE(now["refused"].get<std::string>().find("expected 0 to 10000"), std::string::npos) << now;
  channel_.close();
  channel_.open();
  channel_.take(tick(2));
  answer();
  EXPECT_EQ(answer()["values"][3], 450);
}

// The page is closed while its button is down.
TEST_F(LiveChannelTest, ReleasesTheButtonWhenThePageCloses) {
  channel_.open();
  EXPECT_TRUE(channel_.receive(hand_bytes({0.1, 0.2, 0.3}, 1)));
  ASSERT_TRUE(poses_->take());
  EXPECT_EQ(poses_->front().to.buttons, 1u);
  channel_.close();
  ASSERT_TRUE(poses_->take());
  EXPECT_EQ(poses_->front().to.buttons, 0u);
  EXPECT_EQ(poses_->front().to.position_W, Vec3(0.1, 0.2, 0.3));
}

}  // namespace
}  // namespace remote_touch::live_channel_test
