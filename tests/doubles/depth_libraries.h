// The adapters of depth cameras' libraries with their test doubles.
#pragma once

#include <memory>
#include <ostream>
#include <string>

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

// GoogleTest prints it in the names of tests.
void PrintTo(const DepthLibrary* library, std::ostream* out);  // NOLINT(readability-identifier-naming)

// kOldRealSense lacks what older versions of librealsense lack.
extern const DepthLibrary kK4a, kRealSense, kOldRealSense;

class CameraInstalled : public InstalledDouble<CameraDouble> {
 public:
  using InstalledDouble::InstalledDouble;
  ~CameraInstalled() { expect_all_given_back(); }
  void expect_all_given_back() const;
};

}  // namespace remote_touch
