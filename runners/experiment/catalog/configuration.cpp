#include "runners/experiment/catalog/configuration.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "runners/experiment/settings/json_parameters.h"

namespace remote_touch {

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
