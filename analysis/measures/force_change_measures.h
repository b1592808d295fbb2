// Change of the force on the hand, without the part of guidance, from one tick to the next: at frame updates
// (jump) and between them (noise). A change counts if at least one of its two ticks has a force, so the
// beginning and the end of a force count too. Every value is NaN if a force is unknown in a tick that counts.
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

// Settling of the force after a touch. The final force is the mean magnitude of the force of contact over the
// last kFinal_s of the run. A run has these measures only if the force is steady at its end: if all
// magnitudes of that time are within kSettledBand of the final force. NaN otherwise, without a final force,
// and if a force is unknown.
inline constexpr double kFinal_s = 0.1, kSettledBand = 0.05;
// The largest magnitude of the run divided by the final force, minus 1; 0 if the force rises to it evenly.
double force_overshoot(const Trace& trace);
// Time from the first tick with a force to the first tick from which on all magnitudes are within
// kSettledBand of the final force, s. 0 for a force that is there at once.
double force_settling_time_s(const Trace& trace);

}  // namespace remote_touch
