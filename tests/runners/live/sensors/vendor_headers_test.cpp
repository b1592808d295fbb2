// This project's declarations of the depth cameras' libraries, compared with the vendors' own headers if
// these are installed. Debian has no package of them. If they are missing, nothing is compared, and the tests
// report so. CMakeLists.txt lists the functions that the adapters look up.
#include <gtest/gtest.h>

#include <cstddef>
#include <type_traits>

#include "runners/live/sensors/k4a_camera.h"
#include "runners/live/sensors/realsense_camera.h"

#if __has_include(<k4a/k4a.h>)
#include <k4a/k4a.h>
#define REMOTE_TOUCH_HAS_K4A_HEADERS
#endif
#if __has_include(<librealsense2/rs.h>)
#include <librealsense2/h/rs_pipeline.h>
#include <librealsense2/rs.h>
#include <librealsense2/rsutil.h>
#define REMOTE_TOUCH_HAS_REALSENSE_HEADERS
#endif

namespace remote_touch::vendor_headers_test {
namespace {

// True if both are passed in the same way: pointers, or floating point or whole numbers of the same size.
template <class A, class B>
constexpr bool is_passed_alike() {
  if constexpr (std::is_void_v<A> || std::is_void_v<B>)
    return std::is_void_v<A> && std::is_void_v<B>;
  else if constexpr (std::is_pointer_v<A> || std::is_pointer_v<B>)
    return std::is_pointer_v<A> && std::is_pointer_v<B>;
  else
    return sizeof(A) == sizeof(B) && std::is_floating_point_v<A> == std::is_floating_point_v<B>;
}

template <class Ours, class Theirs>
struct CalledAlike : std::false_type {};
template <class R, class... P, class S, class... Q>
struct CalledAlike<R (*)(P...), S(Q...)> {
  static constexpr bool is_so() {
    if constexpr (sizeof...(P) != sizeof...(Q))
      return false;
    else
      return is_passed_alike<R, S>() && (is_passed_alike<P, Q>() && ...);
  }
  static constexpr bool value = is_so();
};

using Example = int(int, float);
static_assert(CalledAlike<int (*)(int, float), Example>::value);
static_assert(!CalledAlike<int (*)(float, int), Example>::value);
static_assert(!CalledAlike<int (*)(int), Example>::value);
static_assert(!CalledAlike<void (*)(int, float), Example>::value);
static_assert(!CalledAlike<int (*)(int*, float), Example>::value);

// The member of an adapter's library, and the vendor's function that it calls.
#define EXPECT_CALLED_ALIKE(member, function) \
  static_assert(CalledAlike<decltype(Library::member), decltype(function)>::value, #function);

#ifdef REMOTE_TOUCH_HAS_K4A_HEADERS
TEST(VendorHeaders, K4a) {
  using Library = k4a::K4aLibrary;
#include "k4a_functions.inc"
  static_assert(CalledAlike<Library::LogCallback*, k4a_logging_message_cb_t>::value);

  EXPECT_EQ(k4a::succeeded, static_cast<int>(K4A_RESULT_SUCCEEDED));
  EXPECT_EQ(k4a::succeeded, static_cast<int>(K4A_BUFFER_RESULT_SUCCEEDED));
  EXPECT_EQ(k4a::wait_succeeded, static_cast<int>(K4A_WAIT_RESULT_SUCCEEDED));
  EXPECT_EQ(k4a::wait_failed, static_cast<int>(K4A_WAIT_RESULT_FAILED));
  EXPECT_EQ(k4a::wait_timeout, static_cast<int>(K4A_WAIT_RESULT_TIMEOUT));
  EXPECT_EQ(k4a::nfov_2x2_binned, static_cast<int>(K4A_DEPTH_MODE_NFOV_2X2BINNED));
  EXPECT_EQ(k4a::nfov_unbinned, static_cast<int>(K4A_DEPTH_MODE_NFOV_UNBINNED));
  EXPECT_EQ(k4a::wfov_2x2_binned, static_cast<int>(K4A_DEPTH_MODE_WFOV_2X2BINNED));
  EXPECT_EQ(k4a::wfov_unbinned, static_cast<int>(K4A_DEPTH_MODE_WFOV_UNBINNED));
  EXPECT_EQ(k4a::fps_15, static_cast<int>(K4A_FRAMES_PER_SECOND_15));
  EXPECT_EQ(k4a::fps_30, static_cast<int>(K4A_FRAMES_PER_SECOND_30));
  EXPECT_EQ(k4a::colour_off, static_cast<int>(K4A_COLOR_RESOLUTION_OFF));
  EXPECT_EQ(k4a::depth_camera, static_cast<int>(K4A_CALIBRATION_TYPE_DEPTH));
  EXPECT_EQ(k4a::depth16, static_cast<int>(K4A_IMAGE_FORMAT_DEPTH16));
  EXPECT_EQ(k4a::log_error, static_cast<int>(K4A_LOG_LEVEL_ERROR));

  using Ours = k4a::Configuration;
  using Theirs = k4a_device_configuration_t;
  EXPECT_EQ(sizeof(Ours), sizeof(Theirs));
  EXPECT_EQ(offsetof(Ours, colour_format), offsetof(Theirs, color_format));
  EXPECT_EQ(offsetof(Ours, colour_resolution), offsetof(Theirs, color_resolution));
  EXPECT_EQ(offsetof(Ours, depth_mode), offsetof(Theirs, depth_mode));
  EXPECT_EQ(offsetof(Ours, camera_fps), offsetof(Theirs, camera_fps));
  EXPECT_EQ(offsetof(Ours, synchronized_images_only), offsetof(Theirs, synchronized_images_only));
  EXPECT_EQ(offsetof(Ours, depth_delay_off_colour_us), offsetof(Theirs, depth_delay_off_color_usec));
  EXPECT_EQ(offsetof(Ours, wired_sync_mode), offsetof(Theirs, wired_sync_mode));
  EXPECT_EQ(offsetof(Ours, subordinate_delay_off_master_us),
            offsetof(Theirs, subordinate_delay_off_master_usec));
  EXPECT_EQ(offsetof(Ours, disable_streaming_indicator), offsetof(Theirs, disable_streaming_indicator));
  EXPECT_EQ(Ours{}.wired_sync_mode, static_cast<int>(K4A_WIRED_SYNC_MODE_STANDALONE));
  EXPECT_EQ(sizeof(k4a::Float2), sizeof(k4a_float2_t));
  EXPECT_EQ(sizeof(k4a::Float3), sizeof(k4a_float3_t));
  EXPECT_GE(sizeof(k4a::Calibration), sizeof(k4a_calibration_t));
  EXPECT_GE(alignof(k4a::Calibration), alignof(k4a_calibration_t));
}
#else
TEST(VendorHeaders, K4a) {
  GTEST_SKIP() << "k4a/k4a.h is not installed";
}
#endif

#ifdef REMOTE_TOUCH_HAS_REALSENSE_HEADERS
TEST(VendorHeaders, RealSense) {
  using Library = rs2::RealSenseLibrary;
#include "realsense_functions.inc"
  EXPECT_EQ(rs2::info_name, static_cast<int>(RS2_CAMERA_INFO_NAME));
  EXPECT_EQ(rs2::info_serial_number, static_cast<int>(RS2_CAMERA_INFO_SERIAL_NUMBER));
  EXPECT_EQ(rs2::is_depth_sensor, static_cast<int>(RS2_EXTENSION_DEPTH_SENSOR));
  EXPECT_EQ(RS2_API_MAJOR_VERSION, 2);
  EXPECT_EQ(rs2::stream_depth, static_cast<int>(RS2_STREAM_DEPTH));
  EXPECT_EQ(rs2::format_z16, static_cast<int>(RS2_FORMAT_Z16));
  EXPECT_EQ(rs2::is_composite_frame, static_cast<int>(RS2_EXTENSION_COMPOSITE_FRAME));
  EXPECT_EQ(rs2::distortion_none, static_cast<int>(RS2_DISTORTION_NONE));
  EXPECT_EQ(rs2::inverse_brown_conrady, static_cast<int>(RS2_DISTORTION_INVERSE_BROWN_CONRADY));
  EXPECT_EQ(rs2::brown_conrady, static_cast<int>(RS2_DISTORTION_BROWN_CONRADY));
  using Ours = rs2::Intrinsics;
  using Theirs = rs2_intrinsics;
  EXPECT_EQ(sizeof(Ours), sizeof(Theirs));
  EXPECT_EQ(offsetof(Ours, height), offsetof(Theirs, height));
  EXPECT_EQ(offsetof(Ours, ppx), offsetof(Theirs, ppx));
  EXPECT_EQ(offsetof(Ours, fx), offsetof(Theirs, fx));
  EXPECT_EQ(offsetof(Ours, model), offsetof(Theirs, model));
  EXPECT_EQ(offsetof(Ours, coefficients), offsetof(Theirs, coeffs));
}
#else
TEST(VendorHeaders, RealSense) {
  GTEST_SKIP() << "librealsense2/rs.h is not installed";
}
#endif

}  // namespace
}  // namespace remote_touch::vendor_headers_test
