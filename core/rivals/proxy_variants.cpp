#include "core/rivals/proxy_variants.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <sstream>

namespace remote_touch {
namespace {

constexpr std::size_t kBlock = 128;

const Vec3 kNotMeasured = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());

// Returns the gradient of the distance as a unit vector; zero if it is not known.
Vec3 true_normal(const TrueSurface& truth, const Vec3& p_W, double time_s) {
  constexpr double kStep_m = 1e-6;
  Vec3 gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 step = kStep_m * Vec3::Unit(axis);
    gradient[axis] = truth.signed_distance(p_W + step, time_s) - truth.signed_distance(p_W - step, time_s);
  }
  return gradient.allFinite() ? Vec3(gradient.normalized()) : Vec3::Zero();  // 0 stays 0
}

}  // namespace

void BlockSearch::reserve(std::size_t points) {
  for (std::vector<double>* column : {&x_, &y_, &z_, &radius_, &stiffness_}) column->reserve(points);
  boxes_.reserve(points / kBlock + 1);
}

void BlockSearch::clear(std::size_t points, int columns, bool with_radius, bool with_stiffness) {
  constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
  for (std::vector<double>* column : {&x_, &y_, &z_}) column->assign(points, kNoNumber);
  radius_.assign(with_radius ? points : 0, 0);
  stiffness_.assign(with_stiffness ? points : 0, kNoNumber);
  columns_ = columns;
}

void BlockSearch::finish() {
  max_radius_m_ = 0;
  for (const double radius : radius_) max_radius_m_ = std::max(max_radius_m_, radius);
  boxes_.clear();
  for (std::size_t first = 0; first < size(); first += kBlock) {
    BoundingBox box;
    for (std::size_t i = first; i < std::min(first + kBlock, size()); ++i)
      if (const Vec3 p(x_[i], y_[i], z_[i]); p.allFinite()) box.extend(p);
    boxes_.push_back(box);
  }
}

void BlockSearch::gather(const Ball& ball, const Kernels& kernels, GatheredPoints& out) const {
  const double reach = (ball.radius + max_radius_m_) * (1 + 1e-9);
  for (std::size_t block = 0; block < boxes_.size(); ++block) {
    const BoundingBox& box = boxes_[block];
    if (box.isEmpty() || box.squaredExteriorDistance(ball.centre) > reach * reach) continue;
    const std::size_t first = block * kBlock, count = std::min(kBlock, size() - first);
    out.add({x_.data() + first, y_.data() + first, z_.data() + first,
             has_fixture_radius() ? radius_.data() + first : nullptr,
             has_stiffness() ? stiffness_.data() + first : nullptr, nullptr,
             static_cast<std::uint32_t>(first), count},
            ball, kernels);
  }
}

Parameters parameters(FrameAverageSettings& s) {
  return {
      {"average", choice(s.rule, {"exponential", "mean"}), 0, 0,
       "average of each point over the frames; exponential: temporal filter of a depth camera, along the ray; mean: of the last frames"},
      {"alpha", &s.alpha, 0.01, 1, "weight of the newest depth in the exponential average; 1: no filter"},
      {"step_threshold_m", &s.step_threshold_m, 0, 10,
       "exponential: a depth that differs from the average by this distance or more replaces the average"},
      {"persistence_hits", &s.persistence_hits, 1, 16,
       "exponential: a missing point is shown at its last position if it was measured in at least this many of the "
       "last persistence_frames frames"},
      {"persistence_frames", &s.persistence_frames, 0, 16,
       "exponential: number of last frames that persistence_hits counts; 0: a missing point is never shown"},
      {"mean_frames", &s.mean_frames, 1, 16, "mean: number of last frames that are averaged"},
      {"view_direction", &s.view_direction, -1, 1,
       "viewing direction of the sensor; for images the ray of each pixel is used instead"},
  };
}

std::string validate(const FrameAverageSettings& s) {
  if (s.view_direction.norm() < 0.001) return "view_direction: expected a vector of length 0.001 or more";
  if (s.persistence_frames > 0 && s.persistence_hits > s.persistence_frames)
    return "persistence_hits = " + std::to_string(s.persistence_hits) +
           ": expected at most persistence_frames = " + std::to_string(s.persistence_frames);
  return "";
}

FrameAverage::FrameAverage(const FrameAverageSettings& settings, const Kernels& kernels)
    : s_(settings),
      kernels_(kernels),
      shown_{std::make_shared<BlockSearch>(), std::make_shared<BlockSearch>()} {}

