#include "runners/experiment/sessions/live_settings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "tests/support/test_files.h"

namespace remote_touch::live_settings_test {
namespace {

// The placement of device and camera, as settings.

// Every parameter sets the field of its name.
TEST(LiveSettings, ParametersReachTheSettings) {
  LiveSettings s;
  std::vector<std::string> names;
  for (const Parameter& p : parameters(s)) {
    names.push_back(p.name);
    const auto number = static_cast<double>(names.size());
    if (const auto* vector = std::get_if<Vec3*>(&p.value)) {
      EXPECT_LT(p.low, 0) << p.name;
      EXPECT_GT(p.high, 0) << p.name;
      **vector = Vec3::Constant(number);
    } else {
      EXPECT_GT(p.low, 0) << p.name;
      *std::get<double*>(p.value) = number;
    }
  }
  EXPECT_EQ(names, (std::vector<std::string>{"device_position_m", "device_rotation_deg", "device_scale",
                                             "camera_position_m", "camera_rotation_deg"}));
  EXPECT_EQ(s.device_position_m, Vec3::Constant(1));
  EXPECT_EQ(s.device_rotation_deg, Vec3::Constant(2));
  EXPECT_EQ(s.device_scale, 3);
  EXPECT_EQ(s.camera_position_m, Vec3::Constant(4));
  EXPECT_EQ(s.camera_rotation_deg, Vec3::Constant(5));
  EXPECT_EQ(validate(s), "");
}

// The camera is turned first, and then moved. A quarter turn about z maps x to y.
TEST(LiveSettings, ACameraIsTurnedAndMoved) {
  EXPECT_EQ(camera_registration({}).matrix(), Eigen::Matrix4d::Identity());
  LiveSettings s;
  s.camera_position_m = Vec3(1, 2, 3), s.camera_rotation_deg = Vec3(0, 0, 90);
  EXPECT_LT((camera_registration(s) * Vec3(0.5, 0, 0) - Vec3(1, 2.5, 3)).norm(), 1e-15);
  EXPECT_LT((camera_registration(s) * Vec3(0, 0.5, 0.25) - Vec3(0.5, 2, 3.25)).norm(), 1e-15);
  EXPECT_EQ(camera_registration(s).translation(), Vec3(1, 2, 3));
}

TEST(LiveSettings, PositionOfTheDeviceDoesNotMoveTheCamera) {
  LiveSettings s;
  s.device_position_m = Vec3(1, 2, 3), s.device_rotation_deg = Vec3(0, 0, 90), s.device_scale = 2;
  EXPECT_EQ(camera_registration(s).matrix(), Eigen::Matrix4d::Identity());
}

// The limits of a live run's safety gate, as settings.

TEST(SafetyLimits, ParametersReachFieldsOfTheirOwnAndAllowTheDefaults) {
  SafetyLimits s;
  std::set<std::string> names;
  for (const Parameter& p : parameters(s)) {
    names.insert(p.name);
    double& value = *std::get<double*>(p.value);
    EXPECT_TRUE(p.low <= value && value <= p.high) << p.name;
    EXPECT_FALSE(p.help.empty()) << p.name;
    value = static_cast<double>(names.size());
  }
  EXPECT_EQ(names.size(), 10u);
  const double set[] = {s.max_force_N,        s.max_torque_Nm,
                        s.force_slew_N_per_s, s.torque_slew_Nm_per_s,
                        s.max_speed_m_per_s,  s.max_angular_speed_rad_per_s,
                        s.engage_force_N,     s.ramp_s,
                        s.max_command_age_s,  s.max_frame_age_s};
  for (int i = 0; i < 10; ++i) EXPECT_EQ(set[i], i + 1);
}

// Any force must fall to zero within 10 ms: 5 N at 500 N/s.
TEST(SafetyLimits, ASlewRateThatCannotReleaseIsRefused) {
  EXPECT_EQ(validate(SafetyLimits{}), "");
  SafetyLimits force;
  force.force_slew_N_per_s = 500;
  EXPECT_EQ(validate(force), "");
  force.force_slew_N_per_s = std::nextafter(500, 0);
  EXPECT_HAS(validate(force), "force_slew_N_per_s = 500");
  force.force_slew_N_per_s = 499;
  EXPECT_EQ(validate(force),
            "force_slew_N_per_s = 499.000000: expected max_force_N / 0.01 s = 500.000000 or more, "
            "so that the maximum can fall to 0 in that time");
  SafetyLimits torque;
  torque.torque_slew_Nm_per_s = 20;
  EXPECT_EQ(validate(torque), "");
  torque.torque_slew_Nm_per_s = 19;
  EXPECT_HAS(validate(torque),
             "torque_slew_Nm_per_s = 19.000000: expected max_torque_Nm / 0.01 s = 20.000000");
}

TEST(SafetyLimits, ALargerForceNeedsAFasterSlewRate) {
  SafetyLimits s;
  s.max_force_N = 10;
  EXPECT_EQ(validate(s), "");
  s.max_force_N = 10.1;
  EXPECT_HAS(validate(s), "force_slew_N_per_s = 1000");
  s.max_force_N = 0, s.max_torque_Nm = 0.41;
  EXPECT_HAS(validate(s), "torque_slew_Nm_per_s = 40");
}

}  // namespace
}  // namespace remote_touch::live_settings_test
