#include "scenarios/synthetic/listed_points.h"

namespace remote_touch {

Parameters parameters(ListedPoints::Settings& s) {
  return {
      {"points", Rows{{"x_m", "y_m", "z_m"}, &s.points}, -100, 100, "the points, world frame"},
      {"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames per second, when fixtures change with time"},
  };
}

std::string validate(const ListedPoints::Settings& s) {
  return s.points.empty() ? "points: expected one or more" : "";
}

PointCloud ListedPoints::cloud(int) const {
  PointCloud cloud;
  const std::vector<double>& p = settings_.points;
  for (std::size_t i = 0; i + 2 < p.size(); i += 3) cloud.append({p[i], p[i + 1], p[i + 2]});
  return cloud;
}

}  // namespace remote_touch
