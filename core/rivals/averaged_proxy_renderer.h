// The proxy of chapter 4 on points that are averaged over the last frames (frame_average.h). A user has this
// result when the temporal filter of the depth camera is on.
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

class AveragedProxyRenderer final : public Renderer {
 public:
  // pre: validate(parameters) is empty. haptic_rate_hz: the rate at which step() is called.
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
