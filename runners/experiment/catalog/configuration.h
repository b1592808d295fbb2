// One resolved configuration as plain data. The table in sections.cpp defines how its sections are read,
// checked, written and described.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/dissertation/virtual_fixtures/guided_renderer.h"
#include "core/parameters/parameter.h"
#include "core/rendering/renderer.h"
#include "core/teleoperation/channel.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/catalog/frame_stream.h"
#include "runners/experiment/hand/simulated_hand.h"
#include "runners/experiment/hand/teleoperation.h"
#include "runners/experiment/sessions/session_file.h"
#include "runners/libraries/depth_device.h"
#include "scenarios/simulated/sensor_faults.h"

namespace remote_touch {

// Settings of a renderer that change during a run: the section `changes` of an experiment.

// A change takes effect in the first tick at or after its time, before that tick's frame. Changes of the same
// time take effect together. Two changes of one parameter in one tick are refused.
struct RendererChange {
  double time_s = 0;
  std::string parameter;  // "renderer.stiffness_N_per_m"; one that is marked live
  double value = 0;       // 0 or 1 for a switch
};

Parameters parameters(RendererChange& change);
inline std::string validate(const RendererChange&) {
  return {};
}

// The name that a parameter of a renderer has in changes.
inline std::string name_in_changes(const Parameter& parameter) {
  return "renderer." + parameter.name;
}
// Returns the parameter that has this name in changes; null if there is none.
const Parameter* find_in_changes(const Parameters& live, const std::string& name);

// pre: a number or a switch, as all live parameters are. Allocates nothing.
void set_number(const Parameter& parameter, double value);
double number_of(const Parameter& parameter);

// Makes the changes of an experiment while it runs.
class RendererChanges {
 public:
  // pre: the changes are sorted by time and name live parameters of the renderer, which outlives this.
  RendererChanges(const std::vector<RendererChange>& changes, Renderer& renderer);
  // Makes the changes that are due at time_s.
  void make_until(double time_s);

 private:
  struct Change {
    double time_s;
    Parameter parameter;
    double value;
  };
  Renderer& renderer_;
  std::vector<Change> changes_;
  std::size_t next_ = 0;
};

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

// Rules between the sections of an experiment.

// Each throws InputError if its section does not fit the others.
void check_fixtures(ExperimentConfiguration& configuration);
// If a fixture needs guidance and the section is missing, adds it with default values, so that results store
// the settings used.
void complete_guidance(ExperimentConfiguration& configuration);
void check_changes(ExperimentConfiguration& configuration);
void check_sequence(ExperimentConfiguration& configuration);
// Friction and damping of the device need a hand with a mass.
void check_device(ExperimentConfiguration& configuration);
// Links and feedback need a slave. With one, adds those that were left out with default values, so that
// results store the settings used. If the renderer has a tool, the slave has the same one, so it must be
// known. Architectures other than position-force are for a ball; passivity control and waves need an exact
// device, and waves no dead-band. The dead-band of commands must not be relative.
void check_slave(ExperimentConfiguration& configuration);
// True if the renderer has a tool, which a slave then has as well.
bool renders_tool(const ExperimentConfiguration& configuration);

// Returns the largest max_stiffness_N_per_m() of the renderer's settings, at the start and after each change.
// Throws InputError if one of them is not finite or negative, whatever factory it comes from. check_changes()
// calls it, so that no experiment with such a renderer is read.
double max_renderer_stiffness(const ExperimentConfiguration& configuration);

// The sections of an experiment as one table: reading, writing, validation, help and the tests follow from
// it. A new section is a member of ExperimentConfiguration and a line in sections.cpp.

// One kind of settings that a section may have, for example those of the scenario with this name. The name is
// empty if the section has only one kind.
struct SectionEntry {
  std::string name;
  std::string summary;
  std::function<std::unique_ptr<Configurable>()> make;  // makes settings with default values
};

struct ExperimentSection {
  const char* key;      // key in a file; only a name if is_top_level
  const char* summary;  // continues "... of an experiment: "
  // Heading in a list of all that experiments can name; null if the section's entries have no names.
  const char* heading = nullptr;
  bool is_top_level = false;  // its parameters are at the level of the other sections
  std::vector<SectionEntry> (*entries)() = nullptr;
  // Reads the section from the whole configuration. Throws InputError for settings that cannot be used, and
  // for a missing section that is required.
  void (*read)(const ExperimentSection& section, const nlohmann::ordered_json& whole,
               ExperimentConfiguration& configuration) = nullptr;
  // Writes all parameters of the section into the whole configuration. An optional section that was left out
  // is not written; a list of catalog entries that was left out is written as an empty list.
  void (*write)(const ExperimentSection& section, const ExperimentConfiguration& configuration,
                nlohmann::ordered_json& whole) = nullptr;
  // Adds the files that its settings name. Null: they name none.
  void (*add_inputs)(const ExperimentConfiguration& configuration, std::vector<InputPart>& inputs) = nullptr;
  // Called after all sections are read. Checks this section against the others: throws InputError, or adds
  // settings that were left out. Null: no check.
  void (*complete)(ExperimentConfiguration& configuration) = nullptr;
};

// The sections, in the order in which they are read and written.
std::span<const ExperimentSection> experiment_sections();

// Throws InputError if `json` has another entry in a section than `former` had, and still has a parameter
// that only the former entry has: --set replaced the name alone.
void refuse_former_keys(const nlohmann::ordered_json& former, const nlohmann::ordered_json& json);
// Throws InputError for anything that cannot be run.
ExperimentConfiguration read_configuration(const nlohmann::ordered_json& json);
// Returns the complete configuration: every parameter of every section that is present.
nlohmann::ordered_json write_configuration(const ExperimentConfiguration& configuration);
// Returns the part of write_configuration() to which a key of its top level belongs: an object with that
// section as its only member. If the key is not a section, returns the parameters at the level of the
// sections.
nlohmann::ordered_json write_section_of(const ExperimentConfiguration& configuration, const std::string& key);

}  // namespace remote_touch
