// Derivation of the error bound in the header, in units of the roundoff 2^-53. Every coefficient is computed
// as a Taylor series for T / 2^s, and addition theorems then double that time s times.
//
// Series: phi = sum f_n t^n with n (n + 1) f_(n+1) = -d n f_n - w f_(n-1), so n! |f_n| <= M^(n-1) with
// M = d + sqrt(w). s is the least number with M T / 2^s <= 1/2. The terms that are left out are below
// (1/2)^19 / 20! < 1e-24 of the first one. Each sum is above 0.6 of its first term and is added up from the
// smallest term on, which costs less than 3 roundoffs.
//
// Doubling without oscillation (d^2 >= 4 w): every sum in double_up() for phi, psi and chi has positive
// terms, and a relative error of one level enters the next level with a factor of at most 1 until the
// quantity saturates or decays. At most 4 roundoffs are added on each of at most 2 + log2(M T) < 20 levels:
// 80 in all.
//
// Doubling with oscillation: z = (1 - w psi) + i sqrt(w) phi lies within the unit circle and is squared, so
// its error doubles on each level. The levels before an angle of 1 add 2 roundoffs of the angle each, and
// those after it at most 10 roundoffs of 1. Let a = sqrt(w) T be the angle at the end. The first kind then
// gives (3 + 2 * 2) a, and the second less than 10 (1 + 1/2 + 1/4 + ...) a = 20 a: 27 (1 + a) in all. 27 * 33
// roundoffs are 9.9e-14.
#include "runners/experiment/hand/held_force_step.h"

#include <cmath>

