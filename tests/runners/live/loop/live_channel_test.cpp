#include "runners/live/loop/live_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "tests/doubles/simulated_clock.h"
#include "tests/runners/live/loop/page_bytes.h"
#include "tests/support/scenes.h"

namespace remote_touch::live_channel_test {
namespace {

// The hand does not jump when another page receives it.

Eigen::Quaterniond about_z(double degrees) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, Vec3::UnitZ()));
}

// The hand that the loop reads, and the page that moves it, as in a live run at 1 kHz.
class PageHandTest : public testing::Test {
 protected:
  DeviceReading read_after(int ticks) {
    DeviceReading reading;
    for (int i = 0; i < ticks; ++i) {
      clock_.sleep_s(0.001);
      EXPECT_FALSE(device_.read(reading));
    }
    return reading;
  }
  Vec3 after(int ticks) { return read_after(ticks).position_m; }
  void page_at(double x_m) { hand_.move({Vec3(x_m, 0, 0), about_z(0), 0}); }

  const std::shared_ptr<HandPoses> poses_ = std::make_shared<HandPoses>();
  PageHand hand_{poses_};
  SimulatedClock clock_;
  const DeviceState start_{.position_W = Vec3(0.1, 0.2, 0.3), .orientation_W = about_z(90)};
  BrowserDevice device_{poses_, start_, DevicePlacement(LiveSettings{}), 1000, clock_};
};

TEST_F(PageHandTest, TheFirstPoseOfAPageDoesNotMoveTheHand) {
  hand_.pass_on();
  hand_.move({Vec3(7, 7, 7), about_z(20), 0});
  const DeviceReading first = read_after(1000);
  EXPECT_NEAR((first.position_m - start_.position_W).norm(), 0, 1e-12);
  EXPECT_NEAR(first.orientation.angularDistance(about_z(90)), 0, 1e-7);
  hand_.move({Vec3(7, 7.01, 7), about_z(25), 2});
  const DeviceReading second = read_after(1000);
  EXPECT_NEAR((second.position_m - Vec3(0.1, 0.21, 0.3)).norm(), 0, 1e-9);
  EXPECT_NEAR(second.orientation.angularDistance(about_z(95)), 0, 1e-7);
  EXPECT_EQ(second.buttons, 2u);
}

TEST_F(PageHandTest, PassingOnStopsTheRotationAndReleasesTheButtons) {
  hand_.move({Vec3::Zero(), about_z(0), 0});
  hand_.move({Vec3::Zero(), about_z(90), 3});
  const DeviceReading turning = read_after(50);
  EXPECT_EQ(turning.buttons, 3u);
  EXPECT_GT(turning.orientation.angularDistance(start_.orientation_W), 0.1);
  hand_.pass_on();
  const DeviceReading stopped = read_after(500);
  EXPECT_NEAR(stopped.orientation.angularDistance(turning.orientation), 0, 1e-7);
  EXPECT_EQ(stopped.buttons, 0u);
}

// The pages are limited to 20 m of motion, and the hand begins at 0.1 m.
TEST_F(PageHandTest, NoPoseIsBeyondTheLimitOfPages) {
  page_at(-10), page_at(10);
  EXPECT_NEAR(after(12000).x(), kMaxHandDistance_m, 1e-9);
}

// A hand that presses keeps its depth, so the force does not jump.
TEST_F(PageHandTest, ATakeOverLeavesAHandAtRestWhereItIs) {
  after(1);
  page_at(0), page_at(0.02);
  const Vec3 pressed = after(1000);
  hand_.pass_on();
  page_at(-3);
  for (int i = 0; i < 500; ++i) EXPECT_NEAR((after(1) - pressed).norm(), 0, 1e-12) << i << " ms";
}

// A hand at its greatest speed v overshoots by v / (e w), as a critically damped spring does, and then
// returns.
TEST_F(PageHandTest, ATakeOverStopsAMovingHandWithoutAJump) {
  after(1);
  page_at(0), page_at(1);
  const Vec3 there = after(300);
  hand_.pass_on();
  page_at(-3);
  Vec3 before = there;
  double farthest_m = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 now = after(1);
    EXPECT_LE((now - before).norm(), 0.001 * BrowserDevice::kMaxSpeed_m_per_s + 1e-9);
    farthest_m = std::max(farthest_m, (now - there).norm());
    before = now;
  }
  EXPECT_LT(farthest_m, BrowserDevice::kMaxSpeed_m_per_s /
                            (std::numbers::e * BrowserDevice::kNaturalFrequency_rad_per_s));
  EXPECT_NEAR((before - there).norm(), 0, 1e-9);
}

