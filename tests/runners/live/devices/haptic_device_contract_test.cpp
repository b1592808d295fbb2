// The contract of every adapter of a vendor's library. Each is tested with its test double.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/doubles/vendor_devices.h"
#include "tests/support/test_files.h"

namespace remote_touch::haptic_device_contract_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

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
  double_->set([&](DeviceDouble::State& state) {
    state.position = in_vendor_lengths(position), state.velocity = in_vendor_lengths(velocity);
    state.turning = in_vendor_axes(turning), state.rotation = turn_in_vendor_axes(kRotation);
    state.buttons = 5;
  });
  const auto device = open();
  const auto [reading, fault] = read_once(*device);
  ASSERT_FALSE(fault) << fault.what;
  EXPECT_TRUE(reading.position_m.isApprox(position, 1e-12)) << reading.position_m.transpose();
  EXPECT_TRUE(reading.velocity_m_per_s.isApprox(velocity, 1e-12)) << reading.velocity_m_per_s.transpose();
  EXPECT_TRUE(reading.angular_velocity_rad_per_s.isApprox(turning, 1e-12))
      << reading.angular_velocity_rad_per_s.transpose();
  EXPECT_TRUE(reading.orientation.toRotationMatrix().isApprox(kRotation, 1e-12));
  EXPECT_EQ(reading.buttons, vendor().has_buttons ? 5u : 0u);
}

// Position and orientation put each point of the handle where the vendor's do.
TEST_P(HapticDeviceContract, TurnsAreRotationsThatFitThePositions) {
  const auto device = open();
  const Vec3 centre(0.1, 0.2, -0.1), of_handle(0.03, -0.01, 0.02);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> turn =
        Eigen::AngleAxisd(0.3, Vec3::Unit(axis)).toRotationMatrix();
    double_->set([&](DeviceDouble::State& state) {
      const Vec3 p = centre * vendor().length_per_m;
      state.position = {p.x(), p.y(), p.z()};
      std::copy(turn.data(), turn.data() + 9, state.rotation.begin());
    });
    const auto [reading, fault] = read_once(*device);
    ASSERT_FALSE(fault) << fault.what;
    const Eigen::Matrix3d turned = reading.orientation.toRotationMatrix(), ours = vendor().axes.transpose();
    EXPECT_NEAR(turned.determinant(), 1, 1e-12);
    EXPECT_TRUE(
        (reading.position_m + turned * ours * of_handle).isApprox(ours * (centre + turn * of_handle), 1e-12));
    EXPECT_NEAR(Eigen::AngleAxisd(reading.orientation).angle(), 0.3, 1e-12);
  }
}

