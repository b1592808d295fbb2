#include "runners/experiment/hand/trajectory.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/points/noise.h"
#include "core/points/vector.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {

namespace {

// The place of a time among others: the index of the next one, and the fraction of the way to it.
struct TimePlace {
  std::size_t next = 0;
  std::optional<double> fraction;  // none before the first time and after the last one
};

// At a jump, whose times are equal, it is the end of the jump.
TimePlace place_in(const std::vector<double>& times_s, double time_s) {
  const auto next = std::upper_bound(times_s.begin(), times_s.end(), time_s);
  if (next == times_s.end()) return {times_s.size() - 1, {}};
  if (next == times_s.begin()) return {};
  return {static_cast<std::size_t>(next - times_s.begin()), (time_s - *(next - 1)) / (*next - *(next - 1))};
}

constexpr std::size_t kColumns = 7;
constexpr double kHalfRotation_deg = 179.99;

DeviceState pose(const double* row) {
  return {{row[0], row[1], row[2]}, rotation(kRadiansPerDegree * Vec3(row[3], row[4], row[5]))};
}

Vec3 rotation_to(const DeviceState& from, const DeviceState& to) {
  return rotation_vector(to.orientation_W * from.orientation_W.conjugate());
}

// Spacing of the samples of the surface. A vertical step becomes a slope of this width.
constexpr double kSampling_m = 1e-4;

constexpr const char* kFollowSubject = "trajectory.name = follow-surface";

// Returns the line from start to end, without its height.
Vec3 level_line_m(const FollowSurface::Settings& s) {
  return {s.to_m.x() - s.from_m.x(), 0, s.to_m.z() - s.from_m.z()};
}

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

// The sines' shares of the extent, and their relative rates. The ratios of the rates are irrational: the
// golden and the silver ratio.
constexpr double kFraction[] = {0.5, 0.3, 0.2};
constexpr double kRate[] = {1, 1.618033988749895, 2.414213562373095};
// The rates of the axes differ too, so that no two stay in phase: they are powers of two, with tenths and
// twelfths as exponents.
constexpr double kAxisRate[] = {
    1, 1.0717734625362931, 0.9438743126816935, 1.1486983549970351, 0.8705505632961241, 1.2311444133449163};
constexpr double kTwoPi = 6.283185307179586;

// Returns the rate of the first sine of x, rad/s, at which the largest speeds of all sines add up to the
// allowed speed.
double rate_of_first_sine(const RandomMotion::Settings& s) {
  double of_all = 0;
  for (int i = 0; i < 3; ++i) of_all += kFraction[i] * kRate[i];
  const Vec3 of_axes = of_all * s.extent_m.cwiseProduct(Vec3(kAxisRate[0], kAxisRate[1], kAxisRate[2]));
  return s.speed_m_per_s / of_axes.norm();
}

}  // namespace

void PolylinePath::go_to(const Vec3& p, double speed_m_per_s) {
  const double duration = speed_m_per_s > 0 ? (p - points_.back()).norm() / speed_m_per_s : 0;
  arrival_s_.push_back(arrival_s_.back() + duration);
  points_.push_back(p);
}

void PolylinePath::wait(double duration_s) {
  arrival_s_.push_back(arrival_s_.back() + duration_s);
  points_.push_back(points_.back());
}

Vec3 PolylinePath::at(double time_s) const {
  const auto [i, fraction] = place_in(arrival_s_, time_s);
  if (!fraction) return points_[i];
  return points_[i - 1] + *fraction * (points_[i] - points_[i - 1]);
}

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

Parameters parameters(Poses::Settings& s) {
  return {
      {"poses", Rows{{"x_m", "y_m", "z_m", "rx_deg", "ry_deg", "rz_deg", "duration_s"}, &s.poses}, -1000,
       1000,
       "poses: position, rotation vector (axis times angle, world frame) and duration of the motion to it; 0 jumps. The first pose is the start; its duration is ignored. A motion rotates by less than 180 degrees, in the shorter direction; for more, insert a pose"}};
}

std::string validate(const Poses::Settings& s) {
  if (s.poses.empty()) return "poses = []: expected one row or more";
  for (std::size_t i = 0; i + kColumns <= s.poses.size(); i += kColumns) {
    const double* const row = s.poses.data() + i;
    if (row[6] < 0) return "poses: a duration of " + std::to_string(row[6]) + ": expected 0 or more";
    if (i > 0 && row[6] > 0 &&
        rotation_to(pose(row - kColumns), pose(row)).norm() > kHalfRotation_deg * kRadiansPerDegree)
      return "poses: row " + std::to_string(i / kColumns) +
             " is rotated by 180 degrees from the row before: expected less, because the direction of rotation is "
             "ambiguous";
  }
  return "";
}

