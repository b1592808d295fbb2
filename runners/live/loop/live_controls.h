// Parameters that someone changes while a live run goes on. A change is checked outside the haptic loop, and
// made by the loop between two ticks.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "runners/experiment/experiment.h"
#include "runners/live/loop/parameter_changes.h"
#include "runners/live/loop/ring.h"
#include "runners/live/sensors/replaceable_scenario.h"

namespace remote_touch {

class LiveControls {
 public:
  enum class Camera { simulated, other };
  // With another camera than the experiment's scenario only the renderer's parameters can change. An
  // experiment with changes of its own has none.
  LiveControls(const Experiment& experiment, const Kernels& kernels, Camera camera);

  // Those of the renderer in the order of Renderer::live_parameters(), then those of the scenario.
  const std::vector<LiveParameter>& parameters() const { return parameters_; }

  // Their present values, as the loop has them or will have them in one of its next ticks. From the thread of
  // change().
  const std::vector<double>& values() const { return values_; }
  bool has_changed() const;
  // From one thread. Empty: the loop will make these changes together; else why not, in one line.
  std::string change(const ParameterChanges& changes);

  // For the run.
  Ring<ParameterChanges>& asked() { return asked_; }
  std::unique_ptr<const Scenario> scenario() const;  // null with another camera
  // For a device with motors: no greater stiffness than at the start, since nobody knows whether it is
  // stable.
  void limit_stiffness() { has_stiffness_limit_ = true; }

 private:
  Experiment checked(const std::vector<double>& values) const;
  bool is_of_scenario(const ParameterChanges& changes) const;

  const Kernels& kernels_;
  const std::string configuration_;
  const double max_stiffness_N_per_m_;
  std::vector<LiveParameter> parameters_;
  std::size_t of_renderer_ = 0;
  std::vector<double> values_;  // now
  std::shared_ptr<ShownScenario> shown_;
  Ring<ParameterChanges> asked_{64};
  std::atomic<bool> has_stiffness_limit_ = false;
};

}  // namespace remote_touch
