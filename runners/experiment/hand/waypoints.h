// A device that visits listed points, each at its own speed.
#pragma once

#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "runners/experiment/hand/polyline_path.h"
#include "runners/experiment/hand/trajectory.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

class Waypoints final : public Trajectory {
 public:
  struct Settings {
    // Each row has x, y, z in metres and the speed in m/s of the motion to this position; speed 0 jumps. The
    // first row is the start; its speed is not used.
    std::vector<double> waypoints{0, 0.01, 0, 0};
  };

  Waypoints(const Settings& settings, const Scenario& scenario);
  DeviceState at(double time_s) const override { return {path_.at(time_s)}; }
  double duration_s() const override { return path_.duration_s(); }

 private:
  PolylinePath path_;
};

Parameters parameters(Waypoints::Settings& s);
std::string validate(const Waypoints::Settings& s);

}  // namespace remote_touch
