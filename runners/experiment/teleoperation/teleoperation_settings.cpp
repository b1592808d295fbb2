#include "runners/experiment/teleoperation/teleoperation_settings.h"

#include <numbers>

namespace remote_touch {

Parameters parameters(FeedbackSettings& s) {
  const Parameters own{
      {"force", choice(s.force, {"rendered", "none", "slave-force", "passive-slave-force"}), 0, 0,
       "what the hand feels: the renderer's force, nothing, the force of the scene on the slave, or this force with passivity control"},
      {"gain", &s.gain, 0, 100, "factor on the force of the scene on the slave, for slave-force"},
  };
  return appended(own, parameters(s.passivity));
}

std::string validate(const FeedbackSettings& s) {
  if (s.force != Feedback::slave_force && s.gain != 1)
    return "gain = " + std::to_string(s.gain) +
           ": expected 1 unless force = slave-force; a sweep sets both in a variant";
  return {};
}

double felt_stiffness_N_per_m(const SlaveSettings& slave, const FeedbackSettings& feedback) {
  if (feedback.force == Feedback::none || slave.contact_stiffness_N_per_m == 0) return 0;
  const double w = 2 * std::numbers::pi * slave.natural_frequency_hz;
  return feedback.gain / (1 / (slave.mass_kg * w * w) + 1 / slave.contact_stiffness_N_per_m);
}

Parameters parameters(LinkSettings& s) {
  return appended(parameters(s.channel), parameters(s.dead_band));
}

std::string validate(const LinkSettings& s) {
  const std::string problem = validate(s.channel);
  return problem.empty() ? validate(s.dead_band) : problem;
}

}  // namespace remote_touch
