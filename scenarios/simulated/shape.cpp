#include "scenarios/simulated/shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "core/points/vector.h"
#include "scenarios/simulated/grid_scenes.h"

namespace remote_touch {

namespace {

constexpr double kFullRotation = 360 * kRadiansPerDegree;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kSame_m = 1e-9;  // tolerance for a position on the border

}  // namespace

Parameters parameters(Shape::Settings& s) {
  return {
      {"shape", choice(s.kind, {"flat", "ridge", "valley", "sphere", "ripple", "corner"}), 0, 0,
       "flat; ridge or valley along z; sphere: upper half of a ball; ripple: sine along x; corner: top of a pyramid with three faces"},
      {"slope_deg", &s.slope_deg, 0, 80,
       "slope of the flanks of a ridge or valley, or of the faces of a corner"},
      {"radius_m", &s.radius_m, 0.001, 10, "radius of the sphere; its top is the origin"},
      {"amplitude_m", &s.amplitude_m, 0, 1, "amplitude of the ripple"},
      {"period_m", &s.period_m, 0.001, 10, "period of the ripple, along x"},
  };
}

double steepest_deg(const Shape::Settings& s) {
  switch (s.kind) {
    case Shape::Kind::ridge:
    case Shape::Kind::valley:
    case Shape::Kind::corner:
      return s.slope_deg;
    case Shape::Kind::ripple:
      return std::atan(kFullRotation * s.amplitude_m / s.period_m) / kRadiansPerDegree;
    default:
      return 0;
  }
}

Shape::Shape(const Settings& settings, const Grid& grid)
    : settings_(settings),
      grid_(grid),
      x0_(grid.x(0)),
      x1_(grid.x(grid.columns - 1)),
      z0_(grid.z(0)),
      z1_(grid.z(grid.rows - 1)) {
  const auto [sine, cosine] = sin_cos(settings.slope_deg * kRadiansPerDegree);
  if (settings.kind == Kind::flat) add_flank(x0_, x1_, 0);
  for (std::size_t k = 0; k < faces_.size(); ++k) {
    const auto [up, across] = sin_cos((90 + 120 * static_cast<double>(k)) * kRadiansPerDegree);
    faces_[k] = {sine * across, cosine, sine * up};
  }
  if (settings.kind != Kind::ridge && settings.kind != Kind::valley) return;
  slope_ = (settings.kind == Kind::ridge ? -sine : sine) / cosine;
  if (x0_ < 0) add_flank(x0_, std::min(0.0, x1_), -slope_);
  if (x1_ > 0 || x0_ >= 0) add_flank(std::max(0.0, x0_), x1_, slope_);
}

// Adds the part from x0 to x1 of the plane y = slope x.
void Shape::add_flank(double x0, double x1, double slope) {
  const double x = 0.5 * (x0 + x1), along = std::sqrt(1 + slope * slope);
  FlatPanel flank;
  flank.centre = {x, slope * x, 0.5 * (z0_ + z1_)};
  flank.u = Vec3(1, slope, 0) / along;
  flank.normal = Vec3(-slope, 1, 0) / along;
  flank.half_u_m = 0.5 * (x1 - x0) * along;
  flank.half_v_m = 0.5 * (z1_ - z0_);
  flanks_.push_back(flank);
}

Shape::Wave Shape::wave(double x) const {
  const double periods = x / settings_.period_m, per_m = kFullRotation / settings_.period_m;
  const auto [sine, cosine] = sin_cos(kFullRotation * (periods - std::floor(periods)));
  const double height_m = settings_.amplitude_m * sine;
  return {height_m, settings_.amplitude_m * per_m * cosine, -per_m * per_m * height_m};
}

double Shape::height(double x, double z) const {
  const double r = settings_.radius_m;
  switch (settings_.kind) {
    case Kind::ridge:
    case Kind::valley:
      return slope_ * std::abs(x);
    case Kind::sphere:
      return std::sqrt(std::max(0.0, r * r - x * x - z * z)) - r;
    case Kind::ripple:
      return wave(x).height_m;
    case Kind::corner: {  // the lowest of its planes
      double height_m = std::numeric_limits<double>::infinity();
      for (const Vec3& n : faces_) height_m = std::min(height_m, -(n.x() * x + n.z() * z) / n.y());
      return height_m;
    }
    default:
      return 0;
  }
}

Vec3 Shape::normal(double x, double z) const {
  switch (settings_.kind) {
    case Kind::ridge:
    case Kind::valley:
      return Vec3(x < 0 ? slope_ : -slope_, 1, 0).normalized();
    case Kind::sphere:
      return Vec3(x, height(x, z) + settings_.radius_m, z).normalized();
    case Kind::ripple:
      return Vec3(-wave(x).slope, 1, 0).normalized();
    case Kind::corner:
      return *std::max_element(faces_.begin(), faces_.end(), [&](const Vec3& a, const Vec3& b) {
        return a.x() * x + a.z() * z < b.x() * x + b.z() * z;
      });
    default:
      return Vec3::UnitY();
  }
}

Vec3 Shape::point(double x, double z) const {
  if (settings_.kind == Kind::sphere && x * x + z * z > settings_.radius_m * settings_.radius_m)
    return Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  return {x, height(x, z), z};
}

double Shape::signed_distance(const Vec3& p_S) const {
  if (settings_.kind == Kind::sphere) return distance_to_dome(p_S);
  if (settings_.kind == Kind::ripple) return distance_to_wave(p_S);
  if (settings_.kind == Kind::corner) return distance_to_corner(p_S);
  const bool over = p_S.x() >= x0_ && p_S.x() <= x1_ && p_S.z() >= z0_ && p_S.z() <= z1_;
  if (settings_.kind == Kind::flat && over) return p_S.y();  // exact to the last bit
  const double distance_m = remote_touch::signed_distance(flanks_, p_S);
  // Deep below a ridge, one of its lower borders is nearest. p is still below the ridge, so the sign is
  // known.
  return std::isnan(distance_m) && covers(p_S) ? -distance_to_flanks(p_S) : distance_m;
}

bool Shape::covers(const Vec3& p_S) const {
  return grid_.covers(p_S.x(), p_S.z());
}

// Returns the distance to the nearest flank, without a sign.
double Shape::distance_to_flanks(const Vec3& p_S) const {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const FlatPanel& flank : flanks_) nearest_m = std::min(nearest_m, (p_S - flank.nearest(p_S)).norm());
  return nearest_m;
}

