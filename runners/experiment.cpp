#include "runners/experiment.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "runners/json_parameters.h"

namespace remote_touch {

Parameters parameters(RunSettings& s) {
  return {
      {"title", &s.title, 0, 0, "one line for lists"},
      {"duration_s", &s.duration_s, 0, 86400, "simulated time; 0: as long as the trajectory lasts"},
      {"haptic_rate_hz", &s.haptic_rate_hz, 100, 10000, "haptic ticks per second, f_h of (4.16)"},
      {"frame_latency_s", &s.frame_latency_s, 0, 10, "time from the capture of a frame to its arrival"},
      {"seed", &s.key.seed, 0, 18446744073709551615.0, "key of all noise"},
      {"cell", &s.key.cell, 0, 4294967295.0, "second key of the noise: the cell of a sweep"},
      {"replicate", &s.key.replicate, 0, 4294967295.0, "third key of the noise: the repetition of a cell"},
  };
}

namespace {

template <class Entry>
auto read_part(const Json& configuration, std::span<const Entry> entries, const std::string& part,
               std::string& name) {
  const auto found = configuration.find(part);
  if (found != configuration.end() && found->is_object() && found->contains("name") &&
      !(*found)["name"].is_string())
    throw InputError(part + ".name = " + (*found)["name"].dump(),
                     "allowed a name that remote-touch list prints");
  if (found == configuration.end() || !found->is_object() || !found->contains("name"))
    throw InputError(part, "missing; allowed {\"name\": ..., parameters}");
  name = (*found)["name"].template get<std::string>();
  auto blueprint = find_entry(entries, name, part + ".name").make();
  read_parameters(*found, blueprint->settings(), part, true);
  const std::string contradiction = blueprint->contradiction();
  if (!contradiction.empty())
    throw InputError(part + "." + contradiction, "together with the other settings");
  return blueprint;
}

template <class Blueprint>
Json part_json(const std::string& name, const Blueprint& blueprint) {
  Json json = {{"name", name}};
  write_parameters(blueprint->settings(), json);
  return json;
}

}  // namespace

Experiment Experiment::from_json(const std::string& text, const std::string& label,
                                 const std::vector<std::string>& overrides) {
  Json configuration = parse_json(text, label);
  if (!configuration.is_object()) throw InputError(label, "not an object; allowed {\"scenario\": ..., ...}");
  for (const std::string& assignment : overrides) apply_override(configuration, assignment);
  return from_json(std::move(configuration));
}

Experiment Experiment::from_json(Json configuration) {
  Experiment experiment;
  experiment.scenario_ = read_part(configuration, scenarios(), "scenario", experiment.scenario_name_);
  experiment.renderer_ = read_part(configuration, renderers(), "renderer", experiment.renderer_name_);
  experiment.trajectory_ =
      read_part(configuration, trajectories(), "trajectory", experiment.trajectory_name_);
  for (const char* part : {"scenario", "renderer", "trajectory"}) configuration.erase(part);
  read_parameters(configuration, parameters(experiment.settings_), "", false);
  return experiment;
}

Experiment Experiment::load(const std::string& name_or_file, const std::vector<std::string>& overrides) {
  return from_json(stored_or_file(stored_experiments(), name_or_file, "an experiment's"), name_or_file,
                   overrides);
}

std::string Experiment::to_json() const {
  Json json = Json::object();
  RunSettings settings = settings_;
  write_parameters(parameters(settings), json);
  json["scenario"] = part_json(scenario_name_, scenario_);
  json["renderer"] = part_json(renderer_name_, renderer_);
  json["trajectory"] = part_json(trajectory_name_, trajectory_);
  return json.dump();
}

std::vector<RecordingPart> Experiment::inputs() const {
  std::vector<RecordingPart> all = scenario_->inputs();
  for (const auto& parts : {renderer_->inputs(), trajectory_->inputs()})
    all.insert(all.end(), parts.begin(), parts.end());
  return all;
}

std::unique_ptr<Scenario> Experiment::build_scenario(const Kernels& kernels) const {
  return scenario_->build(settings_.key, kernels);
}

std::unique_ptr<Trajectory> Experiment::build_trajectory(const Scenario& scenario) const {
  return trajectory_->build(scenario);
}

std::unique_ptr<Renderer> Experiment::build_renderer(const Kernels& kernels) const {
  return renderer_->build(settings_.haptic_rate_hz, kernels);
}

}  // namespace remote_touch
