#include "tests/doubles/depth_libraries.h"

#include "runners/live/sensors/depth_source.h"

namespace remote_touch {

const DepthLibrary kK4a{.name = "k4a",
                        .double_file = REMOTE_TOUCH_DOUBLE_K4A,
                        .variable = "REMOTE_TOUCH_LIBK4A",
                        .library = "libk4a.so.1.4",
                        .open = open_k4a,
                        .availability = k4a_availability};

const DepthLibrary kRealSense{.name = "realsense",
                              .double_file = REMOTE_TOUCH_DOUBLE_REALSENSE,
                              .variable = "REMOTE_TOUCH_LIBREALSENSE",
                              .library = "librealsense2.so",
                              .open = open_realsense,
                              .availability = realsense_availability};

const DepthLibrary kOldRealSense{.name = "old_realsense",
                                 .double_file = REMOTE_TOUCH_DOUBLE_OLD_REALSENSE,
                                 .variable = "REMOTE_TOUCH_LIBREALSENSE",
                                 .library = "librealsense2.so",
                                 .open = open_realsense,
                                 .availability = realsense_availability};

void PrintTo(const DepthLibrary* library, std::ostream* out) {
  *out << library->name;
}

void CameraInstalled::expect_all_given_back() const {
  const CameraDouble& camera = **this;
  EXPECT_EQ(camera.held(), 0u);
  EXPECT_TRUE(camera.misuse().empty()) << camera.misuse().front();
  EXPECT_FALSE(camera.is_started());
}

}  // namespace remote_touch
