// Changes of parameters on their way to the haptic loop, and one tick of this loop.
#include "runners/live/loop/servo.h"

#include <gtest/gtest.h>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/doubles/simulated_clock.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::servo_test {
namespace {

Experiment experiment(const std::vector<std::string>& overrides = {}) {
  return Experiment::from_json(R"({
      "scenario": {"name": "camera-scene", "width": 64, "height": 48}, "renderer": {"name": "proxy"},
      "trajectory": {"name": "waypoints"}})",
                               "test", overrides);
}

class LiveControlsTest : public testing::Test {
 protected:
  std::int32_t number(const std::string& name) const {
    const auto& all = controls_.parameters();
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i].name == name) return static_cast<std::int32_t>(i);
    ADD_FAILURE() << name << " is not live";
    return 0;
  }
  std::string change(const std::vector<std::pair<std::string, double>>& values) {
    ParameterChanges changes;
    for (const auto& [name, value] : values) changes.list[changes.count++] = {number(name), value};
    return controls_.change(changes);
  }
  double value(const std::string& name) const {
    return controls_.values()[static_cast<std::size_t>(number(name))];
  }

  LiveControls controls_{experiment(), scenes::kernels(), LiveControls::Camera::simulated};
};

TEST_F(LiveControlsTest, ListsTheRenderersAndThenTheScenarios) {
  std::vector<std::string> names;
  for (const LiveParameter& parameter : controls_.parameters()) names.push_back(parameter.name);
  EXPECT_EQ(names, (std::vector<std::string>{"renderer.r1_m", "renderer.r2_m", "renderer.r3_m",
                                             "renderer.stiffness_N_per_m", "renderer.velocity_estimate",
                                             "scenario.noise_per_m"}));
  const LiveParameter& on = controls_.parameters()[4];
  EXPECT_TRUE(on.is_switch);
  EXPECT_EQ(on.value, 1);
  EXPECT_EQ(on.high, 1);
  const LiveControls with_camera(experiment(), scenes::kernels(), LiveControls::Camera::other);
  EXPECT_EQ(with_camera.parameters().size(), 5u);
  EXPECT_EQ(with_camera.scenario(), nullptr);
  const LiveControls with_changes(
      experiment({R"(changes=[{"time_s": 1, "parameter": "renderer.r3_m", "value": 0.02}])"}),
      scenes::kernels(), LiveControls::Camera::simulated);
  EXPECT_TRUE(with_changes.parameters().empty());
}

