#include "core/rivals/rival_renderer.h"

#include <limits>

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

}  // namespace remote_touch
