// The contract of every adapter of a vendor's library, and what each of them does beyond it. Each is tested
// with its test double.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/doubles/vendor_devices.h"
#include "tests/support/test_files.h"

namespace remote_touch::vendor_devices_test {
namespace {

using State = DeviceDouble::State;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const Wrench kPush = {Vec3(1, 0, 0), Vec3::Zero()};

class HapticDeviceContract : public testing::TestWithParam<const VendorDevice*> {
 protected:
  const VendorDevice& vendor() const { return *GetParam(); }
  std::unique_ptr<HapticDevice> open() { return vendor().open("", clock_); }

  std::array<double, 3> in_vendor_axes(const Vec3& v) const {
    const Vec3 turned = vendor().axes * v;
    return {turned.x(), turned.y(), turned.z()};
  }
  std::array<double, 3> in_vendor_lengths(const Vec3& v) const {
    return in_vendor_axes(v * vendor().length_per_m);
  }
  std::array<double, 9> turn_in_vendor_axes(const Eigen::Matrix3d& turn) const {
    Eigen::Matrix<double, 3, 3, Eigen::RowMajor> turned = vendor().axes * turn * vendor().axes.transpose();
    std::array<double, 9> rows{};
    std::copy(turned.data(), turned.data() + 9, rows.begin());
    return rows;
  }
  SimulatedClock clock_;
  DoubleInstalled double_{vendor(), &clock_};
};

const Eigen::Matrix3d kRotation = Eigen::AngleAxisd(0.7, Vec3(1, -2, 3).normalized()).toRotationMatrix();

TEST_P(HapticDeviceContract, StateIsInOurAxesAndUnits) {
  const Vec3 position(0.01, -0.02, 0.03), velocity(0.4, 0.5, -0.6), turning(1, -2, 3);
  double_->set([&](State& state) {
    state.position = in_vendor_lengths(position), state.velocity = in_vendor_lengths(velocity);
    state.turning = in_vendor_axes(turning), state.rotation = turn_in_vendor_axes(kRotation);
    state.buttons = 5;
  });
  const auto device = open();
  const auto [reading, fault, written] = read_once(*device);
  ASSERT_FALSE(fault) << fault.what;
  EXPECT_TRUE(reading.position_m.isApprox(position, 1e-12)) << reading.position_m.transpose();
  EXPECT_TRUE(reading.velocity_m_per_s.isApprox(velocity, 1e-12)) << reading.velocity_m_per_s.transpose();
  EXPECT_TRUE(reading.angular_velocity_rad_per_s.isApprox(turning, 1e-12))
      << reading.angular_velocity_rad_per_s.transpose();
  EXPECT_TRUE(reading.orientation.toRotationMatrix().isApprox(kRotation, 1e-12));
  EXPECT_EQ(reading.buttons, vendor().has_buttons ? 5u : 0u);
}

TEST_P(HapticDeviceContract, ForcesAndTorquesArriveAlongTheVendorsAxes) {
  const auto device = open();
  run_ticks(*device, 6, [&](int i) {
    const Vec3 unit = Vec3::Unit(i % 3);
    const TickOnce tick(*device, i < 3 ? Wrench{unit, Vec3::Zero()} : Wrench{Vec3::Zero(), unit});
    EXPECT_FALSE(tick.read || tick.written);
  });
  const auto arrived = sent_forces(*double_);
  ASSERT_EQ(arrived.size(), 6u);
  for (int i = 0; i < 6; ++i) {
    Eigen::Matrix<double, 6, 1> expected = Eigen::Matrix<double, 6, 1>::Zero();
    expected.segment<3>(i < 3 ? 0 : 3) = vendor().axes.col(i % 3) * (i < 3 ? 1 : vendor().torque_per_Nm);
    const Eigen::Map<const Eigen::Matrix<double, 6, 1>> actual(arrived[static_cast<std::size_t>(i)].data());
    EXPECT_EQ(actual, expected) << "axis " << i;
  }
}

// Entact's library does not report which motors there are.
class TellsOfMotors : public HapticDeviceContract {};

TEST_P(TellsOfMotors, ADeviceWithoutTorqueMotorsGetsNoTorque) {
  double_->set(&State::actuated_axes, 3);
  const auto device = open();
  EXPECT_EQ(device->traits().sensed_axes, 6);
  EXPECT_EQ(device->traits().actuated_axes, 3);
  run_ticks(*device, 1, [&](int) { device->write({Vec3(1, 0, 0), Vec3(1, 1, 1)}); });
  const auto arrived = sent_forces(*double_);
  ASSERT_EQ(arrived.size(), 1u);
  EXPECT_TRUE(Vec3(arrived[0].data() + 3).isZero(0));
}

TEST_P(HapticDeviceContract, RunsAThousandTicksASecondUntilItIsStopped) {
  const auto device = open();
  std::vector<std::int64_t> at_us;
  run_ticks(*device, 300, [&](int) { at_us.push_back(clock_.now_ns() / 1000); });
  ASSERT_EQ(at_us.size(), 300u);
  for (std::size_t i = 0; i < at_us.size(); ++i)
    EXPECT_EQ(at_us[i] - at_us[0], 1000 * static_cast<std::int64_t>(i));
  clock_.sleep_s(1);
  EXPECT_EQ(at_us.size(), 300u);
}

TEST_P(HapticDeviceContract, AbsentLibraryIsNamedWithTheVariable) {
  expect_absent_library_is_named(vendor(), [&] { open(); });
}

TEST_P(HapticDeviceContract, AnotherLibraryIsRefused) {
  setenv(vendor().variable, "libm.so.6", 1);
  const std::string message = refusal([&] { open(); });
  EXPECT_HAS(message, "libm.so.6: has no function ");
  EXPECT_HAS(message, vendor().variable);
}

TEST_P(HapticDeviceContract, AbsentDeviceIsRefused) {
  double_->set(&State::devices, 0);
  EXPECT_HAS(refusal([&] { open(); }), ": expected ");
  EXPECT_FALSE(double_->is_open());
}

TEST_P(HapticDeviceContract, IsAvailableWithItsLibrary) {
  const Availability availability = vendor().availability();
  EXPECT_TRUE(availability.compiled_in);
  EXPECT_NE(availability.found, !availability.was_searched) << "found, or only opening tells";
  EXPECT_HAS(availability.detail, vendor().double_file);
}

TEST_P(HapticDeviceContract, ADeviceThatIsUnpluggedWhileItRunsIsAFault) {
  const auto device = open();
  int good = 0, reading_faults = 0, writing_faults = 0;
  DeviceFault last;
  run_ticks(*device, 40, [&](int i) {
    if (i == 20) double_->set(&State::is_unplugged, true);
    const TickOnce tick(*device, kPush);
    good += !tick.read && !tick.written;
    reading_faults += bool(tick.read), writing_faults += bool(tick.written);
    if (tick.read) last = tick.read;
  });
  EXPECT_GE(good, 20);
  EXPECT_GE(reading_faults, 18);
  EXPECT_EQ(last.code, vendor().unplugged_code) << last.what;
  EXPECT_EQ(writing_faults, vendor().drives_itself ? 0 : 20);
}

TEST_P(HapticDeviceContract, NanOrInfinityInAReadingIsAFault) {
  const auto device = open();
  const auto fault_with = [&](auto change) {
    double_->set([](State& state) { state = {}; });
    double_->set(change);
    return read_once(*device).read;
  };
  EXPECT_FALSE(fault_with([](State&) {}));
  EXPECT_TRUE(fault_with([](State& state) { state.position[1] = kNaN; }));
  EXPECT_TRUE(fault_with([](State& state) { state.position[0] = INFINITY; }));
  EXPECT_TRUE(fault_with([](State& state) { state.velocity[2] = kNaN; }));
  EXPECT_TRUE(fault_with([](State& state) { state.turning[0] = kNaN; }));
  EXPECT_TRUE(fault_with([](State& state) { state.rotation[4] = kNaN; }));
  EXPECT_FALSE(fault_with([](State&) {}));
}

TEST_P(HapticDeviceContract, ATurnThatIsNoRotationIsAFault) {
  const auto device = open();
  for (const std::array<double, 9>& turn :
       {std::array<double, 9>{}, std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, -1},
        std::array<double, 9>{1, 0.1, 0, 0, 1, 0, 0, 0, 1}}) {
    double_->set(&State::rotation, turn);
    const DeviceFault fault = read_once(*device).read;
    ASSERT_TRUE(fault);
    EXPECT_HAS(fault.what, "not a rotation");
  }
}

TEST_P(HapticDeviceContract, ANanForceIsNotSent) {
  const auto device = open();
  run_ticks(*device, 2, [&](int i) {
    EXPECT_TRUE(TickOnce(*device, i == 0 ? Wrench{Vec3(kNaN, 0, 0), Vec3::Zero()}
                                         : Wrench{Vec3::Zero(), Vec3(0, 0, kNaN)})
                    .written);
  });
  EXPECT_TRUE(sent_forces(*double_).empty());
}

TEST_P(HapticDeviceContract, ErrorsOfTheVendorArePassedOn) {
  const auto device = open();
  DeviceFault read, written, after;
  run_ticks(*device, 6, [&](int i) {
    double_->set(&State::reading_error, i == 2 ? vendor().error : 0);
    double_->set(&State::writing_error, i == 4 ? vendor().error : 0);
    const TickOnce tick(*device, kPush);
    if (i == 2) read = tick.read;
    if (i == 4) written = tick.written;
    if (i == 5) after = tick.read;
  });
  ASSERT_TRUE(read);
  EXPECT_EQ(read.code, vendor().fault_code) << read.what;
  // OpenHaptics reports an error of a force in the next frame.
  const DeviceFault& of_force = vendor().drives_itself ? after : written;
  ASSERT_TRUE(of_force);
  EXPECT_EQ(of_force.code, vendor().fault_code) << of_force.what;
}

INSTANTIATE_TEST_SUITE_P(Vendors, HapticDeviceContract, kVendors, vendor_name);
INSTANTIATE_TEST_SUITE_P(Vendors, TellsOfMotors, testing::Values(&kForceDimension, &kOpenHaptics),
                         vendor_name);

// The things that single adapters do beyond the contract.

template <const VendorDevice& vendor>
class AdapterTest : public testing::Test {
 protected:
  SimulatedClock clock_;
  DoubleInstalled double_{vendor, &clock_};
};

using ForceDimensionTest = AdapterTest<kForceDimension>;
using EntactTest = AdapterTest<kEntact>;
using OpenHapticsTest = AdapterTest<kOpenHaptics>;

TEST_F(ForceDimensionTest, DevicesAreNumbered) {
  const auto refused = [&](const std::string& address) {
    return refusal([&] { open_force_dimension(address, clock_); });
  };
  for (const char* address : {"x", "-1", "0x", "1.5", "128", " 0"})
    EXPECT_HAS(refused(address),
               std::string("fd:") + address + ": not the number of a device: expected 0 for the first");
  EXPECT_HAS(refused("1"), "fd:1: no such device: expected 0 to 0");
  double_->set(&State::devices, 2);
  EXPECT_NO_THROW(open_force_dimension("1", clock_));
  EXPECT_EQ(force_dimension_availability().detail, std::string(kForceDimension.double_file) + ": 2 devices");
  double_->set(&State::switching_error, 20);
  EXPECT_HAS(refused("0"), "fd:0: cannot be opened (the double's text): expected ");
  double_->set(&State::devices, 0);
  EXPECT_HAS(refused(""), "fd:0: no device is connected: expected ");
  EXPECT_FALSE(force_dimension_availability().found);
  EXPECT_HAS(force_dimension_availability().detail, "no device is connected");
}

TEST_F(ForceDimensionTest, LimitsThatAreNotSetAreUnknown) {
  double_->set([](State& state) { state.max_force = -1, state.max_torque = -1; });
  EXPECT_EQ(open_force_dimension("", clock_)->traits().max_force_N, 0);
  EXPECT_EQ(open_force_dimension("", clock_)->traits().max_torque_Nm, 0);
  double_->set([](State& state) { state.max_force = 12, state.max_torque = 0.4; });
  const auto device = open_force_dimension("", clock_);
  EXPECT_EQ(device->traits().name, "double.7");
  EXPECT_EQ(device->traits().max_force_N, 12);
  EXPECT_EQ(device->traits().max_torque_Nm, 0.4);
  EXPECT_EQ(device->traits().tick_rate_hz, 1000);
}

// A device without a wrist does not turn, whatever its library reports.
TEST_F(ForceDimensionTest, DoesNotTurnIfItHasNoWrist) {
  double_->set([](State& state) {
    state.sensed_axes = state.actuated_axes = 3;
    state.rotation = {};
  });
  const auto device = open_force_dimension("", clock_);
  const auto [reading, fault, written] = read_once(*device);
  EXPECT_FALSE(fault);
  EXPECT_EQ(device->traits().sensed_axes, 3);
  EXPECT_TRUE(reading.orientation.isApprox(Eigen::Quaterniond::Identity()));
}

TEST_F(EntactTest, DevicesHaveAddresses) {
  EXPECT_NO_THROW(open_entact("192.168.1.144", clock_));
  EXPECT_HAS(refusal([&] { open_entact("192.168.1.145", clock_); }),
             "entact:192.168.1.145: no device answers: expected ");
  EXPECT_EQ(open_entact("", clock_)->traits().name, "Double W5D");
}

TEST_F(EntactTest, IsHomedIfItIsNot) {
  double_->set([](State& state) { state.is_homed = false, state.failing_homings = 5; });
  EXPECT_NO_THROW(open_entact("", clock_));
  double_->set([](State& state) { state.is_homed = false, state.failing_homings = 1000; });
  EXPECT_HAS(refusal([&] { open_entact("", clock_); }),
             "entact: cannot be homed; hold the handle in its calibration position");
  EXPECT_FALSE(double_->is_open());
}

TEST_F(EntactTest, AReadingIsOneTickOld) {
  const auto device = open_entact("", clock_);
  run_ticks(*device, 10, [&](int i) {
    double_->set([&](State& state) { state.position = {0, 1000.0 * i, 0}; });
    const TickOnce tick(*device);
    EXPECT_FALSE(tick.read);
    EXPECT_EQ(tick.reading.position_m.x(), std::max(i - 1, 0));
  });
}

// No force remains after a tick without one, nor after the last tick.
TEST_F(OpenHapticsTest, SendsZeroForceAfterATickWithoutOneAndAfterTheLast) {
  const auto device = open_open_haptics("", clock_);
  std::array<double, 6> sent_in_between{1};
  int ticks = 0;
  device->run([&] {
    if (ticks == 2) sent_in_between = double_->now().sent;
    if (ticks != 1) device->write({Vec3(1, 0, 0), Vec3::Zero()});
    return ++ticks < 4;
  });
  EXPECT_EQ(sent_in_between, (std::array<double, 6>{}));
  EXPECT_EQ(double_->now().sent, (std::array<double, 6>{}));
  EXPECT_TRUE(double_->now().has_motors_on);
}

TEST_F(OpenHapticsTest, DevicesHaveNames) {
  EXPECT_NO_THROW(open_open_haptics("Default Device", clock_));
  EXPECT_NO_THROW(open_open_haptics("Left Device", clock_));
  EXPECT_HAS(refusal([&] { open_open_haptics("Right Device", clock_); }),
             "touch:Right Device: cannot be opened (the double's text, 770/-28): expected ");
}

TEST_F(OpenHapticsTest, HasTraitsInOurUnits) {
  double_->set([](State& state) {
    state.max_force = 3.3, state.continuous_force = 0.88;
    state.max_stiffness = 0.5, state.max_torque = 300;
  });
  const auto device = open_open_haptics("", clock_);
  const DeviceTraits& traits = device->traits();
  EXPECT_EQ(traits.name, "Double Touch");
  EXPECT_EQ(traits.sensed_axes, 6);
  EXPECT_EQ(traits.max_force_N, 3.3);
  EXPECT_EQ(traits.continuous_force_N, 0.88);
  EXPECT_EQ(traits.max_stiffness_N_per_m, 500);
  EXPECT_DOUBLE_EQ(traits.max_torque_Nm, 0.3);
}

// Each of the three calls that read the state leaves an error.
TEST_F(OpenHapticsTest, NoErrorOfATickReachesALaterOne) {
  const auto device = open_open_haptics("", clock_);
  std::vector<int> codes;
  run_ticks(*device, 4, [&](int i) {
    double_->set(&State::reading_error, i == 0 ? 0x0300 : 0);
    DeviceReading reading;
    codes.push_back(device->read(reading).code);
  });
  EXPECT_EQ(codes, (std::vector<int>{0x0300, 0, 0, 0}));
}

// The cycle still runs without a scheduler: its ticks receive the reason as a fault, and decide when it
// ends.
void expect_fault_of_the_scheduler(HapticDevice& device, DeviceDouble& behind, int before, const char* what) {
  DeviceFault fault, written;
  run_ticks(device, before + 3, [&](int i) {
    const TickOnce tick(device, {Vec3(1, 0, 0), Vec3::Zero()});
    fault = tick.read, written = tick.written;
    if (i + 1 == before) behind.set(&State::is_scheduler_silent, true);
  });
  ASSERT_TRUE(fault && written);
  EXPECT_STREQ(fault.what, what);
  EXPECT_STREQ(written.what, what);
  EXPECT_FALSE(behind.now().has_motors_on);
}

TEST_F(OpenHapticsTest, ASchedulerThatDoesNotStartIsAFault) {
  double_->set(&State::scheduler_error, 0x0304);
  const auto device = open_open_haptics("", clock_);
  expect_fault_of_the_scheduler(*device, *double_, 0, "OpenHaptics: the scheduler has no timer");
}

// The fault is reported after more than a second without a call.
TEST_F(OpenHapticsTest, ASchedulerThatStopsCallingIsAFault) {
  const auto device = open_open_haptics("", clock_);
  expect_fault_of_the_scheduler(*device, *double_, 5, "OpenHaptics: the scheduler has stopped calling");
  EXPECT_GT(clock_.now_s(), 1.004);
  EXPECT_LT(clock_.now_s(), 1.02);
}

}  // namespace
}  // namespace remote_touch::vendor_devices_test
