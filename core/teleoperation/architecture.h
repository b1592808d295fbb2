// Architectures of teleoperation with force feedback, and the passivity control that keeps one of them
// stable.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/parameters/parameter.h"
#include "core/points/vector.h"
#include "core/teleoperation/channel.h"
#include "core/teleoperation/slave.h"

namespace remote_touch {

// Time-domain passivity control of a channel with delay between a hand and a slave: a controller at each port
// changes its signal, as little as possible, so that no more energy leaves the channel there than the far
// port has sent as its credit. Derivation, bound and sources: README.md of runners/experiment/hand.
//
// All forces act on the body at the port. Energy that enters the channel in a tick is -F . d at the hand and
// f . d at the slave, where d is the displacement of the hand, or of the slave's command.

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

// Architectures of teleoperation with force feedback: what the hand's end and the slave's end of a channel
// send to each other, and what each does with what has arrived.
//
// Always sent: the position of the hand as the command, and the force f of the scene on the slave. Beside
// them travels a Message. In a tick both ends observe what has happened, then both send, then both use the
// newest packet that has arrived. F is the force on the hand, x its position, c the reference of the slave's
// drive, y the slave, D the force of the drive on the slave, _ a signal that has arrived, T the tick.
//
//   architecture       hand                                 slave                     port of the slave
//   position-force     F = g f_                             c = x_                    f . dc
//   with passivity     f_ as far as the energy suffices     x_ as far as it suffices  f . dc
//   control
//   position-position  F = K (y_ - x) + B (y'_ - x')        c = x_                    -D . dy
//   wave variables     F = sqrt(2 b) w_ - b x'              sqrt(2 b) u_ = b c' + D   -D . dc
//                      sends u = w_ - sqrt(2 / b) F         sends w = (b c' - D) / sqrt(2 b)
//
// The port of the hand is -F . dx in all of them, with the force F that the device really exerts. in - out
// over both ports is the energy in the channel. Sources: D. A. Lawrence, IEEE Trans. Robotics and Automation
// 9(5), 1993; G. Niemeyer and J.-J. E. Slotine, IEEE J. Oceanic Engineering 16(1), 1991, and Int. J. Robotics
// Research 23(9), 2004; passivity control above. Compared by E. J. Rodriguez-Seda, D. Lee and M. W. Spong,
// IEEE Trans. Robotics 25(4), 2009. Numbers and bounds: README.md of runners/experiment/hand.
//
// All positions, forces and waves here are in the frame in which the hand works. Nothing allocates in a tick.

// The force that the device exerts on the hand, and the position that is sent to the slave.
//   rendered:     the force of the renderer, which it computes from the points of the newest frame. The
//                 commanded position of the renderer is sent, which stays outside forbidden regions. This is
//                 teleoperation as in the dissertation, 3.2.
//   none:         no force. The position of the HIP is sent, as in all architectures below.
//   The others are those of the table above.
enum class Feedback { rendered, none, slave_force, passive_slave_force, position_position, wave };

// True if the hand is to feel the slave, so that the slave sends packets.
bool feels_slave(Feedback force);

struct FeedbackSettings {
  Feedback force = Feedback::rendered;
  double gain = 1;
  HoldSettings hold;  // forces of the slave
  PassivitySettings passivity;
  double stiffness_N_per_m = 600, damping_Ns_per_m = 10;  // K and B of position-position
  double impedance_Ns_per_m = 0;                          // b of wave; 0: matched
};

Parameters parameters(FeedbackSettings& s);
std::string validate(const FeedbackSettings& s);

// Returns the impedance b of the waves; matched: the damping 2 zeta w M of the slave's drive.
double wave_impedance_Ns_per_m(const FeedbackSettings& feedback, const SlaveSettings& slave);

// Returns how fast the force on the hand grows with its displacement, at rest and without a delay. With
// waves, a delay each way and the tick add (delay + T) / b to its inverse.
double felt_stiffness_N_per_m(const SlaveSettings& slave, const FeedbackSettings& feedback);

// A wave u, the sum of u T and the sum of |u|^2 T / 2 since the start, which make up for lost packets.
struct Wave {
  Vec3 value = Vec3::Zero();     // sqrt(W)
  Vec3 integral = Vec3::Zero();  // sqrt(W) s
  double energy_J = 0;

