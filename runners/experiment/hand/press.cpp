#include "runners/experiment/hand/press.h"

#include <cmath>

#include "core/parameters/input_error.h"

namespace remote_touch {

Parameters parameters(Press::Settings& s) {
  return {
      {"start_m", &s.start_m, -100, 100, "where the device waits"},
      {"press_at_s", &s.press_at_s, 0, 1e6, "time at which the press starts"},
      {"depth_m", &s.depth_m, -1, 1, "depth below the true surface"},
      {"surface", choice(s.surface, {"newest-frame", "moving"}), 0, 0,
       "surface that the HIP follows: newest-frame: as at the last capture; moving: as it moves between frames"},
  };
}

Press::Press(const Settings& settings, const Scenario& scenario) : settings_(settings), scenario_(scenario) {
  if (!std::isfinite(scenario.surface_height(settings.start_m.x(), settings.start_m.z(), 0)))
    throw InputError("trajectory.name = press",
                     "the scenario has no surface height: expected a height field");
}

DeviceState Press::at(double time_s) const {
  if (time_s < settings_.press_at_s) return {settings_.start_m};
  double surface_time_s = time_s;
  if (settings_.surface == SurfaceTime::newest_frame)
    surface_time_s = scenario_.captured_s(scenario_.newest_frame(time_s));
  const double y = scenario_.surface_height(settings_.start_m.x(), settings_.start_m.z(), surface_time_s);
  return {Vec3(settings_.start_m.x(), y - settings_.depth_m, settings_.start_m.z())};
}

}  // namespace remote_touch
