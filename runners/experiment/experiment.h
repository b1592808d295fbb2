// What can be run: a resolved configuration, and all that is built from it.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "runners/experiment/configuration.h"
#include "runners/settings/embedded_data.h"

namespace remote_touch {

class Experiment {
 public:
  // From JSON text; label names the source in errors. Overrides are "key=value" and come last. Throws
  // InputError for anything that cannot be run, so that nothing starts that would fail for its configuration.
  static Experiment from_json(const std::string& text, const std::string& label,
                              const std::vector<std::string>& overrides = {});
  static Experiment from_json(const nlohmann::ordered_json& configuration);
  // A name of data/experiments, a JSON file, or a live session, which runs again.
  static Experiment load(const std::string& name_or_file, const std::vector<std::string>& overrides = {});

  const RunSettings& settings() const { return configuration_.run; }
  const std::vector<SequenceStep>& sequence() const { return configuration_.sequence; }
  std::string to_json() const;  // complete: every parameter, one line
  // The recordings that a run reads, as they are named; none has been looked for yet.
  std::vector<RecordingPart> inputs() const;

  // As the sensor shows it: with its faults.
  std::unique_ptr<Scenario> build_scenario(const Kernels& kernels) const;
  // The same hand whatever the faults, so that what they do is seen by itself.
  std::unique_ptr<Trajectory> build_trajectory(const Scenario& scenario) const;
  // switches: where a task sets and the processing of frames reads which fixtures count; without a task there
  // are none to set.
  std::unique_ptr<Renderer> build_renderer(const Kernels& kernels,
                                           std::shared_ptr<FixtureSwitches> switches = nullptr) const;
  FixtureAssignment build_fixtures(std::shared_ptr<const FixtureSwitches> switches = nullptr) const;
  FrameProcessing build_processing(const Kernels& kernels,
                                   std::shared_ptr<const FixtureSwitches> switches = nullptr) const;
  SimulatedHand build_hand() const;
  // No pose makes force grow faster with the device's way: springs of the renderer or of a forbidden region,
  // and of all guidance beside them.
  double max_stiffness_N_per_m() const;
  // For the live loop; offline runs take no notice of them.
  LiveSettings live() const { return configuration_.live.value_or(LiveSettings{}); }
  SafetyLimits safety() const { return configuration_.safety.value_or(SafetyLimits{}); }

 private:
  ExperimentConfiguration configuration_;
};

}  // namespace remote_touch
