// The proxy of chapter 4 on points that are averaged over the last frames (frame_average.h): what a user gets
// who switches on the temporal filter of the depth camera.
#pragma once

#include <string>

#include "core/dissertation/proxy/proxy_renderer.h"
#include "core/rivals/frame_average.h"

namespace remote_touch {

struct AveragedProxyParameters {
  ProxyParameters proxy;
  FrameAverageSettings average;
};

Parameters parameters(AveragedProxyParameters& p);
std::string validate(const AveragedProxyParameters& p);
// Upper bound, over all poses, of how fast |force| grows with the displacement of the HIP.
inline double max_stiffness_N_per_m(const AveragedProxyParameters& p) {
  return max_stiffness_N_per_m(p.proxy);
}

class AveragedProxyRenderer final : public Renderer {
 public:
  // pre: validate(parameters) is empty. haptic_rate_hz: how often step() is called.
  AveragedProxyRenderer(const AveragedProxyParameters& parameters, double haptic_rate_hz,
                        const Kernels& kernels)
      : proxy_(parameters.proxy, haptic_rate_hz, kernels), average_(parameters.average, kernels) {}
  void reserve(std::size_t points) override;
  void on_frame(const Frame& frame) override;
  Parameters live_parameters() override { return proxy_.live_parameters(); }
  void parameters_changed() override { proxy_.parameters_changed(); }
  RenderOutput step(const DeviceState& device, double time_s) override { return proxy_.step(device, time_s); }

 private:
  ProxyRenderer proxy_;
  FrameAverage average_;
};

}  // namespace remote_touch
