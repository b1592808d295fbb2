#include "runners/experiment/hand/waypoints.h"

namespace remote_touch {

Parameters parameters(Waypoints::Settings& s) {
  return {
      {"waypoints", Rows{{"x_m", "y_m", "z_m", "speed_m_per_s"}, &s.waypoints}, -100, 100,
       "positions, each with the speed of the motion to it; 0 jumps. The first is the start; its speed is ignored"}};
}

std::string validate(const Waypoints::Settings& s) {
  for (std::size_t i = 3; i < s.waypoints.size(); i += 4)
    if (s.waypoints[i] < 0)
      return "waypoints: a speed of " + std::to_string(s.waypoints[i]) + ": expected 0 or more";
  return s.waypoints.empty() ? "waypoints = []: expected one row or more" : "";
}

Waypoints::Waypoints(const Settings& settings, const Scenario&)
    : path_(Vec3(settings.waypoints[0], settings.waypoints[1], settings.waypoints[2])) {
  const std::vector<double>& w = settings.waypoints;
  for (std::size_t i = 4; i + 3 < w.size(); i += 4) path_.go_to({w[i], w[i + 1], w[i + 2]}, w[i + 3]);
}

}  // namespace remote_touch
