// The settings of a run with teleoperation: the slave, the links to it and back, and what the hand feels.
#pragma once

#include <optional>
#include <string>

#include "core/parameters/parameter.h"
#include "core/teleoperation/architecture.h"
#include "core/teleoperation/channel.h"
#include "core/teleoperation/dead_band.h"
#include "core/teleoperation/slave.h"
#include "core/teleoperation/tool_slave.h"

namespace remote_touch {

// One direction of the connection: which samples are sent, and how they travel.
struct LinkSettings {
  ChannelSettings channel;
  DeadBandSettings dead_band;
};

Parameters parameters(LinkSettings& s);
std::string validate(const LinkSettings& s);

struct TeleoperationSettings {
  SlaveSettings slave;
  LinkSettings commands, forces;
  FeedbackSettings feedback;
  RegistrationError registration;
  // Mass of hand and device, with which passivity control and waves predict the motion of the hand; 0: not
  // known.
  double hand_mass_kg = 0;
  std::optional<SlaveTool> tool;  // tool of the slave; none: it is a ball
};

}  // namespace remote_touch
