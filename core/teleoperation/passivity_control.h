// Time-domain passivity control of a channel with delay between a hand and a slave: a controller at each port
// changes its signal, as little as possible, so that no more energy leaves the channel there than the far
// port has sent as its credit. Derivation, bound and sources: README.md of runners/experiment/hand.
//
// All forces act on the body at the port. Energy that enters the channel in a tick is -F . d at the hand and
// f . d at the slave, where d is the displacement of the hand, or of the slave's command.
#pragma once

#include <string>

#include "core/parameters/parameter.h"
#include "core/points/vector.h"

namespace remote_touch {

struct PassivitySettings {
  double max_damping_Ns_per_m = 100;
  double max_yield_m_per_s = 0.1;
  double drift_time_s = 0;
};

Parameters parameters(PassivitySettings& s);

// The energy of one port since the start, J. None of the sums ever falls.
struct PortEnergy {
  double in_J = 0;        // entered the channel
  double out_J = 0;       // left the channel
  double repaid_J = 0;    // part of in_J that entered while more had left than the far port had given
  double received_J = 0;  // largest credit of the far port that has arrived
  // Energy that a controller kept in the channel: what the delayed signal would have given out in a tick,
  // less what the applied one gave out, over the ticks in which this is positive. Not part of the balance.
  double dissipated_J = 0;

  // Records a tick in which this energy entered the channel; negative: left it.
  void add(double energy_J);
  // A credit that arrives late, after a larger one, changes nothing.
  void receive(double far_credit_J);
  // The energy that the far port may give out, which is sent to it.
  double credit_J() const { return in_J - repaid_J; }
  // The energy that may still leave the channel here. Negative: an older prediction was wrong.
  double balance_J() const { return received_J + repaid_J - out_J; }
};

// Predicts how far the hand moves in the coming tick. Neither call allocates.
class MotionPrediction {
 public:
  // response_m_per_N: displacement of the hand in a tick per force that is held for the tick; T^2 / (2 m) for
  // the mass m of hand and device; 0: not known. pre: response_m_per_N >= 0.
  explicit MotionPrediction(double response_m_per_N) : response_(response_m_per_N) {}

  // Records what has happened since the last call. displacement_m: of the hand. force_N: the force that the
  // device exerted meanwhile.
  void observe(const Vec3& displacement_m, const Vec3& force_N);

  double response_m_per_N() const { return response_; }
  // Returns the displacement in the coming tick without a force. With d1 and d2, the displacements of the
  // last two ticks, and the force f2 before the last, it is 2 d1 - d2 - response f2: exact for a mass under
  // another force that is constant. Returns d1 if the response is not known.
  Vec3 free_displacement() const;

 private:
  const double response_;
  Vec3 last_m_ = Vec3::Zero(), last_but_one_m_ = Vec3::Zero();
  Vec3 last_force_N_ = Vec3::Zero(), last_but_one_force_N_ = Vec3::Zero();
};

// The port at the hand. Call force() before each tick, observe() after it. Neither allocates.
class ImpedancePassivityController {
 public:
  // response_m_per_N: see MotionPrediction; 0: the published rule f = f_delayed - alpha v. pre: tick_s > 0.
  ImpedancePassivityController(const PassivitySettings& settings, double tick_s, double response_m_per_N = 0);

  // Returns the force on the hand for the coming tick. It is delayed_force_N, bit by bit, if the energy
  // suffices. free_displacement_m: of the hand in the coming tick without this force; with the published
  // rule, its velocity times the tick. With a response the result is the nearest force that the energy
  // allows. The controller takes from the delayed force at most the part that does work on the hand in the
  // tick, plus max_damping_Ns_per_m for what an earlier tick left missing. With the published rule nothing
  // changes without motion.
  Vec3 force(const Vec3& delayed_force_N, const Vec3& free_displacement_m, double far_credit_J);
  // displacement_m: of the hand since the last call. applied_N: the force that the device exerted meanwhile,
  // with all its limits.
  void observe(const Vec3& displacement_m, const Vec3& applied_N);

  const PortEnergy& energy() const { return energy_; }

 private:
  const double response_, max_stiffness_;
  PortEnergy energy_;
  Vec3 delayed_force_N_ = Vec3::Zero();
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
  // port, in the coming tick; with a response, if the command does not move. The first call states where the
  // command starts.
  Vec3 command(const Vec3& delayed_W, const Vec3& expected_force_N, double far_credit_J);
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
