// The parts of a depth image that a scripted device can touch.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "core/geometry/camera.h"

namespace remote_touch {

// Criteria for a surface without gaps.
struct Support {
  double edge_jump_m = 0.006;  // a larger depth difference between neighbouring pixels is an edge
  double margin_m = 0.01;      // the surface must extend this far around a pixel
};
// Returns the median depth of the rectangle around a pixel that extends by the margin to each side. Returns
// NaN if the rectangle contains a hole or an edge, if it reaches the border of the image, or if the pixel is
// outside the image.
double supported_depth(const DepthImage& image, int u, int v, const CameraIntrinsics& camera,
                       const Support& support);

// Returns the length in pixels that a length has at a depth, along the axis with this focal length: at least
// 1, and at most the larger of width and height of the image. Returns 1 if the depth is NaN or not positive.
int reach_px(const DepthImage& image, double focal_px, double length_m, double depth_m);

struct ImagePixel {
  int row = 0, column = 0;
};
// Returns the pixel nearest to (row, column) that has a supported_depth(). Nothing: no pixel has one.
std::optional<ImagePixel> nearest_supported(const DepthImage& image, const ImagePixel& to,
                                            const CameraIntrinsics& camera, const Support& support);

// The default of bridge_m. The proxy does not fall into a hole of this diameter, even if the depth of its rim
// varies by edge_jump_m: (0.008 / 2)^2 + (0.006 / 2)^2 = r_c^2 with the default radius r_c = 0.005 m.
inline constexpr double kBridge_m = 0.008;

// Returns the image with its small holes closed. A measured pixel at the rim of a hole covers the pixels
// whose viewing rays pass it at a distance of at most hole_m / 2, at its depth, and at most 64 pixels away.
// So no closed hole contains a disc wider than hole_m. A covered pixel without a depth gets the depth of the
// nearest pixel that covers it. If two are equally near, it gets the depth of the one nearer to the camera.
// Measured pixels keep their depth. The result without holes is the image itself.
DepthImage bridged(const DepthImage& image, const CameraIntrinsics& camera, double hole_m);

// A depth image, and the same image with its holes closed. The second one is computed on its first use,
// because most images do not need it.
class BridgeableImage {
 public:
  BridgeableImage(DepthImage measured, const CameraIntrinsics& camera, double hole_m)
      : measured_(std::move(measured)), camera_(camera), hole_m_(hole_m) {}
  const DepthImage& measured() const { return measured_; }
  const DepthImage& closed();

 private:
  const DepthImage measured_;
  CameraIntrinsics camera_;
  double hole_m_ = 0;
  std::optional<DepthImage> closed_;
};

// A rectangle of pixels, both ends included.
struct PixelWindow {
  int first_column = 0, last_column = 0, first_row = 0, last_row = 0;
};
// Returns the least depth that was measured in the part of the window that is in the image; infinite if none
// was.
double nearest_depth(const DepthImage& image, const PixelWindow& window);

// Returns the median of the depths that were measured in the part of the window that is in the image; NaN if
// none was.
double median_depth(const DepthImage& image, const PixelWindow& window);

// Returns the depth at the clearance in front of a surface, or half the depth of the surface if the clearance
// is larger than that half.
double in_front_of(double depth_m, double clearance_m);

// Returns a text such as "8 mm", for messages.
std::string millimetres(double length_m);

}  // namespace remote_touch
