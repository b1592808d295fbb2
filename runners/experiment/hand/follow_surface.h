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
// HIP moves at constant speed along its own path, approaches from above and leaves upwards. The path is that
// over the surface at time 0. If the surface rises or sinks as a whole, the HIP rises and sinks with it: with
// the true surface, from which signed_distance() measures.
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

  // The scenario must outlive the motion. Throws InputError if the scenario has no surface height at the
  // start of the line, or if the surface moves otherwise than up and down as a whole.
  FollowSurface(const Settings& settings, const Scenario& scenario);
  DeviceState at(double time_s) const override;
  double duration_s() const override { return path_.duration_s(); }

 private:
  double risen_m(const Vec3& at_W, double time_s) const;  // change of the height of the surface since time 0
  void follow(const Settings& settings);                  // sets moves_

  const Scenario& scenario_;
  PolylinePath path_;
  bool moves_ = false;
};

Parameters parameters(FollowSurface::Settings& s);
std::string validate(const FollowSurface::Settings& s);

}  // namespace remote_touch