void FrameAverage::reserve(std::size_t points) {
  all_.reserve(points, true, true);
  const int frames = s_.rule == AverageRule::mean ? s_.mean_frames : 1;
  for (int i = 0; i < frames; ++i) history_[i].reserve(points);
  smooth_.reserve(points), seen_.reserve(points);
  for (const auto& shown : shown_) shown->reserve(points);
}

void FrameAverage::begin(std::size_t points) {
  reserve(points);
  const int frames = s_.rule == AverageRule::mean ? s_.mean_frames : 1;
  for (int i = 0; i < frames; ++i) history_[i].assign(points, kNotMeasured);
  smooth_.assign(points, kNotMeasured), seen_.assign(points, 0);
}

// Stores the positions of the newest frame by the indices of its points.
void FrameAverage::store(const NeighbourSearch& points) {
  constexpr double kEverywhere_m = 1e6;
  newest_ = s_.rule == AverageRule::mean ? (newest_ + 1) % s_.mean_frames : 0;
  std::vector<Vec3>& now = history_[newest_];
  std::fill(now.begin(), now.end(), kNotMeasured);
  all_.clear();
  points.gather({Vec3::Zero(), kEverywhere_m}, kernels_, all_);
  const PointsView view = all_.view();
  for (std::size_t i = 0; i < all_.size(); ++i) now[all_.index()[i]] = Vec3(view.x[i], view.y[i], view.z[i]);
}

// Returns the average of a point after the newest frame. A missing point keeps its average as long as the
// persistence allows; then the result is NaN.
Vec3 FrameAverage::exponential(std::size_t number, const ViewPoint& view) {
  const Vec3 now = latest(number);
  const bool is_measured = now.allFinite();
  std::uint32_t& seen = seen_[number];
  seen = seen << 1 | (is_measured ? 1u : 0u);
  Vec3& smooth = smooth_[number];
  if (!is_measured) {
    const std::uint32_t recent = seen & ((1u << s_.persistence_frames) - 1);
    return s_.persistence_frames > 0 && std::popcount(recent) >= s_.persistence_hits ? smooth : kNotMeasured;
  }
  const Vec3 ray = view.ray_to(now).normalized();
  const double change_m = ray.dot(smooth - now);  // NaN at first
  smooth = std::abs(change_m) < s_.step_threshold_m ? Vec3(now + (1 - s_.alpha) * change_m * ray) : now;
  return smooth;
}

Vec3 FrameAverage::mean(std::size_t number) const {
  if (!latest(number).allFinite()) return kNotMeasured;
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (int i = 0; i < s_.mean_frames; ++i)
    if (const Vec3& p = history_[i][number]; p.allFinite()) sum += p, ++count;
  return sum / count;
}

std::shared_ptr<const NeighbourSearch> FrameAverage::next(const NeighbourSearch& points) {
  all_.reserve(points.size(), true, true);
  if (points.size() != seen_.size() && points.size() > 0) begin(points.size());
  store(points);
  shown_last_ = 1 - shown_last_;
  BlockSearch& shown = *shown_[shown_last_];
  shown.clear(seen_.size(), points.organised_columns(), points.has_fixture_radius(), points.has_stiffness());
  const PointsView view_of_all = all_.view();
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (points.has_fixture_radius()) shown.set_fixture_radius(all_.index()[i], view_of_all.radius[i]);
    if (points.has_stiffness()) shown.set_stiffness(all_.index()[i], view_of_all.stiffness[i]);
  }
  const ViewPoint view = view_point(points, s_.view_direction);
  for (std::size_t i = 0; i < seen_.size(); ++i)
    shown.set(i, s_.rule == AverageRule::mean ? mean(i) : exponential(i, view));
  shown.finish();
  return shown_[shown_last_];
}

Parameters parameters(AveragedProxyParameters& p) {
  return appended(parameters(p.proxy), parameters(p.average));
}

std::string validate(const AveragedProxyParameters& p) {
  const std::string average = validate(p.average);
  return average.empty() ? validate(p.proxy) : average;
}

void AveragedProxyRenderer::reserve(std::size_t points) {
  proxy_.reserve(points);
  average_.reserve(points);
}

void AveragedProxyRenderer::on_frame(const Frame& frame) {
  if (!proxy_.is_newer(frame)) return proxy_.on_frame(frame);
  proxy_.on_frame({frame.index, frame.captured_s, frame.arrives_s, average_.next(*frame.points)});
}

Parameters parameters(DensityProxyParameters& p) {
  const Parameters own = {
      {"radius_ratio", &p.radius_ratio, 0.1, 100,
       "contact radius r_c in units of the local spacing of the points"},
      {"min_radius_m", &p.min_radius_m, 1e-4, 1, "smallest contact radius"},
      {"max_radius_m", &p.max_radius_m, 1e-4, 1, "largest contact radius"},
      {"neighbours", &p.neighbours, 4, 1000, "number K of points from which the local spacing is computed"},
  };
  return appended(with_fixed_radii(parameters(p.proxy)), own);
}

