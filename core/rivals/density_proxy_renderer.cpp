#include "core/rivals/density_proxy_renderer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace remote_touch {

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

}  // namespace remote_touch
