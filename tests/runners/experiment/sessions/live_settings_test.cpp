// The placement of device and camera, as settings.
#include "runners/experiment/sessions/live_settings.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace remote_touch::live_settings_test {
namespace {

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

}  // namespace
}  // namespace remote_touch::live_settings_test
