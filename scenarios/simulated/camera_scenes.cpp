#include "scenarios/simulated/camera_scenes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/points/point_cloud.h"

namespace remote_touch {
namespace {

// The closest point x to q on an ellipsoid with semi-axes e obeys q - x = s x / e^2 for some s (Lagrange),
// with x in the octant of q. With s = tau - e_min^2 and g = e^2 - e_min^2, x = e^2 q / (tau + g), and tau >=
// 0 is the root of sum (e q / (tau + g))^2 = 1, whose left side falls and is convex.
struct ClosestPoint {
  Vec3 scaled;  // e |q|
  Vec3 gap;     // g
  int shortest;

  // x / e at tau, in the first octant.
  Vec3 unit(double tau) const {
    return {scaled.x() / (tau + gap.x()), scaled.y() / (tau + gap.y()), scaled.z() / (tau + gap.z())};
  }
  double excess(double tau) const { return unit(tau).squaredNorm() - 1; }
  double root(double low) const;
};

// pre: excess(low) > 0 and low > 0.
double ClosestPoint::root(double low) const {
  // Lower bound: where one term alone is 1, the sum is at least 1. Upper bound: at tau = |scaled| the sum
  // would be 1 without gaps, so that it is at most 1.
  low = std::max({low, scaled.x() - gap.x(), scaled.y() - gap.y(), scaled.z() - gap.z()});
  double high = std::max(low, scaled.norm());
  // Each step halves the logarithm of high / low: 12 steps reduce the range of all doubles to a factor of 2.
  for (int i = 0; i < 12 && high > 2 * low; ++i) {
    const double between = std::sqrt(low) * std::sqrt(high);
    (excess(between) > 0 ? low : high) = between;
  }
  // Newton's method on a convex function that falls cannot pass the root if it starts left of it. A start
  // within a factor of 2 of the root gives all digits after seven steps.
  double tau = low;
  for (int i = 0; i < 10; ++i) {
    const Vec3 x = unit(tau);
    const double slope = 2 * (x.x() * x.x() / (tau + gap.x()) + x.y() * x.y() / (tau + gap.y()) +
                              x.z() * x.z() / (tau + gap.z()));
    tau += std::max(0.0, (x.squaredNorm() - 1) / slope);
  }
  return tau;
}

// Ends of the phases of a ventricle, as fractions of a beat: it contracts, stays contracted, relaxes, and
// rests until the beat ends. The atrium is ahead of the ventricles by kAtriumLeads.
constexpr double kContracted = 0.3, kRelaxes = 0.35, kRelaxed = 0.75;
constexpr double kAtriumLeads = 0.18;

// Vertical semi-axis of the left ventricle, which ends at the organ's top. amplitude_m is the largest
// decrease of this semi-axis.
constexpr double kTopSemiAxis_m = 0.032;

// Reds that differ a little (hues 3 to 11 degrees) for the organ, and hue 190 for the drape on the table.
constexpr std::uint32_t kLeftVentricle = 0xB23A30, kRightVentricle = 0xC4553C, kAtrium = 0x9A2F2A;
constexpr std::uint32_t kTable = 0x3A6E78;

// Rises from 0 to 1 with zero velocity and zero acceleration at both ends.
double smooth_step(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10 - u * (15 - 6 * u));
}

// A turn of 16.3 degrees about y.
Eigen::Matrix3d turned() {
  Eigen::Matrix3d axes;
  axes << 0.96, 0, 0.28,  //
      0, 1, 0,            //
      -0.28, 0, 0.96;
  return axes;
}

constexpr double kOnSurface_m = 1e-9;
// Limit of the steps of a ray. A ray that needs more passes very close to the surface and counts as a miss.
constexpr int kMaxSteps = 20000;
constexpr double kDifference_m = 1e-6;

// Directions of the spokes, 120 degrees apart, as (x, y).
constexpr double kSin60 = 0.86602540378443865;
constexpr double kSpokes[3][2] = {{0, 1}, {kSin60, -0.5}, {-kSin60, -0.5}};

// The functions below use coordinates relative to the wheel's centre. Each part is exact on both sides.

double across(const Vec3& q) {
  return std::sqrt(q.x() * q.x() + q.y() * q.y());
}

double to_ring(const Vec3& q, double ring_radius) {
  const double off = across(q) - ring_radius;
  return std::sqrt(off * off + q.z() * q.z()) - Handwheel::kTubeRadius_m;
}

// Distance to a spoke: a capsule from the centre to the middle of the ring's tube.
double to_spoke(const Vec3& q, const double (&displacement)[2], double ring_radius) {
  const double along = std::clamp(q.x() * displacement[0] + q.y() * displacement[1], 0.0, ring_radius);
  const double x = q.x() - along * displacement[0], y = q.y() - along * displacement[1];
  return std::sqrt(x * x + y * y + q.z() * q.z()) - Handwheel::kSpokeRadius_m;
}

// Distance to a cylinder about the axis, from z_low to z_high.
double to_cylinder(const Vec3& q, double radius, double z_low, double z_high) {
  const double beside = across(q) - radius, beyond = std::max(z_low - q.z(), q.z() - z_high);
  if (beside > 0 && beyond > 0) return std::sqrt(beside * beside + beyond * beyond);
  return std::max(beside, beyond);
}

constexpr double kNoLightLeft = 64;  // exp(-64) = 1.6e-28
constexpr int kSquarings = 10;
constexpr double kDepthLoss = 0.25;  // factor on beta
constexpr double kFar_m = 1e6;       // replaces infinity, because 0 times infinity is NaN

constexpr double kPaintSaturation = 0.85, kPaintLightness = 0.45;
constexpr HueSaturationLightness kWall{195, 0.3, 0.45};
constexpr double kAmbient = 0.3;  // share of the light that is ambient

// Scales the three channels by `light`: the lightness changes; hue and saturation do not, up to rounding.
std::uint32_t dimmed(std::uint32_t rgb, double light) {
  std::uint32_t result = 0;
  for (int shift = 16; shift >= 0; shift -= 8)
    result |= static_cast<std::uint32_t>(std::floor((rgb >> shift & 0xFF) * light + 0.5)) << shift;
  return result;
}

std::uint32_t channel(double value) {
  return static_cast<std::uint32_t>(std::clamp(std::floor(value + 0.5), 0.0, 255.0));
}

}  // namespace

