// One resolved configuration: scenario, faults of the sensor, depth pipeline, fixtures, guidance, task,
// renderer, trajectory, operator, device, live loop, durations, seed.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/guidance/guided_renderer.h"
#include "runners/experiment/catalog.h"
#include "runners/experiment/frame_stream.h"
#include "runners/live/devices/safety_gate.h"
#include "runners/live/loop/live_settings.h"
#include "runners/operator/simulated_hand.h"
#include "runners/settings/embedded_data.h"
#include "scenarios/faults/sensor_faults.h"

namespace remote_touch {

// Settings of the run itself.
struct RunSettings {
  double duration_s = 0;
  double haptic_rate_hz = 1000;
  Transport transport;
  NoiseKey key;
  std::string title;
};

Parameters parameters(RunSettings& s);

// A catalog entry by its name, with settings.
template <class Entry>
struct Part {
  std::string name;
  decltype(Entry{}.make()) factory;
};

class Experiment {
 public:
  // From JSON text; label names the source in errors. Overrides are "key=value" and come last. Throws
  // InputError for anything that cannot be run, so that nothing starts that would fail for its configuration.
  static Experiment from_json(const std::string& text, const std::string& label,
                              const std::vector<std::string>& overrides = {});
  static Experiment from_json(nlohmann::ordered_json configuration);
  // A name of data/experiments, a JSON file, or a live session, which runs again.
  static Experiment load(const std::string& name_or_file, const std::vector<std::string>& overrides = {});

  const RunSettings& settings() const { return settings_; }
  const std::vector<SequenceStep>& sequence() const { return sequence_; }
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
  LiveSettings live() const { return live_.value_or(LiveSettings{}); }
  SafetyLimits safety() const { return safety_.value_or(SafetyLimits{}); }

 private:
  std::vector<FixtureValues> fixture_values() const;
  bool has_guidance() const;
  bool can_be_pressed(const SequenceStep& step) const;

  RunSettings settings_;
  Part<ScenarioEntry> scenario_;
  std::optional<SensorFaults> faults_;
  std::optional<DepthPipelineSettings> depth_pipeline_;
  std::vector<Part<FixtureEntry>> fixtures_;
  std::optional<GuidanceSettings> guidance_;
  std::vector<SequenceStep> sequence_;
  std::optional<OperatorSettings> operator_;
  std::optional<MotorSettings> device_;
  std::optional<LiveSettings> live_;
  std::optional<SafetyLimits> safety_;
  Part<RendererEntry> renderer_;
  Part<TrajectoryEntry> trajectory_;
};

}  // namespace remote_touch
