#include "core/rivals/rival_renderer.h"

#include <algorithm>
#include <limits>
#include <sstream>
#include <utility>

#include "core/dissertation/proxy/proxy_motion.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

namespace {
// A HIP farther away than this cannot be that of a hand, and squares of its distances would lose all
// precision.
constexpr double kMaxHipDistance_m = 1e6;
}  // namespace

void RivalRenderer::on_frame(const Frame& frame) {
  if (!order_.accept_if_newer(frame)) return;
  const std::shared_ptr<const NeighbourSearch> points = shown(frame);
  near_.set_points(points);
  usable_ = set_points(*points);
}

ContactQuery RivalRenderer::query_near_proxy(PointsView points, double sum_grid, double reach_m,
                                             RenderOutput& out) const {
  points.radius = nullptr;
  const ProxyRegions regions{0, reach_m, reach_m, sum_grid, stiffness_N_per_m_};
  const ContactQuery query = kernels_.proxy.contact_query(points, proxy_W_.data(), regions);
  out.nearest_distance_m = query.nearest <= reach_m ? query.nearest : std::numeric_limits<double>::infinity();
  return query;
}

RenderOutput RivalRenderer::step(const DeviceState& device, double time_s) {
  time_s_ = time_s;
  const Vec3& hip_W = device.position_W;
  RenderOutput out;
  out.frame_index = order_.newest();
  if (!hip_W.allFinite() || hip_W.cwiseAbs().maxCoeff() > kMaxHipDistance_m) {
    reset_motion();  // no force, because the position of the HIP is not known
    out.status = RenderStatus::device_not_finite;
  } else {
    if (!placed_) proxy_W_ = hip_W, placed_ = true;
    if (usable_) {
      touch(hip_W, out);
    } else {
      reset_motion();
      proxy_W_ = hip_W;
      out.nearest_distance_m = std::numeric_limits<double>::infinity();
      out.converged = true;
      out.status = RenderStatus::no_frame;
    }
  }
  out.proxy_W = proxy_W_;
  if (placed_) out.slave_W = proxy_W_;  // NaN before the first HIP
  out.normal_W = normal_W_;
  out.status = order_.status(out.status);
  return out;
}

Parameters parameters(PenaltyParameters& p) {
  return {
      {"contact_radius_m", &p.contact_radius_m, 1e-6, 1,
       "radius r_c of the ball around the HIP; the force is at most k_s r_c"},
      {"r3_m", &p.r3_m, 1e-6, 1, "radius around the HIP in which points contribute to the normal (4.1)"},
      {"stiffness_N_per_m", &p.stiffness_N_per_m, 0, 10000,
       "stiffness k_s, multiplied by the depth of the nearest point in the ball", kLive},
      {"damping_Ns_per_m", &p.damping_Ns_per_m, 0, 1000, "damping of the motion along the normal in contact"},
  };
}

std::string validate(const PenaltyParameters& p) {
  if (p.contact_radius_m < p.r3_m) return {};
  std::ostringstream text;
  text << "contact_radius_m = " << p.contact_radius_m << ": expected below r3_m = " << p.r3_m;
  return text.str();
}

PenaltyRenderer::PenaltyRenderer(const PenaltyParameters& parameters, double haptic_rate_hz,
                                 const Kernels& kernels)
    : RivalOf(parameters, parameters.r3_m, kernels), haptic_rate_hz_(haptic_rate_hz) {}

void PenaltyRenderer::touch(const Vec3& hip_W, RenderOutput& out) {
  const double ticks = elapsed_ticks(std::exchange(previous_time_s_, time_s_), time_s_, haptic_rate_hz_);
  const Vec3 velocity =
      has_previous_ ? Vec3(haptic_rate_hz_ * (hip_W - previous_hip_W_) / ticks) : Vec3(Vec3::Zero());
  previous_hip_W_ = proxy_W_ = hip_W;
  has_previous_ = true;

  const PointsView points = near_.around(hip_W).view();
  const ProxyRegions regions{p_.contact_radius_m, p_.contact_radius_m, p_.r3_m, near_.sum_grid(),
                             p_.stiffness_N_per_m};
  const ContactQuery query = kernels_.proxy.contact_query(points, hip_W.data(), regions);
  normal_W_ = unit_normal(query, normal_W_);
  out.nearest_distance_m = query.nearest <= p_.r3_m ? query.nearest : std::numeric_limits<double>::infinity();
  out.contact_count = static_cast<int>(query.touching_count);
  out.steps = 1;
  out.converged = true;
  const double depth = p_.contact_radius_m - query.nearest;
  if (!(depth > 0)) return;
  out.state = ContactState::contact;
  if (normal_W_.isZero(0)) out.status = RenderStatus::degenerate_normal;
  const double push = stiffness_of(query) * depth - p_.damping_Ns_per_m * velocity.dot(normal_W_);
  out.force_N = std::max(push, 0.0) * normal_W_;
}

}  // namespace remote_touch
