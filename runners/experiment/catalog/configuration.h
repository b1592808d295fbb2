// One resolved configuration as plain data. The table in sections.cpp defines how its sections are read,
// checked, written and described.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/dissertation/guidance/guided_renderer.h"
#include "core/teleoperation/dead_band.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/catalog/frame_stream.h"
#include "runners/experiment/catalog/renderer_changes.h"
#include "runners/experiment/hand/simulated_hand.h"
#include "runners/experiment/opencl/depth_device.h"
#include "runners/experiment/sessions/live_settings.h"
#include "runners/experiment/sessions/safety_limits.h"
#include "runners/experiment/teleoperation/teleoperation_settings.h"
#include "scenarios/camera/sensor_faults.h"

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
inline std::string validate(const RunSettings&) {
  return {};
}

// A catalog entry by its name, with settings.
template <class Entry>
struct Part {
  std::string name;
  decltype(Entry{}.make()) factory;
};

struct ExperimentConfiguration {
  RunSettings run;
  Part<ScenarioEntry> scenario;
  std::optional<SensorFaults> faults;
  std::optional<DepthDeviceSettings> depth_pipeline;
  std::vector<Part<FixtureEntry>> fixtures;
  std::optional<GuidanceSettings> guidance;
  std::vector<SequenceStep> sequence;
  Part<RendererEntry> renderer;
  std::vector<RendererChange> changes;
  Part<TrajectoryEntry> trajectory;
  std::optional<OperatorSettings> operator_settings;
  std::optional<DeviceSettings> device;
  std::optional<SlaveSettings> slave;
  std::optional<LinkSettings> command_link, force_link;
  std::optional<FrameDeadBandSettings> frame_link;
  std::optional<FeedbackSettings> feedback;
  std::optional<RegistrationError> registration;
  std::optional<LiveSettings> live;
  std::optional<SafetyLimits> safety;

  std::vector<FixtureValues> fixture_values() const;
  bool has_guidance() const;
};

}  // namespace remote_touch
