// A device that scans along an image row of the first frame, a set depth behind the surface that the camera
// saw: the default path over any recording. It touches surfaces that the camera saw without gaps, and lifts
// off over depth edges and holes: behind those there are no points to hold the proxy.
#pragma once

#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "runners/trajectories/polyline_path.h"
#include "runners/trajectories/trajectory.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

// A part of the row without holes or edges, both ends included.
struct ScanPatch {
  int first_column = 0, last_column = 0;
};

class ImageScan final : public Trajectory {
 public:
  struct Settings {
    int row = -1;
    int first_column = -1;
    int last_column = -1;
    double depth_m = 0.01;
    double speed_m_per_s = 0.1;
    double clearance_m = 0.03;
    double span_m = 0.3;
    double edge_jump_m =
        0.006;  // below sqrt(2) r_c: the proxy falls through a square of points wider than that
    double margin_m = 0.01;
  };

  // Throws InputError when the scenario's frames are not organised images or the row shows no patch to touch.
  ImageScan(const Settings& settings, const Scenario& scenario);
  DeviceState at(double time_s) const override { return {path_.at(time_s)}; }
  double duration_s() const override { return path_.duration_s(); }
  int row() const { return row_; }
  const std::vector<ScanPatch>& patches() const { return patches_; }

 private:
  int row_ = 0;
  std::vector<ScanPatch> patches_;
  PolylinePath path_;
};

Parameters parameters(ImageScan::Settings& s);
std::string validate(const ImageScan::Settings& s);

}  // namespace remote_touch
