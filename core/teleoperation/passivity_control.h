// Time-domain passivity control of a channel with delay between a hand and a slave.
//
// Each side of the channel is a port, at which a force and a motion exchange energy. A port observes the
// energy that enters the channel (in) and the energy that leaves it (out), both as sums that never fall. It
// sends `in` beside its signal. The far port may give out no more than the `in` that has arrived there:
//   received(t) = in of the far port, delayed,    balance(t) = received + dissipated - out >= 0.
// If this holds at both ports, the channel never gives out more energy than went in, whatever the delay, its
// jitter and the losses: the delayed sums are never larger than the sums themselves. If the next tick would
// make the balance negative, a controller changes the signal of its port by just as much as is missing:
//   at the hand (impedance):     f = f_delayed - alpha v,    alpha = missing / (|v|^2 T),
//   at the slave (admittance):   v = v_delayed + beta f,     beta  = missing / (|f|^2 T).
//
// Sources: J.-H. Ryu, D.-S. Kwon and B. Hannaford, "Stability guaranteed control: time domain passivity
// approach", IEEE Trans. Control Systems Technology 12(6), 2004 (observer, alpha and beta); J.-H. Ryu, J.
// Artigas and C. Preusche, "A passive bilateral control scheme for a teleoperator with time-varying
// communication delay", Mechatronics 20(7), 2010, and J. Artigas, J.-H. Ryu, C. Preusche and G. Hirzinger,
// "Network representation and passivity of delayed teleoperation systems", IROS 2011 (in and out at each
// port); V. Chawda and M. K. O'Malley, "Position synchronization in bilateral teleoperation under
// time-varying communication delays", IEEE/ASME Trans. Mechatronics 20(1), 2015 (drift). As in C. Preusche et
// al., ICRA 2003, one scalar alpha serves for all axes.
//
// Signs. All forces act on the body at the port: on the hand, and on the slave's command. Energy that enters
// the channel in a tick is -f . d at the hand, where d is the displacement of the hand, and f . d at the
// slave, where d is the displacement of the command.
//
// Two pairs of forces are possible; the force that is sent to the hand and the force at the slave's port have
// to be of the same kind. The first is the reaction to the slave's drive. The slave with its drive is then a
// passive system behind the port, and so is the whole loop. The hand also feels the inertia of the slave in
// free motion, and all energy for the drive has to come from the hand: the slave moves only as fast as this
// energy arrives. The damper of the drive makes the reaction depend on the command of the same tick, so this
// port needs its response (below). The second is the measured force of the scene. The channel is passive all
// the same, and the energy of the drive is the slave's own. The scene behind a slave that lags is not
// passive, so the loop has no guarantee.
//
// The signals of a tick are chosen before the tick, so a controller has to predict the energy of the tick.
// The published rule predicts that the motion at the port (at the slave: the force) is that of the last tick.
// A strong damping can reverse the motion within a tick; then the prediction has the wrong sign, and the
// energy falls tick after tick. So the caller may give the response of the port: motion = motion without a
// signal + response x signal. The energy is then a quadratic form in the signal, and the controller projects
// the delayed signal onto the ball of signals that the energy allows, which is the smallest possible change.
// Without a response the ball is the half-space of the published rule. observe() records the tick as it was.
// A wrong prediction leaves a negative balance, and later ticks repay it.
#pragma once

#include <string>

#include "core/geometry/vector.h"
#include "core/parameters/parameter.h"

namespace remote_touch {

struct PassivitySettings {
  double max_damping_Ns_per_m = 100;
  double max_yield_m_per_s = 0.1;
  double drift_time_s = 0;
};

Parameters parameters(PassivitySettings& s);

// The energy of one port since the start, J.
struct PortEnergy {
  double in_J = 0;          // entered the channel; sent to the far port
  double out_J = 0;         // left the channel, before the controller changed the signal
  double dissipated_J = 0;  // removed by the controller
  double received_J = 0;    // largest in_J of the far port that has arrived