// Above the plane through the ball's centre, the nearest point is on the half ball. Below it, the nearest
// point is on the rim, and the dome covers only positions within the rim.
double Shape::distance_to_dome(const Vec3& p_S) const {
  const double r = settings_.radius_m, y = p_S.y() + r;
  const double beside = std::sqrt(p_S.x() * p_S.x() + p_S.z() * p_S.z());
  const double from_centre = std::sqrt(beside * beside + std::max(0.0, y) * std::max(0.0, y));
  if (y >= 0 && from_centre >= r) return from_centre - r;
  if (y < 0 && beside > r + kSame_m) return kUnknown;
  const Vec3 nearest = from_centre > 0 ? Vec3(r / from_centre * p_S) : Vec3(p_S);  // only x and z are used
  if (!covers(p_S) && !covers(nearest)) return kUnknown;
  return y >= 0 ? from_centre - r : -std::sqrt((beside - r) * (beside - r) + y * y);
}

// The solid lies below all three planes. Inside it, the distance is that to the nearest plane. Outside, the
// nearest point is the foot on a face or an edge, or the top, whichever is on the surface and nearest.
double Shape::distance_to_corner(const Vec3& p_S) const {
  constexpr double kRounding_m = 1e-12;
  const auto most_above = [&](const Vec3& p) {
    return std::max({faces_[0].dot(p), faces_[1].dot(p), faces_[2].dot(p)});
  };
  const double above = most_above(p_S);
  if (above <= 0) {
    const Vec3& face = *std::max_element(
        faces_.begin(), faces_.end(), [&](const Vec3& a, const Vec3& b) { return a.dot(p_S) < b.dot(p_S); });
    return covers(p_S) || covers(p_S - above * face) ? above : kUnknown;
  }
  double nearest = p_S.norm();  // the top
  for (std::size_t k = 0; k < faces_.size(); ++k) {
    const Vec3 on_face = p_S - faces_[k].dot(p_S) * faces_[k];
    Vec3 edge = faces_[k].cross(faces_[(k + 1) % 3]);
    if (edge.y() > 0) edge = -edge;  // down from the top
    const Vec3 on_edge = std::max(0.0, p_S.dot(edge) / edge.squaredNorm()) * edge;
    for (const Vec3& foot : {on_face, on_edge})
      if (most_above(foot) <= kRounding_m) nearest = std::min(nearest, (p_S - foot).norm());
  }
  return nearest;
}

