#include "runners/experiment/catalog/experiment.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "analysis/storage/block_journal.h"
#include "analysis/storage/digest.h"
#include "runners/experiment/catalog/section_rules.h"
#include "runners/experiment/catalog/sections.h"
#include "runners/experiment/sessions/session_scene.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/embedded_data.h"
#include "runners/experiment/settings/file_refusal.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/experiment/settings/stored_configuration.h"
#include "runners/experiment/tool_files/tool_loading.h"

namespace remote_touch {

namespace {

constexpr const char* kRecordedSession = "live-session";

void add_inputs(const Part<ScenarioEntry>& scenario, std::vector<RecordingPart>& all) {
  const std::vector<RecordingPart> own = scenario.factory->inputs();
  all.insert(all.end(), own.begin(), own.end());
}

// Returns the tool of the renderer for the slave, nothing if the renderer has none. Throws InputError if the
// steps of the slave are too long for it. See load_tool() for the tool itself.
std::optional<SlaveTool> slave_tool(const ExperimentConfiguration& configuration) {
  if (!renders_tool(configuration)) return {};
  Json of_renderer = Json::object(), of_tool = Json::object();
  write_parameters(configuration.renderer.factory->settings(), of_renderer);
  ToolSettings settings;
  for (const Parameter& p : parameters(settings)) of_tool[p.name] = of_renderer[p.name];
  read_parameters(of_tool, parameters(settings), "renderer");
  const auto tool = load_tool(settings);
  SlaveTool made = make_slave_tool(tool->mesh, tool->inertia_m2);
  const std::string problem = validate(*configuration.slave, made, 1 / configuration.run.haptic_rate_hz);
  if (!problem.empty()) throw InputError("slave." + problem);
  return made;
}

// Throws InputError if a file that was named as an experiment is a sweep.
void refuse_sweep(const Json& configuration, const std::string& label) {
  if (configuration.contains("experiment") && configuration.contains("axes"))
    throw InputError(label, std::string("is a sweep: expected `remote-touch sweep ") + label + " -o FILE`");
}

// The override that removes the slave also removes the sections that need one.
void remove_with_slave(Json& configuration, const std::vector<std::string>& overrides) {
  if (std::ranges::find(overrides, "slave=null") == overrides.end()) return;
  for (const char* section : {"command_link", "force_link", "frame_link", "feedback", "registration"})
    configuration.erase(section);
}

}  // namespace

Experiment Experiment::from_json(const std::string& text, const std::string& label,
                                 const std::vector<std::string>& overrides) {
  Json configuration = parse_json(text, label);
  if (!configuration.is_object()) throw InputError(label, "not an object: expected {\"scenario\": ..., ...}");
  refuse_sweep(configuration, label);
  const Json former = configuration;
  remove_with_slave(configuration, overrides);
  apply_overrides(configuration, overrides);
  refuse_former_keys(former, configuration);
  return from_json(configuration);
}

Experiment Experiment::from_json(const Json& configuration) {
  Experiment experiment;
  experiment.configuration_ = read_configuration(configuration);
  return experiment;
}

Experiment Experiment::load(const std::string& name_or_file, const std::vector<std::string>& overrides) {
  require_no_journal(name_or_file);
  const std::string text = has_result_header(name_or_file)
                               ? session_experiment(name_or_file)
                               : embedded_or_file(embedded_experiments(), name_or_file, "an experiment's");
  const auto read = [&](const std::vector<std::string>& settings) {
    return from_json(text, name_or_file, settings);
  };
  return is_stored(embedded_experiments(), name_or_file)
             ? read(overrides)
             : with_file_in_refusal(name_or_file, overrides, read);
}

std::string Experiment::to_json() const {
  return write_configuration(configuration_).dump();
}

Json Experiment::value_at_start(const std::string& path) const {
  const std::vector<std::string> keys = path_keys(path);
  if (keys.empty()) return {};
  Json section = write_section_of(configuration_, keys.front());
  if (keys.front() == "renderer")
    for (const RendererChange& change : configuration_.changes) {
      if (change.time_s > 0) continue;
      Json& value = section["renderer"][path_keys(change.parameter).back()];
      value = value.is_boolean() ? Json(change.value != 0) : Json(change.value);
    }
  const Json* const found = find_value(section, keys);
  return found ? *found : Json();
}

std::vector<RecordingPart> Experiment::inputs(const std::vector<std::string>& except) const {
  std::vector<RecordingPart> all;
  for (const ExperimentSection& section : experiment_sections())
    if (section.add_inputs && std::ranges::find(except, section.key) == except.end())
      section.add_inputs(configuration_, all);
  if (!configuration_.slave || std::ranges::find(except, "scenario") != except.end()) return all;
  for (auto recorded = recorded_experiment(); recorded; recorded = recorded->recorded_experiment())
    add_inputs(recorded->configuration_.scenario, all);
  return all;
}

std::unique_ptr<Scenario> Experiment::build_scenario(const Kernels& kernels) const {
  auto scenario = configuration_.scenario.factory->build(configuration_.run.key, kernels);
  if (!configuration_.faults) return scenario;
  return std::make_unique<FaultySensor>(std::move(scenario), *configuration_.faults, configuration_.run.key,
                                        kernels);
}

std::unique_ptr<Trajectory> Experiment::build_trajectory(const Scenario& scenario) const {
  return configuration_.trajectory.factory->build(scenario.without_faults());
}

std::unique_ptr<Renderer> Experiment::build_renderer(const Kernels& kernels,
                                                     std::shared_ptr<FixtureSwitches> switches) const {
  auto renderer = configuration_.renderer.factory->build(configuration_.run.haptic_rate_hz, kernels);
  if (configuration_.sequence.empty() && !configuration_.has_guidance()) return renderer;
  if (!switches) switches = std::make_shared<FixtureSwitches>();
  return std::make_unique<GuidedRenderer>(
      std::move(renderer), configuration_.guidance.value_or(GuidanceSettings{}),
      configuration_.fixture_values(), configuration_.sequence, std::move(switches));
}

namespace {

// Returns k_s of a renderer for points without a stiffness, as the configuration gives it.
double own_stiffness_N_per_m(const Part<RendererEntry>& renderer) {
  for (const Parameter& p : renderer.factory->settings())
    if (double* const* value = std::get_if<double*>(&p.value); value && p.name == "stiffness_N_per_m")
      return **value;
  return renderer.factory->stiffness_N_per_m();
}

}  // namespace

FixtureAssignment Experiment::build_fixtures(std::shared_ptr<const FixtureSwitches> switches) const {
  std::vector<std::unique_ptr<const FixtureRule>> rules;
  for (const auto& rule : configuration_.fixtures) rules.push_back(rule.factory->build());
  // Switches change only with a sequence. Without one they are left out, because FrameStream would send the
  // frame of a scene at rest again and again.
  return FixtureAssignment(std::move(rules), configuration_.sequence.empty() ? nullptr : std::move(switches),
                           own_stiffness_N_per_m(configuration_.renderer));
}

namespace {

// The default DepthReport: prints one line when an OpenCL device has failed or cannot be used. The CPU then
// computes the same results.
void print_line(const std::string& line) {
  std::fprintf(stderr, "%s\n", line.c_str());
}

}  // namespace

FrameProcessing Experiment::build_processing(const Kernels& kernels,
                                             std::shared_ptr<const FixtureSwitches> switches,
                                             const DepthReport& report) const {
  FrameProcessing processing{nullptr,
                             build_fixtures(std::move(switches)),
                             {configuration_.renderer.name, renderer_needs(configuration_)}};
  if (configuration_.depth_pipeline)
    processing.depth = make_depth_processor(*configuration_.depth_pipeline, kernels,
                                            report ? report : DepthReport(print_line));
  return processing;
}

void Experiment::check_needs(const Scenario& scenario) const {
  remote_touch::check_needs(configuration_, build_fixtures(), scenario);
}

void Experiment::check_needs(const SensorView& view) const {
  remote_touch::check_needs(configuration_, view);
}

void Experiment::add_depth_device(TextAttributes& provenance) const {
  if (!configuration_.depth_pipeline) return;
  const std::string device = depth_device_of(*configuration_.depth_pipeline);
  if (!device.empty()) provenance.emplace_back("depth_device", device);
}

SimulatedHand Experiment::build_hand() const {
  // A slave's force acts through a device, so that the trace records what the hand feels.
  std::optional<DeviceSettings> device = configuration_.device;
  if (configuration_.slave && !device) device.emplace();
  return {configuration_.operator_settings, device, 1 / configuration_.run.haptic_rate_hz};
}

std::optional<Teleoperation> Experiment::build_teleoperation(const Scenario* touched, Hand hand) const {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  const ExperimentConfiguration& c = configuration_;
  if (!c.slave) return {};
  const SlaveScene scene{
      [touched](const Vec3& p_W, double time_s) {
        return touched ? touched->signed_distance(p_W, time_s) : kUnknown;
      },
      [touched](const Vec3& p_W, double time_s) {
        return touched ? touched->true_normal(p_W, time_s) : Vec3(Vec3::Constant(kUnknown));
      },
      [touched](double time_s) { return touched ? touched->truth_time_s(time_s) : time_s; }};
  const bool knows_mass = hand == Hand::simulated && c.operator_settings;
  const double hand_mass_kg = knows_mass ? c.operator_settings->mass_kg : 0;
  return Teleoperation(
      {*c.slave, *c.command_link, *c.force_link, *c.feedback, *c.registration, hand_mass_kg, slave_tool(c)},
      c.run.key, 1 / c.run.haptic_rate_hz, scene);
}

FrameDeadBandSettings Experiment::frame_dead_band() const {
  FrameDeadBandSettings settings = configuration_.frame_link.value_or(FrameDeadBandSettings{});
  if (settings.least_motion_m == 0) return settings;
  if (const std::optional<SlaveTool> tool = slave_tool(configuration_)) settings.near_m += tool->reach_m;
  return settings;
}

std::optional<Experiment> Experiment::recorded_experiment() const {
  if (configuration_.scenario.name != kRecordedSession) return {};
  for (const Parameter& p : configuration_.scenario.factory->settings())
    if (const auto* const path = std::get_if<std::string*>(&p.value)) {
      const SessionReader session{find_recording(**path)};
      if (session.depth() != kSimulatedDepth) return {};
      return from_json(parse_json(stored_configuration(session.config()), **path + " config"));
    }
  return {};
}

std::unique_ptr<const Scenario> Experiment::build_recorded_scene(const Kernels& kernels) const {
  const bool is_recorded = configuration_.scenario.name == kRecordedSession;
  return configuration_.slave && is_recorded ? simulated_scene(kernels) : nullptr;
}

std::unique_ptr<const Scenario> Experiment::build_simulated_scene(const Kernels& kernels) const {
  return configuration_.slave ? simulated_scene(kernels) : nullptr;
}

// See build_simulated_scene(), also for an experiment without a slave.
std::unique_ptr<const Scenario> Experiment::simulated_scene(const Kernels& kernels) const {
  if (configuration_.scenario.name == kRecordedSession) {
    const std::optional<Experiment> recorded = recorded_experiment();
    return recorded ? recorded->simulated_scene(kernels) : nullptr;
  }
  auto scenario = configuration_.scenario.factory->build(configuration_.run.key, kernels);
  if (!scenario->truth_text().empty()) return nullptr;
  return scenario;
}

std::vector<LiveParameter> Experiment::live_parameters() const {
  std::vector<LiveParameter> list;
  const auto add = [&](const char* section, LiveParameter::Of of, Configurable& settings) {
    for (const Parameter& p : live_ones(settings.settings())) {
      const bool is_switch = std::holds_alternative<bool*>(p.value);
      list.push_back({std::string(section) + "." + p.name, p.help, number_of(p), is_switch ? 0 : p.low,
                      is_switch ? 1 : p.high, is_switch, of});
    }
  };
  add("renderer", LiveParameter::Of::renderer, *configuration_.renderer.factory);
  add("scenario", LiveParameter::Of::scenario, *configuration_.scenario.factory);
  return list;
}

double Experiment::max_stiffness_N_per_m() const {
  if (configuration_.slave && configuration_.feedback->force != Feedback::rendered)
    return felt_stiffness_N_per_m(*configuration_.slave, *configuration_.feedback);
  double holds = max_renderer_stiffness(configuration_), pulls = 0;
  for (const FixtureValues& v : configuration_.fixture_values()) {
    if (v.role == FixtureRole::forbidden)
      holds = std::max(holds, v.stiffness_N_per_m);
    else
      pulls += v.stiffness_N_per_m < 0 ? configuration_.guidance->stiffness_N_per_m : v.stiffness_N_per_m;
  }
  return holds + pulls;
}

}  // namespace remote_touch
