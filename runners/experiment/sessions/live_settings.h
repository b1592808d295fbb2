// The poses of device and camera in the world, as settings.
#pragma once

#include <string>

#include "core/geometry/vector.h"
#include "core/parameters/parameter.h"

namespace remote_touch {

struct LiveSettings {
  Vec3 device_position_m = Vec3::Zero();
  Vec3 device_rotation_deg = Vec3::Zero();
  double device_scale = 1;
  Vec3 camera_position_m = Vec3::Zero();
  Vec3 camera_rotation_deg = Vec3::Zero();
};

Parameters parameters(LiveSettings& s);
inline std::string validate(const LiveSettings&) {
  return {};
}

// Registration X_WC of the camera from these settings; applied to the camera pose that its source reports.
RigidTransform camera_registration(const LiveSettings& s);

}  // namespace remote_touch
