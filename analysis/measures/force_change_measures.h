// How much the force on the hand changes from one tick to the next: at frame updates (jump) and between them
// (noise). Compared are ticks of which at least one has a force, so a force that ends or begins counts as
// well.
#pragma once

#include "analysis/trace/trace.h"

namespace remote_touch {

// The force at ticks with a new frame: maximum and root mean square of its change, N. NaN without any.
double max_force_jump_N(const Trace& trace);
double rms_force_jump_N(const Trace& trace);
// Root mean square change of the force at the other ticks, N. NaN without any.
double force_noise_N(const Trace& trace);

// The same of the torque about the HIP, N m. NaN without a tool.
double max_torque_jump_Nm(const Trace& trace);
double rms_torque_jump_Nm(const Trace& trace);
double torque_noise_Nm(const Trace& trace);

}  // namespace remote_touch
