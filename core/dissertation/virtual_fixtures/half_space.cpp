#include "core/dissertation/virtual_fixtures/half_space.h"

namespace remote_touch {

Parameters parameters(HalfSpace::Settings& s) {
  const Parameters own = {
      {"point_m", &s.point_m, -100, 100, "a point of the plane, world frame"},
      {"normal", &s.normal, -1e6, 1e6, "direction into the half-space; any length"},
      {"transition_m", &s.transition_m, 0, 100,
       "the weight of the rule rises linearly from 0 to 1 over this distance from the plane; 0: a step"},
  };
  return appended(parameters(s.values), own);
}

std::string validate(const HalfSpace::Settings& s) {
  if (!(s.normal.norm() > 1e-9)) return "normal: expected longer than 0";
  return validate(s.values);
}

HalfSpace::HalfSpace(const Settings& settings)
    : FixtureRule(settings.values),
      point_W_(settings.point_m),
      normal_W_(settings.normal.normalized()),
      transition_m_(settings.transition_m) {}

std::vector<double> HalfSpace::weights(const PointCloud& cloud) const {
  std::vector<double> weights(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double height = (cloud.point(i) - point_W_).dot(normal_W_);  // NaN fails every comparison
    const bool inside = height >= 0;
    weights[i] = !inside ? 0 : height < transition_m_ ? height / transition_m_ : 1;
  }
  return weights;
}

}  // namespace remote_touch
