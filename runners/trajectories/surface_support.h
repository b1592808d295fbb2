// The parts of a depth image that a scripted device can touch.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "core/cloud/camera.h"

namespace remote_touch {

// Depth along the optical axis of every pixel, NaN where nothing was measured. pre: cloud.image is set.
DepthImage depth_image(const PointCloud& cloud);

// Criteria for a surface without gaps.
struct Support {
  double edge_jump_m = 0.006;  // a larger depth difference between neighbouring pixels is an edge
  double margin_m = 0.01;      // how far around a pixel the surface must go on
};
// Median depth of the square around a pixel that is as wide as the margin; NaN if the square contains a hole,
// an edge or the image's border.
double supported_depth(const DepthImage& image, int u, int v, double focal_px, const Support& support);

// Default of bridge_m. The proxy does not fall into a hole of this diameter, even if the depth of its rim
// differs by edge_jump_m: (0.008 / 2)^2 + (0.006 / 2)^2 = r_c^2 with the default radius r_c = 0.005 m.
inline constexpr double kBridge_m = 0.008;

// The image with its small holes closed. A measured pixel covers the pixels whose viewing rays pass it, at
// its depth, at no more than hole_m / 2, so that no closed hole contains a disc wider than hole_m. A hole
// takes the depth of the nearest measured pixel at its rim that covers it; of two at the same distance, of
// the one nearer to the camera. Measured pixels keep their depth. Without holes the result is the image
// itself.
DepthImage bridged(const DepthImage& image, double focal_px, double hole_m);

// A depth image, and the same with its holes closed. The second is computed when it is used first, because
// most images need none.
class BridgeableImage {
 public:
  BridgeableImage(DepthImage measured, double focal_px, double hole_m)
      : measured_(std::move(measured)), focal_px_(focal_px), hole_m_(hole_m) {}
  const DepthImage& measured() const { return measured_; }
  const DepthImage& closed();

 private:
  const DepthImage measured_;
  double focal_px_ = 0, hole_m_ = 0;
  std::optional<DepthImage> closed_;
};

// A rectangle of pixels, both ends included.
struct PixelWindow {
  int first_column = 0, last_column = 0, first_row = 0, last_row = 0;
};
// The least depth that was measured in the part of the window that is in the image; infinite without a
// measurement.
double nearest_depth(const DepthImage& image, const PixelWindow& window);

// The median of the depths that were measured in the part of the window that is in the image; NaN without a
// measurement.
double median_depth(const DepthImage& image, const PixelWindow& window);

// A clearance in front of a surface at that depth, or half way between it and the camera if the clearance
// does not fit.
double in_front_of(double depth_m, double clearance_m);

// "8 mm", for messages.
std::string millimetres(double length_m);

}  // namespace remote_touch
