#include "runners/experiment/experiment.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "runners/live/loop/session_scene.h"
#include "runners/settings/json_parameters.h"

namespace remote_touch {

Parameters parameters(RunSettings& s) {
  return {
      {"title", &s.title, 0, 0, "one line for lists"},
      {"duration_s", &s.duration_s, 0, 86400, "simulated time; 0: duration of the trajectory"},
      {"haptic_rate_hz", &s.haptic_rate_hz, 100, 10000, "haptic ticks per second, f_h of (4.16)"},
      {"frame_latency_s", &s.transport.latency_s, 0, 10,
       "minimum time from the capture of a frame to its arrival"},
      {"frame_jitter_s", &s.transport.jitter_s, 0, 10,
       "maximum additional delay, uniformly distributed for each frame; frames may overtake each other"},
      {"frame_drop_probability", &s.transport.drop_probability, 0, 1,
       "probability that a frame never arrives"},
      {"seed", &s.key.seed, 0, 18446744073709551615.0, "seed of all noise"},
      {"cell", &s.key.cell, 0, 4294967295.0, "second key of the noise: the cell of a sweep"},
      {"replicate", &s.key.replicate, 0, 4294967295.0, "third key of the noise: the replicate of a cell"},
  };
}

namespace {

template <class Entry>
Part<Entry> read_part(const Json& json, std::span<const Entry> entries, const std::string& path) {
  if (json.is_object() && json.contains("name") && !json["name"].is_string())
    throw InputError(path + ".name = " + json["name"].dump(), "expected a name from `remote-touch list`");
  if (!json.is_object() || !json.contains("name"))
    throw InputError(path, "missing: expected {\"name\": ..., parameters}");
  Part<Entry> part;
  part.name = json["name"].template get<std::string>();
  part.factory = find_entry(entries, part.name, path + ".name").make();
  read_parameters(json, part.factory->settings(), path, true);
  const std::string problem = part.factory->validate();
  if (!problem.empty()) throw InputError(path + "." + problem);
  return part;
}

// The value of a key, which is then no longer in the configuration.
Json taken(Json& configuration, const std::string& key) {
  const auto found = configuration.find(key);
  if (found == configuration.end()) return {};
  Json value = std::move(*found);
  configuration.erase(found);
  return value;
}

std::vector<Part<FixtureEntry>> read_fixtures(const Json& list) {
  std::vector<Part<FixtureEntry>> parts;
  if (list.is_null()) return parts;
  if (!list.is_array()) throw InputError("fixtures", "expected a list of {\"name\": ..., parameters}");
  for (std::size_t i = 0; i < list.size(); ++i)
    parts.push_back(read_part(list[i], fixtures(), "fixtures." + std::to_string(i)));
  return parts;
}

template <class Settings>
Settings read_settings(const Json& json, const std::string& path) {
  if (!json.is_object()) throw InputError(path, "expected an object of parameters, or nothing");
  Settings settings;
  read_parameters(json, parameters(settings), path, false);
  const std::string problem = validate(settings);
  if (!problem.empty()) throw InputError(path + "." + problem);
  return settings;
}

// A part of the experiment that may be left out.
template <class Settings>
std::optional<Settings> read_section(Json& configuration, const std::string& path) {
  const Json json = taken(configuration, path);
  if (json.is_null()) return {};
  return read_settings<Settings>(json, path);
}

std::vector<SequenceStep> read_sequence(const Json& list) {
  std::vector<SequenceStep> steps;
  if (list.is_null()) return steps;
  if (!list.is_array()) throw InputError("sequence", "expected a list of {\"action\": ..., parameters}");
  for (std::size_t i = 0; i < list.size(); ++i)
    steps.push_back(read_settings<SequenceStep>(list[i], "sequence." + std::to_string(i)));
  return steps;
}

template <class Settings>
void write_section(const std::optional<Settings>& section, const char* path, Json& json) {
  if (!section) return;
  Settings settings = *section;
  json[path] = Json::object();
  write_parameters(parameters(settings), json[path]);
}

// Of a rule that is not built: some read files when they are.
FixtureValues values_of(const Part<FixtureEntry>& rule) {
  Json all = Json::object(), own = Json::object();
  write_parameters(rule.factory->settings(), all);
  FixtureValues values;
  for (const Parameter& p : parameters(values)) own[p.name] = all[p.name];
  read_parameters(own, parameters(values), rule.name, false);
  return values;
}

template <class Entry>
Json part_json(const Part<Entry>& part) {
  Json json = {{"name", part.name}};
  write_parameters(part.factory->settings(), json);
  return json;
}

}  // namespace

Experiment Experiment::from_json(const std::string& text, const std::string& label,
                                 const std::vector<std::string>& overrides) {
  Json configuration = parse_json(text, label);
  if (!configuration.is_object()) throw InputError(label, "not an object: expected {\"scenario\": ..., ...}");
  for (const std::string& assignment : overrides) apply_override(configuration, assignment);
  return from_json(std::move(configuration));
}

Experiment Experiment::from_json(Json configuration) {
  Experiment experiment;
  experiment.scenario_ = read_part(taken(configuration, "scenario"), scenarios(), "scenario");
  experiment.faults_ = read_section<SensorFaults>(configuration, "faults");
  experiment.depth_pipeline_ = read_section<DepthPipelineSettings>(configuration, "depth_pipeline");
  experiment.fixtures_ = read_fixtures(taken(configuration, "fixtures"));
  experiment.guidance_ = read_section<GuidanceSettings>(configuration, "guidance");
  experiment.sequence_ = read_sequence(taken(configuration, "sequence"));
  experiment.renderer_ = read_part(taken(configuration, "renderer"), renderers(), "renderer");
  experiment.trajectory_ = read_part(taken(configuration, "trajectory"), trajectories(), "trajectory");
  experiment.operator_ = read_section<OperatorSettings>(configuration, "operator");
  experiment.device_ = read_section<MotorSettings>(configuration, "device");
  experiment.live_ = read_section<LiveSettings>(configuration, "live");
  experiment.safety_ = read_section<SafetyLimits>(configuration, "safety");
  read_parameters(configuration, parameters(experiment.settings_), "", false);
  const std::string problem = validate(experiment.fixture_values(), experiment.sequence_);
  if (!problem.empty()) throw InputError(problem);
  if (experiment.guidance_ && !experiment.has_guidance())
    throw InputError("guidance", "expected only when a fixture has role = guidance");
  if (experiment.has_guidance() && !experiment.guidance_) experiment.guidance_.emplace();
  for (std::size_t i = 0; i < experiment.sequence_.size(); ++i)
    if (!experiment.can_be_pressed(experiment.sequence_[i]))
      throw InputError(
          "sequence." + std::to_string(i) + ".button = " + std::to_string(experiment.sequence_[i].button),
          "expected a button of operator.presses (any button in experiments with a section live)");
  return experiment;
}

Experiment Experiment::load(const std::string& name_or_file, const std::vector<std::string>& overrides) {
  const std::string text = has_result_header(name_or_file)
                               ? session_experiment(name_or_file)
                               : embedded_or_file(embedded_experiments(), name_or_file, "an experiment's");
  return from_json(text, name_or_file, overrides);
}

std::string Experiment::to_json() const {
  Json json = Json::object();
  RunSettings settings = settings_;
  write_parameters(parameters(settings), json);
  json["scenario"] = part_json(scenario_);
  write_section(faults_, "faults", json);
  write_section(depth_pipeline_, "depth_pipeline", json);
  json["fixtures"] = Json::array();
  for (const auto& rule : fixtures_) json["fixtures"].push_back(part_json(rule));
  write_section(guidance_, "guidance", json);
  for (SequenceStep step : sequence_) {
    Json step_json = Json::object();
    write_parameters(parameters(step), step_json);
    json["sequence"].push_back(step_json);
  }
  json["renderer"] = part_json(renderer_);
  json["trajectory"] = part_json(trajectory_);
  write_section(operator_, "operator", json);
  write_section(device_, "device", json);
  write_section(live_, "live", json);
  write_section(safety_, "safety", json);
  return json.dump();
}

std::vector<RecordingPart> Experiment::inputs() const {
  std::vector<RecordingPart> all = scenario_.factory->inputs();
  const auto add = [&](const std::vector<RecordingPart>& parts) {
    all.insert(all.end(), parts.begin(), parts.end());
  };
  for (const auto& rule : fixtures_) add(rule.factory->inputs());
  add(renderer_.factory->inputs()), add(trajectory_.factory->inputs());
  return all;
}

std::unique_ptr<Scenario> Experiment::build_scenario(const Kernels& kernels) const {
  auto scenario = scenario_.factory->build(settings_.key, kernels);
  if (!faults_) return scenario;
  return std::make_unique<FaultySensor>(std::move(scenario), *faults_, settings_.key, kernels);
}

std::unique_ptr<Trajectory> Experiment::build_trajectory(const Scenario& scenario) const {
  return trajectory_.factory->build(scenario.without_faults());
}

std::vector<FixtureValues> Experiment::fixture_values() const {
  std::vector<FixtureValues> values;
  for (const auto& rule : fixtures_) values.push_back(values_of(rule));
  return values;
}

bool Experiment::has_guidance() const {
  const std::vector<FixtureValues> values = fixture_values();
  return std::any_of(values.begin(), values.end(),
                     [](const FixtureValues& v) { return v.role == FixtureRole::guidance; });
}

// A simulated device has no other buttons than those that the operator's settings press.
bool Experiment::can_be_pressed(const SequenceStep& step) const {
  if (step.start != StepStart::button && step.done != StepEnd::button) return true;
  if (live_ || trajectory_.name == "live-session") return true;  // the device has its own
  const std::vector<double> presses = operator_ ? operator_->presses : std::vector<double>{};
  for (std::size_t i = 1; i < presses.size(); i += 3)
    if (presses[i] == step.button) return true;
  return false;
}

std::unique_ptr<Renderer> Experiment::build_renderer(const Kernels& kernels,
                                                     std::shared_ptr<FixtureSwitches> switches) const {
  auto renderer = renderer_.factory->build(settings_.haptic_rate_hz, kernels);
  if (sequence_.empty() && !has_guidance()) return renderer;
  if (!switches) switches = std::make_shared<FixtureSwitches>();
  return std::make_unique<GuidedRenderer>(std::move(renderer), *guidance_, fixture_values(), sequence_,
                                          std::move(switches));
}

FixtureAssignment Experiment::build_fixtures(std::shared_ptr<const FixtureSwitches> switches) const {
  std::vector<std::unique_ptr<const FixtureRule>> rules;
  for (const auto& rule : fixtures_) rules.push_back(rule.factory->build());
  // Frames of a scene at rest are sent on only where something can change.
  return FixtureAssignment(std::move(rules), sequence_.empty() ? nullptr : std::move(switches));
}

FrameProcessing Experiment::build_processing(const Kernels& kernels,
                                             std::shared_ptr<const FixtureSwitches> switches) const {
  FrameProcessing processing{nullptr, build_fixtures(std::move(switches))};
  if (depth_pipeline_) processing.depth = std::make_unique<DepthPipeline>(*depth_pipeline_, kernels);
  return processing;
}

SimulatedHand Experiment::build_hand() const {
  return {operator_, device_, 1 / settings_.haptic_rate_hz};
}

double Experiment::max_stiffness_N_per_m() const {
  double holds = 0, pulls = 0;
  for (const Parameter& p : renderer_.factory->settings())
    if (const auto* const value = std::get_if<double*>(&p.value); value && p.name == "stiffness_N_per_m")
      holds = **value;
  for (const FixtureValues& v : fixture_values()) {
    if (v.role == FixtureRole::forbidden)
      holds = std::max(holds, v.stiffness_N_per_m);
    else
      pulls += v.stiffness_N_per_m < 0 ? guidance_->stiffness_N_per_m : v.stiffness_N_per_m;
  }
  return holds + pulls;
}

}  // namespace remote_touch
