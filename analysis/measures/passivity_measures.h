// Energy that the device gives to the hand: force . displacement of the HIP until the next tick, and with a
// tool also torque . rotation. This is the exact work of a force that is held for a tick. A simulated
// operator gains or dissipates all of it (runners/experiment/hand/held_force_step.h). If the run simulates an
// operator or a device, the force and torque are those that the device exerts with the motors that it has.
// Otherwise they are those that the renderer commands.
#pragma once

namespace remote_touch {

struct Trace;

// Work on the hand in the whole run, J. Negative if the hand did more work on the surface.
double energy_injected_J(const Trace& trace);

// The maximum over time of the net energy injected into the hand since the start, J; 0 if it was never
// positive. A passive renderer without stored energy at the start cannot exceed 0: the passivity observer of
// B. Hannaford and J.-H. Ryu, IEEE Trans. Robotics and Automation 18 (2002), with the opposite sign.
double max_energy_injected_J(const Trace& trace);

// Work done on the hand from one frame update to the next, J: mean and maximum over the complete intervals in
// which the hand feels a force or a torque. NaN if there is no such interval.
double mean_energy_per_update_J(const Trace& trace);
double max_energy_per_update_J(const Trace& trace);

// The lowest energy of the channel between the hand and a slave in the run, J: in - out of both ports, 0 at
// the start. Negative if the channel has given more than it received, so it is not passive. NaN if the hand
// is not to feel the slave.
double min_channel_energy_J(const Trace& trace);

// Energy that passivity control has kept from leaving this channel, J; 0 with other architectures. NaN as
// above.
double dissipated_energy_J(const Trace& trace);

}  // namespace remote_touch
