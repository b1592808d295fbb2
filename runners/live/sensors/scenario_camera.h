// A scenario played in real time: a simulated camera, or a recording on disk.
#pragma once

#include <memory>

#include "runners/live/sensors/depth_source.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

// Gives the scenario's frame at the time since the first next(), at the scenario's frame rate; frames for
// which there was no time are skipped. Depths are rounded to kUnit_m, as a sensor does. A scene at rest is
// repeated.
class ScenarioCamera final : public DepthSource {
 public:
  static constexpr double kUnit_m = 1e-4;  // 16 bits, so depths up to 6.5 m

  // A scenario whose frames are no depth images is seen by a sensor that sends clouds, in the world frame.
  ScenarioCamera(std::unique_ptr<const Scenario> scenario, Clock& clock);

  const SensorView& view() const override { return view_; }
  SensorState next(SensorFrame& frame, double timeout_s) override;

 private:
  std::unique_ptr<const Scenario> scenario_;
  SensorView view_;
  Clock& clock_;
  double start_s_ = -1;  // of the clock; -1: not started
  int next_ = 0;
};

}  // namespace remote_touch
