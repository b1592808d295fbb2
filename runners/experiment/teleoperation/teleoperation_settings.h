// The settings of a run with teleoperation: the slave, the links to it and back, and what the hand feels.
#pragma once

#include <optional>
#include <string>

#include "core/parameters/parameter.h"
#include "core/teleoperation/channel.h"
#include "core/teleoperation/dead_band.h"
#include "core/teleoperation/passivity_control.h"
#include "core/teleoperation/registration_error.h"
#include "core/teleoperation/slave.h"
#include "core/teleoperation/slave_tool.h"

namespace remote_touch {

// The force that the device exerts on the hand, and the position that is sent to the slave.
//   rendered:     the force of the renderer, which it computes from the points of the newest frame. The
//                 commanded position of the renderer is sent, which stays outside forbidden regions. This is
//                 teleoperation as in the dissertation, 3.2.
//   none:         no force. The position of the HIP is sent, as in all architectures below.
//   slave_force:  the force of the scene on the slave, times `gain` (position-force).
//   passive_slave_force: this force without a gain, with passivity control at the hand and at the slave, see
//                 passivity_control.h.
enum class Feedback { rendered, none, slave_force, passive_slave_force };

struct FeedbackSettings {
  Feedback force = Feedback::rendered;
  double gain = 1;
  PassivitySettings passivity;
};

Parameters parameters(FeedbackSettings& s);
std::string validate(const FeedbackSettings& s);

// Returns how fast the force on the hand grows with its displacement, at rest and without a delay: drive and
// contact of the slave in series, times the gain. pre: force is not rendered.
double felt_stiffness_N_per_m(const SlaveSettings& slave, const FeedbackSettings& feedback);

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
  // Mass of hand and device, which passivity control uses to predict the motion of the hand; 0: not known.
  double hand_mass_kg = 0;
  std::optional<SlaveTool> tool;  // tool of the slave; none: it is a ball
};

}  // namespace remote_touch