TEST_P(HapticDeviceContract, ForcesAndTorquesArriveAlongTheVendorsAxes) {
  const auto device = open();
  run_ticks(*device, 6, [&](int i) {
    DeviceReading reading;
    EXPECT_FALSE(device->read(reading));
    const Vec3 unit = Vec3::Unit(i % 3);
    EXPECT_FALSE(device->write(i < 3 ? Wrench{unit, Vec3::Zero()} : Wrench{Vec3::Zero(), unit}));
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
  double_->set([](DeviceDouble::State& state) { state.actuated_axes = 3; });
  const auto device = open();
  EXPECT_EQ(device->traits().sensed_axes, 6);
  EXPECT_EQ(device->traits().actuated_axes, 3);
  run_ticks(*device, 1, [&](int) { device->write({Vec3(1, 0, 0), Vec3(1, 1, 1)}); });
  const auto arrived = sent_forces(*double_);
  ASSERT_EQ(arrived.size(), 1u);
  EXPECT_EQ(arrived[0][3], 0);
  EXPECT_EQ(arrived[0][4], 0);
  EXPECT_EQ(arrived[0][5], 0);
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

// These adapters run their own ticks. The others use the scheduler of their vendor.
class RunsByTheClock : public HapticDeviceContract {};

// One tick takes 50.3 ms. Ticks that fall into it are skipped; the later ones come at their usual times.
TEST_P(RunsByTheClock, LateTicksAreLeftOut) {
  const auto device = open();
  std::vector<std::int64_t> at_us;
  run_ticks(*device, 100, [&](int i) {
    at_us.push_back(clock_.now_ns() / 1000);
    if (i == 20) clock_.sleep_s(0.0503);
  });
  for (int i = 0; i < 100; ++i)
    EXPECT_EQ(at_us[static_cast<std::size_t>(i)], 1000 * (i <= 20 ? i : i + 50)) << i;
}

TEST_P(HapticDeviceContract, AbsentLibraryIsNamedWithTheVariable) {
  expect_absent_library_is_named(vendor(), [&] { open(); });
}

TEST_P(HapticDeviceContract, AnotherLibraryIsRefused) {
  const VendorDevice& other = &vendor() == &kEntact ? kOpenHaptics : kEntact;
  setenv(vendor().variable, other.double_file, 1);
  const std::string message = refusal([&] { open(); });
  EXPECT_HAS(message, std::string(other.double_file) + ": has no function ");
  EXPECT_HAS(message, vendor().variable);
}

TEST_P(HapticDeviceContract, AbsentDeviceIsRefused) {
  double_->set([](DeviceDouble::State& state) { state.devices = 0; });
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
    if (i == 20) double_->set([](DeviceDouble::State& state) { state.is_unplugged = true; });
    DeviceReading reading;
    const DeviceFault read = device->read(reading), written = device->write({Vec3(1, 0, 0), Vec3::Zero()});
    good += !read && !written;
    reading_faults += bool(read), writing_faults += bool(written);
    if (read) last = read;
  });
  EXPECT_GE(good, 20);
  EXPECT_GE(reading_faults, 18);
  EXPECT_EQ(last.code, vendor().unplugged_code) << last.what;
  EXPECT_EQ(writing_faults, vendor().drives_itself ? 0 : 20);
}

TEST_P(HapticDeviceContract, NanOrInfinityInAReadingIsAFault) {
  const auto device = open();
  const auto fault_with = [&](auto change) {
    double_->set([](DeviceDouble::State& state) { state = {}; });
    double_->set(change);
    return read_once(*device).fault;
  };
  EXPECT_FALSE(fault_with([](DeviceDouble::State&) {}));
  EXPECT_TRUE(fault_with([](DeviceDouble::State& state) { state.position[1] = kNaN; }));
  EXPECT_TRUE(fault_with([](DeviceDouble::State& state) { state.position[0] = INFINITY; }));
  EXPECT_TRUE(fault_with([](DeviceDouble::State& state) { state.velocity[2] = kNaN; }));
  EXPECT_TRUE(fault_with([](DeviceDouble::State& state) { state.turning[0] = kNaN; }));
  EXPECT_TRUE(fault_with([](DeviceDouble::State& state) { state.rotation[4] = kNaN; }));
  EXPECT_FALSE(fault_with([](DeviceDouble::State&) {}));
}

TEST_P(HapticDeviceContract, ATurnThatIsNoRotationIsAFault) {
  const auto device = open();
  for (const std::array<double, 9>& turn :
       {std::array<double, 9>{}, std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, -1},
        std::array<double, 9>{1, 0.1, 0, 0, 1, 0, 0, 0, 1}}) {
    double_->set([&](DeviceDouble::State& state) { state.rotation = turn; });
    const DeviceFault fault = read_once(*device).fault;
    ASSERT_TRUE(fault);
    EXPECT_HAS(fault.what, "not a rotation");
  }
}

TEST_P(HapticDeviceContract, ANanForceIsNotSent) {
  const auto device = open();
  run_ticks(*device, 2, [&](int i) {
    DeviceReading reading;
    device->read(reading);
    EXPECT_TRUE(device->write(i == 0 ? Wrench{Vec3(kNaN, 0, 0), Vec3::Zero()}
                                     : Wrench{Vec3::Zero(), Vec3(0, 0, kNaN)}));
  });
  EXPECT_TRUE(sent_forces(*double_).empty());
}

TEST_P(HapticDeviceContract, ErrorsOfTheVendorArePassedOn) {
  const auto device = open();
  DeviceFault read, written, after;
  run_ticks(*device, 6, [&](int i) {
    DeviceReading reading;
    double_->set([&](DeviceDouble::State& state) {
      state.reading_error = i == 2 ? vendor().error : 0, state.writing_error = i == 4 ? vendor().error : 0;
    });
    const DeviceFault reads = device->read(reading), writes = device->write({Vec3(1, 0, 0), Vec3::Zero()});
    if (i == 2) read = reads;
    if (i == 4) written = writes;
    if (i == 5) after = reads;
  });
  ASSERT_TRUE(read);
  EXPECT_EQ(read.code, vendor().fault_code) << read.what;
  // OpenHaptics reports an error of a force in the next frame.
  const DeviceFault& of_force = vendor().drives_itself ? after : written;
  ASSERT_TRUE(of_force);
  EXPECT_EQ(of_force.code, vendor().fault_code) << of_force.what;
}

std::string name_of(const testing::TestParamInfo<const VendorDevice*>& tested) {
  return tested.param->name;
}
INSTANTIATE_TEST_SUITE_P(Vendors, HapticDeviceContract,
                         testing::Values(&kForceDimension, &kOpenHaptics, &kEntact), name_of);
INSTANTIATE_TEST_SUITE_P(Vendors, TellsOfMotors, testing::Values(&kForceDimension, &kOpenHaptics), name_of);
INSTANTIATE_TEST_SUITE_P(Vendors, RunsByTheClock, testing::Values(&kForceDimension, &kEntact), name_of);

}  // namespace
}  // namespace remote_touch::haptic_device_contract_test
