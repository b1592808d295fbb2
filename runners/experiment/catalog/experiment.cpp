#include "runners/experiment/catalog/experiment.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "analysis/storage/block_journal.h"
#include "analysis/storage/digest.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/catalog/configuration.h"
#include "runners/experiment/mesh_files/loaded_tool.h"
#include "runners/experiment/sessions/session_scene.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/json_parameters.h"
#include "scenarios/files/input_files.h"
#include "scenarios/simulated/depth_camera.h"

namespace remote_touch {
namespace {

// Adds a phase for each pair of successive rows between which the fraction changes. rows: times and
// fractions, see scheduled().
void add_schedule(const std::string& name, const std::vector<double>& rows, std::vector<Phase>& phases) {
  for (std::size_t i = 2; i < rows.size(); i += 2)
    if (rows[i + 1] != rows[i - 1]) phases.push_back({"the change of " + name, rows[i - 2], rows[i]});
}

constexpr const char* kRecordedSession = "live-session";

// Returns the tool of the renderer for the slave, nothing if the renderer has none. Throws InputError if the
// steps of the slave are too long for it. See load_tool() for the tool itself.
std::optional<SlaveTool> slave_tool(const ExperimentConfiguration& configuration) {
  if (!renders_tool(configuration)) return {};
  const auto tool = load_tool(*configuration.renderer.factory->tool());
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

// Returns k_s of a renderer for points without a stiffness, as the configuration gives it.
double own_stiffness_N_per_m(const Part<RendererEntry>& renderer) {
  for (const Parameter& p : renderer.factory->settings())
    if (double* const* value = std::get_if<double*>(&p.value); value && p.name == "stiffness_N_per_m")
      return **value;
  return renderer.factory->stiffness_N_per_m();
}

// The default DepthReport: prints one line when an OpenCL device has failed or cannot be used. The CPU then
// computes the same results.
void print_line(const std::string& line) {
  std::fprintf(stderr, "%s\n", line.c_str());
}

using Names = std::vector<std::string>;

// The deviations, jitters and probabilities, by section; the first is the level of the sections.
const Names kOfRun = {"frame_jitter_s", "frame_drop_probability"};
const Names kOfScene = {"noise_sigma_m", "noise_per_m", "colour_noise", "dropout_probability",
                        "turbidity_per_m"};
const Names kOfSensor = {"name", "sensor", "noise_px", "disparity_step_px", "lateral_noise_px"};
const Names kOfFaults = random_faults();
const Names kOfLink = {"jitter_s", "loss_probability"};
const Names kOfRegistration = {"offset_m", "rotation_deg"};

bool has(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_any_above_0(const Json& section, const Names& parameters) {
  for (const std::string& name : parameters)
    if (const auto found = section.find(name);
        found != section.end() && found->is_number() && found->get<double>() > 0)
      return true;
  return false;
}

// True if a triangulating sensor may draw. The rounding of active stereo may be all of its noise; structured
// light has more where it meets a surface at an angle.
bool triangulation_draws(const Json& scene) {
  const bool is_structured = scene["sensor"] == "structured-light";
  DepthSensorSettings settings;
  settings.sensor = is_structured ? DepthSensorKind::structured_light : DepthSensorKind::active_stereo;
  settings.noise_px = scene.value("noise_px", -1.0);
  settings.disparity_step_px = scene.value("disparity_step_px", -1.0);
  settings.lateral_noise_px = scene.value("lateral_noise_px", -1.0);
  const Triangulation t = triangulation(settings);
  const double rounding = is_structured ? 0 : t.step_px * t.step_px / 12;
  return t.lateral_noise_px > 0 || t.noise_px * t.noise_px > rounding;
}

bool scene_draws(const Json& scene) {
  const std::string name = scene.value("name", "");
  const auto is_named = [&](const ScenarioEntry& entry) { return entry.name == name; };
  if (std::ranges::none_of(built_in_catalog().scenarios(), is_named))
    return true;  // what it draws is not known
  if (scene.contains("sensor") && scene["sensor"] != "simple") return triangulation_draws(scene);
  return is_any_above_0(scene, kOfScene);
}

}  // namespace

std::vector<Phase> setting_phases(const ExperimentConfiguration& configuration) {
  std::vector<Phase> phases;
  for (const RendererChange& change : configuration.changes)
    phases.push_back({"the change of " + change.parameter, change.time_s});
  const std::vector<FixtureValues> fixtures = configuration.fixture_values();
  for (std::size_t i = 0; i < fixtures.size(); ++i)
    add_schedule("the strength of fixtures." + std::to_string(i), fixtures[i].schedule, phases);
  for (std::size_t i = 0; i < configuration.sequence.size(); ++i) {
    const SequenceStep& step = configuration.sequence[i];
    if (step.not_before_s > 0)
      phases.push_back({"sequence." + std::to_string(i) + " (" + name_of(step) + ")", step.not_before_s});
  }
  return phases;
}

std::vector<Phase> operator_phases(const ExperimentConfiguration& configuration) {
  std::vector<Phase> phases;
  if (!configuration.operator_settings) return phases;
  const OperatorSettings& hand = *configuration.operator_settings;
  for (std::size_t i = 0; i + 2 < hand.presses.size(); i += 3)
    phases.push_back({"the press of button " + std::to_string(static_cast<int>(hand.presses[i + 1])),
                      hand.presses[i], hand.presses[i] + hand.presses[i + 2]});
  add_schedule("operator.grip", hand.grip, phases);
  return phases;
}

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

std::vector<InputPart> Experiment::inputs(const std::vector<std::string>& except) const {
  std::vector<InputPart> all;
  for (const ExperimentSection& section : experiment_sections())
    if (section.add_inputs && std::ranges::find(except, section.key) == except.end())
      section.add_inputs(configuration_, all);
  if (!configuration_.slave || std::ranges::find(except, "scenario") != except.end()) return all;
  for (auto recorded = recorded_experiment(); recorded; recorded = recorded->recorded_experiment())
    for (InputPart& part : recorded->configuration_.scenario.factory->inputs())
      all.push_back(std::move(part));
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

FixtureAssignment Experiment::build_fixtures(std::shared_ptr<const FixtureSwitches> switches) const {
  std::vector<std::unique_ptr<const FixtureRule>> rules;
  for (const auto& rule : configuration_.fixtures) rules.push_back(rule.factory->build());
  // Switches change only with a sequence. Without one they are left out, because FrameStream would send the
  // frame of a scene at rest again and again.
  return FixtureAssignment(std::move(rules), configuration_.sequence.empty() ? nullptr : std::move(switches),
                           own_stiffness_N_per_m(configuration_.renderer));
}

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
  const std::string path = configuration_.scenario.factory->inputs().front().path;  // the recording
  const SessionReader session{find_input(path)};
  if (session.depth() != kSimulatedDepth) return {};
  return from_json(parse_json(session.config(), path + " config"));
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

RandomStreams random_streams(const Experiment& experiment) {
  const Json json = parse_json(experiment.to_json(), "an experiment");
  const auto section = [&](const char* name) {
    const Json found = json.value(name, Json::object());
    return found.is_object() ? found : Json::object();
  };
  RandomStreams streams;
  streams.of_cell = is_any_above_0(json, kOfRun) || scene_draws(section("scenario")) ||
                    is_any_above_0(section("faults"), kOfFaults) ||
                    is_any_above_0(section("command_link"), kOfLink) ||
                    is_any_above_0(section("force_link"), kOfLink);
  streams.of_replicate = is_any_above_0(section("registration"), kOfRegistration);
  return streams;
}

bool may_change_streams(const std::string& path) {
  const std::vector<std::string> keys = path_keys(path);
  const std::string& section = keys.front();
  if (has(kOfRun, section)) return true;
  const auto names_one = [&](const Names& names) { return keys.size() == 1 || has(names, keys[1]); };
  if (section == "scenario") return names_one(kOfScene) || names_one(kOfSensor);
  if (section == "faults") return names_one(kOfFaults);
  if (section == "command_link" || section == "force_link") return names_one(kOfLink);
  return section == "registration" && names_one(kOfRegistration);
}

}  // namespace remote_touch