Ellipsoid::Ellipsoid(const Vec3& centre_m, const Vec3& semi_axes_m, const Eigen::Matrix3d& axes)
    : centre_(centre_m), semi_axes_(semi_axes_m), axes_(axes) {
  for (int i = 0; i < 3; ++i) to_unit_ball_.row(i) = axes_.col(i).transpose() / semi_axes_[i];
}

Vec3 Ellipsoid::closest(const Vec3& p) const {
  const Vec3 q = axes_.transpose() * (p - centre_);
  ClosestPoint problem;
  semi_axes_.minCoeff(&problem.shortest);
  const double shortest = semi_axes_[problem.shortest];
  problem.scaled = semi_axes_.cwiseProduct(q.cwiseAbs());
  for (int i = 0; i < 3; ++i) problem.gap[i] = (semi_axes_[i] - shortest) * (semi_axes_[i] + shortest);

  // The root goes to 0 if p is deep enough inside and near the plane through the centre that is perpendicular
  // to the shortest axis. There the surface above and the surface below that plane are equally close, and the
  // coordinate along the shortest axis follows from the other two.
  const double min = 1e-20 * shortest * shortest;
  Vec3 unit;
  if (problem.excess(min) > 0) {
    unit = problem.unit(problem.root(min));
  } else {
    unit = problem.unit(min);
    unit[problem.shortest] = 0;
    unit[problem.shortest] = std::sqrt(1 - unit.squaredNorm());
  }
  Vec3 x;
  for (int i = 0; i < 3; ++i) x[i] = std::copysign(semi_axes_[i] * unit[i], q[i]);
  return centre_ + axes_ * x;
}

