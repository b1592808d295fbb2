// A scenario played in real time: a simulated camera, or a recording on disk.
#pragma once

#include <memory>

#include "runners/live/sensors/depth_source.h"
#include "runners/live/sensors/frame_encoder.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

// Delivers the frames of the scenario at its frame rate; time 0 is start_at(), or else
// the first next(). If several frames are
// due, only the newest is delivered. Depths are rounded, as a sensor does, see FrameEncoder. The last frame
// is repeated after the end of the scenario, so the camera never ends.
class ScenarioCamera final : public DepthSource {
 public:
  ScenarioCamera(std::unique_ptr<const Scenario> scenario, Clock& clock,
                 const FrameEncoder::Settings& settings = {});

  const SensorView& view() const override { return encoder_.view(); }
  void start_at(std::int64_t start_ns) override { start_s_ = 1e-9 * static_cast<double>(start_ns); }
  // Throws InputError, which names the frame, if a frame cannot be read or does not fit the view.
  SensorState next(SensorFrame& frame, double timeout_s) override;

 private:
  std::unique_ptr<const Scenario> scenario_;
  FrameEncoder encoder_;
  Clock& clock_;
  double start_s_ = -1;  // time of the clock at the start; -1: not started
  int next_ = 0;
};

}  // namespace remote_touch
