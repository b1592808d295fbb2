// Device motions that are planned on depth images: a press at a pixel, and a scan along a row.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "core/points/point_cloud.h"
#include "runners/experiment/hand/image_surface.h"
#include "runners/experiment/hand/trajectory.h"
#include "scenarios/simulated/scenario.h"

namespace remote_touch {

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
