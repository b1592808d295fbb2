// Device motions that are planned on the depth images of a scenario, and the surfaces in them that a scripted
// device can touch.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/parameters/parameter.h"
#include "core/points/point_cloud.h"
#include "runners/experiment/hand/trajectory.h"
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

// The motions: a press at a pixel, and a scan along a row.

// A device that presses along the ray of one pixel, a set depth behind the surface of the newest frame: it
// stays in contact while the camera or the scene moves. Its depths, clearance and speed are those along the
// axis of the camera; along the ray they are larger by 1 / cos of the angle between both.
//
// If the newest frame shows no surface without gaps around the pixel, the device lifts off: it waits in front
// of the surface that was seen last, until a frame shows a surface again. Something else may meanwhile appear
// in front of this waiting position. If the device would then be farther behind it than a press may be, the
// device moves in front of everything that the newest frame shows around the pixel.
class ImagePress final : public Trajectory {
 public:
  struct Settings {
    int row = -1;
    int column = -1;
    double depth_m = 0.01;
    double clearance_m = 0.03;
    double press_at_s = 0.1;
    double approach_m_per_s = 0.2;
    double edge_jump_m =
        0.006;  // below sqrt(2) r_c: the proxy falls through a square of points wider than that
    double bridge_m = kBridge_m;
    double margin_m = 0.01;
  };

  // The scenario must outlive the trajectory. Throws InputError if its first frame is not an image or shows
  // nothing to touch at the pixel, or if the device would be behind the camera.
  ImagePress(const Settings& settings, const Scenario& scenario);
  // Throws InputError if a frame has another size or camera than the first, see require_image_of().
  DeviceState at(double time_s) const override;
  double duration_s() const override { return 0; }
  std::vector<Phase> phases() const override { return {{"the press", settings_.press_at_s}}; }
  // The press is meant to touch from the time at which it reaches the surface.
  std::optional<SurfacePlan> surface_plan(double time_s) const override;
  // "image-press, row 220, column 450 at depth 0.523 m"
  std::string aim() const override;
  std::vector<Note> notes() const override;
  int row() const { return row_; }
  int column() const { return column_; }

 private:
  // The surface that one frame shows at the pixel. Depths are in m along the optical axis.
  struct Seen {
    double supported_m = 0;  // depth of the surface; NaN: no surface without gaps
    double shown_m = 0;      // median of the depths measured within bridge_m / 2; NaN: none
    double nearest_m = 0;    // least depth within margin_m or bridge_m / 2, the larger one; infinite: none
    RigidTransform X_WC = RigidTransform::Identity();  // the camera
  };
  const Seen& seen(int frame) const;
  Support support() const { return {settings_.edge_jump_m, settings_.margin_m}; }
  NearestObject choose_pixel(BridgeableImage& image);
  bool has_support(const DepthImage& image, int pixel) const;
  void note_missed_object(const NearestObject& object, const DepthImage& measured);
  [[noreturn]] void refuse_pixel(BridgeableImage& image) const;
  double travelled_m(double time_s) const;
  double lifted_depth(double planned_m, const Seen& newest) const;

  const Settings settings_;
  const Scenario& scenario_;
  ImageLayout image_;
  int row_ = 0, column_ = 0;
  bool bridges_holes_ = false;
  std::string missed_object_;         // the text of the note "object not pressed"; empty: no note
  mutable std::map<int, Seen> seen_;  // cache, by frame: many ticks use the same one
};

Parameters parameters(ImagePress::Settings& s);
inline std::string validate(const ImagePress::Settings&) {
  return {};
}

// The row of a depth image along which a device scans, and the parts of it that the device touches.

// A part of the row without holes or edges, both ends included.
struct ScanPatch {
  int first_column = 0, last_column = 0;
};

// A row or a column of -1 is chosen from the image.
struct ScanRowRequest {
  int row = -1;
  int first_column = -1, last_column = -1;
  double span_m = 0.3;
  double edge_jump_m =
      0.006;  // below sqrt(2) r_c: the proxy falls through a square of points wider than that
  double bridge_m = kBridge_m;
  double margin_m = 0.01;
};

struct ScanRow {
  int row = 0;
  std::vector<ScanPatch> patches;  // patches from left to right; empty: there is nothing to touch
  std::vector<double> depth_m;     // supported_depth() of each column; NaN: none, or beyond span_m
  double edge_jump_m = 0;          // the largest depth jump that counts as surface
  bool bridges_holes = false;      // holes up to bridge_m were closed
  bool is_on_object = false;       // a patch touches the nearest large object
  bool is_whole_scene = false;     // there is no large object: the whole scene counts as one
};

// Returns the first row with a patch on the nearest large object. If there is none, it returns the first row
// with a patch. A requested row that does not cross the object needs no patch on it. If no row has a patch,
// `patches` is empty.
//
// Six settings are tried in turn, because a rough scan is better than none: edge_jump_m, twice and four times
// that, each first without and then with closed holes. Each setting is tried on the requested row. Without a
// requested row it is tried on the rows of the object, from its middle outwards. pre: the requested row and
// columns are in the image.
ScanRow find_scan_row(const DepthImage& image, const CameraIntrinsics& camera, const ScanRowRequest& request);

// A device that scans along an image row of the first frame, at a set depth behind the surface that the
// camera saw, along the axis of the camera. It is the default path over any recording. The device touches
// surfaces that the camera saw without gaps. It lifts off over depth edges and holes, because there are no
// points behind them to hold the proxy. While it is lifted, it is in front of everything that the first frame
// shows along its way.
class ImageScan final : public Trajectory {
 public:
  struct Settings : ScanRowRequest {
    double depth_m = 0.01;
    double speed_m_per_s = 0.1;
    double clearance_m = 0.03;
  };

  // Throws InputError if the first frame of the scenario is not an image, if the row or a column is outside
  // the image, if the row shows no patch to touch, or if a part of the path would be behind the camera.
  ImageScan(const Settings& settings, const Scenario& scenario);
  DeviceState at(double time_s) const override { return {path_.at(time_s)}; }
  double duration_s() const override { return path_.duration_s(); }
  std::optional<SurfacePlan> surface_plan(double time_s) const override;
  // "image-scan, row 310, columns 256 to 287 at depth 0.601 to 0.612 m, columns ..."
  std::string aim() const override;
  std::vector<Note> notes() const override;
  int row() const { return scan_.row; }
  const std::vector<ScanPatch>& patches() const { return scan_.patches; }

 private:
  [[noreturn]] void refuse_row(const DepthImage& image, const CameraIntrinsics& camera) const;
  void note_missed_object(const DepthImage& image, const CameraIntrinsics& camera);
  void plan_path(const DepthImage& image, const ImageLayout& layout);

  const Settings settings_;
  ScanRow scan_;
  std::string missed_object_;  // the text of the note "object not scanned"; empty: no note
  PolylinePath path_;
  struct Interval {
    double begins_s = 0, ends_s = 0;
  };
  std::vector<Interval> touches_;  // one for each patch
};

Parameters parameters(ImageScan::Settings& s);
std::string validate(const ImageScan::Settings& s);

}  // namespace remote_touch
