#include "core/virtual_fixtures/fixture_rule.h"

#include "core/parameters/schedule.h"

namespace remote_touch {

Parameters parameters(FixtureValues& v) {
  return {
      {"radius_m", &v.radius_m, -1, 1,
       "forbidden-region radius r_f of the points (5.2); -1: as it was, 0 without another rule"},
      {"stiffness_N_per_m", &v.stiffness_N_per_m, -1, 10000,
       "stiffness k_s of the points (5.3); -1: as it was, which is the renderer's own without another rule"},
      {"schedule", Rows{{"time_s", "strength"}, &v.schedule}, 0, 86400,
       "how far the rule counts, 0 to 1, over the time of capture: even between rows; none: always 1"},
      {"role", choice(v.role, {"forbidden", "guidance"}), 0, 0,
       "forbidden: its points are kept away from; guidance: their mean is where the hand is led to, radius_m is "
       "how near counts as there, stiffness_N_per_m that of the spring"},
      {"label", &v.label, 0, 0, "by which the steps of a sequence name the rule"},
  };
}

std::string validate(const FixtureValues& v) {
  if (v.radius_m < 0 && v.radius_m != -1)
    return "radius_m = " + std::to_string(v.radius_m) + ": allowed 0 or more, or -1";
  if (v.stiffness_N_per_m < 0 && v.stiffness_N_per_m != -1)
    return "stiffness_N_per_m = " + std::to_string(v.stiffness_N_per_m) + ": allowed 0 or more, or -1";
  if (v.role == FixtureRole::guidance && v.radius_m <= 0)
    return "radius_m = " + std::to_string(v.radius_m) + ": allowed above 0 for role = guidance";
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
