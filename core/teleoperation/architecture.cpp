#include "core/teleoperation/architecture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/points/vector.h"
#include "core/teleoperation/slave.h"

namespace remote_touch {
namespace {

// Share of the missing energy per |direction|^2: the new energy of this tick in full, an older debt up to a
// limit. new_J <= |a| |direction| for the signal a that is changed, so the first part never exceeds this
// signal.
double share(double new_J, double balance_J, const Vec3& direction, double max_for_debt) {
  const double squared = direction.squaredNorm();
  if (!(squared > 0)) return 0;
  const double missing_now_J = std::max(0.0, new_J - std::max(0.0, balance_J));
  const double debt_J = std::max(0.0, -balance_J);
  if (missing_now_J == 0 && debt_J == 0) return 0;
  return missing_now_J / squared + std::min(debt_J / squared, max_for_debt);
}

// A port in a tick: the conjugate of a signal s is offset + response s, and s . conjugate leaves the channel.
struct PortInTick {
  Vec3 offset;
  double response = 0;

  double out_J(const Vec3& s) const { return s.dot(offset) + response * s.squaredNorm(); }
};

// Returns what is removed from s if the conjugate responds: the way to the nearest point of the ball |x -
// centre| <= radius of the signals from which at most budget_J leaves the channel.
Vec3 removed_by_projection(const PortInTick& port, const Vec3& s, double balance_J, double max_for_debt) {
  const double out_J = port.out_J(s);
  const double budget_J =
      balance_J >= 0 ? balance_J
                     : std::min(0.0, out_J) + std::max(balance_J, -max_for_debt * port.offset.squaredNorm());
  if (out_J <= budget_J) return Vec3::Zero();
  const Vec3 centre = -port.offset / (2 * port.response), way = s - centre;
  const double radius = std::sqrt(std::max(0.0, budget_J / port.response + centre.squaredNorm()));
  const double distance = way.norm();
  return distance > radius ? Vec3((1 - radius / distance) * way) : Vec3(Vec3::Zero());
}

// Returns what is removed from the signal s; zero if the energy suffices.
Vec3 removed(const PortInTick& port, const Vec3& s, double balance_J, double max_for_debt) {
  if (port.response > 0) return removed_by_projection(port, s, balance_J, max_for_debt);
  const double part = share(std::max(0.0, port.out_J(s)), balance_J, port.offset, max_for_debt);
  return part > 0 ? Vec3(part * port.offset) : Vec3(Vec3::Zero());
}

// A wave that was late is made up for no faster than with this time constant, or than waves arrive now.
constexpr double kCatchUp_s = 0.05;

// --- position-force ---

class PositionForceHand final : public HandEnd {
 public:
  explicit PositionForceHand(double gain) : gain_(gain) {}
  Vec3 force(const Arrival& arrival) override { return gain_ * (arrival.share * arrival.force_N); }

 private:
  const double gain_;
};

class PositionForceSlave final : public SlaveEnd {
 public:
  void observe(const Motion& motion) override { energy_.add(motion.force_N.dot(displacement_m_)); }
  Vec3 command(const Vec3& arrived_W, const Message&) override {
    displacement_m_ = arrived_W - command_W_.value_or(arrived_W);
    command_W_ = arrived_W;
    return arrived_W;
  }

 private:
  std::optional<Vec3> command_W_;
  Vec3 displacement_m_ = Vec3::Zero();
};

// --- the same with passivity control ---

class PassiveHand final : public HandEnd {
 public:
  PassiveHand(const PassivitySettings& settings, double response_m_per_N, double tick_s)
      : prediction_(response_m_per_N), port_(settings, tick_s, response_m_per_N) {}
  void observe(const Motion& motion) override {
    port_.observe(motion.displacement_m, motion.applied_N);
    prediction_.observe(motion.displacement_m / motion.ticks, motion.applied_N);
  }
  Message message() const override { return {.credit_J = port_.energy().credit_J()}; }
  Vec3 force(const Arrival& arrival) override {
    return port_.force(arrival.share * arrival.force_N, prediction_.free_displacement(),
                       arrival.message.credit_J);
  }
  const PortEnergy& energy() const override { return port_.energy(); }

 private:
  MotionPrediction prediction_;
  ImpedancePassivityController port_;
};

class PassiveSlave final : public SlaveEnd {
 public:
  PassiveSlave(const PassivitySettings& settings, double tick_s) : port_(settings, tick_s) {}
  void observe(const Motion& motion) override { force_N_ = motion.force_N, port_.observe(force_N_); }
  Message message() const override { return {.credit_J = port_.energy().credit_J()}; }
  Vec3 command(const Vec3& arrived_W, const Message& newest) override {
    return port_.command(arrived_W, force_N_, newest.credit_J);
  }
  const PortEnergy& energy() const override { return port_.energy(); }