namespace remote_touch {

namespace {

constexpr int kTerms = 19;
constexpr double kSeriesRange = 0.5;

// phi, psi and chi after the time t, and the integrals of psi^2, phi^2 and phi'^2 from 0 to t. The integrals
// are not valid with Squares::left_out.
struct Responses {
  double t = 0, phi = 0, psi = 0, chi = 0, psi_psi = 0, phi_phi = 0, slope_slope = 0;
};

enum class Squares { left_out, integrated };

// Returns the responses after a short time t. pre: (d + sqrt(w)) t <= 1/2.
Responses series(double w, double d, double t, Squares squares) {
  // phi = t sum(term), phi' = sum(slope) and psi = t^2 sum(area), where term[n] is f_(n+1) t^n.
  double term[kTerms], slope[kTerms], area[kTerms];
  const double wt = w * t * t, dt = d * t;
  term[0] = 1, term[1] = -dt / 2;
  for (int n = 2; n < kTerms; ++n) term[n] = -(dt * n * term[n - 1] + wt * term[n - 2]) / (n * (n + 1));
  for (int n = 0; n < kTerms; ++n) slope[n] = (n + 1) * term[n], area[n] = term[n] / (n + 2);
  double phi = 0, psi = 0, chi = 0, psi_psi = 0, phi_phi = 0, slope_slope = 0;
  for (int n = kTerms - 1; n >= 0; --n) {
    phi += term[n];
    psi += area[n];
    chi += area[n] / (n + 3);
    if (squares == Squares::left_out) continue;
    double area_square = 0, square = 0, slope_square = 0;  // the terms of order n of the squares
    for (int k = 0; k <= n; ++k) {
      area_square += area[k] * area[n - k];
      square += term[k] * term[n - k];
      slope_square += slope[k] * slope[n - k];
    }
    psi_psi += area_square / (n + 5);
    phi_phi += square / (n + 3);
    slope_slope += slope_square / (n + 1);
  }
  const double tt = t * t, ttt = tt * t;
  return {t, t * phi, tt * psi, ttt * chi, tt * ttt * psi_psi, ttt * phi_phi, t * slope_slope};
}

// Returns the responses after twice the time of r. Let s be the time since the middle, and let a = phi'(t) +
// d phi(t) = 1 - w psi(t). Then
//   psi(t + s) = psi(t) + a psi(s) + phi(t) phi(s),   phi(t + s) = a phi(s) + phi(t) phi'(s),
//   phi'(t + s) = phi'(t) phi'(s) - w phi(t) phi(s),
// and 2 psi phi and 2 phi phi' are the derivatives of psi^2 and phi^2.
Responses double_up(double w, double d, const Responses& r) {
  const double a = 1 - w * r.psi, slope = a - d * r.phi;
  Responses next;
  next.t = 2 * r.t;
  next.phi = r.phi * (2 - 2 * w * r.psi - d * r.phi);
  next.psi = r.psi * (2 - w * r.psi) + r.phi * r.phi;
  next.chi = r.chi * (2 - w * r.psi) + r.psi * (r.t + r.phi);
  const double square = r.phi * r.phi;
  next.psi_psi = r.psi_psi + r.t * r.psi * r.psi + a * a * r.psi_psi + square * r.phi_phi +
                 2 * r.psi * (a * r.chi + r.phi * r.psi) + a * r.phi * r.psi * r.psi;
  next.phi_phi = r.phi_phi + a * a * r.phi_phi + a * r.phi * square + square * r.slope_slope;
  next.slope_slope =
      r.slope_slope + slope * slope * r.slope_slope - w * r.phi * slope * square + w * w * square * r.phi_phi;
  return next;
}

Responses responses(double w, double d, double duration_s, Squares squares) {
  double t = duration_s;
  int doublings = 0;
  for (const double rate = d + std::sqrt(w); rate * t > kSeriesRange; ++doublings) t *= 0.5;
  Responses r = series(w, d, t, squares);
  for (; doublings > 0; --doublings) r = double_up(w, d, r);
  return r;
}

}  // namespace

StepEnergy& StepEnergy::operator+=(const StepEnergy& other) {
  force_work_J += other.force_work_J, path_work_J += other.path_work_J;
  path_damper_J += other.path_damper_J, ground_damper_J += other.ground_damper_J;
  dry_friction_J += other.dry_friction_J;
  kinetic_J += other.kinetic_J, potential_J += other.potential_J;
  return *this;
}

HeldForceStep::HeldForceStep(const MassOnSpring& system, double duration_s)
    : system_(system),
      duration_s_(duration_s),
      w_(system.stiffness / system.mass),
      d_((system.path_damping + system.ground_damping) / system.mass) {
  const Responses r = responses(w_, d_, duration_s, Squares::left_out);
  phi_ = r.phi, psi_ = r.psi, chi_ = r.chi;
  slope_ = 1 - w_ * psi_ - d_ * phi_;
}

// Returns the acceleration at the start, without the damping that the velocity of the mass itself causes.
Vec3 HeldForceStep::pull(const Start& start) const {
  return (start.force + system_.stiffness * start.apart + system_.path_damping * start.path_velocity) /
         system_.mass;
}

HeldForceStep::Motion HeldForceStep::motion(const Start& start) const {
  const Vec3 r = pull(start), ramp = w_ * start.path_velocity;
  return {phi_ * start.velocity + psi_ * r + chi_ * ramp, slope_ * start.velocity + phi_ * r + psi_ * ramp};
}

// The energies need integrals of e = x - p, e'^2 and x'^2. The motion gives e' = e'(0) phi' + r phi and x' =
// x'(0) phi' + pull phi + w p' psi, so these integrals are closed forms in phi, psi, chi and the integrals of
// squares. No energy is derived from the energy balance, so the balance is an independent check. Changes are
// computed directly, and not as differences of nearly equal numbers.
StepEnergy HeldForceStep::energy(const Start& start) const {
  // A path without spring and damper has no effect, however fast it is.
  const bool follows = system_.stiffness > 0 || system_.path_damping > 0;
  const Vec3 path_velocity = follows ? start.path_velocity : Vec3(Vec3::Zero());
  const Vec3 slip = start.velocity - path_velocity;  // e'(0)
  const Vec3 r =
      (start.force + system_.stiffness * start.apart - system_.ground_damping * path_velocity) / system_.mass;
  const Vec3 apart_sum = duration_s_ * start.apart - psi_ * slip - chi_ * r;  // the integral of p - x
  const Vec3 apart_change = -(phi_ * slip + psi_ * r);
  const Vec3 velocity_change = phi_ * r - (w_ * psi_ + d_ * phi_) * slip;
  const Responses integrals = responses(w_, d_, duration_s_, Squares::integrated);
  const Vec3 a = pull(start), ramp = w_ * path_velocity;
  const double velocity_squares =
      integrals.slope_slope * start.velocity.squaredNorm() + integrals.phi_phi * a.squaredNorm() +
      integrals.psi_psi * ramp.squaredNorm() + phi_ * phi_ * a.dot(start.velocity) +
      2 * (phi_ * psi_ - integrals.phi_phi) * ramp.dot(start.velocity) + psi_ * psi_ * a.dot(ramp);

  StepEnergy energy;
  energy.force_work_J = start.force.dot(motion(start).displacement);
  energy.path_work_J = path_velocity.dot(system_.stiffness * apart_sum + system_.path_damping * apart_change);
  energy.path_damper_J =
      system_.path_damping * (integrals.slope_slope * slip.squaredNorm() + phi_ * phi_ * slip.dot(r) +
                              integrals.phi_phi * r.squaredNorm());
  energy.ground_damper_J = system_.ground_damping * velocity_squares;
  energy.kinetic_J = 0.5 * system_.mass * velocity_change.dot(2 * start.velocity + velocity_change);
  energy.potential_J = 0.5 * system_.stiffness * apart_change.dot(2 * start.apart + apart_change);
  return energy;
}

}  // namespace remote_touch