// The columns of a live run that a page receives.

std::vector<std::string> names_with(const std::optional<SlaveState>& slave) {
  LiveTick tick;
  tick.slave = slave;
  std::vector<std::string> names;
  for (const Column& column : live_columns({tick}, 1000, DevicePlacement({}))) names.push_back(column.name);
  return names;
}

TEST(LiveColumns, HaveTheColumnsOfASlaveAndOneForceOfTheDevice) {
  const auto count = [](const std::vector<std::string>& names, const char* name) {
    return std::count(names.begin(), names.end(), name);
  };
  const std::vector<std::string> with = names_with(SlaveState{}), without = names_with({});
  for (const char* name : {"received_command", "slave_position", "slave_force", "slave_clearance"}) {
    EXPECT_EQ(count(with, name), 1) << name;
    EXPECT_EQ(count(without, name), 0) << name;
  }
  EXPECT_EQ(count(with, "commanded_force"), 1);
  EXPECT_EQ(count(without, "commanded_force"), 0) << "it is the renderer's force";
  EXPECT_EQ(count(with, "device_force"), 1);
  EXPECT_EQ(count(without, "device_force"), 1);
}

// The hand feels the slave here, and the safety gate has reduced its force.
TEST(LiveColumns, TheCommandedForceIsThatBeforeTheGate) {
  LiveTick tick;
  tick.slave = SlaveState{};
  tick.out.force_N = Vec3(0, 20, 0);
  tick.command.force_N = Vec3(0, 0.5, 0);
  tick.written.force_N = Vec3(0, 0.25, 0);
  const std::pair<const char*, double> expected[] = {
      {"force", 20}, {"commanded_force", 0.5}, {"device_force", 0.25}};
  const std::vector<Column> columns = live_columns({tick}, 1000, DevicePlacement({}));
  for (const auto& [name, value_N] : expected) {
    const auto found = std::find_if(columns.begin(), columns.end(),
                                    [name = name](const Column& column) { return column.name == name; });
    ASSERT_NE(found, columns.end()) << name;
    EXPECT_EQ(std::get<std::vector<double>>(found->values)[1], value_N) << name;
  }
}

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
  const auto list = nlohmann::json::parse(columns.bytes)["columns"];
  std::size_t width = 0, hip = 0;
  for (const auto& column : list) {
    if (column["name"] == "hip_position") hip = width;
    width += column["width"].get<std::size_t>();
  }
  const LiveChannel::Message ticks = next();
  EXPECT_FALSE(ticks.is_text);
  ASSERT_EQ(ticks.bytes.size(), 16 + 8 * 2 * width);
  EXPECT_EQ(number_at<std::uint32_t>(ticks.bytes, 0), 1u);
  EXPECT_EQ(number_at<std::uint32_t>(ticks.bytes, 8), 2u);
  EXPECT_EQ(number_at<double>(ticks.bytes, 16), 0.007) << "time is the first column";
  EXPECT_EQ(number_at<double>(ticks.bytes, 24), 0.008);
  EXPECT_EQ(number_at<double>(ticks.bytes, 16 + 8 * (2 * hip + 2)), 7) << "z of the HIP";
  EXPECT_EQ(number_at<double>(ticks.bytes, 16 + 8 * (2 * hip + 5)), 8);
}

// The renderer commands 19 N, and the safety gate lets 5 N pass.
TEST_F(LiveChannelTest, SendsTheForceThatTheDeviceGets) {
  LiveTick limited = tick(1);
  limited.out.force_N = Vec3(0, 19, 0);
  limited.written.force_N = DevicePlacement(placed_).to_device({Vec3(0, 3, 4), Vec3::Zero()}).force_N;
  limited.gate = GateState::engaged;
  limited.since_last_tick_s = 0.25F;
  channel_.open();
  channel_.take(limited);
  const auto list = nlohmann::json::parse(next().bytes)["columns"];
  const std::string ticks = next().bytes;
  std::map<std::string, std::vector<double>> row;
  std::size_t at = 16;
  for (const auto& column : list)
    for (std::size_t i = 0; i < column["width"].get<std::size_t>(); ++i, at += 8)
      row[column["name"].get<std::string>()].push_back(number_at<double>(ticks, at));
  ASSERT_EQ(at, ticks.size());
  EXPECT_EQ(row["force"], (std::vector<double>{0, 19, 0}));
  ASSERT_EQ(row["device_force"].size(), 3u);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(row["device_force"][k], Vec3(0, 3, 4)[static_cast<int>(k)], 1e-12) << "in the world";
  EXPECT_EQ(row["tick_interval"], std::vector<double>{0.25});
  EXPECT_EQ(row["gate"], std::vector<double>{2});
  EXPECT_EQ(list.back()["names"][2], "engaged");
}