Poses::Poses(const Settings& settings, const Scenario&)
    : poses_{pose(settings.poses.data())}, arrival_s_{0}, rotation_W_{Vec3::Zero()} {
  for (std::size_t i = kColumns; i + kColumns <= settings.poses.size(); i += kColumns) {
    const double* const row = settings.poses.data() + i;
    const DeviceState next = pose(row);
    rotation_W_.push_back(rotation_to(poses_.back(), next));
    arrival_s_.push_back(arrival_s_.back() + row[6]);
    poses_.push_back(next);
  }
}

DeviceState Poses::at(double time_s) const {
  const auto [i, fraction] = place_in(arrival_s_, time_s);
  if (!fraction) return poses_[i];
  const DeviceState &from = poses_[i - 1], &to = poses_[i];
  return {from.position_W + *fraction * (to.position_W - from.position_W),
          (rotation(*fraction * rotation_W_[i]) * from.orientation_W).normalized()};
}

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
    refuse("trajectory.name = press", "the scenario has no surface height: expected a height field");
}

DeviceState Press::at(double time_s) const {
  if (time_s < settings_.press_at_s) return {settings_.start_m};
  double surface_time_s = time_s;
  if (settings_.surface == SurfaceTime::newest_frame)
    surface_time_s = scenario_.captured_s(scenario_.newest_frame(time_s));
  const double y = scenario_.surface_height(settings_.start_m.x(), settings_.start_m.z(), surface_time_s);
  return {Vec3(settings_.start_m.x(), y - settings_.depth_m, settings_.start_m.z())};
}

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
    refuse(kFollowSubject, "the scenario has no surface height: expected a height field");
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
        refuse(kFollowSubject, "the surface changes its shape or place along the line at ", time_s,
               " s: expected a surface that is at rest, or rises and sinks as a whole");
  }
}

DeviceState FollowSurface::at(double time_s) const {
  Vec3 p_W = path_.at(time_s);
  if (moves_) p_W.y() += risen_m(p_W, time_s);
  return {p_W};
}

Parameters parameters(RandomMotion::Settings& s) {
  return {
      {"centre_m", &s.centre_m, -100, 100, "centre of the box that the device stays in"},
      {"extent_m", &s.extent_m, 0, 100, "half size of the box"},
      {"max_rotation_deg", &s.max_rotation_deg, 0, 180, "maximum rotation"},
      {"speed_m_per_s", &s.speed_m_per_s, 0, 100, "maximum speed"},
      {"seed", &s.seed, 0, 18446744073709551615.0, "seed of the motion"},
      {"duration_s", &s.duration_s, 1e-3, 1e5, "duration of the motion; the device then stops"},
  };
}

std::string validate(const RandomMotion::Settings& s) {
  if (!(s.extent_m.norm() > 0)) return "extent_m = 0, 0, 0: expected above 0 along one axis or more";
  return rate_of_first_sine(s) * s.duration_s < 1e5
             ? ""
             : "extent_m is too small for speed_m_per_s and duration_s: expected fewer than 15000 oscillations";
}

RandomMotion::RandomMotion(const Settings& settings, const Scenario&)
    : settings_(settings), rate_(rate_of_first_sine(settings)) {
  const NoiseStream stream = noise_stream({settings.seed}, NoiseUse::motion, 0);
  for (std::size_t axis = 0; axis < 6; ++axis) {
    const auto random = uniforms(stream, static_cast<std::uint32_t>(axis));
    for (std::size_t i = 0; i < kSines; ++i) phase_[axis][i] = kTwoPi * random[i];
  }
}

double RandomMotion::coordinate(int axis, double time_s) const {
  double sum = 0;
  for (int i = 0; i < kSines; ++i) {
    const double phase = phase_[static_cast<std::size_t>(axis)][static_cast<std::size_t>(i)];
    sum += kFraction[i] * sin_cos(kRate[i] * kAxisRate[axis] * rate_ * time_s + phase).first;
  }
  return sum;
}

DeviceState RandomMotion::at(double time_s) const {
  const double t = std::clamp(time_s, 0.0, settings_.duration_s);
  Vec3 position, angles;
  for (int axis = 0; axis < 3; ++axis) {
    position[axis] = settings_.centre_m[axis] + settings_.extent_m[axis] * coordinate(axis, t);
    angles[axis] = coordinate(axis + 3, t);
  }
  // The rotation vector lies in a cube, whose corners are farther from the centre than its faces by the root
  // of three. The division keeps the rotation below max_rotation_deg.
  constexpr double root_of_three = 1.7320508075688772;
  return {position, rotation(settings_.max_rotation_deg * kRadiansPerDegree / root_of_three * angles)};
}

}  // namespace remote_touch