  // Makes this value the wave of the next time_s.
  void add(const Vec3& next, double time_s);
};

// The waves that an end uses. They never have more energy than those that were sent, whatever the delay, its
// jitter and the losses, and their integral follows the one that was sent as far as this energy suffices.
// Without jitter and losses they are those that were sent. Jitter and losses make them later, as a buffer
// does: by the time in which no packet came. A wave that is missing is 0.
class WaveReceiver {
 public:
  // Returns the wave for the coming tick.
  Vec3 next(const Wave& newest, double tick_s);
  // The last wave lasted so much longer, because ticks were missed. The next waves are smaller by its energy.
  void prolong(double time_s) { used_.add(used_.value, time_s); }

 private:
  Wave used_;
};

// A message travels beside a position or a force.
struct Message {
  double credit_J = 0;                                        // passivity control: of its port
  Vec3 position_W = Vec3::Zero(), velocity_W = Vec3::Zero();  // position-position: of the slave
  Wave wave = {};                                             // wave variables: u or w
};

class HandEnd {
 public:
  virtual ~HandEnd() = default;

  // The hand has done this since the last call.
  struct Motion {
    Vec3 position_W = Vec3::Zero();
    Vec3 displacement_m = Vec3::Zero();
    Vec3 applied_N = Vec3::Zero();  // force that the device exerted meanwhile, with all its limits
    double ticks = 1;
  };
  virtual void observe(const Motion& motion) { energy_.add(-motion.applied_N.dot(motion.displacement_m)); }
  virtual Message message() const { return {}; }
  // The newest message that has arrived, and its force. Both are zero before the first packet.
  struct Arrival {
    Message message = {};
    Vec3 force_N = Vec3::Zero();
    double share = 1;  // the rest of a force whose packets no longer arrive, see held_share()
    bool has_come = false;
  };
  // Returns the force on the hand for the coming tick.
  virtual Vec3 force(const Arrival& arrival) = 0;
  virtual const PortEnergy& energy() const { return energy_; }

 private:
  PortEnergy energy_;
};

class SlaveEnd {
 public:
  virtual ~SlaveEnd() = default;

  // The slave has done this in a tick, in the frame in which the hand works.
  struct Motion {
    Vec3 force_N = Vec3::Zero();  // mean force of the scene
    Vec3 position_W = Vec3::Zero(), velocity_W = Vec3::Zero();
    // These have the meaning of Slave::State.
    Vec3 reference_displacement_m = Vec3::Zero(), drive_N = Vec3::Zero();
    double reference_work_J = 0, drive_work_J = 0;
  };
  virtual void observe(const Motion& motion) = 0;
  virtual Message message() const { return {}; }
  // Returns the command for the coming tick. The first call states where the slave starts.
  virtual Vec3 command(const Vec3& arrived_W, const Message& newest) = 0;
  // The wave that moves the slave in the coming tick in place of a command.
  virtual std::optional<Slave::Wave> wave() const { return {}; }
  virtual const PortEnergy& energy() const { return energy_; }

 protected:
  PortEnergy energy_;
};

struct Ends {
  std::unique_ptr<HandEnd> hand;
  std::unique_ptr<SlaveEnd> slave;
};

// The ends are those of position-force if the hand feels no slave; the caller then ignores their forces.
// hand_mass_kg: mass of hand and device, with which passivity control and waves predict the motion of the
// hand; 0: not known, then it is predicted to move as in the last tick.
Ends make_ends(const FeedbackSettings& feedback, const SlaveSettings& slave, double hand_mass_kg,
               double tick_s);

}  // namespace remote_touch
