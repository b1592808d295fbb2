// The frames that travel from the slave's camera to the operator: those that the dead-band lets pass.
#pragma once

#include <deque>
#include <utility>

#include "core/rendering/renderer.h"
#include "core/teleoperation/frame_dead_band.h"

namespace remote_touch {

// Passes frames on to a renderer, which must outlive it. The dead-band compares a frame near the position
// that the slave had when the frame was captured. Latency, jitter and loss of the frames are those of the
// run. A frame that is lost on its way does not reach the dead-band, so the next one is compared with the
// last frame that was passed on.
class FrameLink final : public Renderer {
 public:
  // pre: validate(settings) is empty.
  FrameLink(const FrameDeadBandSettings& settings, Renderer& renderer, const Kernels& kernels)
      : dead_band_(settings), renderer_(renderer), kernels_(kernels) {}

  void on_frame(const Frame& frame) override;
  RenderOutput step(const DeviceState& device, double time_s) override {
    return renderer_.step(device, time_s);
  }
  // Must be called once per tick, after the slave has moved, with increasing times.
  void observe_slave(const Vec3& slave_W, double time_s) { slave_.emplace_back(time_s, slave_W); }
  // Returns the number of frames that were passed on.
  int sent() const { return dead_band_.sent(); }

 private:
  Vec3 slave_at(double time_s);

  FrameDeadBand dead_band_;
  Renderer& renderer_;
  const Kernels& kernels_;
  std::deque<std::pair<double, Vec3>> slave_;  // times and positions since the newest frame was captured
};

}  // namespace remote_touch
