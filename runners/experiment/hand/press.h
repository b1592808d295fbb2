// A device that waits at a point and then presses a set depth into the surface below it, 4.3.2.
#pragma once

#include <string>

#include "core/parameters/parameter.h"
#include "runners/experiment/hand/trajectory.h"
#include "scenarios/interface/scenario.h"
#include "scenarios/interface/surface_time.h"

namespace remote_touch {

class Press final : public Trajectory {
 public:
  struct Settings {
    Vec3 start_m{0, 0, 0};
    double press_at_s = 0.5;
    double depth_m = 0.03;
    SurfaceTime surface = SurfaceTime::newest_frame;
  };

  // The scenario must outlive the trajectory. Throws InputError when it is not a height field.
  Press(const Settings& settings, const Scenario& scenario);
  DeviceState at(double time_s) const override;
  double duration_s() const override { return 0; }
  std::vector<Phase> phases() const override { return {{"the press", settings_.press_at_s}}; }

 private:
  const Settings settings_;
  const Scenario& scenario_;
};

Parameters parameters(Press::Settings& s);
inline std::string validate(const Press::Settings&) {
  return {};
}

}  // namespace remote_touch
