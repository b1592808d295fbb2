#include "runners/experiment/hand/follow_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/parameters/input_error.h"

namespace remote_touch {

namespace {
// Spacing of the samples of the surface. A vertical step becomes a slope of this width.
constexpr double kSampling_m = 1e-4;

// Returns the line from start to end, without its height.
Vec3 level_line_m(const FollowSurface::Settings& s) {
  return {s.to_m.x() - s.from_m.x(), 0, s.to_m.z() - s.from_m.z()};
}
}  // namespace

Parameters parameters(FollowSurface::Settings& s) {
  return {
      {"from_m", &s.from_m, -100, 100, "start; its height is not used"},
      {"to_m", &s.to_m, -100, 100, "end; its height is not used"},
      {"depth_m", &s.depth_m, 0, 1, "depth of the HIP below the surface"},
      {"speed_m_per_s", &s.speed_m_per_s, 1e-6, 100, "speed along the HIP's path"},
      {"clearance_m", &s.clearance_m, 0, 10,
       "height above the surface at the start, at the end and over steps"},
      {"step_m", &s.step_m, 0, 100, "height difference within step_margin_m above which there is a step"},
      {"step_margin_m", &s.step_margin_m, 1e-4, 1,
       "distance before and after a step at which the HIP is lifted"},
  };
}

std::string validate(const FollowSurface::Settings& s) {
  return level_line_m(s).norm() > 0 ? "" : "to_m: expected another x or z than that of from_m";
}

namespace {

// Returns the heights of the curve that stays at distance `depth` below a profile with samples every
// `spacing`. It is the lower envelope of circles around the samples.
std::vector<double> inside(const std::vector<double>& heights, double spacing, double depth) {
  const int count = static_cast<int>(heights.size()), reach = static_cast<int>(std::abs(depth) / spacing);
  std::vector<double> result(heights.size(), std::numeric_limits<double>::infinity());
  for (int i = 0; i < count; ++i)
    for (int j = std::max(0, i - reach); j <= std::min(count - 1, i + reach); ++j) {
      const double offset = (i - j) * spacing;
      const double circle = std::sqrt(std::max(0.0, depth * depth - offset * offset));
      double& lowest = result[static_cast<std::size_t>(i)];
      lowest = std::min(lowest, heights[static_cast<std::size_t>(j)] - circle);
    }
  return result;
}

// Returns, for each sample of the profile, the height of the upper end of a step within step_margin_m; minus
// infinity if there is no step.
std::vector<double> step_tops(const std::vector<double>& heights, double spacing,
                              const FollowSurface::Settings& s) {
  const auto count = static_cast<std::ptrdiff_t>(heights.size());
  const auto reach = static_cast<std::ptrdiff_t>(s.step_margin_m / spacing);
  std::vector<double> tops(heights.size(), -std::numeric_limits<double>::infinity());
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const auto first = heights.begin() + std::max<std::ptrdiff_t>(0, i - reach);
    const auto last = heights.begin() + std::min(count - 1, i + reach) + 1;
    const auto [low, high] = std::minmax_element(first, last);
    if (*high - *low > s.step_m) tops[static_cast<std::size_t>(i)] = *high;
  }
  return tops;
}

}  // namespace

FollowSurface::FollowSurface(const Settings& s, const Scenario& scenario)
    : scenario_(scenario), path_(s.from_m) {
  const Vec3 path = level_line_m(s);
  const int pieces = static_cast<int>(std::ceil(path.norm() / kSampling_m));
  std::vector<double> heights;
  std::vector<Vec3> positions;
  for (int i = 0; i <= pieces; ++i) {
    positions.push_back(s.from_m + (static_cast<double>(i) / pieces) * path);
    heights.push_back(scenario.surface_height(positions.back().x(), positions.back().z(), 0));
  }
  if (!std::isfinite(heights.front()))
    throw InputError("trajectory.name = follow-surface",
                     "the scenario has no surface height: expected a height field");
  const std::vector<double> depths = inside(heights, path.norm() / pieces, s.depth_m);
  const std::vector<double> tops = step_tops(heights, path.norm() / pieces, s);
  const auto at_height = [&](std::size_t i, double y) { return Vec3(positions[i].x(), y, positions[i].z()); };
  path_ = PolylinePath(at_height(0, heights.front() + s.clearance_m));
  for (std::size_t i = 0; i < positions.size(); ++i)
    path_.go_to(at_height(i, std::max(depths[i], tops[i] + s.clearance_m)), s.speed_m_per_s);
  path_.go_to(at_height(positions.size() - 1, heights.back() + s.clearance_m), s.speed_m_per_s);
  follow(s);
}

double FollowSurface::risen_m(const Vec3& at_W, double time_s) const {
  return scenario_.surface_height(at_W.x(), at_W.z(), scenario_.truth_time_s(time_s)) -
         scenario_.surface_height(at_W.x(), at_W.z(), 0);
}

// Compares the heights along the line during the motion. Heights that are unknown count as at rest.
void FollowSurface::follow(const Settings& s) {
  constexpr double kEvery_s = 0.005, kSame_m = 1e-9, kMostTimes = 20000, kMostHeights = 2e5;
  if (scenario_.frame_count() == 1) return;
  const double times = std::min(std::ceil(path_.duration_s() / kEvery_s), kMostTimes);
  const Vec3 line_m = level_line_m(s);
  const double pieces = std::ceil(std::clamp(line_m.norm() / kSampling_m, 2.0, kMostHeights / times));
  for (int i = 1; i <= times; ++i) {
    const double time_s = path_.duration_s() * i / times, first_m = risen_m(s.from_m, time_s);
    moves_ |= std::abs(first_m) > kSame_m;
    for (double piece = 1; piece <= pieces; ++piece)
      if (std::abs(risen_m(s.from_m + piece / pieces * line_m, time_s) - first_m) > kSame_m)
        throw InputError("trajectory.name = follow-surface",
                         "the surface changes its shape or place along the line at " +
                             std::to_string(time_s) +
                             " s: expected a surface that is at rest, or rises and sinks as a whole");
  }
}

DeviceState FollowSurface::at(double time_s) const {
  Vec3 p_W = path_.at(time_s);
  if (moves_) p_W.y() += risen_m(p_W, time_s);
  return {p_W};
}

}  // namespace remote_touch