  // Records a tick in which this energy entered the channel; negative: left it.
  void add(double energy_J);
  // A value that arrives late, after a larger one, changes nothing.
  void receive(double far_in_J);
  // The energy that may still leave the channel here.
  double balance_J() const { return received_J + dissipated_J - out_J; }
};

// The port at the hand. Call force() before each tick, observe() after it. Neither allocates.
class ImpedancePassivityController {
 public:
  // response_m_per_N: displacement of the hand in a tick per force that is held for the tick; T^2 / (2 m) for
  // the mass m of hand and device; 0: the published rule. pre: tick_s > 0, response_m_per_N >= 0.
  ImpedancePassivityController(const PassivitySettings& settings, double tick_s, double response_m_per_N = 0);

  // Returns the force on the hand for the coming tick. It is delayed_force_N, bit by bit, if the energy
  // suffices. expected_displacement_m: of the hand in the coming tick without this force; with the published
  // rule, its velocity times the tick. The controller takes from the delayed force at most the part that does
  // work on the hand in the tick, plus max_damping_Ns_per_m for what an earlier tick left missing. With the
  // published rule nothing changes without motion.
  Vec3 force(const Vec3& delayed_force_N, const Vec3& expected_displacement_m, double far_in_J);
  // displacement_m: of the hand in the tick that has ended.
  void observe(const Vec3& displacement_m);

  // Returns a prediction of the displacement in the coming tick without a force of this port. With d1 and d2,
  // the displacements of the last two ticks, and the force f2 before the last, it is 2 d1 - d2 - response f2:
  // exact for a mass under another force that is constant.
  Vec3 free_displacement() const;

  const PortEnergy& energy() const { return energy_; }

 private:
  const double response_, max_stiffness_;
  PortEnergy energy_;
  Vec3 delayed_force_N_ = Vec3::Zero(), removed_N_ = Vec3::Zero();
  Vec3 last_m_ = Vec3::Zero(), last_but_one_m_ = Vec3::Zero();
  Vec3 last_force_N_ = Vec3::Zero(), last_but_one_force_N_ = Vec3::Zero();
};

// The port at the slave. Call command() before each tick, observe() after it. Neither allocates.
class AdmittancePassivityController {
 public:
  // response_N_per_m: decrease of the mean force at the port in a tick per displacement of the command in
  // this tick; about b / T + k / 2 for the reaction to a drive of stiffness k and damping b; 0: the published
  // rule, and right for a measured force of the scene. pre: tick_s > 0, response_N_per_m >= 0.
  AdmittancePassivityController(const PassivitySettings& settings, double tick_s,
                                double response_N_per_m = 0);

  // Returns the position that the slave's command has to reach in the coming tick. It is delayed_W, bit by
  // bit, if the energy has always sufficed. Otherwise the command yields by beta f T, and keeps the sum of
  // all yields as its drift. If drift_time_s is set, the drift decays with this time constant, as far as the
  // energy suffices. The controller takes from the delayed motion at most the part that does work on the
  // slave in the tick, plus max_yield_m_per_s for what an earlier tick left missing. expected_force_N: at the
  // port, in the coming tick; with a response, if the command does not move.
  Vec3 command(const Vec3& delayed_W, const Vec3& expected_force_N, double far_in_J);
  // force_N: mean force at the port in the tick that has ended.
  void observe(const Vec3& force_N);

  const PortEnergy& energy() const { return energy_; }
  const Vec3& drift_m() const { return drift_m_; }  // distance from the delayed to the commanded position

 private:
  // The motion against the drift, as far as the energy allows beside the delayed motion.
  Vec3 correction(const Vec3& motion_m, const Vec3& force_N) const;

  const double response_, max_yield_m_, drift_share_;
  PortEnergy energy_;
  Vec3 delayed_W_ = Vec3::Zero(), drift_m_ = Vec3::Zero();
  Vec3 motion_m_ = Vec3::Zero(), yield_m_ = Vec3::Zero();
  bool is_placed_ = false;
};

}  // namespace remote_touch