std::string validate(const DensityProxyParameters& p) {
  std::ostringstream text;
  const double half_shell = 0.5 * (p.proxy.r2_m - p.proxy.r1_m);
  if (p.max_radius_m < p.min_radius_m)
    text << "max_radius_m = " << p.max_radius_m << ": expected at least min_radius_m = " << p.min_radius_m;
  else if (p.min_radius_m <= half_shell)
    text << "min_radius_m = " << p.min_radius_m << ": expected above (r2_m - r1_m) / 2 = " << half_shell;
  else
    return validate(p.proxy);
  return text.str();
}

DensityProxyRenderer::DensityProxyRenderer(const DensityProxyParameters& parameters, double haptic_rate_hz,
                                           const Kernels& kernels)
    : p_(parameters),
      proxy_(parameters.proxy, haptic_rate_hz, kernels),
      nearest_(kernels),
      radius_m_(parameters.proxy.contact_radius_m()) {}

void DensityProxyRenderer::reserve(std::size_t points) {
  proxy_.reserve(points);
  nearest_.reserve(points);
}

Parameters DensityProxyRenderer::live_parameters() {
  return live_ones(with_fixed_radii(proxy_.live_parameters()));
}

void DensityProxyRenderer::on_frame(const Frame& frame) {
  if (proxy_.is_newer(frame)) {
    points_ = frame.points;
    nearest_.reserve(points_->size());
  }
  proxy_.on_frame(frame);
}

// Returns the contact radius for the points that nearest_ found last; 0 if there are too few. last_m:
// distance of the last of these points.
double DensityProxyRenderer::wanted_radius(double last_m) const {
  constexpr double kPi = 3.14159265358979323846, kGrowth = 1.05;
  double first_m = std::numeric_limits<double>::infinity();
  int count = 0;
  nearest_.for_each([&](const Vec3& e) { first_m = std::min(first_m, e.norm()), ++count; });
  if (count < p_.neighbours) return 0;
  const double spacing = std::sqrt(kPi * (last_m * last_m - first_m * first_m) / p_.neighbours);
  double radius = p_.min_radius_m;
  while (radius * kGrowth <= p_.radius_ratio * spacing && radius < p_.max_radius_m) radius *= kGrowth;
  return std::min(radius, p_.max_radius_m);
}

void DensityProxyRenderer::adapt() {
  const double wanted = wanted_radius(nearest_.find(*points_, proxy_.proxy_W(), p_.neighbours));
  if (wanted == 0 || wanted == radius_m_) return;
  radius_m_ = wanted;
  const double half_shell = 0.5 * (p_.proxy.r2_m - p_.proxy.r1_m);
  proxy_.set_radii(radius_m_ - half_shell, radius_m_ + half_shell, 2 * radius_m_);
}

RenderOutput DensityProxyRenderer::step(const DeviceState& device, double time_s) {
  if (points_ && proxy_.proxy_W().allFinite()) adapt();
  RenderOutput out = proxy_.step(device, time_s);
  if (out.state != ContactState::free || proxy_.in_contact())
    out.proxy_W += (p_.proxy.contact_radius_m() - radius_m_) * out.normal_W;
  return out;
}

// The true motion is given, so there is no estimate.
Parameters parameters(OracleProxyParameters& p) {
  return without(parameters(p.proxy), {"velocity_estimate"});
}

Parameters OracleProxyRenderer::live_parameters() {
  return without(proxy_.live_parameters(), {"velocity_estimate"});
}

SurfaceMotion true_motion(const TrueSurface& truth, const Vec3& p_W, double before_s, double now_s) {
  SurfaceMotion motion;
  const double moved_m = truth.signed_distance(p_W, before_s) - truth.signed_distance(p_W, now_s);
  if (!std::isfinite(moved_m) || moved_m == 0) return motion;
  motion.normal_W = true_normal(truth, p_W, now_s);
  motion.displacement_m = moved_m * motion.normal_W;
  motion.velocity_m_per_s = moved_m / (now_s - before_s);
  return motion;
}

void OracleProxyRenderer::on_frame(const Frame& frame) {
  SurfaceMotion motion;
  if (proxy_.is_newer(frame)) {
    if (has_frame_ && frame.truth)
      motion = true_motion(*frame.truth, proxy_.proxy_W(), captured_s_, frame.captured_s);
    captured_s_ = frame.captured_s, has_frame_ = true;
  }
  proxy_.on_frame(frame, motion);
}

}  // namespace remote_touch
