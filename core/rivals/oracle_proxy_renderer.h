// ORACLE, not a method: the proxy of chapter 4 with knowledge of the true surface's motion. It shows what the
// proxy would achieve with a perfect estimate of the velocity, and which failures have other causes: the
// points and their noise are the same. Only a simulation knows the truth (Frame::truth). The proxy without it
// is the same as with velocity_estimate = false.
//
// At a frame, the displacement in (4.3) is that of the true surface since the previous frame, along its true
// normal at the proxy. v_hat in (4.15) is its mean velocity in that time, of either sign. A frame whose truth
// is not known at the proxy does not move it.
#pragma once

#include <string>

#include "core/dissertation/proxy/proxy_renderer.h"

namespace remote_touch {

struct OracleProxyParameters {
  ProxyParameters proxy;
};

Parameters parameters(OracleProxyParameters& p);
inline std::string validate(const OracleProxyParameters& p) {
  return validate(p.proxy);
}

// Returns the motion of the true surface nearest to p from before_s to now_s, along its normal at now_s. The
// motion is zero if it is not known.
SurfaceMotion true_motion(const TrueSurface& truth, const Vec3& p_W, double before_s, double now_s);

class OracleProxyRenderer final : public Renderer {
 public:
  // pre: validate(parameters) is empty. haptic_rate_hz: the rate at which step() is called.
  OracleProxyRenderer(const OracleProxyParameters& parameters, double haptic_rate_hz, const Kernels& kernels)
      : proxy_(parameters.proxy, haptic_rate_hz, kernels) {}
  void reserve(std::size_t points) override { proxy_.reserve(points); }
  void on_frame(const Frame& frame) override;
  Parameters live_parameters() override;
  void parameters_changed() override { proxy_.parameters_changed(); }
  RenderOutput step(const DeviceState& device, double time_s) override { return proxy_.step(device, time_s); }

 private:
  ProxyRenderer proxy_;
  double captured_s_ = 0;  // capture time of the newest frame
  bool has_frame_ = false;
};

}  // namespace remote_touch