TEST_F(LiveChannelTest, AFrameHasItsPointsColoursAndRegions) {
  PointCloud cloud = scenes::random_cloud(500, 0.1, 3);
  cloud.colour.resize(cloud.size(), 0x112233);
  cloud.fixture_radius_m.resize(cloud.size(), 0.004);
  cloud.y[5] = std::numeric_limits<double>::quiet_NaN();
  channel_.take(scenes::frame(cloud, 12));
  channel_.open();
  channel_.take(tick(1));
  next();
  const std::string bytes = next().bytes;
  ASSERT_EQ(number_at<std::uint32_t>(bytes, 0), 2u);
  EXPECT_EQ(number_at<std::int32_t>(bytes, 8), 12);
  const auto count = number_at<std::uint32_t>(bytes, 12);
  ASSERT_EQ(count, 499u) << "one is not measured";
  EXPECT_EQ(number_at<std::uint32_t>(bytes, 16), 3u);
  const double step = number_at<double>(bytes, 24);
  const auto has = [&](const Vec3& p) {
    for (std::size_t i = 0; i < count; ++i) {
      Vec3 shown;
      for (std::size_t axis = 0; axis < 3; ++axis)
        shown[static_cast<int>(axis)] = number_at<double>(bytes, 32 + 8 * axis) +
                                        step * number_at<std::uint16_t>(bytes, 56 + 2 * (3 * i + axis));
      if ((shown - p).lpNorm<Eigen::Infinity>() <= 0.51 * step) return true;
    }
    return false;
  };
  for (std::size_t i = 0; i < cloud.size(); ++i) EXPECT_EQ(has(cloud.point(i)), i != 5) << i;
  const std::size_t colours = 56 + (6 * count + 7) / 8 * 8;
  EXPECT_EQ(bytes.substr(colours, 3), "\x11\x22\x33");
  EXPECT_EQ(number_at<float>(bytes, (colours + 3 * count + 7) / 8 * 8), 0.004f);
}

TEST_F(LiveChannelTest, ALargeFrameIsThinned) {
  channel_.take(
      scenes::frame(scenes::random_cloud(static_cast<int>(2 * LiveChannel::kMaxPoints) + 7, 0.1, 3)));
  channel_.open();
  channel_.take(tick(1));
  next();
  const auto count = number_at<std::uint32_t>(next().bytes, 12);
  EXPECT_LE(count, LiveChannel::kMaxPoints);
  EXPECT_GT(count, LiveChannel::kMaxPoints / 2);
}

// Returns the number of points of a frame message that are within reach_m of `centre`.
std::size_t points_within(const std::string& bytes, const Vec3& centre, double reach_m) {
  std::size_t within = 0;
  for (std::size_t i = 0; i < number_at<std::uint32_t>(bytes, 12); ++i) {
    Vec3 point;
    for (std::size_t axis = 0; axis < 3; ++axis)
      point[static_cast<int>(axis)] =
          number_at<double>(bytes, 32 + 8 * axis) +
          number_at<double>(bytes, 24) * number_at<std::uint16_t>(bytes, 56 + 2 * (3 * i + axis));
    within += (point - centre).norm() <= reach_m ? 1 : 0;
  }
  return within;
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
  constexpr double kRounding_m = 2e-5;  // of sent positions
  const std::string bytes = next().bytes;
  EXPECT_LE(number_at<std::uint32_t>(bytes, 12), LiveChannel::kMaxPoints);
  for (const Vec3& centre : {hip, proxy})
    EXPECT_GE(points_within(bytes, centre, kNear_m + kRounding_m), all_within(centre, kNear_m));
  EXPECT_LT(points_within(bytes, elsewhere, kNear_m), all_within(elsewhere, kNear_m) / 2);
  EXPECT_LT(points_within(bytes, hip, 2 * kNear_m), all_within(hip, 2 * kNear_m)) << "beyond the reach";

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
  EXPECT_GE(points_within(next().bytes, hip, 2 * kNear_m + kRounding_m), all_within(hip, 2 * kNear_m));
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
}

TEST_F(LiveChannelTest, KeepsNoTicksIfNoPageIsOpen) {
  for (std::int64_t i = 0; i < 100; ++i) channel_.take(tick(i));
  channel_.open();
  EXPECT_FALSE(has_next());
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
