// A device that scans along an image row of the first frame, at a set depth behind the surface that the
// camera saw, along the axis of the camera. It is the default path over any recording. The device touches
// surfaces that the camera saw without gaps. It lifts off over depth edges and holes, because there are no
// points behind them to hold the proxy. While it is lifted, it is in front of everything that the first frame
// shows along its way.
#pragma once

#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "runners/experiment/hand/polyline_path.h"
#include "runners/experiment/hand/scan_row.h"
#include "runners/experiment/hand/trajectory.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

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
