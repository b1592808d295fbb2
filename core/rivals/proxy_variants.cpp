#include "core/rivals/proxy_variants.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace remote_touch {

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

namespace {

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
