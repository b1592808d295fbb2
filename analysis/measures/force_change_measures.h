// Change of the force on the hand from one tick to the next: at frame updates (jump) and between them
// (noise). A change counts if at least one of its two ticks has a force, so the beginning and the end of a
// force count too.
#pragma once

namespace remote_touch {

struct Trace;

// Maximum and root mean square of the change of force at ticks with a new frame, N. NaN if no change counts.
double max_force_jump_N(const Trace& trace);
double rms_force_jump_N(const Trace& trace);
// The first tick with the change that max_force_jump_N() returns. NaN if no change counts or all are 0.
double max_force_jump_tick(const Trace& trace);
// Root mean square change of the force at the other ticks, N. NaN if no change counts.
double force_noise_N(const Trace& trace);

// The same measures for the torque about the HIP, N m. NaN without a tool.
double max_torque_jump_Nm(const Trace& trace);
double rms_torque_jump_Nm(const Trace& trace);
double torque_noise_Nm(const Trace& trace);

}  // namespace remote_touch