 private:
  AdmittancePassivityController port_;
  Vec3 force_N_ = Vec3::Zero();
};

// --- position-position ---

class PositionPositionHand final : public HandEnd {
 public:
  PositionPositionHand(const FeedbackSettings& s, double tick_s)
      : stiffness_(s.stiffness_N_per_m), damping_(s.damping_Ns_per_m), tick_s_(tick_s) {}
  void observe(const Motion& motion) override {
    HandEnd::observe(motion);
    position_W_ = motion.position_W;
    if (!start_W_) start_W_ = position_W_;
    velocity_W_ = motion.displacement_m / (motion.ticks * tick_s_);
  }
  Vec3 force(const Arrival& arrival) override {
    const Message& slave = arrival.message;
    const Vec3 slave_W = arrival.has_come ? slave.position_W : start_W_.value_or(position_W_);
    return arrival.share *
           Vec3(stiffness_ * (slave_W - position_W_) + damping_ * (slave.velocity_W - velocity_W_));
  }

 private:
  const double stiffness_, damping_, tick_s_;
  std::optional<Vec3> start_W_;  // the slave starts there, too
  Vec3 position_W_ = Vec3::Zero(), velocity_W_ = Vec3::Zero();
};

class PositionPositionSlave final : public SlaveEnd {
 public:
  void observe(const Motion& motion) override {
    energy_.add(-motion.drive_work_J);
    sent_.position_W = motion.position_W, sent_.velocity_W = motion.velocity_W;
  }
  Message message() const override { return sent_; }
  Vec3 command(const Vec3& arrived_W, const Message&) override { return arrived_W; }

 private:
  Message sent_;
};

// --- wave variables ---

// F acts on the motion of the same tick. The motion is predicted as free + response F, which gives F.
class WaveHand final : public HandEnd {
 public:
  WaveHand(double impedance_Ns_per_m, double response_m_per_N, double tick_s)
      : impedance_(impedance_Ns_per_m), tick_s_(tick_s), prediction_(response_m_per_N) {}
  void observe(const Motion& motion) override {
    HandEnd::observe(motion);
    prediction_.observe(motion.displacement_m / motion.ticks, motion.applied_N);
    sent_.wave.add(wave_ - std::sqrt(2 / impedance_) * motion.applied_N, motion.ticks * tick_s_);
    receiver_.prolong((motion.ticks - 1) * tick_s_);
  }
  Message message() const override { return sent_; }
  Vec3 force(const Arrival& arrival) override {
    wave_ = receiver_.next(arrival.message.wave, tick_s_);
    const double per_tick = impedance_ / tick_s_;
    return (std::sqrt(2 * impedance_) * wave_ - per_tick * prediction_.free_displacement()) /
           (1 + per_tick * prediction_.response_m_per_N());
  }

 private:
  const double impedance_, tick_s_;
  MotionPrediction prediction_;
  WaveReceiver receiver_;
  Vec3 wave_ = Vec3::Zero();
  Message sent_;
};

// w is the mean of (b c' - D) / sqrt(2 b) in a tick, whose square is at most the mean square.
class WaveSlave final : public SlaveEnd {
 public:
  WaveSlave(double impedance_Ns_per_m, double tick_s) : impedance_(impedance_Ns_per_m), tick_s_(tick_s) {}
  void observe(const Motion& motion) override {
    energy_.add(-motion.reference_work_J);
    const Vec3 back_N = impedance_ / tick_s_ * motion.reference_displacement_m - motion.drive_N;
    sent_.wave.add(back_N / std::sqrt(2 * impedance_), tick_s_);
  }
  Message message() const override { return sent_; }
  Vec3 command(const Vec3& arrived_W, const Message& newest) override {
    if (is_placed_) wave_ = Slave::Wave{receiver_.next(newest.wave, tick_s_), impedance_};
    is_placed_ = true;
    return arrived_W;
  }
  std::optional<Slave::Wave> wave() const override { return wave_; }

