// The adapters of depth cameras' libraries with their test doubles.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "runners/experiment/sessions/sensor_frame.h"
#include "runners/live/devices/haptic_device.h"
#include "runners/live/sensors/depth_source.h"
#include "tests/doubles/camera_double.h"
#include "tests/doubles/installed_double.h"

namespace remote_touch {

struct DepthLibrary {
  const char* name;
  const char* double_file;
  const char* variable;  // environment variable that names the library
  const char* library;   // first name that is tried if it is not set
  std::unique_ptr<DepthSource> (*open)(const std::string& address, Clock& clock);
  Availability (*availability)();
};

inline const DepthLibrary kK4a{.name = "k4a",
                               .double_file = REMOTE_TOUCH_DOUBLE_K4A,
                               .variable = "REMOTE_TOUCH_LIBK4A",
                               .library = "libk4a.so.1.4",
                               .open = open_k4a,
                               .availability = k4a_availability};
inline const DepthLibrary kRealSense{.name = "realsense",
                                     .double_file = REMOTE_TOUCH_DOUBLE_REALSENSE,
                                     .variable = "REMOTE_TOUCH_LIBREALSENSE",
                                     .library = "librealsense2.so",
                                     .open = open_realsense,
                                     .availability = realsense_availability};
// Lacks what older versions of librealsense lack.
inline const DepthLibrary kOldRealSense{.name = "old_realsense",
                                        .double_file = REMOTE_TOUCH_DOUBLE_OLD_REALSENSE,
                                        .variable = "REMOTE_TOUCH_LIBREALSENSE",
                                        .library = "librealsense2.so",
                                        .open = open_realsense,
                                        .availability = realsense_availability};

class CameraInstalled : public InstalledDouble<CameraDouble> {
 public:
  using InstalledDouble::InstalledDouble;
  ~CameraInstalled() { expect_all_given_back(); }
  void expect_all_given_back() const {
    const CameraDouble& camera = **this;
    EXPECT_EQ(camera.held(), 0u);
    EXPECT_TRUE(camera.misuse().empty()) << camera.misuse().front();
    EXPECT_FALSE(camera.is_started());
  }
};

// Checks that the points of a frame lie on the plane that the camera sees, within a tolerance in units of
// depth, and that at least this share of the pixels has a point. max_radius: beyond it, rays are not checked.
inline void expect_plane(const CameraDouble& camera, const SensorFrame& frame, const SensorView& view,
                         double tolerance, double least_share, double max_radius = HUGE_VAL) {
  std::size_t present = 0;
  double worst_m = 0;
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    if (frame.depth[i] == 0) continue;
    ++present;
    const int u = static_cast<int>(i) % view.camera.width, v = static_cast<int>(i) / view.camera.width;
    const Eigen::Vector3d ray((u - view.camera.cx) / view.camera.fx, (v - view.camera.cy) / view.camera.fy,
                              1);
    if (ray.head<2>().norm() > max_radius) continue;
    const double expected_m = camera.state.distance_m / camera.state.normal.dot(ray);
    worst_m = std::max(worst_m, std::abs(frame.depth[i] * view.metres_per_unit - expected_m));
  }
  EXPECT_LT(worst_m, tolerance * view.metres_per_unit);
  EXPECT_GT(static_cast<double>(present), least_share * static_cast<double>(frame.depth.size()));
}

}  // namespace remote_touch
