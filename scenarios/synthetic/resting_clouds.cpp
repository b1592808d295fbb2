#include "scenarios/synthetic/resting_clouds.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

Parameters parameters(FlatGrid::Settings& s) {
  return appended(
      parameters(s.grid),
      {{"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames of the cloud per second, f_c"},
       {"noise_sigma_m", &s.noise_sigma_m, 0, 0.1, "standard deviation of the noise on x, y and z", kLive},
       {"redraw_noise", &s.redraw_noise, 0, 1,
        "true: new noise in every frame; false: the same noise in all"}});
}

PointCloud FlatGrid::cloud(int frame) const {
  return sampled(redraw_noise_ ? frame : 0, [](double x, double z) { return Vec3(x, 0, z); });
}

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

Parameters parameters(TriangleWave::Settings& s) {
  const Parameters more = {
      {"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames of the cloud per second, f_c"},
      {"period_m", &s.period_m, 1e-3, 10, "length of one wave along x"},
      {"max_height_m", &s.max_height_m, 0, 10, "peak-to-peak height at the end of the grid; 0 at its start"},
      {"noise_sigma_m", &s.noise_sigma_m, 0, 0.1,
       "standard deviation of the noise on x, y and z, the same in all frames", kLive},
  };
  return appended(parameters(s.grid), more);
}

// A grid of one column has no length along x, so its wave has no flank.
std::string validate(const TriangleWave::Settings& s) {
  return s.grid.columns >= 2 ? "" : "columns = 1: expected 2 or more, because the wave runs along x";
}

// The corners are at every half period from the grid's start, at the envelope's height there: 0, +, -, +, ...
// The wave is straight between them.
double TriangleWave::surface_height(double x, double, double) const {
  const double start = grid_.x(0), length = grid_.x(grid_.columns - 1) - start;
  const double half = 0.5 * settings_.period_m;
  const double place = std::clamp(x - start, 0.0, length) / half;
  const auto corner = [&](double k) {
    const double amplitude = 0.5 * settings_.max_height_m * std::min(1.0, k * half / length);
    return std::fmod(k, 2) == 1 ? amplitude : -amplitude;
  };
  const double k = std::floor(place);
  return corner(k) + (place - k) * (corner(k + 1) - corner(k));
}

// Exact distance to the polyline across x; the wave does not change along z.
double TriangleWave::signed_distance(const Vec3& p_W, double time_s) const {
  constexpr double kAtEnd_m = 1e-9;
  const double start = grid_.x(0), end = grid_.x(grid_.columns - 1);
  const double half = 0.5 * settings_.period_m;
  const int corners = static_cast<int>(std::ceil((end - start) / half)) + 1;
  const double height_m = surface_height(p_W.x(), 0, time_s);
  // A flank beyond this along x is farther away than the surface at the point's x, or at the end beside it.
  const double reach_m =
      std::abs(p_W.y() - height_m) + std::max({start - p_W.x(), p_W.x() - end, 0.0}) + half;
  double nearest = std::numeric_limits<double>::infinity();
  bool is_at_end = false;
  for (int k = 0; k + 1 < corners; ++k) {
    const double x0 = start + k * half, x1 = std::min(x0 + half, end);
    if (x0 - p_W.x() > reach_m || p_W.x() - x1 > reach_m) continue;
    const double y0 = surface_height(x0, 0, time_s), y1 = surface_height(x1, 0, time_s);
    const double ex = x1 - x0, ey = y1 - y0, px = p_W.x() - x0, py = p_W.y() - y0;
    const double t = std::clamp((px * ex + py * ey) / (ex * ex + ey * ey), 0.0, 1.0);
    const double dx = px - t * ex, dy = py - t * ey;
    const double distance = std::sqrt(dx * dx + dy * dy);  // not hypot: its bits depend on the machine
    if (!(distance < nearest)) continue;
    const double foot_x = x0 + t * ex;
    nearest = distance, is_at_end = foot_x <= start + kAtEnd_m || foot_x >= end - kAtEnd_m;
  }
  if (p_W.y() >= height_m) return nearest;
  // Beyond the ends of the grid in x the foot may still be on a flank.
  const double x_m = is_at_end ? p_W.x() : grid_.x(0);
  return grid_.covers(x_m, p_W.z()) ? -nearest : std::numeric_limits<double>::quiet_NaN();
}

PointCloud TriangleWave::cloud(int frame) const {
  return sampled(frame, [&](double x, double z) { return Vec3(x, surface_height(x, 0, 0), z); });
}

}  // namespace remote_touch
