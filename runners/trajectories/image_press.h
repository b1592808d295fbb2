// A device that presses along the ray of one pixel, a set depth behind the surface of the newest frame: it
// stays in contact while the camera or the scene moves.
#pragma once

#include <map>
#include <string>

#include "core/parameters/parameter.h"
#include "runners/trajectories/trajectory.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

// If a frame shows no gap-free surface around the pixel, the device lifts off until one does.
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
    double margin_m = 0.01;
  };

  // The scenario must outlive the trajectory. Throws InputError when its frames are not organised images, or
  // when the first frame shows nothing to touch at the pixel.
  ImagePress(const Settings& settings, const Scenario& scenario);
  DeviceState at(double time_s) const override;
  double duration_s() const override { return 0; }
  std::vector<Phase> phases() const override { return {{"the press", settings_.press_at_s}}; }

 private:
  double surface_depth(int frame) const;

  const Settings settings_;
  const Scenario& scenario_;
  ImageLayout image_;
  int row_ = 0, column_ = 0;
  mutable std::map<int, double> depths_;  // cache, by frame: many ticks use the same one
};

Parameters parameters(ImagePress::Settings& s);
inline std::string validate(const ImagePress::Settings&) {
  return {};
}

}  // namespace remote_touch