 private:
  const double impedance_, tick_s_;
  WaveReceiver receiver_;
  bool is_placed_ = false;
  std::optional<Slave::Wave> wave_;
  Message sent_;
};

// Stiffness of the slave's drive, N/m.
double drive_stiffness(const SlaveSettings& slave) {
  return slave.mass_kg * std::pow(natural_rate_per_s(slave), 2);
}

}  // namespace

Parameters parameters(PassivitySettings& s) {
  return {
      {"max_damping_Ns_per_m", &s.max_damping_Ns_per_m, 0, 10000,
       "largest damping at the hand with which the passivity controller repays energy of earlier ticks"},
      {"max_yield_m_per_s", &s.max_yield_m_per_s, 0, 10,
       "largest speed at the slave with which the passivity controller repays energy of earlier ticks"},
      {"drift_time_s", &s.drift_time_s, 0, 100,
       "time constant with which the slave returns from its drift if the energy suffices; 0: never"},
  };
}

void PortEnergy::add(double energy_J) {
  if (energy_J > 0) repaid_J += std::min(energy_J, std::max(0.0, -balance_J()));
  (energy_J > 0 ? in_J : out_J) += std::abs(energy_J);
}

void PortEnergy::receive(double far_credit_J) {
  received_J = std::max(received_J, far_credit_J);
}

void MotionPrediction::observe(const Vec3& displacement_m, const Vec3& force_N) {
  last_but_one_m_ = last_m_, last_m_ = displacement_m;
  last_but_one_force_N_ = last_force_N_, last_force_N_ = force_N;
}

Vec3 MotionPrediction::free_displacement() const {
  return response_ > 0 ? Vec3(2 * last_m_ - last_but_one_m_ - response_ * last_but_one_force_N_) : last_m_;
}

ImpedancePassivityController::ImpedancePassivityController(const PassivitySettings& settings, double tick_s,
                                                           double response_m_per_N)
    : response_(response_m_per_N), max_stiffness_(settings.max_damping_Ns_per_m / tick_s) {}

Vec3 ImpedancePassivityController::force(const Vec3& delayed_force_N, const Vec3& free_displacement_m,
                                         double far_credit_J) {
  energy_.receive(far_credit_J);
  delayed_force_N_ = delayed_force_N;
  return delayed_force_N -
         removed({free_displacement_m, response_}, delayed_force_N, energy_.balance_J(), max_stiffness_);
}

void ImpedancePassivityController::observe(const Vec3& displacement_m, const Vec3& applied_N) {
  energy_.add(-applied_N.dot(displacement_m));
  energy_.dissipated_J += std::max(0.0, (delayed_force_N_ - applied_N).dot(displacement_m));
}

AdmittancePassivityController::AdmittancePassivityController(const PassivitySettings& settings, double tick_s,
                                                             double response_N_per_m)
    : response_(response_N_per_m),
      max_yield_m_(settings.max_yield_m_per_s * tick_s),
      drift_share_(settings.drift_time_s > 0 ? std::min(1.0, tick_s / settings.drift_time_s) : 0.0) {}

// The energy has to suffice for the whole way back if the port has a response; otherwise the way back waits.
Vec3 AdmittancePassivityController::correction(const Vec3& motion_m, const Vec3& force_N) const {
  const Vec3 wanted_m = -drift_share_ * drift_m_;
  const double spare_J = energy_.balance_J() + force_N.dot(motion_m);
  if (response_ > 0) {
    const double response_J = response_ * (motion_m + wanted_m).squaredNorm();
    return response_J - force_N.dot(wanted_m) <= spare_J ? wanted_m : Vec3(Vec3::Zero());
  }
  const double cost_J = -force_N.dot(wanted_m);
  return cost_J <= 0 ? wanted_m : Vec3(std::clamp(spare_J / cost_J, 0.0, 1.0) * wanted_m);
}

Vec3 AdmittancePassivityController::command(const Vec3& delayed_W, const Vec3& expected_force_N,
                                            double far_credit_J) {
  energy_.receive(far_credit_J);
  if (!is_placed_) delayed_W_ = delayed_W;
  is_placed_ = true;
  motion_m_ = delayed_W - delayed_W_;
  const Vec3 returned_m = correction(motion_m_, expected_force_N);
  motion_m_ += returned_m;
  // An older debt is repaid with at most max_yield_m_: share * |f| = max_yield_m_.
  const double length_N = expected_force_N.norm();
  const double max_for_debt = length_N > 0 ? max_yield_m_ / length_N : 0;
  yield_m_ = -removed({-expected_force_N, response_}, motion_m_, energy_.balance_J(), max_for_debt);
  delayed_W_ = delayed_W;
  drift_m_ += returned_m + yield_m_;
  return delayed_W + drift_m_;
}

void AdmittancePassivityController::observe(const Vec3& force_N) {
  energy_.add(force_N.dot(motion_m_ + yield_m_));
  energy_.dissipated_J += std::max(0.0, force_N.dot(yield_m_));
}

bool feels_slave(Feedback force) {
  return force != Feedback::rendered && force != Feedback::none;
}

Parameters parameters(FeedbackSettings& s) {
  Parameters own{
      {"force",
       choice(s.force,
              {"rendered", "none", "slave-force", "passive-slave-force", "position-position", "wave"}),
       0, 0,
       "what the hand feels: the renderer's force, nothing, the force of the scene on the slave, this force with passivity control, a spring and a damper to the slave, or the slave through wave variables"},
      {"gain", &s.gain, 0, 100, "factor on the force of the scene on the slave, for slave-force"},
  };
  return appended(appended(appended(std::move(own), parameters(s.hold)), parameters(s.passivity)),
                  {{"stiffness_N_per_m", &s.stiffness_N_per_m, 0, 1e5,
                    "stiffness of the spring from the hand to the slave, for position-position"},
                   {"damping_Ns_per_m", &s.damping_Ns_per_m, 0, 1e4, "damping beside this spring"},
                   {"impedance_Ns_per_m", &s.impedance_Ns_per_m, 0, 1e4,
                    "impedance of the waves, for wave; 0: matched to the damping of the slave's drive"}});
}

std::string validate(const FeedbackSettings& s) {
  const FeedbackSettings usual;
  const auto why = [&](const char* name, double FeedbackSettings::*setting, Feedback force,
                       const char* expected) -> std::string {
    if (s.force == force || s.*setting == usual.*setting) return {};
    return std::string(name) + " = " + std::to_string(s.*setting) + ": expected " + expected +
           "; a sweep sets both in a variant";
  };
  for (const std::string& problem :
       {why("gain", &FeedbackSettings::gain, Feedback::slave_force, "1 unless force = slave-force"),
        why("stiffness_N_per_m", &FeedbackSettings::stiffness_N_per_m, Feedback::position_position,
            "600 unless force = position-position"),
        why("damping_Ns_per_m", &FeedbackSettings::damping_Ns_per_m, Feedback::position_position,
            "10 unless force = position-position"),
        why("impedance_Ns_per_m", &FeedbackSettings::impedance_Ns_per_m, Feedback::wave,
            "0 unless force = wave")})
    if (!problem.empty()) return problem;
  return {};
}

double wave_impedance_Ns_per_m(const FeedbackSettings& feedback, const SlaveSettings& slave) {
  if (feedback.impedance_Ns_per_m > 0) return feedback.impedance_Ns_per_m;
  return 2 * slave.damping_ratio * natural_rate_per_s(slave) * slave.mass_kg;
}

double felt_stiffness_N_per_m(const SlaveSettings& slave, const FeedbackSettings& feedback) {
  assert(feedback.force != Feedback::rendered);
  const double drive = drive_stiffness(slave), contact = slave.contact_stiffness_N_per_m;
  if (feedback.force == Feedback::none || contact == 0) return 0;
  if (feedback.force == Feedback::position_position)
    return feedback.stiffness_N_per_m * contact / (drive + contact);
  return feedback.gain / (1 / drive + 1 / contact);
}

void Wave::add(const Vec3& next, double time_s) {
  value = next;
  integral += time_s * next;
  energy_J += time_s * next.squaredNorm() / 2;
}

Vec3 WaveReceiver::next(const Wave& newest, double tick_s) {
  const Vec3 missing = newest.integral - used_.integral;
  const double energy_J = std::max(0.0, newest.energy_J - used_.energy_J);
  const double usual = std::max(newest.value.norm(), missing.norm() / kCatchUp_s);
  used_.add(limited_length(missing / tick_s, std::min(usual, std::sqrt(2 * energy_J / tick_s))), tick_s);
  return used_.value;
}

Ends make_ends(const FeedbackSettings& feedback, const SlaveSettings& slave, double hand_mass_kg,
               double tick_s) {
  assert(validate(feedback).empty() && tick_s > 0);
  const double response = hand_mass_kg > 0 ? tick_s * tick_s / (2 * hand_mass_kg) : 0;
  switch (feedback.force) {
    case Feedback::passive_slave_force:
      return {std::make_unique<PassiveHand>(feedback.passivity, response, tick_s),
              std::make_unique<PassiveSlave>(feedback.passivity, tick_s)};
    case Feedback::position_position:
      return {std::make_unique<PositionPositionHand>(feedback, tick_s),
              std::make_unique<PositionPositionSlave>()};
    case Feedback::wave: {
      const double impedance = wave_impedance_Ns_per_m(feedback, slave);
      return {std::make_unique<WaveHand>(impedance, response, tick_s),
              std::make_unique<WaveSlave>(impedance, tick_s)};
    }
    default:
      return {std::make_unique<PositionForceHand>(feedback.gain), std::make_unique<PositionForceSlave>()};
  }
}

}  // namespace remote_touch
