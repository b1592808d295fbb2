#include "core/rivals/oracle_proxy_renderer.h"

#include <cmath>

namespace remote_touch {

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
