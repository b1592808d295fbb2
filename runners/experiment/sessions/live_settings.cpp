#include "runners/experiment/sessions/live_settings.h"

#include "core/geometry/rotation.h"

namespace remote_touch {

Parameters parameters(LiveSettings& s) {
  return {
      {"device_position_m", &s.device_position_m, -100, 100,
       "position of the centre of the device's workspace, world frame"},
      {"device_rotation_deg", &s.device_rotation_deg, -360, 360,
       "rotation vector (axis times angle) of the device, world frame; zero: x right, y up, z towards the user"},
      {"device_scale", &s.device_scale, 0.01, 100,
       "motion scale: displacement in the world per displacement of the hand"},
      {"camera_position_m", &s.camera_position_m, -100, 100,
       "position of the camera, added to the one that its source reports"},
      {"camera_rotation_deg", &s.camera_rotation_deg, -360, 360,
       "rotation vector (axis times angle) of the camera, added in the same way"},
  };
}

RigidTransform camera_registration(const LiveSettings& s) {
  return RigidTransform(Eigen::Translation3d(s.camera_position_m) *
                        rotation(kRadiansPerDegree * s.camera_rotation_deg));
}

}  // namespace remote_touch
