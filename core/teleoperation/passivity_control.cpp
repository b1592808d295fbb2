#include "core/teleoperation/passivity_control.h"

#include <algorithm>
#include <cmath>

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

}  // namespace remote_touch