double Ellipsoid::signed_distance(const Vec3& p) const {
  const double distance = (p - closest(p)).norm();
  return level(p) < 1 ? -distance : distance;
}

// The chord is computed in coordinates in which the ellipsoid is the unit ball. half is computed from the
// point of the line that is nearest to the centre, so that it is as exact for a far origin as for a near one.
Ellipsoid::Chord Ellipsoid::chord(const Vec3& origin, const Vec3& direction) const {
  // Most rays of a camera miss even the ball around the solid. This test needs no rotation and no division.
  const Vec3 displacement = centre_ - origin;
  const double radius = 1.001 * semi_axes_.maxCoeff(), along = displacement.dot(direction);
  if ((displacement.squaredNorm() - radius * radius) * direction.squaredNorm() > along * along)
    return {0, std::numeric_limits<double>::quiet_NaN()};
  const Vec3 o = to_unit_ball_ * (origin - centre_), d = to_unit_ball_ * direction;
  const double squared = d.squaredNorm(), middle = -o.dot(d) / squared;
  const double left = 1 - (o + middle * d).squaredNorm();
  return {middle, left >= 0 ? std::sqrt(left / squared) : std::numeric_limits<double>::quiet_NaN()};
}

double Ellipsoid::cast(const Vec3& origin, const Vec3& direction) const {
  const Chord line = chord(origin, direction);
  return line.middle + line.half >= 0 ? std::max(0.0, line.middle - line.half)
                                      : std::numeric_limits<double>::infinity();
}

double Ellipsoid::height(double x, double z) const {
  const Chord line = chord({x, centre_.y(), z}, {0, 1, 0});
  return std::isnan(line.half) ? -std::numeric_limits<double>::infinity()
                               : centre_.y() + line.middle + line.half;
}

Parameters parameters(BeatingHeart::Settings& s) {
  const Parameters own = {
      {"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames of the camera per second, f_c"},
      {"rate_per_min", &s.rate_per_min, 1, 600, "beats per minute"},
      {"amplitude_m", &s.amplitude_m, 0, 0.015,
       "amplitude of the motion of the organ's top in each beat; 0: no motion"},
  };
  return appended(own, parameters(s.camera));
}

