// Depth cameras: their interface, what they share, and the functions that open them.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/points/point_cloud.h"
#include "runners/experiment/sessions/sensor_frame.h"
#include "runners/live/devices/clock.h"
#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

enum class SensorState { frame, waiting, ended, failed };

// Only one thread may use it. The constructor opens the sensor; it throws InputError, with what is missing
// and what would help.
class DepthSource {
 public:
  virtual ~DepthSource() = default;

  const SensorView& view() const { return view_; }
  // Called at most once, before the first next(): the run begins at start_ns, a time of the clock. A
  // simulated camera counts its time from there; a real one ignores it.
  virtual void start_at([[maybe_unused]] std::int64_t start_ns) {}
  // Waits for the next frame, timeout_s at most. Reuses the memory of the given frame. Throws InputError,
  // which names the frame, if a frame cannot be used: the run then ends. If the camera was lost, it returns
  // `failed` instead: the last frame remains in use.
  virtual SensorState next(SensorFrame& frame, double timeout_s) = 0;
  // Returns the reason why it failed, in one line.
  const std::string& failure() const { return failure_; }

 protected:
  SensorView view_;  // fixed when the constructor of the sensor ends
  std::string failure_;
};

// Frames as drivers deliver them: their numbers, their times and their rows of pixels.

// Numbers frames by the camera's own count, which may restart, or by its time stamps.
class FrameNumbers {
 public:
  // Returns the number of a frame that is `steps` after the one before. Steps that are not between 1 and
  // kMaxGap, for instance after a reset of the camera, count as one.
  int next(double steps) {
    number_ += steps >= 1 && steps <= kMaxGap ? static_cast<int>(std::lround(steps)) : 1;
    return number_;
  }

 private:
  static constexpr double kMaxGap = 10000;

  int number_ = 0;
};

// Conversion of times from the clock of a sensor to that of the host. Arrivals jitter by milliseconds with
// the bus and the scheduler; the sensor's stamps are regular, but have their own origin. The difference
// arrival - stamp is the wanted offset plus a delay that is never negative, so the smallest difference is
// nearest to the offset. It still contains the delay common to all frames: exposure and transfer cannot be
// measured on the host.
class SensorClock {
 public:
  // Returns the time at which the frame with this stamp was captured, on the clock of the arrival: later than
  // the frame before, and not later than the arrival. pre: called in the order of arrival.
  double captured_s(double stamp_s, double arrived_s);

 private:
  bool has_begun_ = false;
  double offset_s_ = 0;
  double stamp_s_ = 0;     // time stamp of the frame before
  double captured_s_ = 0;  // time of capture of the frame before
};

// Images as drivers deliver them: rows of pixels with gaps between them, sometimes mirrored.
struct PixelRows {
  const void* first = nullptr;
  std::size_t bytes = 0;  // number of bytes that may be read
  int width = 0, height = 0;
  std::size_t stride = 0;  // bytes from row to row
  bool is_mirrored = false;
};

// copy_depth() and copy_rgb() undo the mirroring. They return false, and read nothing, if the image has
// another size than the camera's, or fewer bytes than it needs.
bool copy_depth(const PixelRows& rows, const CameraIntrinsics& camera, std::vector<std::uint16_t>& depth);
// Each pixel has three bytes: red, green, blue.
bool copy_rgb(const PixelRows& rows, const CameraIntrinsics& camera, std::vector<std::uint32_t>& colour);

// Converts depth images of a lens that distorts to those of a pinhole camera at the same position.

// A lens as the library of its camera describes it. A ray is (x / z, y / z) in the optical frame; integers
// are the centres of pixels. A map returns none if the lens sees nothing there.
struct Lens {
  using Map = std::function<std::optional<Eigen::Vector2d>(const Eigen::Vector2d&)>;
  Map pixel_of_ray, ray_of_pixel;
};

// The pinhole image has the size of the camera's, and both have the same rays at the ends of the middle row
// and of the middle column. So a lens without distortion changes nothing. The corners of a wide lens may be
// lost, and the middle of its image has fewer pixels than in the camera's image.
class Undistortion {
 public:
  // Throws InputError with this name if the lens maps rays and pixels in ways that contradict each other.
  Undistortion(const std::string& name, int width, int height, const Lens& lens);

