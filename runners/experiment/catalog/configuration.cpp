#include "runners/experiment/catalog/configuration.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "runners/experiment/settings/json_parameters.h"

namespace remote_touch {

Parameters parameters(RendererChange& change) {
  return {
      {"time_s", &change.time_s, 0, 86400,
       "time of the change; it takes effect in the first tick at or after it"},
      {"parameter", &change.parameter, 0, 0,
       "what changes: a parameter of the renderer that is marked live, for example renderer.stiffness_N_per_m"},
      {"value", &change.value, -1e9, 1e9, "new value; of a switch: 0 or 1"},
  };
}

const Parameter* find_in_changes(const Parameters& live, const std::string& name) {
  const auto found = std::ranges::find_if(
      live, [&](const Parameter& parameter) { return name_in_changes(parameter) == name; });
  return found == live.end() ? nullptr : &*found;
}

void set_number(const Parameter& parameter, double value) {
  if (double* const* number = std::get_if<double*>(&parameter.value)) **number = value;
  if (bool* const* is_on = std::get_if<bool*>(&parameter.value)) **is_on = value != 0;
}

double number_of(const Parameter& parameter) {
  if (double* const* number = std::get_if<double*>(&parameter.value)) return **number;
  bool* const* is_on = std::get_if<bool*>(&parameter.value);
  return is_on && **is_on ? 1 : 0;
}

RendererChanges::RendererChanges(const std::vector<RendererChange>& changes, Renderer& renderer)
    : renderer_(renderer) {
  const Parameters live = renderer.live_parameters();
  for (const RendererChange& change : changes)
    if (const Parameter* const found = find_in_changes(live, change.parameter))
      changes_.push_back({change.time_s, *found, change.value});
}

void RendererChanges::make_until(double time_s) {
  const std::size_t first = next_;
  for (; next_ < changes_.size() && changes_[next_].time_s <= time_s; ++next_)
    set_number(changes_[next_].parameter, changes_[next_].value);
  if (next_ > first) renderer_.parameters_changed();
}

Parameters parameters(RunSettings& s) {
  return {
      {"title", &s.title, 0, 0, "one line that says what this is; shown by list"},
      {"duration_s", &s.duration_s, 0, 86400, "simulated time; 0: duration of the trajectory"},
      {"haptic_rate_hz", &s.haptic_rate_hz, 100, 10000, "haptic ticks per second, f_h of (4.16)"},
      {"frame_latency_s", &s.transport.latency_s, 0, 10,
       "minimum time from the capture of a frame to its arrival"},
      {"frame_jitter_s", &s.transport.jitter_s, 0, 10,
       "maximum additional delay, uniformly distributed for each frame; frames may overtake each other"},
      {"frame_drop_probability", &s.transport.drop_probability, 0, 1,
       "probability that a frame never arrives"},
      {"seed", &s.key.seed, 0, 18446744073709551615.0, "seed of the noise"},
      {"cell", &s.key.cell, 0, 4294967295.0, "second key of the noise: the cell of a sweep"},
      {"replicate", &s.key.replicate, 0, 4294967295.0, "third key of the noise: the replicate of a cell"},
  };
}

namespace {

// Returns the values of a rule without building it: some rules read files when they are built.
FixtureValues values_of(const Part<FixtureEntry>& rule) {
  Json all = Json::object(), own = Json::object();
  write_parameters(rule.factory->settings(), all);
  FixtureValues values;
  for (const Parameter& p : parameters(values)) own[p.name] = all[p.name];
  read_parameters(own, parameters(values), rule.name);
  return values;
}

}  // namespace

std::vector<FixtureValues> ExperimentConfiguration::fixture_values() const {
  std::vector<FixtureValues> values;
  for (const auto& rule : fixtures) values.push_back(values_of(rule));
  return values;
}

bool ExperimentConfiguration::has_guidance() const {
  const std::vector<FixtureValues> values = fixture_values();
  return std::ranges::any_of(values, [](const FixtureValues& v) { return v.role == FixtureRole::guidance; });
}

}  // namespace remote_touch
