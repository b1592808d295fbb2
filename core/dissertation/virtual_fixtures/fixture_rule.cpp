#include "core/dissertation/virtual_fixtures/fixture_rule.h"

#include "core/parameters/parameter.h"

namespace remote_touch {

Parameters parameters(FixtureValues& v) {
  return {
      {"radius_m", &v.radius_m, -1, 1,
       "radius r_f of the forbidden regions around the points (5.2); -1: do not change"},
      {"stiffness_N_per_m", &v.stiffness_N_per_m, -1, 10000,
       "stiffness k_s of the points (5.3); -1: do not change (default: stiffness of the renderer)"},
      {"schedule", Rows{{"time_s", "strength"}, &v.schedule}, 0, 86400,
       "strength of the rule, 0 to 1, over the time of capture; linear between rows; no rows: always 1"},
      {"role", choice(v.role, {"forbidden", "guidance"}), 0, 0,
       "forbidden: keep the tool away from the points; guidance: pull the hand towards their mean (radius_m: distance at which the goal is reached; stiffness_N_per_m: of the spring)"},
      {"label", &v.label, 0, 0, "name of the rule for the steps of a sequence"},
  };
}

std::string validate(const FixtureValues& v) {
  if (v.radius_m < 0 && v.radius_m != -1)
    return "radius_m = " + std::to_string(v.radius_m) + ": expected 0 or more, or -1";
  if (v.stiffness_N_per_m < 0 && v.stiffness_N_per_m != -1)
    return "stiffness_N_per_m = " + std::to_string(v.stiffness_N_per_m) + ": expected 0 or more, or -1";
  if (v.role == FixtureRole::guidance && v.radius_m <= 0)
    return "radius_m = " + std::to_string(v.radius_m) + ": expected above 0 for role = guidance";
  return validate_schedule(v.schedule, "schedule", "strength");
}

double FixtureRule::strength(double time_s) const {
  return scheduled(values_.schedule, time_s);
}

bool FixtureRule::changes_with_time() const {
  for (std::size_t i = 1; i < values_.schedule.size(); i += 2)
    if (values_.schedule[i] != values_.schedule[1]) return true;
  return false;
}

}  // namespace remote_touch