  const CameraIntrinsics& camera() const { return camera_; }
  // Converts the camera's depth along its axis to that of the pinhole image, in the same unit; 0: nothing
  // measured. On a surface the depth is interpolated between the four nearest pixels. If one of them is
  // missing or on another surface, the nearest is used, so that no point lies between two surfaces. seen: one
  // number for each pixel of the camera.
  void apply(const std::vector<std::uint16_t>& seen, std::vector<std::uint16_t>& depth) const;

 private:
  // The upper left one of four pixels, and the distance from it to the position, right and down, in pixels.
  struct Place {
    std::int32_t pixel;  // below 0: the lens sees nothing there
    float right, down;
  };

  void choose_camera(const std::string& name, const Lens& lens);
  std::optional<Eigen::Vector2d> seen_at(int u, int v, const Lens& lens) const;
  Place place_of(const std::optional<Eigen::Vector2d>& seen) const;
  std::uint16_t depth_at(const std::vector<std::uint16_t>& seen, const Place& place) const;

  CameraIntrinsics camera_;
  std::vector<Place> places_;  // one for every pixel; empty: the two images are the same
};

// The adapters of cameras, one source each. open_...() opens a camera; it throws InputError, which says what
// is missing. ..._availability() says whether there is one.

// Depth cameras that OpenNI 2 drives (Kinect, Xtion, Carmine, Astra), and its recordings (.oni).
//
// address: "any" or nothing for the first camera, the URI of a camera, or an .oni file. The camera delivers
// its widest image of up to 640 x 480 pixels at 30 Hz, not mirrored; intrinsics follow from the driver's
// field of view. Colour is used if the camera registers depth to it: that of the newest colour frame, if its
// time differs from that of the depth by at most 1.1 periods. If several frames come between two calls of
// next(), only the newest is kept.
//
// A recording plays at its own speed, once. Its colour is not used, because the file does not state whether
// its depth was registered.
//
// Opening the first camera changes the working folder of the process for a moment, while the library loads
// its drivers: open it before other threads use relative paths. The frames may be taken in any thread: the
// camera calls the library only in a thread that lasts until the process ends, because the library crashes
// when it uses a thread that has ended.
std::unique_ptr<DepthSource> open_openni2(const std::string& address, Clock& clock);
Availability openni2_availability();

// The first Kinect (Xbox 360) through libfreenect. address: the number of the camera, or nothing for the
// first. Depth is registered to colour if the library supports that. Intrinsics are the nominal ones of a
// Kinect, because the library that plays its recordings (fakenect) does not have those of the device. If
// several frames come between two calls of next(), only the newest is kept.
//
// The library does not distinguish a lost camera from the end of a recording: both are failures.
std::unique_ptr<DepthSource> open_freenect(const std::string& address, Clock& clock);
Availability freenect_availability();

// Azure Kinect, and Orbbec's Femto cameras through Orbbec's wrapper: depth through the k4a C interface.
//
// address: CAMERA[?MODE]. CAMERA is a number (0: the first, also if left out) or a serial number; MODE is
// nfov (640 x 576 pixels, also if left out), nfov-binned (320 x 288), wfov-binned (512 x 512), all three at
// 30 Hz, or wfov (1024 x 1024 at 15 Hz). Numbers have one or two digits; longer ones are serial numbers.
//
// The lens's distortion is removed from the depth (Undistortion) with the calibration in the camera; the
// view is that of a pinhole camera. There is no colour. If several frames come between two calls of next(),
// only the newest is kept. The camera does not count its frames: their numbers follow from its time stamps,
// so that gaps are visible.
std::unique_ptr<DepthSource> open_k4a(const std::string& address, Clock& clock);
Availability k4a_availability();

// Intel RealSense cameras: depth through the rs2 C interface of librealsense 2.
//
// address: a serial number, or nothing for the first camera. Depth comes with 640 x 480 pixels at 30 Hz, in
// the unit of the camera. If the lens distorts, the distortion is removed (Undistortion); the view is that
// of a pinhole camera. There is no colour. If several frames come between two calls of next(), only the
// newest is kept.
//
// The library is polled for frames every millisecond. It could wait for one, but then it tries for many
// seconds to reopen a camera that was unplugged, and nothing would end that wait.
std::unique_ptr<DepthSource> open_realsense(const std::string& address, Clock& clock);
Availability realsense_availability();

}  // namespace remote_touch
