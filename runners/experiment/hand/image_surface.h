// The depth images of a scenario, and the surfaces in them that a scripted device can touch.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/points/point_cloud.h"
#include "scenarios/simulated/scenario.h"

namespace remote_touch {

// The frames of a scenario as depth images of one camera, for hands that follow the pixels of an image.

// A frame as a depth image: the depth of each pixel along the optical axis, NaN where nothing was measured.
struct FrameImage {
  ImageLayout layout;
  DepthImage depth;
};

// Returns frame 0. subject: the subject of error messages, such as "trajectory.name = image-press". Throws
// InputError if the frame is not an image, if the number of its points is not the number of its pixels, or if
// no pixel has a depth.
FrameImage first_image(const Scenario& scenario, const std::string& subject);

// Returns a frame as an image of the camera that took `first`. The camera may have moved: the layout has the
// pose of this frame. Throws InputError, with the number of the frame, if require_image_of() does.
FrameImage image_of(const Scenario& scenario, int frame, const ImageLayout& first,
                    const std::string& subject);

// Throws InputError, with the number of the frame, unless the points of the frame are the pixels of an image
// with the size and the camera of `first`. The camera counts as the same if each measured point is seen at
// most one pixel, plus the slack of both images, away from its own pixel. One pixel is allowed because the
// fit of a camera to the points of a frame may be off by half a pixel in each of the two images. A frame
// without a measured point is accepted, whatever its number of points: all its pixels are holes.
void require_image_of(const ImageLayout& first, const PointCloud& frame, int number,
                      const std::string& subject);

// The parts of a depth image that a scripted device can touch.

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

// Throws InputError about a clearance or a depth that is too large for a camera at this distance.
[[noreturn]] void refuse_behind_camera(double surface_m);
// where: the pixel or the row, "row 310".
Note holes_bridged(const std::string& where, double bridge_m);

// The nearest large object in a depth image: the default target of a scan.
struct NearestObject {
  double nearest_depth_m = 0;    // depth of its nearest part (5th percentile)
  int row = 0, column = 0;       // medians of its pixels
  std::vector<int> pixels;       // row * width + column of each pixel, unsorted
  bool is_whole_scene = false;   // no large object was found
  bool is_behind_plane = false;  // it is behind the dominant plane, and no large object is in front of it
};

// Returns the nearest large object. The dominant plane (a table, a floor, a wall) is removed first if it has
// more than a fifth of the measured points. The object is the nearest of the remaining patches of continuous
// depth that fill 1 % of the image or more. A patch behind the plane counts only if none is in front of it,
// because it may be a part of a table that is not quite flat. If there is no such patch, the whole scene is
// the object. The result depends on the image alone, because the random choices have a fixed key.
NearestObject nearest_large_object(const DepthImage& image, const CameraIntrinsics& camera);

// The same for an image that may be sparse. The pixels of one object must touch each other, so an object of
// scattered pixels is found only after its holes are closed. The object found with closed holes is returned
// if the measured pixels alone show no large object, only one behind the plane while the other is in front of
// it, or one that is more than 10 mm farther away.
NearestObject nearest_large_object(BridgeableImage& image, const CameraIntrinsics& camera);

// Returns a text about an object that is nearer than the one that a hand touches:
// "an object at row 110, column 150 is nearer, at 600 mm; it does not fill 1 % of the image without gaps"
std::string text_of_nearer(const NearestObject& object);

// Returns the nearest patch of continuous depth in front of the dominant plane that is more than 10 mm nearer
// than touched_depth_m and contains no pixel of `touched` (row * width + column). The patch covers 4 cm^2 or
// more, the square of twice the default margin_m, so that a hand could touch it. It need not fill 1 % of the
// image, and its pixels may join diagonally. It is meant for hands that touch the whole scene, because
// nearest_large_object() found no large object. Returns nothing if there is no such patch.
std::optional<NearestObject> nearer_small_object(const DepthImage& image, const CameraIntrinsics& camera,
                                                 const std::vector<int>& touched, double touched_depth_m);

}  // namespace remote_touch