// The wave repeats every height in each period, so that its nearest point is at most a period away along x.
// That point is an end, or a point at which the normal of the wave passes through p: there the slope of the
// distance changes its sign. Every such change between samples is refined. Only samples that are no farther
// from p along x than the wave above or below p can be next to the nearest point.
double Shape::distance_to_wave(const Vec3& p_S) const {
  constexpr int kSamples = 64;
  const double x = std::clamp(p_S.x(), x0_, x1_);
  const double from = std::max(x0_, x - settings_.period_m), to = std::min(x1_, x + settings_.period_m);
  const auto squared_at = [&](double at) {
    const double across = at - p_S.x(), up = wave(at).height_m - p_S.y();
    return across * across + up * up;
  };
  double squared = std::min(squared_at(from), squared_at(to));
  const double squared_to_ends = squared;
  const auto sample = [&](int i) { return from + (to - from) * i / kSamples; };
  const double reach = std::sqrt(squared_at(x)), samples_per_m = kSamples / (to - from);
  const auto clamped = [](double i) { return static_cast<int>(std::clamp<double>(i, 0, kSamples)); };
  const int first = clamped(std::floor((p_S.x() - reach - from) * samples_per_m) - 1);
  const int last = clamped(std::ceil((p_S.x() + reach - from) * samples_per_m) + 1);
  double before = first == 0 ? from : sample(first);
  bool falls = distance_along_wave(p_S, before).value <= 0;
  for (int i = first + 1; i <= last; ++i) {
    const double next = sample(i);
    const bool rises = distance_along_wave(p_S, next).value > 0;
    if (falls && rises) squared = std::min(squared, squared_at(foot_on_wave(p_S, before, next)));
    before = next, falls = !rises;
  }
  const double beside = p_S.z() - std::clamp(p_S.z(), z0_, z1_);
  const double distance = std::sqrt(squared + beside * beside);
  if (p_S.y() >= wave(x).height_m) return distance;
  const bool has_foot = beside == 0 && squared < squared_to_ends;
  return has_foot || covers(p_S) ? -distance : kUnknown;
}

// Returns half the derivative along x of the squared distance from p to the wave at x, and the derivative of
// that half along x.
Shape::DistanceSlope Shape::distance_along_wave(const Vec3& p_S, double x) const {
  const Wave w = wave(x);
  const double up = w.height_m - p_S.y();
  return {x - p_S.x() + up * w.slope, 1 + w.slope * w.slope + up * w.bend_per_m};
}

// Finds the x at which the slope of the distance is 0, between low, where the distance falls, and high, where
// it rises. Uses Newton's method, and halves the interval if a step would leave it.
double Shape::foot_on_wave(const Vec3& p_S, double low, double high) const {
  constexpr int kMaxSteps = 60;
  double x = 0.5 * (low + high);
  for (int step = 0; step < kMaxSteps; ++step) {
    const DistanceSlope displacement = distance_along_wave(p_S, x);
    (displacement.value > 0 ? high : low) = x;
    double next = x - displacement.value / displacement.slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (next == x) break;
    x = next;
  }
  return x;
}

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