TEST_F(LiveControlsTest, OtherChangesAreRefusedWithTheReasonAndChangeNothing) {
  EXPECT_EQ(change({{"renderer.r1_m", 0.2}}), "renderer.r1_m = 0.2: expected below r2_m = 0.00501");
  EXPECT_EQ(value("renderer.r1_m"), 0.00499);
  for (const double wrong : {-1.0, 1e5, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_HAS(change({{"renderer.stiffness_N_per_m", wrong}}), "renderer.stiffness_N_per_m") << wrong;
  EXPECT_HAS(change({{"renderer.velocity_estimate", 0.5}}), "renderer.velocity_estimate");
  ParameterChanges none;
  none.list[0] = {6, 1}, none.count = 1;
  EXPECT_EQ(controls_.change(none), "there is no live parameter 6");
  none.list[0].parameter = -1;
  EXPECT_EQ(controls_.change(none), "there is no live parameter -1");
  EXPECT_EQ(controls_.requested().oldest(), nullptr);
  controls_.limit_stiffness();  // the device is soft
  EXPECT_HAS(change({{"renderer.stiffness_N_per_m", 601}}), "no greater stiffness");
  EXPECT_EQ(change({{"renderer.stiffness_N_per_m", 300}}), "");
  EXPECT_EQ(change({{"renderer.stiffness_N_per_m", 600}}), "");
}

// Each change is checked together with those before it.
TEST_F(LiveControlsTest, ChangesAddUp) {
  EXPECT_EQ(change({{"renderer.r3_m", 0.03}}), "");
  EXPECT_EQ(change({{"renderer.r2_m", 0.02}}), "");
  EXPECT_EQ(change({{"renderer.r1_m", 0.0199}}), "");
  EXPECT_EQ(change({{"renderer.r3_m", 0.01}}), "renderer.r2_m = 0.02: expected below r3_m = 0.01");
  EXPECT_EQ(change({{"renderer.velocity_estimate", 0}}), "");
}

TEST_F(LiveControlsTest, ChangesAreLimitedIfTheLoopDoesNotReadThem) {
  int taken = 0;
  while (taken < 1000 && change({{"renderer.r3_m", 0.01 + 1e-5 * taken}}).empty()) ++taken;
  EXPECT_EQ(taken, 64);
  EXPECT_HAS(change({{"renderer.r3_m", 0.02}}), "not yet applied");
  EXPECT_NE(value("renderer.r3_m"), 0.02);
}

// The scenario's frames are those of the experiment with that noise. A scenario without noise has one frame,
// which is repeated. A camera may still request a later one.
TEST_F(LiveControlsTest, NoiseIsThatOfTheNextFrameAlsoSwitchedOffAndOnAgain) {
  const auto scenario = controls_.scenario();
  const PointCloud before = scenario->cloud(40);
  const auto noisy = experiment({"scenario.noise_per_m=0.02"}).build_scenario(scenes::kernels())->cloud(40);
  EXPECT_NE(before.z, noisy.z);
  EXPECT_EQ(change({{"scenario.noise_per_m", 0.02}}), "");
  EXPECT_EQ(scenario->cloud(40).z, noisy.z);
  EXPECT_EQ(scenario->cloud(40).y, noisy.y);
  EXPECT_EQ(change({{"scenario.noise_per_m", 0}}), "");
  const PointCloud clean = scenario->cloud(40);
  EXPECT_EQ(clean.z, scenario->cloud(41).z);
  EXPECT_NE(clean.z, before.z);
  EXPECT_EQ(change({{"scenario.noise_per_m", controls_.parameters()[5].value}}), "");
  EXPECT_EQ(scenario->cloud(40).z, before.z);
}

// The tick of the live loop alone, with a scripted device, on a simulated clock.

constexpr double kRate_hz = 1000, kStall_s = 0.01, kTick_s = 1e-3;

// Runs a tick and pauses for a millisecond, again and again, until it is stopped or has run max_ticks.
class ScriptedDevice final : public HapticDevice {
 public:
  using HapticDevice::HapticDevice;

  std::function<DeviceFault()> on_read, on_write;
  Vec3 position_m = Vec3::Zero();
  int max_ticks = 100;
  int rearmed = 0;
  std::vector<std::int64_t> released_ms;
  std::vector<double> written_N;

  void run(const DeviceTick& tick) override {
    for (int i = 0; i < max_ticks && tick(); ++i) clock().sleep_s(kTick_s);
  }
  DeviceFault read(DeviceReading& reading) noexcept override {
    const DeviceFault fault = on_read ? on_read() : DeviceFault{};
    if (!fault) reading.position_m = position_m;
    return fault;
  }
  DeviceFault write(const Wrench& wrench) noexcept override {
    written_N.push_back(wrench.force_N.x());
    return on_write ? on_write() : DeviceFault{};
  }
  void release() noexcept override { released_ms.push_back(clock().now_ns() / ms(1)); }
  bool rearm() noexcept override {
    ++rearmed;
    return true;
  }
};

class ScriptedRenderer final : public Renderer {
 public:
  std::function<void(int)> on_step;  // argument: number of earlier steps
  Vec3 force_N = Vec3::Zero();
  int steps = 0;

  void on_frame(const Frame&) override {}
  RenderOutput step(const DeviceState&, double) override {
    if (on_step) on_step(steps);
    ++steps;
    RenderOutput out;
    out.force_N = force_N;
    return out;
  }
};

class ServoTest : public testing::Test {
 protected:
  void run() {
    servo_ = std::make_unique<Servo>(ServoLinks{device_, renderer_, frames_, rows_, clock_, stop_, nullptr},
                                     DevicePlacement({}), limits_, kRate_hz, clock_.now_ns(), kStall_s);
    Heartbeat& heartbeat = servo_->heartbeat();
    const int watch =
        clock_.every(heartbeat.period_s(), clock_.now_s(), [&] { heartbeat.check(clock_.now_ns()); });
    device_.run([this] { return servo_->tick(); });
    clock_.sleep_s(0.05);
    clock_.cancel(watch);
  }
  // Called before the n-th reading ends.
  void in_read(int number, std::function<DeviceFault()> what) {
    device_.on_read = [number, what = std::move(what), calls = 0]() mutable {
      return ++calls == number ? what() : DeviceFault{};
    };
  }
  DeviceFault hang(double time_s) {
    clock_.sleep_s(time_s);
    return {};
  }
  void send_frame(double sensed_s) {
    LiveFrame& frame = frames_.back();
    frame.frame.captured_s = frame.sensed_s = sensed_s;
    frame.ready_s = clock_.now_s();
    frame.frame.index = 0;
    frames_.publish();
  }
  std::vector<LiveTick> rows() {
    std::vector<LiveTick> rows;
    for (; const LiveTick* row = rows_.oldest(); rows_.pop()) rows.push_back(*row);
    return rows;
  }
  SimulatedClock clock_;
  ScriptedDevice device_{clock_};
  ScriptedRenderer renderer_;
  SafetyLimits limits_;
  TripleBuffer<LiveFrame> frames_;
  Ring<LiveTick> rows_{1 << 10};
  std::atomic<bool> stop_ = false;
  std::unique_ptr<Servo> servo_;
};

using Numbers = std::vector<std::int64_t>;

// A recording of such a run could not be replayed as the same run.
TEST_F(ServoTest, ATickThatHungWhileTheDeviceWasReadIsNotBeforeTheFrameItTakes) {
  device_.max_ticks = 5;
  in_read(3, [&] {
    hang(0.030);
    send_frame(clock_.now_s());
    return DeviceFault{};
  });
  run();
  Numbers numbers;
  for (const LiveTick& row : rows()) numbers.push_back(row.number);
  EXPECT_EQ(numbers, (Numbers{0, 1, 32, 33, 34}));
}

TEST_F(ServoTest, RecordsTheTimesOfATick) {
  device_.max_ticks = 3;
  in_read(2, [&] {
    send_frame(0.25e-3);
    return hang(0.5e-3);
  });
  renderer_.on_step = [&](int) { clock_.sleep_s(0.125e-3); };
  run();
  const std::vector<LiveTick> ticks = rows();
  ASSERT_EQ(ticks.size(), 3u);
  EXPECT_EQ(ticks[0].since_last_tick_s, 0);
  EXPECT_FLOAT_EQ(ticks[1].since_last_tick_s, 1.125e-3f);
  EXPECT_FLOAT_EQ(ticks[2].since_last_tick_s, 1.625e-3f);
  EXPECT_FLOAT_EQ(ticks[1].step_s, 0.125e-3f);
  EXPECT_EQ(ticks[1].taken, 0);
  EXPECT_FLOAT_EQ(ticks[1].waited_s, 0.5e-3f);
  EXPECT_FLOAT_EQ(ticks[1].latency_s, 1.5e-3f);  // sensed at 0.25 ms, written at 1.75
  EXPECT_EQ(ticks[2].taken, -1);
}

TEST_F(ServoTest, AnEndIsNoStall) {
  in_read(50, [&] {
    stop_ = true;
    return DeviceFault{};
  });
  run();
  EXPECT_EQ(servo_->heartbeat().stalls(), 0);
  EXPECT_EQ(device_.released_ms, (Numbers{50}));
}

TEST_F(ServoTest, ARefusedForceDoesNotCountAsWrittenAndItsDeviceIsNotHeldAgain) {
  renderer_.force_N = Vec3(0.1, 0, 0);
  device_.on_write = [&, calls = 0]() mutable {
    if (++calls != 3) return DeviceFault{};
    hang(0.060);
    return DeviceFault{"refused"};
  };
  run();
  EXPECT_TRUE(servo_->has_failed());
  EXPECT_TRUE(servo_->is_latched());
  EXPECT_STREQ(servo_->trouble(), "refused");
  EXPECT_EQ(device_.rearmed, 0);
  const std::vector<LiveTick> ticks = rows();
  ASSERT_GE(ticks.size(), 3u);
  EXPECT_GT(ticks[1].written.force_N.norm(), 0);
  EXPECT_EQ(ticks[2].written.force_N.norm(), 0);
  EXPECT_NE(ticks[1].gate, GateState::latched);
  EXPECT_EQ(ticks[2].gate, GateState::latched);
}

// The fault is recognised by its text, not by the text's address, because an adapter in a library of its own
// has its own copy.
TEST_F(ServoTest, ADeviceThatSaysItWasReleasedHasNotFailed) {
  const std::string said = kReleased.what;
  in_read(3, [&] { return DeviceFault{said.c_str()}; });
  run();
  EXPECT_FALSE(servo_->has_failed());
  EXPECT_FALSE(servo_->is_latched());
  EXPECT_EQ(rows().size(), 100u);
}

// A hand whose reading failed is nowhere, and later where it was read last: never at the device's origin.
TEST_F(ServoTest, AFailedReadDoesNotMoveTheHandToTheOrigin) {
  device_.position_m = Vec3(0.1, 0.2, 0.3);
  device_.max_ticks = 8;
  device_.on_read = [calls = 0]() mutable {
    ++calls;
    return calls == 1 || calls >= 5 ? kReleased : calls == 4 ? DeviceFault{"broken"} : DeviceFault{};
  };
  run();
  const std::vector<LiveTick> ticks = rows();
  ASSERT_EQ(ticks.size(), 8u);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const bool is_known = i != 0 && i != 3;  // before the first reading, and when it failed
    const Vec3& at_W = ticks[i].device.position_W;
    EXPECT_TRUE(is_known ? at_W == device_.position_m : !at_W.allFinite()) << i;
    EXPECT_EQ(ticks[i].gate == GateState::latched, i >= 3) << i;
  }
}

TEST_F(ServoTest, AnExceptionReleasesTheDevice) {
  const std::pair<std::function<void()>, const char*> exceptions[] = {
      {[] { throw std::runtime_error("a renderer breaks its contract"); },
       "an exception in the haptic loop: a renderer breaks its contract"},
      {[] { throw std::bad_alloc(); }, "out of memory in the haptic loop"},
      {[] { throw 7; }, "an exception in the haptic loop"}};
  for (const auto& [throw_it, trouble] : exceptions) {
    SCOPED_TRACE(trouble);
    device_.released_ms.clear(), renderer_.steps = 0;
    renderer_.on_step = [&](int before) {
      if (before == 50) throw_it();
    };
    const std::int64_t begin_ms = clock_.now_ns() / ms(1);
    run();
    EXPECT_EQ(renderer_.steps, 50);
    EXPECT_TRUE(servo_->has_failed());
    EXPECT_STREQ(servo_->trouble(), trouble);
    EXPECT_EQ(device_.released_ms, (Numbers{begin_ms + 50}));
  }
}

TEST_F(ServoTest, KeepsTheStartOfALongReasonAndNoOtherOne) {
  renderer_.on_step = [calls = 0](int) mutable {
    throw std::runtime_error(std::string(10'000, ++calls == 1 ? 'x' : 'y'));
  };
  run();
  const std::string trouble = servo_->trouble();
  EXPECT_EQ(trouble.find("an exception in the haptic loop: xxx"), 0u) << trouble;
  EXPECT_GT(trouble.size(), 200u);
  EXPECT_LT(trouble.size(), 10'000u);
  EXPECT_FALSE(servo_->tick()) << "an adapter that calls once more";
  EXPECT_EQ(servo_->trouble(), trouble);
}

// The hang is shorter than the 20 ms after which a command is too old, but the device was released.
TEST_F(ServoTest, AShortHangBeginsTheForceAnew) {
  limits_.ramp_s = 0;
  renderer_.on_step = [&](int before) { renderer_.force_N.x() = before < 2 ? 0 : 2; };
  in_read(8, [&] { return hang(0.015); });
  device_.max_ticks = 11;
  run();
  EXPECT_EQ(device_.rearmed, 1);
  EXPECT_EQ(device_.written_N, (std::vector<double>{0, 0, 1, 2, 2, 2, 2, 2, 0, 0, 0}));
}

// A command that took longer than 4 ms to render is too old. The force ends in the tick that writes it, and
// begins anew only when the command is small.
TEST_F(ServoTest, AnOldCommandIsNotWritten) {
  limits_.ramp_s = 0, limits_.max_command_age_s = 0.004;
  renderer_.on_step = [&](int before) {
    renderer_.force_N.x() = before < 2 ? 0 : before < 9 ? 2 : 0.25;
    if (before == 5) clock_.sleep_s(0.005);
  };
  device_.max_ticks = 11;
  run();
  EXPECT_EQ(device_.written_N, (std::vector<double>{0, 0, 1, 2, 2, 0, 0, 0, 0, 0.25, 0.25}));
}

}  // namespace
}  // namespace remote_touch::servo_test