BeatingHeart::BeatingHeart(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
    : settings_(settings), camera_(settings.camera, key, kernels) {}

int BeatingHeart::frame_count() const {
  return settings_.amplitude_m > 0 || camera_.noisy() ? std::numeric_limits<int>::max() : 1;
}

double BeatingHeart::contraction(double beats) {
  const double phase = beats - std::floor(beats);
  return phase < kRelaxes ? smooth_step(phase / kContracted)
                          : 1 - smooth_step((phase - kRelaxes) / (kRelaxed - kRelaxes));
}

std::array<BeatingHeart::Lobe, 3> BeatingHeart::lobes(double time_s) const {
  const double beats = time_s * settings_.rate_per_min / 60;
  const double max = settings_.amplitude_m / kTopSemiAxis_m;
  const double ventricles = 1 - max * contraction(beats);
  const double atrium = 1 - max * contraction(beats + kAtriumLeads);
  return {{
      {Ellipsoid({0, 0.028, 0}, ventricles * Vec3(0.040, kTopSemiAxis_m, 0.034)), kLeftVentricle},
      {Ellipsoid({0.004, 0.020, 0.024}, ventricles * Vec3(0.036, 0.026, 0.026), turned()), kRightVentricle},
      {Ellipsoid({-0.035, 0.022, -0.004}, atrium * Vec3(0.020, 0.022, 0.024)), kAtrium},
  }};
}

double BeatingHeart::surface_height(double x, double z, double time_s) const {
  double height = 0;
  for (const Lobe& lobe : lobes(time_s)) height = std::max(height, lobe.solid.height(x, z));
  return height;
}

double BeatingHeart::signed_distance(const Vec3& p_W, double time_s) const {
  double distance = p_W.y();
  for (const Lobe& lobe : lobes(time_s)) distance = std::min(distance, lobe.solid.signed_distance(p_W));
  return distance;
}

PointCloud BeatingHeart::cloud(int frame) const {
  const auto now = lobes(captured_s(frame));
  const auto cast = [&now](const Vec3& origin_W, const Vec3& ray_W) {
    RayHit hit;
    if (ray_W.y() < 0) hit = {-origin_W.y() / ray_W.y(), kTable};
    for (const Lobe& lobe : now) {
      const double t = lobe.solid.cast(origin_W, ray_W);
      if (t < hit.t) hit = {t, lobe.colour};
    }
    return hit;
  };
  return camera_.measured(camera_.view(cast, /*coloured=*/true), frame);
}

Handwheel::Handwheel(const Vec3& centre_m, double ring_radius_m)
    : centre_(centre_m), ring_radius_(ring_radius_m) {
  assert(ring_radius_m > kTubeRadius_m && centre_m.z() > kHubHalfLength_m);
  const double half = 0.5 * (centre_.z() + kHubHalfLength_m), wide = ring_radius_ + kTubeRadius_m;
  ball_centre_ = {centre_.x(), centre_.y(), half};
  ball_radius_ = 1.001 * std::sqrt(half * half + wide * wide);
}

double Handwheel::signed_distance(const Vec3& p) const {
  const Vec3 q = p - centre_;
  double distance = to_ring(q, ring_radius_);
  for (const auto& displacement : kSpokes)
    distance = std::min(distance, to_spoke(q, displacement, ring_radius_));
  distance = std::min(distance, to_cylinder(q, kHubRadius_m, -kHubHalfLength_m, kHubHalfLength_m));
  return std::min(distance, to_cylinder(q, kStemRadius_m, -centre_.z(), 0));
}

// Sphere tracing: no surface is nearer than the distance, so the ray can advance by that distance.
double Handwheel::cast(const Vec3& origin, const Vec3& direction) const {
  // Most rays of a camera miss even the ball around the wheel.
  const double length = direction.norm();
  const double middle = (ball_centre_ - origin).dot(direction) / (length * length);
  const double left =
      ball_radius_ * ball_radius_ - (origin + middle * direction - ball_centre_).squaredNorm();
  if (!(left >= 0)) return std::numeric_limits<double>::infinity();
  const double half = std::sqrt(left) / length;
  double t = std::max(0.0, middle - half);
  for (int step = 0; step < kMaxSteps && t <= middle + half; ++step) {
    const double distance = signed_distance(origin + t * direction);
    if (distance <= kOnSurface_m) return t;
    t += distance / length;
  }
  return std::numeric_limits<double>::infinity();
}

Vec3 Handwheel::normal(const Vec3& p) const {
  Vec3 slope;
  for (int i = 0; i < 3; ++i) {
    const Vec3 step = kDifference_m * Vec3::Unit(i);
    slope[i] = signed_distance(p + step) - signed_distance(p - step);
  }
  return slope.normalized();
}

// exp(-x) = exp(-x / 1024)^1024, whose inner argument is small enough for eight terms of the series.
double decay(double x) {
  if (x >= kNoLightLeft) return 0;
  const double small = x / (1 << kSquarings);
  double value = 1;
  for (int n = 8; n > 0; --n) value = 1 - small / n * value;
  for (int i = 0; i < kSquarings; ++i) value *= value;
  return value;
}

std::array<double, 3> Water::seen(std::uint32_t rgb, double distance_m) const {
  const double depth = turbidity_per_m_ * std::min(distance_m, kFar_m);
  std::array<double, 3> channels{};
  for (int i = 0; i < 3; ++i) {
    const double through = decay(kAttenuation[i] * depth), own = rgb >> (16 - 8 * i) & 0xFF;
    channels[static_cast<std::size_t>(i)] = own * through + kVeil[i] * (1 - through);
  }
  return channels;
}

double Water::lost(double dropout_probability, double distance_m) const {
  return 1 - (1 - dropout_probability) * decay(kDepthLoss * turbidity_per_m_ * std::min(distance_m, kFar_m));
}

double Water::depth_noise_factor(double distance_m) const {
  return 1 + turbidity_per_m_ * std::min(distance_m, kFar_m);
}

Parameters parameters(ValveTank::Settings& s) {
  const Parameters own = {
      {"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames of the camera per second, f_c"},
      {"left_valve_position_m", &s.left_valve_position_m, -2, 2,
       "centre of the wheel of the left valve; z is the distance from the wall"},
      {"right_valve_position_m", &s.right_valve_position_m, -2, 2, "centre of the right valve's wheel"},
      {"ring_radius_m", &s.ring_radius_m, 0.02, 0.2,
       "radius of the wheels' rings, to the middle of the tube"},
      {"left_hue_deg", &s.left_hue_deg, 0, 360, "hue of the left valve's paint: 0 red"},
      {"right_hue_deg", &s.right_hue_deg, 0, 360,
       "hue of the right valve's paint: 46 yellow, which turns towards green in the water"},
      {"turbidity_per_m", &s.turbidity_per_m, 0, 20,
       "attenuation coefficient beta of the water; 0: clear water"},
      {"colour_noise", &s.colour_noise, 0, 128,
       "standard deviation of the noise of each colour channel, on its scale of 0 to 255"},
      {"dropout_probability", &s.dropout_probability, 0, 1,
       "probability that a pixel has no depth in clear water"},
  };
  return appended(own, parameters(s.camera));
}

std::string validate(const ValveTank::Settings& s) {
  if (std::min(s.left_valve_position_m.z(), s.right_valve_position_m.z()) <= Handwheel::kHubHalfLength_m)
    return "left_valve_position_m and right_valve_position_m: expected with z above " +
           std::to_string(Handwheel::kHubHalfLength_m) + ", in front of the wall";
  if (s.camera.camera_position_m.z() <= 0)
    return "camera_position_m: expected with z above 0, in front of the wall";
  return validate(s.camera);
}

ValveTank::ValveTank(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
    : settings_(settings),
      key_(key),
      kernels_(kernels),
      wheels_{Handwheel(settings.left_valve_position_m, settings.ring_radius_m),
              Handwheel(settings.right_valve_position_m, settings.ring_radius_m)},
      paint_{rgb(kWall), rgb({settings.left_hue_deg, kPaintSaturation, kPaintLightness}),
             rgb({settings.right_hue_deg, kPaintSaturation, kPaintLightness})},
      camera_(settings.camera, key, kernels),
      view_(camera_.view([this](const Vec3& origin_W, const Vec3& ray_W) { return shaded(origin_W, ray_W); },
                         /*coloured=*/true)) {
  fill_with_water();
}

int ValveTank::frame_count() const {
  const bool varies = camera_.noisy() || settings_.colour_noise > 0 || settings_.dropout_probability > 0 ||
                      settings_.turbidity_per_m > 0;
  return varies ? std::numeric_limits<int>::max() : 1;
}

ValveTank::ClassifiedHit ValveTank::first_hit(const Vec3& origin_W, const Vec3& ray_W) const {
  const double wall = ray_W.z() < 0 ? -origin_W.z() / ray_W.z() : std::numeric_limits<double>::infinity();
  const double left = wheels_[0].cast(origin_W, ray_W), right = wheels_[1].cast(origin_W, ray_W);
  if (left < wall && left <= right) return {left, Valve::left};
  return right < wall ? ClassifiedHit{right, Valve::right} : ClassifiedHit{wall, Valve::none};
}

RayHit ValveTank::shaded(const Vec3& origin_W, const Vec3& ray_W) const {
  const auto [t, valve] = first_hit(origin_W, ray_W);
  if (std::isinf(t)) return {};
  const auto i = static_cast<std::size_t>(valve);
  const Vec3 normal_W =
      valve == Valve::none ? Vec3(Vec3::UnitZ()) : wheels_[i - 1].normal(origin_W + t * ray_W);
  const double cosine = std::clamp(-normal_W.dot(ray_W) / ray_W.norm(), 0.0, 1.0);
  return {t, dimmed(paint_[i], kAmbient + (1 - kAmbient) * cosine)};
}

// Computes all that the water changes in the ideal view and that is the same in every frame: for each pixel
// its colour, the probability that its depth is lost, and the factor on its depth noise.
void ValveTank::fill_with_water() {
  const CameraIntrinsics& camera = camera_.intrinsics();
  const Water water(settings_.turbidity_per_m);
  const std::size_t count = view_.depth.z_m.size();
  colour_.resize(count), lost_.resize(count), view_.depth_noise_factor.resize(count);
#pragma omp parallel for schedule(static)
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const std::size_t i = static_cast<std::size_t>(v) * camera.width + u;
      const double z = view_.depth.z_m[i];
      const double distance =
          std::isnan(z) ? std::numeric_limits<double>::infinity() : unproject(camera, u, v, z).norm();
      colour_[i] = water.seen(view_.colour[i], distance);
      lost_[i] = water.lost(settings_.dropout_probability, distance);
      view_.depth_noise_factor[i] = water.depth_noise_factor(distance);
    }
}

PointCloud ValveTank::cloud(int frame) const {
  PointCloud cloud = camera_.measured(view_, frame);
#pragma omp parallel for schedule(static)
  for (int v = 0; v < camera_.intrinsics().height; ++v) apply_water(frame, v, cloud);
  return cloud;
}

// Replaces the colours of a row by those seen through the water, with noise, and sets lost depths to NaN. The
// cloud's depths must already have their noise.
void ValveTank::apply_water(int frame, int row, PointCloud& cloud) const {
  const auto width = static_cast<std::size_t>(camera_.intrinsics().width);
  const std::size_t first = width * static_cast<std::size_t>(row);
  const auto number = static_cast<std::uint32_t>(frame);
  const NoiseStream colours = noise_stream(key_, NoiseUse::colour, number);
  const NoiseStream dropouts = noise_stream(key_, NoiseUse::dropout, number);
  std::vector<std::uint32_t> pixel(width);
  std::iota(pixel.begin(), pixel.end(), static_cast<std::uint32_t>(first));
  std::vector<double> red(width), green(width), blue(width);
  kernels_.noise.normals(colours, pixel.data(), width, red.data(), green.data(), blue.data());
  for (std::size_t u = 0; u < width; ++u) {
    const std::size_t i = first + u;
    const double sd = settings_.colour_noise;
    cloud.colour[i] = channel(colour_[i][0] + sd * red[u]) << 16 |
                      channel(colour_[i][1] + sd * green[u]) << 8 | channel(colour_[i][2] + sd * blue[u]);
    if (uniforms(dropouts, pixel[u])[0] < lost_[i])
      cloud.x[i] = cloud.y[i] = cloud.z[i] = std::numeric_limits<double>::quiet_NaN();
  }
}

double ValveTank::signed_distance(const Vec3& p_W, double) const {
  return std::min({p_W.z(), distance_to_valve(Valve::left, p_W), distance_to_valve(Valve::right, p_W)});
}

double ValveTank::distance_to_valve(Valve valve, const Vec3& p_W) const {
  assert(valve != Valve::none);
  return wheels_[static_cast<std::size_t>(valve) - 1].signed_distance(p_W);
}

std::vector<Valve> ValveTank::truth() const {
  const auto label = [this](const Vec3& origin_W, const Vec3& ray_W) {
    const auto [t, valve] = first_hit(origin_W, ray_W);
    return RayHit{t, static_cast<std::uint32_t>(valve)};
  };
  std::vector<Valve> classes;
  for (const std::uint32_t value : camera_.view(label, /*coloured=*/true).colour)
    classes.push_back(static_cast<Valve>(value));
  return classes;
}

}  // namespace remote_touch
