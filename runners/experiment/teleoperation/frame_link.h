// The frames that travel from the slave's camera to the operator: those that the dead-band lets pass.
#pragma once

#include <deque>
#include <optional>
#include <utility>

#include "core/rendering/renderer.h"
#include "core/teleoperation/dead_band.h"

namespace remote_touch {

// Decides which frames are sent. The dead-band compares a frame near the position that the slave had when the
// frame was captured.
class FrameSender {
 public:
  // pre: validate(settings) is empty. The kernels must outlive it.
  FrameSender(const FrameDeadBandSettings& settings, const Kernels& kernels)
      : dead_band_(settings), kernels_(kernels) {}

  // Returns true if the frame has to be sent, and then keeps its points until the next one has to.
  bool sends(const Frame& frame) { return dead_band_.sends(frame, slave_at(frame.captured_s), kernels_); }
  // Must be called once per tick, after the slave has moved, with increasing times. slave_W: NaN before the
  // slave has started, as in a trace.
  void observe_slave(const Vec3& slave_W, double time_s) {
    if (slave_W.allFinite()) slave_.emplace_back(time_s, slave_W);
  }
  // Forgets where the slave was. Until it is observed again, every frame is sent.
  void lose_slave() { slave_.clear(); }
  // Returns the number of frames that had to be sent.
  int sent() const { return dead_band_.sent(); }

 private:
  // Returns nothing if the position at that time is not known.
  std::optional<Vec3> slave_at(double time_s);

  FrameDeadBand dead_band_;
  const Kernels& kernels_;
  std::deque<std::pair<double, Vec3>> slave_;  // times and positions since the newest frame was captured
};

// Passes the frames that are sent on to a renderer, which must outlive it. Latency, jitter and loss of the
// frames are those of the run. A frame that is lost on its way does not reach the dead-band, so the next one
// is compared with the last frame that was passed on.
class FrameLink final : public Renderer {
 public:
  // pre: validate(settings) is empty.
  FrameLink(const FrameDeadBandSettings& settings, Renderer& renderer, const Kernels& kernels)
      : sender_(settings, kernels), renderer_(renderer) {}

  void on_frame(const Frame& frame) override {
    if (sender_.sends(frame)) renderer_.on_frame(frame);
  }
  RenderOutput step(const DeviceState& device, double time_s) override {
    return renderer_.step(device, time_s);
  }
  // See FrameSender.
  void observe_slave(const Vec3& slave_W, double time_s) { sender_.observe_slave(slave_W, time_s); }
  int sent() const { return sender_.sent(); }

 private:
  FrameSender sender_;
  Renderer& renderer_;
};

}  // namespace remote_touch
