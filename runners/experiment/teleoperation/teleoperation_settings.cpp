#include "runners/experiment/teleoperation/teleoperation_settings.h"

namespace remote_touch {

Parameters parameters(LinkSettings& s) {
  return appended(parameters(s.channel), parameters(s.dead_band));
}

std::string validate(const LinkSettings& s) {
  const std::string problem = validate(s.channel);
  return problem.empty() ? validate(s.dead_band) : problem;
}

}  // namespace remote_touch
