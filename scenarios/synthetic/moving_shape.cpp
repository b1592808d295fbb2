#include "scenarios/synthetic/moving_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "core/points/vector.h"
#include "scenarios/synthetic/grid_scene.h"

namespace remote_touch {
namespace {

// Returns sin(2 pi turns), or 0 before the first turn; the same bits on every machine.
double swing(double turns) {
  return turns <= 0 ? 0 : sin_cos(360 * kRadiansPerDegree * (turns - std::floor(turns))).first;
}

// Returns the height at which a vertical line through (x, z) meets the surface. The height above the surface
// increases all along the line, because the surface is nowhere vertical, so bisection finds it.
double height_over(double x, double z, const Shape& shape, const ShapePose& pose) {
  if (pose.sine == 0) return pose.y_m + shape.height(x - pose.x_m, z);
  const auto is_above = [&](double y) {
    const Vec3 p_S = pose.to_S({x, y, z});
    return p_S.y() > shape.height(p_S.x(), p_S.z());
  };
  double reach = 0.001;
  while (reach < 1e6 && (!is_above(pose.y_m + reach) || is_above(pose.y_m - reach))) reach *= 2;
  double low = pose.y_m - reach, high = pose.y_m + reach;
  for (double middle = pose.y_m; middle > low && middle < high; middle = 0.5 * (low + high))
    (is_above(middle) ? high : low) = middle;
  return high;
}

// Returns the first frame at or after that time, or -1 (no frame) if the time is negative.
int first_frame_from(double time_s, double frame_rate_hz) {
  return time_s < 0 ? -1 : static_cast<int>(std::ceil((time_s - kSameTime_s) * frame_rate_hz));
}

}  // namespace

Parameters parameters(ShapeMotion::Settings& s) {
  const Parameters tilt = {
      {"tilt_deg", &s.tilt_deg, -80, 80, "rotation about z through the origin of the shape, from x to y"}};
  const Parameters more = {
      {"slide_velocity_m_per_s", &s.slide_velocity_m_per_s, -10, 10, "velocity along x, added to the lift"},
      {"shake_amplitude_m", &s.shake_amplitude_m, 0, 1, "amplitude of a vertical sine, added to the lift"},
      {"shake_hz", &s.shake_hz, 0, 1000, "frequency of the shake"},
      {"rock_deg", &s.rock_deg, 0, 45, "amplitude of the rocking about z, added to the tilt"},
      {"rock_hz", &s.rock_hz, 0, 1000, "frequency of the rocking"},
      {"motion_from_s", &s.motion_from_s, 0, 10000, "time at which slide, shake and rocking start"},
  };
  return appended(appended(tilt, parameters(s.lift)), more);
}

ShapeMotion::ShapeMotion(const Settings& settings, double frame_rate_hz)
    : settings_(settings), frame_rate_hz_(frame_rate_hz), lift_(settings.lift) {}

ShapePose ShapeMotion::moved(double lift_m, double time_s) const {
  const double moving_s = std::max(0.0, time_s - settings_.motion_from_s);
  ShapePose pose;
  pose.x_m = moving_s * settings_.slide_velocity_m_per_s;
  pose.y_m = lift_m;
  if (settings_.shake_amplitude_m > 0)
    pose.y_m += settings_.shake_amplitude_m * swing(moving_s * settings_.shake_hz);
  double rotation_deg = settings_.tilt_deg;
  if (settings_.rock_deg > 0) rotation_deg += settings_.rock_deg * swing(moving_s * settings_.rock_hz);
  if (rotation_deg != 0) std::tie(pose.sine, pose.cosine) = sin_cos(rotation_deg * kRadiansPerDegree);
  return pose;
}

ShapePose ShapeMotion::of_frame(int frame) const {
  return moved(lift_.height_of_frame_m(frame, frame_rate_hz_), frame / frame_rate_hz_);
}

ShapePose ShapeMotion::at(double time_s) const {
  return moved(lift_.height_m(time_s), time_s);
}

std::vector<Phase> ShapeMotion::phases() const {
  std::vector<Phase> list = lift_.phases();
  if (!ever_rests()) list.push_back({"the slide, shake or rocking", settings_.motion_from_s});
  return list;
}

bool ShapeMotion::ever_rests() const {
  const bool shakes = settings_.shake_amplitude_m > 0 && settings_.shake_hz > 0;
  const bool rocks = settings_.rock_deg > 0 && settings_.rock_hz > 0;
  return settings_.slide_velocity_m_per_s == 0 && !shakes && !rocks;
}

bool ShapeMotion::moves_vertically_only() const {
  return settings_.tilt_deg == 0 && settings_.rock_deg == 0 && settings_.slide_velocity_m_per_s == 0;
}

Parameters parameters(MovingShape::Settings& s) {
  Parameters list = parameters(s.grid);
  list.push_back({"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames of the cloud per second, f_c"});
  list = appended(appended(std::move(list), parameters(s.shape)), parameters(s.motion));
  const Parameters more = {
      {"layers", &s.layers, 1, 5, "number of parallel surfaces; the first is on top and is the true surface"},
      {"layer_spacing_m", &s.layer_spacing_m, 1e-4, 1, "from one layer to the next, along y of the shape"},
      {"normals", &s.normals, 0, 0, "the points have the normals of the true surface, as tools need them"},
      {"noise_sigma_m", &s.noise_sigma_m, 0, 0.1, "standard deviation of the noise on x, y and z", kLive},
      {"redraw_noise", &s.redraw_noise, 0, 1, "true: new noise in every frame; false: the same noise in all"},
      {"vanish_at_s", &s.vanish_at_s, -1, 10000, "frames from this time on have no points; negative: never"},
      {"empty_frame_at_s", &s.empty_frame_at_s, -1, 10000,
       "the first frame from this time on has no points; negative: none"},
      {"truth", choice(s.truth, {"newest-frame", "moving"}), 0, 0,
       "true surface: newest-frame: as at the last capture; moving: as it moves between frames"},
  };
  return appended(std::move(list), more);
}

std::string validate(const MovingShape::Settings& s) {
  const double steepest = steepest_deg(s.shape) + std::abs(s.motion.tilt_deg) + s.motion.rock_deg;
  if (steepest < 89) return {};
  return "tilt_deg = " + std::to_string(s.motion.tilt_deg) +
         ": expected so that slope, tilt and rocking stay below 89 degrees together, not " +
         std::to_string(steepest);
}

MovingShape::MovingShape(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
    : GridScene(settings, key, kernels, settings.truth == SurfaceTime::moving),
      settings_(settings),
      shape_(settings.shape, settings.grid),
      motion_(settings.motion, settings.frame_rate_hz),
      vanish_frame_(first_frame_from(settings.vanish_at_s, settings.frame_rate_hz)),
      empty_frame_(first_frame_from(settings.empty_frame_at_s, settings.frame_rate_hz)) {
  for (int row = 0; row < grid_.rows; ++row)
    for (int column = 0; column < grid_.columns; ++column)
      nodes_S_.push_back(shape_.point(grid_.x(column), grid_.z(row))),
          normals_S_.push_back(shape_.normal(grid_.x(column), grid_.z(row)));
}

int MovingShape::frame_count() const {
  if (vanish_frame_ >= 0) return vanish_frame_ + 1;
  if (!motion_.ever_rests()) return std::numeric_limits<int>::max();
  return frames_of(std::max(motion_.lift_frames(), empty_frame_ + 2), settings_.redraw_noise);
}

std::vector<Phase> MovingShape::phases() const {
  std::vector<Phase> list;
  if (vanish_frame_ >= 0) list.push_back({"the vanishing of the surface", settings_.vanish_at_s});
  if (empty_frame_ >= 0) list.push_back({"the empty frame", settings_.empty_frame_at_s});
  for (Phase& phase : motion_.phases()) list.push_back(std::move(phase));
  return list;
}

bool MovingShape::is_a_level_grid() const {
  return settings_.shape.kind == Shape::Kind::flat && settings_.layers == 1 &&
         motion_.moves_vertically_only() && !settings_.normals;
}

std::shared_ptr<const NeighbourSearch> MovingShape::points(int frame) const {
  if (is_a_level_grid() && !is_empty(frame))
    return std::make_shared<NoisyGridSearch>(grid_, motion_.of_frame(frame).y_m, noise_sigma_m_,
                                             noise(noise_frame(frame)));
  return GridScene::points(frame);
}

PointCloud MovingShape::cloud(int frame) const {
  PointCloud cloud;
  if (is_empty(frame)) return cloud;
  const ShapePose pose = motion_.of_frame(frame);
  const std::size_t size = nodes_S_.size() * static_cast<std::size_t>(settings_.layers);
  cloud.x.reserve(size), cloud.y.reserve(size), cloud.z.reserve(size);
  for (int layer = 0; layer < settings_.layers; ++layer) {
    const Vec3 below(0, layer * settings_.layer_spacing_m, 0);
    for (std::size_t i = 0; i < nodes_S_.size(); ++i) {
      const Vec3 p_W = pose.to_W(nodes_S_[i] - below);
      if (settings_.normals)
        cloud.append(p_W, pose.direction_to_W(normals_S_[i]));
      else
        cloud.append(p_W);
    }
  }
  cloud.grid_columns = grid_.columns;  // layer after layer, each whole rows
  return with_noise(std::move(cloud), noise_frame(frame));
}

ShapePose MovingShape::true_pose(double time_s) const {
  return has_moving_truth_ ? motion_.at(time_s) : motion_.of_frame(newest_frame(time_s));
}

double MovingShape::signed_distance(const Vec3& p_W, double time_s) const {
  if (has_vanished(newest_frame(time_s))) return std::numeric_limits<double>::quiet_NaN();
  return shape_.signed_distance(true_pose(time_s).to_S(p_W));
}

std::optional<Vec3> MovingShape::plane_normal(double time_s) const {
  if (settings_.shape.kind != Shape::Kind::flat || has_vanished(newest_frame(time_s))) return {};
  return true_pose(time_s).direction_to_W(Vec3::UnitY());
}

double MovingShape::surface_height(double x, double z, double time_s) const {
  const double until_s = settings_.vanish_at_s >= 0 ? settings_.vanish_at_s : time_s;
  return height_over(x, z, shape_, motion_.at(std::min(time_s, until_s)));
}

}  // namespace remote_touch
