// A device that moves along a straight line over a height field, a set depth below the true surface.
#pragma once

#include <string>

#include "core/parameters/parameter.h"
#include "runners/experiment/hand/polyline_path.h"
#include "runners/experiment/hand/trajectory.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

// The HIP keeps its distance to every part of the surface along the line (a parallel curve, not a vertical
// shift). It lifts off over steps and comes down behind them: a frictionless proxy stays at the wall of a
// step as long as the HIP is below the step's top, so a HIP that stayed inside would only build up force. The
// HIP moves at constant speed along its own path, approaches from above and leaves upwards.
class FollowSurface final : public Trajectory {
 public:
  struct Settings {
    Vec3 from_m{-0.1, 0, 0};
    Vec3 to_m{0.1, 0, 0};
    double depth_m = 0.005;
    double speed_m_per_s = 0.05;
    double clearance_m = 0.02;
    double step_m = 0.02;
    double step_margin_m = 0.01;
  };

  // Throws InputError if the scenario has no surface height at the start of the line.
  FollowSurface(const Settings& settings, const Scenario& scenario);
  DeviceState at(double time_s) const override { return {path_.at(time_s)}; }
  double duration_s() const override { return path_.duration_s(); }

 private:
  PolylinePath path_;
};

Parameters parameters(FollowSurface::Settings& s);
std::string validate(const FollowSurface::Settings& s);

}  // namespace remote_touch
